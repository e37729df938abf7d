// Which files a build leaves behind, and what they hold.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/base/option_table.h"
#include "pipeline/outputs/gltf/attribute_profile.h"
#include "pipeline/outputs/gltf/compression.h"
#include "pipeline/outputs/gltf/instance_writer.h"
#include "pipeline/outputs/gltf/object_writer.h"

namespace blockrand::outputs {

/// What --formats chooses among, in the order of all_outputs().
std::vector<std::string> format_names();

/// How much CityGML of LoD3 holds.
enum class CityGmlDetail : std::uint8_t {
  lean,  ///< windows and doors in the plane of their walls, elements on walls without small pieces
  full,  ///< reveals, and every element with all its faces
};

/// What surfaces look like from near by.
enum class TextureChoice : std::uint8_t {
  none,    ///< of one colour
  small,   ///< textures of half as many pixels on each side
  shared,  ///< textures, shared by all tiles
};

/// What the ground looks like.
enum class GroundChoice : std::uint8_t {
  none,     ///< as --surroundings has it
  imagery,  ///< as the aerial images show it
};

struct OutputOptions {
  std::vector<std::string> formats = format_names();    ///< in the order of format_names
  Instancing instancing = Instancing::ext;              ///< how GLBs hold what stands in facades
  Compression compression = Compression::tiles;         ///< of vertices, indices and places in GLBs
  AttributeProfile profile = AttributeProfile::people;  ///< what GLBs tell of a building
  TextureChoice textures = TextureChoice::none;         ///< of surfaces in GLBs
  GroundChoice ground = GroundChoice::none;             ///< in GLBs
  double ground_pixel = 0.2;                            ///< m, of the picture of the ground
  std::int64_t max_glb_bytes = 10'000'000;              ///< of a tile's GLB: a larger one is cut; 0: none is
  CityGmlDetail citygml_detail = CityGmlDetail::lean;   ///< of LoD3
  bool imagery = false;                                 ///< there are aerial images: imagery.json. Set by the build
  bool imagery_pictures = false;                        ///< and they can be shown: imagery.html. Set by the build
  bool evidence = false;                ///< GLB, CityGML and CityJSON also say why each attribute has its value
  bool gzip = false;                    ///< CityGML as .gml.gz, CityJSON as .city.jsonl.gz
  bool precompress = false;             ///< tileset.json and GLBs of tiles have a .gz beside them
  bool surroundings = false;            ///< they are asked for. Set by the build
  bool single_glb = false;              ///< also model.glb: the whole build in one frame
  Objects objects = Objects::building;  ///< what model.glb is made of
  bool single_cityjson = false;         ///< also model.city.json: the whole build as one CityJSON object
  bool report = true;                   ///< report.html
  bool explain = true;                  ///< explain/: what `blockrand explain` reads

  /// \param format  one of format_names
  bool writes(std::string_view format) const;
};

/// What is asked for and nothing reads, since no file is written that it would change: a sentence each, of options that are not as by default.
/// \param lod  of the build
std::vector<std::string> unread_options(const OutputOptions& options, int lod);

/// How users set them: in the main section of a build's options.
base::OptionTable<OutputOptions> output_options();

}  // namespace blockrand::outputs
