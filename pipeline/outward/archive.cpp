#include "pipeline/outward/archive.h"

#include <openssl/evp.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <set>
#include <stdexcept>
#include <tuple>

#include "pipeline/base/deflate.h"
#include "pipeline/base/error.h"
#include "pipeline/outward/part_file.h"

namespace blockrand::outward {
namespace {

constexpr std::string_view kIndexName = "@3dtilesIndex1@";
constexpr std::uint64_t kMost32 = std::numeric_limits<std::uint32_t>::max();
constexpr std::uint64_t kMost16 = std::numeric_limits<std::uint16_t>::max();

void append_number(std::string& out, std::uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) out += static_cast<char>(value >> (8 * i) & 0xff);
}

std::uint64_t little_endian(const std::uint8_t* bytes) {
  std::uint64_t value = 0;
  for (int i = 7; i >= 0; --i) value = value << 8 | bytes[i];
  return value;
}

void refuse_large(const std::string& build, const BuildFile& file) {
  if (file.bytes >= kMost32)
    throw base::InputError(build + "/" + file.path, "", "has 4 GB or more, which a 3D Tiles archive cannot hold",
                           "Build smaller tiles: max_glb_bytes");
}

/// tileset.json and all that it leads to.
std::set<std::string> reachable(const std::string& build, const std::map<std::string, BuildFile>& files) {
  std::set<std::string> found{"tileset.json"};
  std::vector<std::string> waiting{"tileset.json"};
  while (!waiting.empty()) {
    const std::string from = std::move(waiting.back());
    waiting.pop_back();
    const bool glb = from.ends_with(".glb");
    if (!glb && !from.ends_with(".json")) continue;
    for (std::string& to : glb ? companions_of_glb(build, from) : contents_of_tileset(build, from)) {
      if (!files.contains(to))
        throw base::InputError(build + "/" + from, "", "leads to " + to + ", which the build does not name",
                               "Build again");
      if (found.insert(to).second) waiting.push_back(std::move(to));
    }
  }
  return found;
}

}  // namespace

std::array<std::uint8_t, 16> archive_hash(std::string_view path) {
  while (path.starts_with('/')) path.remove_prefix(1);
  std::array<std::uint8_t, 16> digest{};
  unsigned int size = 0;
  if (EVP_Digest(path.data(), path.size(), digest.data(), &size, EVP_md5(), nullptr) != 1 || size != digest.size())
    throw std::runtime_error("OpenSSL cannot compute MD5, which the index of a 3D Tiles archive is made of");
  return digest;
}

std::string archive_index(std::vector<ArchiveEntry> entries) {
  const auto key = [](const ArchiveEntry& e) {
    return std::tuple(little_endian(e.md5.data()), little_endian(e.md5.data() + 8), e.offset);
  };
  std::ranges::sort(entries, std::less<>(), key);
  std::string out;
  for (const ArchiveEntry& entry : entries) {
    out.append(reinterpret_cast<const char*>(entry.md5.data()), entry.md5.size());
    append_number(out, entry.offset, 8);
  }
  return out;
}

void ZipWriter::write(std::string_view bytes) {
  append_(bytes);
  size_ += bytes.size();
}

