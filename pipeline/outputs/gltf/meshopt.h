// EXT_meshopt_compression's bitstreams, by meshoptimizer: the only place that knows the library.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace blockrand::outputs {

/// How elements are encoded; all but `triangles` give back the same bytes.
enum class MeshoptCoding : std::uint8_t {
  attributes,  ///< mode ATTRIBUTES: bytes of neighbouring elements resemble each other
  steps,       ///< ATTRIBUTES with the filter EXPONENTIAL: floats that are multiples of 1/4096 below 2048
  tile_steps,  ///< the same with multiples of 1/2048 below 4096
  whole,       ///< the same with floats that are whole numbers below 2^23
  scales,      ///< the same with floats that are multiples of 2^-17 below 64
  triangles,   ///< mode TRIANGLES: indices; the same triangles, turned or not
};
constexpr bool has_filter(MeshoptCoding coding) {
  return coding != MeshoptCoding::attributes && coding != MeshoptCoding::triangles;
}

/// Puts triangles and vertices into the order that packs best. \param indices  of triangles
/// \return by vertex its new number; ~0 where no triangle uses it. The indices are new ones already.
std::vector<std::uint32_t> packing_order(std::vector<std::uint16_t>& indices, std::size_t vertices);

/// \param bytes  at least size * count; \param size  of an element, a multiple of 4; of an index 2
/// \param count  of elements; a multiple of 3 for triangles
std::string meshopt_encode(std::string_view bytes, std::size_t size, std::size_t count, MeshoptCoding coding);

}  // namespace blockrand::outputs
