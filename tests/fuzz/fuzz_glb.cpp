// libFuzzer target: whatever a GLB holds, `validate` reads it to rows, triangles and places that point to what is there,
// or says what is wrong.
#include <cstdint>
#include <cstdlib>

#include "pipeline/validate/glb.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace blockrand::validate;
  const Glb glb = read_glb({reinterpret_cast<const char*>(data), size}, "f.glb");
  if (!glb.readable) {
    if (glb.contents.findings.empty()) std::abort();
    return 0;
  }
  if (glb.triangles.size() != glb.contents.bodies.size()) std::abort();
  for (const GlbPlace& place : glb.places)
    if (place.element >= glb.elements.size() || place.row >= glb.contents.bodies.size()) std::abort();
  return 0;
}
