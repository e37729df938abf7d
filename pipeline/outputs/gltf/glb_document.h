// A binary glTF file under construction: JSON text and the bytes that it points at.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "pipeline/outputs/gltf/compression.h"

namespace blockrand::outputs {

/// Bytes of one kind, which share a buffer view.
enum class Stream : std::uint8_t {
  positions,               ///< 3 floats, multiples of 1/4096
  tile_positions,          ///< 3 floats, multiples of 1/2048
  far_positions,           ///< 3 floats of a mesh that is too wide for that, or has slivers
  normals,                 ///< 3 signed bytes and an empty one
  colours,                 ///< 4 words
  texture_places,          ///< 2 words
  texture_repeats,         ///< 2 floats
  features,                ///< a word and an empty one
  wide_features,           ///< a float
  indices,                 ///< a word
  element_positions,       ///< 3 signed words and an empty one
  translations,            ///< of instances: 3 floats, whole numbers
  far_translations,        ///< the same, where they are too large to be compressed as such
  rotations,               ///< 4 signed words
  scales,                  ///< 3 floats
  piece_scales,            ///< 3 floats, multiples of 2^-17 below 64
  instance_features,       ///< a word
  wide_instance_features,  ///< a float
};

/// Values of componentType.
enum class Component : std::uint16_t { int8 = 5120, int16 = 5122, uint16 = 5123, float32 = 5126 };

struct GlbAccessor {
  Stream stream = Stream::positions;
  std::size_t offset = 0;  ///< bytes from the start of the stream
  Component component = Component::float32;
  std::string_view type;  ///< "SCALAR", "VEC3", "VEC4"
  std::size_t count = 0;
  bool normalised = false;
  /// Of positions, which must have them.
  std::optional<std::array<std::array<double, 3>, 2>> bounds = std::nullopt;
};

/// Positions of objects (model.glb) count in these steps: 1/4096 m. The model's own grid of 1/1024 m costs up to 0.69 mm
/// in plan; with 0.17 mm more a corner still lies within 1 mm of its place.
inline constexpr double kGlbStepsPerMetre = 4096;
/// Those of tiles, and of what is placed in them: 1/2048 m. A corner lies up to 0.42 mm from where the model has it, 0.35
/// in plan. Finer steps are noise that packs badly: 1/4096 takes 3 % more bytes and 6 % more when gzipped, 1/1024, which
/// would cost the millimetre, 5 and 4 % less.
inline constexpr double kTileStepsPerMetre = 2048;
/// m. Farther from the origin a float, or a compressed number of 24 bits, no longer holds a step.
inline constexpr double kFinestReach = 2047;

/// Collects the parts of a document; every list is written in the order in which its entries came.
class GlbDocument {
 public:
  GlbDocument();
  ~GlbDocument();
  GlbDocument(const GlbDocument&) = delete;
  GlbDocument& operator=(const GlbDocument&) = delete;

  /// Appends values to a stream, whose elements stand one behind the other.
  /// \return their offset in it
  template <class T>
  std::size_t append(Stream stream, std::span<const T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    return append_bytes(stream, values.data(), values.size() * sizeof(T));
  }
  /// How many elements append() will add to the stream, about: growing by doubling would cost its size again.
  void expect(Stream stream, std::size_t elements) { expected_[stream] += elements; }
  /// A buffer view of its own, aligned to 8 bytes and never compressed: a column of a property table.
  int add_view(std::string bytes);

  int add_accessor(const GlbAccessor& accessor);
  /// JSON texts of entries; each returns the entry's number. Equal materials are one.
  int add_material(const std::string& json);
  /// A picture whose pixels are looked up, never mixed.
  int add_texture(std::string png);
  /// Pictures in files of their own, mixed between pixels and repeated: WebP (EXT_texture_webp), and PNG for readers without
  /// it. Equal ones are one.
  int add_repeated_texture(const std::string& webp, const std::string& png);
  /// The same of a picture that covers a mesh once: not repeated beyond its edges.
  int add_covering_texture(const std::string& webp, const std::string& png);
  int add_mesh(std::string json);
  int add_node(std::string json);
  /// A node that the scene holds. Without any there is no scene: an empty one is not allowed.
  void add_root(int node) { roots_.push_back(node); }

  void use(const std::string& extension, bool required);
  nlohmann::json& asset() { return *asset_; }
  /// The document's own extensions, by name.
  nlohmann::ordered_json& extensions() { return *extensions_; }

  /// The file. \throws std::length_error where it has more than 4 GB
  std::string write(Compression compression);

 private:
  struct View {
    std::string bytes;
    std::optional<Stream> stream;  ///< none: a table's
  };
  std::size_t append_bytes(Stream stream, const void* bytes, std::size_t size);
  int view_of(Stream stream);

  std::vector<View> views_;
  std::map<Stream, std::size_t> expected_;
  std::map<Stream, int> view_numbers_;
  std::map<std::string, int> material_numbers_;
  enum class Sampler : std::uint8_t { nearest, repeated, covering };
  int add_file_texture(const std::string& webp, const std::string& png, Sampler sampler);
  struct Texture {
    Sampler sampler = Sampler::nearest;
    std::string extensions;
    std::size_t image = 0;
  };
  std::vector<Texture> textures_;
  std::map<std::string, int> file_textures_;  ///< by their WebP
  std::vector<std::string> accessors_, materials_, meshes_, nodes_, images_;
  std::vector<int> roots_;
  std::map<std::string, bool> used_;
  // Behind pointers: the types are only declared here.
  std::unique_ptr<nlohmann::json> asset_;
  std::unique_ptr<nlohmann::ordered_json> extensions_;
};

}  // namespace blockrand::outputs
