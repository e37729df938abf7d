// libFuzzer target: whatever rules say, deriving them on a lot ends within its limits, with leaves that can be drawn.
#include <cstdint>
#include <cstdlib>

#include "styles/grammar/evaluation/derive.h"
#include "styles/grammar/shapes/initial_shape.h"
#include "styles/grammar/shapes/mesh_triangles.h"
#include "styles/grammar/shapes/occlusion.h"
#include "tests/fuzz/rule_text.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace blockrand;
  const grammar::Program program = fuzz::load_rules(data, size);
  // Few shapes, so that inputs stay fast; the limits themselves are tried, too.
  grammar::DeriveOptions options;
  options.limits = {.shapes = 200,
                    .depth = 40,
                    .function_depth = 40,
                    .pieces = 2000,
                    .calls = 20000,
                    .diagnostics = 50,
                    .faces = 2000};
  options.keep_tree = true;
  static const grammar::Shape lot =
      grammar::initial_shape({{0, 0, 0}, {12, 0, 0}, {12, 0, -9}, {7, 0, -9}, {7, 0, -5}, {0, 0, -5}});
  const grammar::Derivation result = grammar::derive(program, lot, options);
  if (result.shapes > options.limits.shapes) std::abort();
  for (const grammar::Leaf& leaf : result.leaves) {
    if (!result.tree.empty() && leaf.node >= result.tree.size()) std::abort();
    // As `grammar run -o FILE.glb` draws it.
    const grammar::Mesh mesh = grammar::mesh_in_world(leaf.shape);
    for (const grammar::MeshTriangle& triangle : grammar::triangles_of(mesh))
      for (const std::uint32_t vertex : triangle.vertices)
        if (vertex >= mesh.vertices.size()) std::abort();
  }
  return 0;
}
