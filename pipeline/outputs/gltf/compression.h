// How GLBs are compressed.
#pragma once

#include <cstdint>

namespace blockrand::outputs {

/// How the bytes of vertices, indices and places are stored.
enum class Compression : std::uint8_t {
  none,
  meshopt,  ///< EXT_meshopt_compression (required by the file); lossless, but for the first corner of a triangle
  tiles,    ///< the same in the tiles of a tileset; model.glb is for programs that cannot read it
};

}  // namespace blockrand::outputs
