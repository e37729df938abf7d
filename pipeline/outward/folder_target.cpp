#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

#include "pipeline/base/error.h"
#include "pipeline/base/sha256.h"
#include "pipeline/outward/target.h"

namespace blockrand::outward {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void cannot_put(const std::string& path, int error) {
  throw base::OutputError(path + ": cannot be written: " + std::strerror(error) +
                          (error == ENOSPC || error == EDQUOT
                               ? ". Make room there, and publish again: it goes on there"
                               : ". Check the web root's permissions, and publish again"));
}

/// A file that is closed at the end, and removed unless it was renamed.
struct Part {
  explicit Part(const std::string& place) : path(place + ".blockrand-part") {
    descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    if (descriptor < 0) cannot_put(path, errno);
  }
  ~Part() {
    if (descriptor >= 0) ::close(descriptor);
    if (!done) ::unlink(path.c_str());
  }
  Part(const Part&) = delete;
  Part& operator=(const Part&) = delete;

  void write(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t n = ::write(descriptor, bytes.data(), bytes.size());
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) cannot_put(path, errno);
      bytes.remove_prefix(static_cast<std::size_t>(n));
    }
  }
  void become(const std::string& place) {
    const int closed = ::close(descriptor);
    descriptor = -1;
    if (closed != 0 || ::rename(path.c_str(), place.c_str()) != 0) cannot_put(place, errno);
    done = true;
  }

  std::string path;
  int descriptor = -1;
  bool done = false;
};

void make_parent(const std::string& place) {
  std::error_code error;
  fs::create_directories(fs::path(place).parent_path(), error);
  if (error) cannot_put(fs::path(place).parent_path().string(), error.value());
}

void copy_file(const std::string& from, const std::string& to, const BuildFile& file) {
  make_parent(to);
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> in(std::fopen(from.c_str(), "rbe"), &std::fclose);
  if (!in) check_there(from.substr(0, from.size() - file.path.size() - 1), file);
  Part part(to);
  base::Sha256 hash;
  std::array<char, 1 << 16> piece;
  for (std::size_t n = 0; in && (n = std::fread(piece.data(), 1, piece.size(), in.get())) > 0;) {
    hash.add({piece.data(), n});
    part.write({piece.data(), n});
  }
  if (hash.finish() != file.sha256)
    throw base::InputError(from, "", "is not the file that build.json names: the build is damaged",
                           "Nothing of it was sent. 'blockrand validate' tells what else is; build again");
  part.become(to);
}

/// Folders that became empty, up to the root.
void remove_empty_parents(const std::string& root, const std::string& path) {
  for (fs::path folder = fs::path(path).parent_path(); !folder.empty(); folder = folder.parent_path())
    if (::rmdir((root + "/" + folder.string()).c_str()) != 0) return;
}

void refuse_own_folders(const std::string& folder) {
  std::error_code error;
  for (fs::path at = fs::weakly_canonical(fs::absolute(folder)); at.has_relative_path(); at = at.parent_path())
    if (fs::exists(at / "region.toml", error))
      throw base::UsageError("--web-root " + folder + " lies in the region " + at.string() +
                             ". Name a web root beside it.");
  // A web root has the build.json of what was sent to it, but not run.json.
  if (fs::exists(folder + "/run.json", error))
    throw base::UsageError("--web-root " + folder + " is a build itself. Name a web root beside it.");
}

}  // namespace

void check_there(const std::string& build, const BuildFile& file) {
  std::error_code error;
  const std::string place = build + "/" + file.path;
  const std::uintmax_t size = fs::file_size(place, error);
  if (error)
    throw base::InputError(place, "", "is gone: " + error.message(),
                           "Perhaps the region has removed this build; publish again, the newest one");
  if (size != file.bytes)
    throw base::InputError(place, "", "has another size than build.json says: the build is damaged",
                           "'blockrand validate' tells what else is; build again");
}

Target folder_target(const std::string& build, const std::string& folder) {
  refuse_own_folders(folder);
  Target target;
  target.put = [build, folder](const Batch& batch, const MakeVariant& variant) {
    std::vector<std::string> variants;
    for (const BuildFile& file : batch.files) {
      const std::string place = folder + "/" + file.path;
      copy_file(build + "/" + file.path, place, file);
      const std::string bytes = variant ? variant(file) : std::string();
      if (bytes.empty()) continue;
      Part part(place + ".gz");
      part.write(bytes);
      part.become(place + ".gz");
      variants.push_back(file.path + ".gz");
    }
    return variants;
  };
  target.remove = [folder](std::span<const std::string> paths, int, int) {
    for (const std::string& path : paths) {
      if (::unlink((folder + "/" + path).c_str()) != 0 && errno != ENOENT) cannot_put(folder + "/" + path, errno);
      remove_empty_parents(folder, path);
    }
  };
  target.has = [folder](const BuildFile& file) {
    std::error_code error;
    const std::string place = folder + "/" + file.path;
    return fs::file_size(place, error) == file.bytes && !error && base::sha256_file(place) == file.sha256;
  };
  return target;
}

}  // namespace blockrand::outward
