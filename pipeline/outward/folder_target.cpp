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
#include "pipeline/outward/part_file.h"
#include "pipeline/outward/target.h"

namespace blockrand::outward {
namespace {

namespace fs = std::filesystem;

void make_parent(const std::string& place) {
  std::error_code error;
  fs::create_directories(fs::path(place).parent_path(), error);
  if (error) cannot_put(fs::path(place).parent_path().string(), error.value());
}

void copy_file(const std::string& from, const std::string& to, const BuildFile& file) {
  make_parent(to);
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> in(std::fopen(from.c_str(), "rbe"), &std::fclose);
  if (!in) check_there(from.substr(0, from.size() - file.path.size() - 1), file);
  PartFile part(to);
  base::Sha256 hash;
  std::array<char, 1 << 16> piece;
  for (std::size_t n = 0; in && (n = std::fread(piece.data(), 1, piece.size(), in.get())) > 0;) {
    hash.add({piece.data(), n});
    part.append({piece.data(), n});
  }
  if (hash.finish() != file.sha256) throw_damaged(from);
  part.publish();
}

/// Folders that became empty, up to the root.
void remove_empty_parents(const std::string& root, const std::string& path) {
  for (fs::path folder = fs::path(path).parent_path(); !folder.empty(); folder = folder.parent_path())
    if (::rmdir((root + "/" + folder.string()).c_str()) != 0) return;
}

/// What was written there, and its names, are on the disk when it returns: the state that says so is, too.
void sync_file_system(const std::string& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) cannot_put(folder, errno);
  const int synced = ::syncfs(descriptor), error = errno;
  ::close(descriptor);
  if (synced != 0) cannot_put(folder, error);
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
  refuse_own_folders("--web-root", folder);
  Target target;
  target.put = [build, folder](const Batch& batch, const MakeVariant& variant) {
    std::vector<std::string> variants;
    for (const BuildFile& file : batch.files) {
      const std::string place = folder + "/" + file.path;
      copy_file(build + "/" + file.path, place, file);
      const std::string bytes = variant ? variant(file) : std::string();
      if (bytes.empty()) continue;
      PartFile part(place + ".gz");
      part.append(bytes);
      part.publish();
      variants.push_back(file.path + ".gz");
    }
    sync_file_system(folder);
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
