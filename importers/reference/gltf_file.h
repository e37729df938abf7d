// A glTF 2.0 file with its buffers: JSON and checked access to numbers. Internal to this folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "importers/reference/json_access.h"
#include "importers/reference/note_log.h"

namespace blockrand::importers::reference {

/// \return the JSON of a text. \throws base::InputError  with the place where it is broken
Json parse_json(const std::string& path, std::string_view text);

/// The file that a uri means, seen from a folder; empty where it is an address on the network.
std::string file_of_uri(const std::string& folder, const std::string& uri);

/// Values of an accessor, element after element.
struct AccessorValues {
  std::size_t components = 0;  ///< 1 to 4 (16 for matrices)
  std::vector<double> values;
  std::size_t count() const { return components == 0 ? 0 : values.size() / components; }
};

class GltfFile {
 public:
  /// Reads `.glb` and `.gltf`, also gzipped, with all buffers; what meshopt packed is unpacked.
  /// \throws base::InputError  when it is damaged, not glTF 2.0, a buffer is missing, or geometry is compressed in a
  ///         way that is not read (Draco)
  GltfFile(const std::string& path, NoteLog& notes);

  const Json& json() const { return json_; }
  /// \throws base::InputError  where it keeps geometry in files beside it: whoever keeps work by a file's hash cannot see those
  void refuse_files_beside() const;
  std::uint64_t bytes() const { return bytes_; }  ///< on disk, with its buffers

  /// Nothing (and a note) where the number leads nowhere.
  std::optional<std::span<const unsigned char>> view(const Json& number);

  /// Elements of an accessor whose bytes may be there; 0 where they cannot, or there is no such accessor.
  std::size_t accessor_count(const Json& number) const;

  /// Numbers as they count: normalised integers as fractions, sparse ones in place. Nothing (and a note) where the
  /// accessor does not exist, reaches out of its buffer, or is of no type.
  std::optional<AccessorValues> accessor(const Json& number);

 private:
  [[noreturn]] void refuse_compression(const std::string& what) const;
  void read_container(std::string& bytes, std::string& json, std::string& binary) const;
  void check_extensions(NoteLog& notes) const;
  void read_buffers(std::string binary);
  void unpack_views();
  bool fill(const Json& view_number, std::size_t offset, int component_type, std::size_t components, std::size_t stride,
            std::size_t count, bool normalized, std::vector<double>& out);

  std::string path_, folder_;
  NoteLog& notes_;
  Json json_;
  std::vector<std::string> buffers_;
  std::uint64_t bytes_ = 0;
};

/// Bytes of a component type (5120 to 5126); 0 for any other number.
std::size_t component_size(int component_type);
/// The number that stands at `bytes`.
double component_at(const unsigned char* bytes, int component_type);
/// The largest value of an integer type, which a normalised 1 stands for; 0 for floats.
double component_maximum(int component_type);

}  // namespace blockrand::importers::reference
