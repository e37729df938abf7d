#include "pipeline/outputs/gltf/meshopt.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <mutex>
#include <vector>

namespace blockrand::outputs {
namespace {

/// The versions that the extension knows: vertices 0, indices 1. The library keeps them in variables of its own.
void choose_versions() {
  static std::once_flag once;
  std::call_once(once, [] {
    meshopt_encodeVertexVersion(0);
    meshopt_encodeIndexVersion(1);
  });
}

/// The filter EXPONENTIAL: a float becomes a signed exponent in the upper byte and a mantissa of 24 bits. One exponent
/// for all, so that neighbours differ in few bytes. meshopt_encodeFilterExp() would choose one for each element.
std::vector<std::uint32_t> filtered(std::string_view bytes, std::size_t floats, int exponent) {
  std::vector<std::uint32_t> out(floats);
  const double steps = std::ldexp(1.0, -exponent);
  for (std::size_t i = 0; i < floats; ++i) {
    float value = 0;
    std::memcpy(&value, bytes.data() + i * sizeof(value), sizeof(value));
    const auto mantissa = static_cast<std::int32_t>(std::nearbyint(static_cast<double>(value) * steps));
    out[i] = static_cast<std::uint32_t>(exponent) << 24 | (static_cast<std::uint32_t>(mantissa) & 0xFFFFFFu);
  }
  return out;
}

int exponent_of(MeshoptCoding coding) {
  switch (coding) {
    case MeshoptCoding::steps:
      return -12;
    case MeshoptCoding::tile_steps:
      return -11;
    case MeshoptCoding::scales:
      return -17;
    case MeshoptCoding::whole:
    case MeshoptCoding::attributes:
    case MeshoptCoding::triangles:
      break;
  }
  return 0;
}

}  // namespace

std::vector<std::uint32_t> packing_order(std::vector<std::uint16_t>& indices, std::size_t vertices) {
  const std::vector<unsigned int> before(indices.begin(), indices.end());
  std::vector<unsigned int> after(before.size());
  meshopt_optimizeVertexCache(after.data(), before.data(), before.size(), vertices);
  std::vector<unsigned int> numbers(vertices);
  meshopt_optimizeVertexFetchRemap(numbers.data(), after.data(), after.size(), vertices);
  for (std::size_t i = 0; i < after.size(); ++i) indices[i] = static_cast<std::uint16_t>(numbers[after[i]]);
  return numbers;
}

std::string meshopt_encode(std::string_view bytes, std::size_t size, std::size_t count, MeshoptCoding coding) {
  choose_versions();
  std::vector<unsigned char> out;
  if (coding == MeshoptCoding::triangles) {
    std::vector<std::uint16_t> narrow(count);
    std::memcpy(narrow.data(), bytes.data(), count * sizeof(narrow[0]));
    const std::vector<unsigned int> indices(narrow.begin(), narrow.end());
    const unsigned int most = indices.empty() ? 0 : *std::max_element(indices.begin(), indices.end());
    out.resize(meshopt_encodeIndexBufferBound(count, std::size_t{most} + 1));
    out.resize(meshopt_encodeIndexBuffer(out.data(), out.size(), indices.data(), count));
  } else {
    std::vector<std::uint32_t> words;
    const void* from = bytes.data();
    if (has_filter(coding)) {
      words = filtered(bytes, size * count / sizeof(float), exponent_of(coding));
      from = words.data();
    }
    out.resize(meshopt_encodeVertexBufferBound(count, size));
    out.resize(meshopt_encodeVertexBuffer(out.data(), out.size(), from, count, size));
  }
  return {out.begin(), out.end()};
}

}  // namespace blockrand::outputs
