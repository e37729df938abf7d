#include "pipeline/run/link_unchanged.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

#include "pipeline/outputs/area_folders.h"
#include "pipeline/run/region_state.h"

namespace blockrand::run {

using Json = nlohmann::ordered_json;

namespace {

bool same_bytes(const std::string& a, const std::string& b) {
  std::ifstream x(a, std::ios::binary), y(b, std::ios::binary);
  std::string p(1 << 16, '\0'), q(1 << 16, '\0');
  while (x && y) {
    x.read(p.data(), static_cast<std::streamsize>(p.size())), y.read(q.data(), static_cast<std::streamsize>(q.size()));
    if (x.gcount() != y.gcount() || std::memcmp(p.data(), q.data(), static_cast<std::size_t>(x.gcount())) != 0)
      return false;
  }
  return x.eof() && y.eof();
}

}  // namespace

LinkedFiles link_unchanged(const std::string& before, const std::string& after,
                           const std::set<std::string>& taken_over) {
  LinkedFiles linked;
  for (const std::string& area : outputs::area_folders(after)) {
    if (!taken_over.contains(area.substr(area.find('/') + 1))) {
      const LinkedFiles its = link_unchanged(before + "/" + area, after + "/" + area, {});
      linked.files += its.files, linked.bytes += its.bytes;
      continue;
    }
    const Json its = read_json(after + "/" + area + "/build.json");  // linked when it was taken over
    if (its.contains("files"))
      for (const auto& [path, entry] : its["files"].items())
        ++linked.files, linked.bytes += entry.value("bytes", std::uint64_t{0});
  }
  const Json old = read_json(before + "/build.json"), now = read_json(after + "/build.json");
  if (!old.contains("files") || !now.contains("files")) return linked;
  for (const auto& [path, entry] : now["files"].items()) {
    if (!old["files"].contains(path) || old["files"][path] != entry) continue;
    const std::string from = before + "/" + path, to = after + "/" + path, link = to + ".link";
    struct stat one {
    }, other{};
    if (::stat(from.c_str(), &one) == 0 && ::stat(to.c_str(), &other) == 0 && one.st_ino == other.st_ino &&
        one.st_dev == other.st_dev) {  // by way of the cache
      ++linked.files;
      linked.bytes += static_cast<std::uint64_t>(one.st_size);
      continue;
    }
    // A disk may have lost what the record says: bytes are compared, not hashes.
    if (!same_bytes(from, to)) continue;
    ::unlink(link.c_str());
    if (::link(from.c_str(), link.c_str()) != 0) continue;  // another disk, too many links: two files, then
    if (::rename(link.c_str(), to.c_str()) != 0) {
      ::unlink(link.c_str());
      continue;
    }
    ++linked.files;
    if (entry.contains("bytes")) linked.bytes += entry["bytes"].get<std::uint64_t>();
  }
  return linked;
}

}  // namespace blockrand::run
