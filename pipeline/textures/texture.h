// Seamless pictures of materials, made by the program itself: what a wall, a roof or a ground looks like from near by.
//
// A picture holds no colour of its own but the grain of its material: it is multiplied with the colour that the data
// shows, divided by the picture's mean, so that from afar a textured wall has the colour that a plain one has. All is
// worked out from the row of configs/materials/textures.toml alone: the same bytes on every run.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace blockrand::textures {

/// How a texture is laid out. The words of `pattern` in configs/materials/textures.toml.
enum class Pattern : std::uint8_t {
  plaster,      ///< trowelled or rough
  bond,         ///< bricks or clinker, stretchers alone, each course half a brick aside
  cross_bond,   ///< bricks, courses of stretchers and of headers in turn
  ashlar,       ///< dressed stones in level courses of unequal lengths
  rubble,       ///< coursed stones of unequal sizes
  cyclopean,    ///< polygonal stones without level joints
  concrete,     ///< panels with joints and marks of formwork
  boards,       ///< of wood
  metal,        ///< sheets with standing seams
  pantiles,     ///< wavy roof tiles
  plain_tiles,  ///< flat tiles, each row half a tile aside
  slates,       ///< thin and unequal
  felt,         ///< bitumen in lanes
  grains,       ///< gravel, sand, asphalt: by the size of grains
  soil,         ///< clods, crumbs and small stones
  setts,        ///< small hewn stones in rows
  cobbles,      ///< round stones
  flags,        ///< paving stones with level joints
  grass,        ///< blades, from lawn to meadow
};

/// A row of the file: one texture.
struct TextureRow {
  std::string name;  ///< of its files: [a-z_]+
  Pattern pattern = Pattern::plaster;
  double width = 2.56, height = 2.56;  ///< m until it repeats; in both directions a whole number of its stones
  int pixels = 512;                    ///< on each side, a power of two
  /// m, of what the pattern lays, with one joint; 0: it has none. Of grains their size, of a blade of grass its width and
  /// length, of metal and felt the width of a sheet.
  double stone_width = 0, stone_height = 0;
  double joint = 0;       ///< m; of metal the width of a seam, of felt that of a lap
  double depth = 0.002;   ///< m from the deepest joint to the highest grain
  double contrast = 0.1;  ///< largest share by which linear light falls below the brightest
  double roughness = 0.9, metallic = 0;
};

/// 8-bit pixels, row by row from the top; u runs with the columns, v of glTF with the rows.
struct TextureMaps {
  int pixels = 0;
  std::vector<std::uint8_t> base;       ///< RGB, sRGB transfer; brightest near 255
  std::vector<std::uint8_t> normal;     ///< RGB, tangent space, glTF 2.0: green up
  std::vector<std::uint8_t> orm;        ///< RGB: 255, roughness, metallic
  std::array<double, 3> mean{1, 1, 1};  ///< of base, in linear light, 0 to 1
};

enum class TextureSize : std::uint8_t { full, small };  ///< small: half the pixels on each side

/// All wrap at their edges. The lowest row of pixels is where the lowest course begins, with its bed joint; eaves are there
/// too. Names seed the noise: rows of unlike names look unlike. Takes 20 to 85 ms of processor time at 512 pixels.
/// \param row  as a TextureCatalogue has checked it
TextureMaps make_maps(const TextureRow& row, TextureSize size);

}  // namespace blockrand::textures
