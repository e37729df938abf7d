#include "importers/osm/pbf_blobs.h"

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <osmium/io/detail/pbf_decoder.hpp>
#include <protozero/pbf_reader.hpp>
#include <protozero/pbf_writer.hpp>
#include <vector>

#include "pipeline/base/error.h"

namespace blockrand::importers::osm {
namespace {

// Limits of the format's specification (wiki.openstreetmap.org/wiki/PBF_Format).
constexpr std::uint32_t kMaxBlobHeader = 64 * 1024;
constexpr std::int64_t kMaxBlob = 32 * 1024 * 1024;
constexpr const char* kFetchAgain = "Fetch or write the file again";

struct BlobPlace {
  std::uint64_t begin = 0;  ///< byte of the length field
  std::uint64_t blob = 0;   ///< byte of the Blob message
  std::int64_t size = 0;
  std::string type;
};

[[noreturn]] void fail(const std::string& path, std::uint64_t byte, const std::string& what) {
  throw base::InputError(path, "byte " + std::to_string(byte), what, kFetchAgain);
}

/// Calls `visit(stream, place)` for every blob, the stream standing at its first byte.
template <class Visit>
void for_each_blob(const std::string& path, Visit&& visit) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw base::InputError(path, "", "cannot be opened", "Check the permissions of the file");
  const std::uint64_t end = std::filesystem::file_size(path);
  std::uint64_t at = 0;
  std::string header;
  while (at < end) {
    BlobPlace place;
    place.begin = at;
    unsigned char length[4];
    if (end - at < 4 || !in.read(reinterpret_cast<char*>(length), 4)) fail(path, at, "the file ends within a blob");
    const std::uint32_t header_size = std::uint32_t{length[0]} << 24 | length[1] << 16 | length[2] << 8 | length[3];
    if (header_size == 0 || header_size > kMaxBlobHeader)
      fail(path, at, at == 0 ? "this is not a PBF file" : "no blob begins here, but the file goes on");
    at += 4;
    if (end - at < header_size) fail(path, place.begin, "the file ends within a blob");
    header.resize(header_size);
    in.read(header.data(), header_size);
    at += header_size;
    try {
      protozero::pbf_reader reader(header);
      while (reader.next()) {
        using Wire = protozero::pbf_wire_type;
        if (reader.tag() == 1 && reader.has_wire_type(Wire::length_delimited))
          place.type = reader.get_string();
        else if (reader.tag() == 3 && reader.has_wire_type(Wire::varint))
          place.size = reader.get_int32();
        else
          reader.skip();
      }
    } catch (const std::exception&) {
      fail(path, place.begin, "the header of a blob is damaged");
    }
    if (place.type.empty() || place.size <= 0 || place.size > kMaxBlob)
      fail(path, place.begin, "the header of a blob is damaged");
    if (end - at < static_cast<std::uint64_t>(place.size)) fail(path, place.begin, "the file ends within a blob");
    place.blob = at;
    visit(in, place);
    at += static_cast<std::uint64_t>(place.size);
    in.seekg(static_cast<std::streamoff>(at));
  }
}

/// The block with NULs in its string table replaced; empty when there are none.
std::string clean_block(std::string_view block, std::unordered_set<std::string>& cleaned) {
  bool dirty = false;
  std::string out;
  protozero::pbf_writer writer(out);
  protozero::pbf_reader reader(block.data(), block.size());
  while (reader.next()) {
    if (reader.tag() == 1 && reader.wire_type() == protozero::pbf_wire_type::length_delimited) {
      protozero::pbf_writer table(writer, 1);
      protozero::pbf_reader strings = reader.get_message();
      while (strings.next(1, protozero::pbf_wire_type::length_delimited)) {
        std::string text = strings.get_string();
        bool hit = false;
        for (std::size_t nul = text.find('\0'); nul != std::string::npos; nul = text.find('\0', nul)) {
          text.replace(nul, 1, "\xEF\xBF\xBD");
          hit = true;
        }
        if (hit) cleaned.insert(text);
        dirty = dirty || hit;
        table.add_bytes(1, text);
      }
    } else if (reader.wire_type() == protozero::pbf_wire_type::length_delimited) {
      writer.add_bytes(reader.tag(), reader.get_string());
    } else if (reader.wire_type() == protozero::pbf_wire_type::varint) {
      writer.add_int64(reader.tag(), reader.get_int64());
    } else {
      reader.skip();
    }
  }
  return dirty ? out : std::string();
}

/// A granularity of 0 puts all nodes of a block at one place. Writers use one granularity for a file: the first block tells.
/// What cannot be unpacked is left to libosmium, which says so.
void check_granularity(const std::string& path, std::ifstream& in, const BlobPlace& place) {
  constexpr protozero::pbf_tag_type kGranularity = 17;  // of PrimitiveBlock, nanodegrees
  std::string blob(static_cast<std::size_t>(place.size), '\0'), unpacked;
  in.read(blob.data(), place.size);
  std::int32_t granularity = 100;
  try {
    const auto block = osmium::io::detail::decode_blob(blob, unpacked);
    protozero::pbf_reader reader(block.data(), block.size());
    while (reader.next())
      if (reader.tag() == kGranularity && reader.has_wire_type(protozero::pbf_wire_type::varint))
        granularity = reader.get_int32();
      else
        reader.skip();
  } catch (const std::exception&) {
    return;
  }
  if (granularity <= 0)
    fail(path, place.begin,
         "the granularity of coordinates is " + std::to_string(granularity) + ", so nodes have no place");
}

}  // namespace

void check_pbf_structure(const std::string& path) {
  bool first = true, first_data = true;
  for_each_blob(path, [&](std::ifstream& in, const BlobPlace& place) {
    if (first && place.type != "OSMHeader") fail(path, 0, "this is not an OSM PBF file");
    first = false;
    if (place.type != "OSMData" || !first_data) return;
    first_data = false;
    check_granularity(path, in, place);
  });
}

CleanedPbf clean_pbf_strings(const std::string& path) {
  CleanedPbf result;
  std::string blob, unpacked;
  for_each_blob(path, [&](std::ifstream& in, const BlobPlace& place) {
    blob.resize(static_cast<std::size_t>(place.size));
    in.read(blob.data(), place.size);
    if (place.type == "OSMData") {
      try {
        const auto block = osmium::io::detail::decode_blob(blob, unpacked);
        const std::string clean = clean_block({block.data(), block.size()}, result.cleaned);
        if (!clean.empty()) {
          blob.clear();
          protozero::pbf_writer(blob).add_bytes(1, clean);  // stored raw
        }
      } catch (const std::exception& error) {
        fail(path, place.begin, error.what());
      }
    }
    std::string header;
    protozero::pbf_writer writer(header);
    writer.add_string(1, place.type);
    writer.add_int32(3, static_cast<std::int32_t>(blob.size()));
    const auto n = static_cast<std::uint32_t>(header.size());
    for (const int shift : {24, 16, 8, 0}) result.bytes += static_cast<char>(n >> shift & 0xff);
    result.bytes += header;
    result.bytes += blob;
  });
  return result;
}

}  // namespace blockrand::importers::osm