std::uint64_t ZipWriter::add(std::string_view name, std::string_view bytes, bool deflate) {
  constexpr int kLevel = 9;
  constexpr std::uint64_t kDeflated = 8, kFirstDay = 1 << 5 | 1;  // 1980-01-01
  constexpr std::uint64_t kVersion = 20, kVersion64 = 45;
  const std::uint64_t offset = size_;
  std::string packed;
  if (deflate) packed = base::deflated(bytes, kLevel, base::DeflateFormat::raw);
  const bool smaller = deflate && packed.size() < bytes.size();
  const std::string_view data = smaller ? std::string_view(packed) : bytes;
  const bool far = offset >= kMost32;
  // What the file's own header and its line in the directory have in common.
  std::string common;
  append_number(common, far ? kVersion64 : kVersion, 2);
  append_number(common, 0, 2);  // flags
  append_number(common, smaller ? kDeflated : 0, 2);
  append_number(common, 0, 2);  // time of day
  append_number(common, kFirstDay, 2);
  append_number(common, base::crc32_of(bytes), 4);
  append_number(common, data.size(), 4);
  append_number(common, bytes.size(), 4);
  append_number(common, name.size(), 2);
  std::string header = "PK\x03\x04" + common;
  append_number(header, 0, 2);  // extra fields
  header += name;
  write(header);
  write(data);
  directory_ += "PK\x01\x02";
  append_number(directory_, far ? kVersion64 : kVersion, 2);
  directory_ += common;
  constexpr std::uint64_t kExtra = 12;  // bytes: id, size, offset
  append_number(directory_, far ? kExtra : 0, 2);
  append_number(directory_, 0, 2);  // comment
  append_number(directory_, 0, 2);  // disk
  append_number(directory_, 0, 2);  // attributes
  append_number(directory_, 0, 4);
  append_number(directory_, far ? kMost32 : offset, 4);
  directory_ += name;
  if (far) {
    append_number(directory_, 1, 2);  // ZIP64
    append_number(directory_, 8, 2);
    append_number(directory_, offset, 8);
  }
  ++entries_;
  return offset;
}

void ZipWriter::close() {
  const std::uint64_t begin = size_, length = directory_.size();
  write(directory_);
  std::string end;
  if (entries_ >= kMost16 || begin >= kMost32 || length >= kMost32) {
    const std::uint64_t record = size_;
    constexpr std::uint64_t kVersion64 = 45, kRest = 44;  // bytes that follow the size
    end += "PK\x06\x06";
    append_number(end, kRest, 8);
    append_number(end, kVersion64, 2);
    append_number(end, kVersion64, 2);
    append_number(end, 0, 4);  // disks
    append_number(end, 0, 4);
    append_number(end, entries_, 8);
    append_number(end, entries_, 8);
    append_number(end, length, 8);
    append_number(end, begin, 8);
    end += "PK\x06\x07";
    append_number(end, 0, 4);
    append_number(end, record, 8);
    append_number(end, 1, 4);
  }
  end += "PK\x05\x06";
  append_number(end, 0, 4);  // disks
  append_number(end, std::min(entries_, kMost16), 2);
  append_number(end, std::min(entries_, kMost16), 2);
  append_number(end, std::min(length, kMost32), 4);
  append_number(end, std::min(begin, kMost32), 4);
  append_number(end, 0, 2);  // comment
  write(end);
}

ArchiveSummary write_archive(const std::string& build, const std::map<std::string, BuildFile>& files,
                             const std::string& path, base::Progress& progress) {
  if (!path.ends_with(".3tz"))
    throw base::UsageError("--archive " + path + ": the name of a 3D Tiles archive ends with .3tz.");
  if (!files.contains("tileset.json"))
    throw base::UsageError(build + " has no tileset.json to pack: build with --formats gltf.");
  const std::set<std::string> names = reachable(build, files);
  progress.begin("archive", names.size(), "files");
  PartFile file(path);
  ZipWriter zip([&file](std::string_view bytes) { file.append(bytes); });
  std::vector<ArchiveEntry> entries;
  for (const std::string& name : names) {
    refuse_large(build, files.at(name));
    const std::string bytes = whole_file(build, files.at(name));
    const bool text = name.ends_with(".json");
    entries.push_back({archive_hash(name), zip.add(name, bytes, text)});
    progress.advance_to(entries.size());
  }
  const std::uint64_t count = entries.size();
  zip.add(kIndexName, archive_index(std::move(entries)), false);
  zip.close();
  file.publish_on_disk();
  return {count, zip.size()};
}

}  // namespace blockrand::outward
