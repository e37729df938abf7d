#include "importers/osm/node_file.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <string_view>

#include "importers/osm/raw_data.h"
#include "pipeline/base/error.h"

namespace blockrand::importers::osm {
namespace {

/// Rises in the order of files.
std::uint64_t key_of(std::int64_t id) {
  return id < 0 ? static_cast<std::uint64_t>(-(id + 1)) : static_cast<std::uint64_t>(id) + (std::uint64_t{1} << 63);
}

void put(std::string& bytes, std::uint64_t value) {
  for (; value >= 128; value >>= 7) bytes.push_back(static_cast<char>(value | 128));
  bytes.push_back(static_cast<char>(value));
}
void put_signed(std::string& bytes, std::int64_t value) {
  put(bytes, (static_cast<std::uint64_t>(value) << 1) ^ static_cast<std::uint64_t>(value >> 63));
}

std::uint64_t take(std::string_view& bytes) {
  std::uint64_t value = 0;
  for (int shift = 0; !bytes.empty(); shift += 7) {
    const auto byte = static_cast<unsigned char>(bytes.front());
    bytes.remove_prefix(1);
    value |= std::uint64_t{byte & 127u} << shift;
    if (byte < 128 || shift >= 63) break;
  }
  return value;
}
std::int64_t take_signed(std::string_view& bytes) {
  const std::uint64_t value = take(bytes);
  return static_cast<std::int64_t>(value >> 1) ^ -static_cast<std::int64_t>(value & 1);
}

}  // namespace

NodeFile::NodeFile(std::string path) : path_(std::move(path)) {
  std::error_code error;
  std::filesystem::remove(path_, error);  // it may be a link to that of another store
  out_.open(path_, std::ios::binary | std::ios::trunc);
  if (!out_) throw base::OutputError(path_ + ": cannot be written: " + std::strerror(errno));
}

NodeFile::NodeFile(std::string path, std::vector<std::pair<std::uint64_t, std::uint64_t>> blocks, std::uint64_t bytes)
    : path_(std::move(path)), kept_(true), in_(path_, std::ios::binary), blocks_(std::move(blocks)), bytes_(bytes) {}

NodeFile::~NodeFile() {
  if (kept_) return;
  std::error_code error;
  std::filesystem::remove(path_, error);
}

void NodeFile::add(std::int64_t id, model::Location place) {
  pending_.emplace_back(key_of(id), place);
  if (pending_.size() == kBlock) write_block();
}

void NodeFile::write_block() {
  if (pending_.empty()) return;
  blocks_.emplace_back(pending_.front().first, bytes_);
  std::string bytes;
  std::uint64_t key = pending_.front().first;
  model::Location place{0, 0};
  for (const auto& [k, l] : pending_) {
    put(bytes, k - key);
    put_signed(bytes, std::int64_t{l.lon} - place.lon), put_signed(bytes, std::int64_t{l.lat} - place.lat);
    key = k, place = l;
  }
  out_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!out_) throw base::OutputError(path_ + ": cannot be written: " + std::strerror(errno) + ". Free some space");
  bytes_ += bytes.size();
  pending_.clear();
}

void NodeFile::finish() {
  write_block();
  out_.close();
  if (!out_) throw base::OutputError(path_ + ": cannot be written: " + std::strerror(errno) + ". Free some space");
  in_.open(path_, std::ios::binary);
}

const NodeFile::Block& NodeFile::block(std::size_t index) {
  if (const auto found = loaded_.find(index); found != loaded_.end()) {
    recent_.splice(recent_.begin(), recent_, found->second);
    return found->second->second;
  }
  const std::uint64_t from = blocks_[index].second,
                      to = index + 1 < blocks_.size() ? blocks_[index + 1].second : bytes_;
  std::string bytes(to - from, '\0');
  in_.clear();
  in_.seekg(static_cast<std::streamoff>(from));
  in_.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!in_) throw base::InputError(path_, "", "cannot be read any more", "Run again");
  Block read;
  read.reserve(kBlock);
  std::uint64_t key = blocks_[index].first;
  std::int64_t lon = 0, lat = 0;
  for (std::string_view rest = bytes; !rest.empty();) {
    key += take(rest), lon += take_signed(rest), lat += take_signed(rest);
    read.emplace_back(key, model::Location{static_cast<std::int32_t>(lon), static_cast<std::int32_t>(lat)});
  }
  if (recent_.size() >= kBlocksInMemory) {
    loaded_.erase(recent_.back().first);
    recent_.pop_back();
  }
  recent_.emplace_front(index, std::move(read));
  loaded_[index] = recent_.begin();
  return recent_.front().second;
}

model::Location NodeFile::find(std::int64_t id) {
  const std::uint64_t key = key_of(id);
  const auto after = std::upper_bound(blocks_.begin(), blocks_.end(), key,
                                      [](std::uint64_t k, const auto& block) { return k < block.first; });
  if (after == blocks_.begin()) return kMissing;
  const Block& its = block(static_cast<std::size_t>(after - blocks_.begin()) - 1);
  const auto found =
      std::lower_bound(its.begin(), its.end(), key, [](const auto& node, std::uint64_t k) { return node.first < k; });
  return found == its.end() || found->first != key ? kMissing : found->second;
}

}  // namespace blockrand::importers::osm
