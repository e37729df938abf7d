// The operations of the language: names, arguments, blocks (docs/rule_language.md §2).
#include "styles/grammar/language/name_tables.h"

namespace blockrand::grammar::tables {

namespace {

constexpr BuiltIn operation(std::string_view name, std::string_view signature, Tier tier, std::uint32_t files = 0,
                            BlockKind block = BlockKind::none, Status status = Status::runs) {
  return {.kind = NameKind::operation,
          .name = name,
          .signature = signature,
          .tier = tier,
          .status = status,
          .block = block,
          .corpus_files = files};
}
constexpr BuiltIn missing(std::string_view name, std::string_view signature, Tier tier, std::uint32_t files = 0,
                          BlockKind block = BlockKind::none) {
  return operation(name, signature, tier, files, block, Status::not_yet);
}

using enum Tier;
constexpr BlockKind kSplit = BlockKind::split, kSelectors = BlockKind::selectors;

constexpr BuiltIn kRows[] = {
    operation("NIL", "", b, 259),
    // Transformations and scope.
    operation("t", "r r r", b, 324),
    operation("s", "r r r", b, 345),
    operation("r", "n n n | <rotation_centre> n n n", b, 107),
    operation("translate", "<mode> <system> n n n", b, 50),
    operation("rotate", "<mode> <system> n n n", b, 8),
    operation("center", "<axes>", b, 162),
    operation("alignScopeToAxes", " | <aligned_axis>", b, 156),
    operation("alignScopeToGeometry", "<up> n<face_choice> n<edge_choice>?", b, 208),
    operation("alignScopeToGeometryBBox", "<axis_pair>", g, 4),
    operation("rotateScope", "n n n", b, 72),
    operation("mirrorScope", "b b b", d, 8),
    operation("mirror", "b b b", b, 9),
    operation("setPivot", "<axis_order> n", b, 30),
    // Creating geometry.
    operation("extrude", "n | <extrusion> n", b, 260),
    operation("taper", "n", d, 2),
    operation("roofHip", "n n? b? | <by> n n? b?", d, 50),
    operation("roofGable", "n n? n? b? n? | <by> n n? n? b? n?", d, 43),
    operation("roofPyramid", "n | <by> n", d, 11),
    operation("roofShed", "n n? | <by> n n?", d, 31),
    operation("roofRidge", "<by> n", d),
    operation("envelope", "<envelope_direction> n n n n? n? n? n? n? n? | <envelope_direction> n N N", d, 6),
    operation("offset", "n <kept_part>?", d, 103),
    operation("primitiveQuad", " | n n", b, 5),
    operation("primitiveDisk", " | n n?", b, 2),
    operation("primitiveCube", " | n n n", b, 145),
    operation("primitiveSphere", " | n n n?", b, 7),
    operation("primitiveCylinder", " | n n? n?", b, 16),
    operation("primitiveCone", " | n n? n?", b, 3),
    operation("i", "s <up>? <insert_mode>? a?", b, 198),
    missing("insertAlongUV", "n s n <up>? a?", g, 12),
    operation("footprint", "", d),
    // Splits and components.
    operation("split", "<axis> <adjustment>? | <uv_axis> <uv_space> n", b, 342, kSplit),
    operation("splitArea", "<axis> <adjustment>?", g, 4, kSplit),
    missing("splitAndSetbackPerimeter", "r n? B?", g, 0, BlockKind::perimeter),
    operation("comp", "<component> <component_alignment>?", b, 255, kSelectors),
    missing("modify", "<component>", g, 0, kSelectors),
    // Setbacks and lots.
    operation("setback", "n n? | N n?", d, 42, kSelectors),
    operation("setbackPerEdge", "n n?", d, 0, kSelectors),
    operation("setbackToArea", "n n? | n N N? n?", d, 0, kSelectors),
    operation("shapeL", "n n", d, 26, kSelectors),
    operation("shapeU", "n n n", d, 15, kSelectors),
    operation("shapeO", "n n n n", d, 19, kSelectors),
    operation("innerRectangle", "<rectangle_choice>", d, 16, kSelectors),
    operation("innerRect", "", d, 25),
    operation("scatter", "<scatter_domain> n <distribution> r<scatter_mean>? r? r?", d, 37, BlockKind::scatter),
    // Changing geometry.
    operation("cleanupGeometry", "<cleaned> n", d, 55),
    operation("convexify", " | n", b, 18),
    operation("deleteHoles", "", d),
    operation("reverseNormals", "", d, 56),
    operation("setNormals", "<normals>", d, 5),
    missing("softenNormals", "n", d),
    operation("rectify", "n", d),
    missing("reduceGeometry", "n", g, 4),
    operation("resetGeometry", "", d),
    operation("trim", "", d, 7),
    missing("union", "", g, 0, BlockKind::boolean),
    missing("subtract", "", g, 0, BlockKind::boolean),
    missing("intersect", "", g, 0, BlockKind::boolean),
    operation("tag", "s <tagged>?", g),
    operation("deleteTags", " | s <tagged>?", g),
    missing("setTagsFromEdgeAttrs", " | s", g),
    // Texture and material.
    operation("setupProjection", "n <projection> r r r? r? n?", b, 271),
    operation("projectUV", "n", b, 269),
    missing("setupUV", "a+", g, 1),
    operation("texture", "s", b, 267),
    operation("tileUV", "n r r", c, 33),
    operation("scaleUV", "n n n", c, 41),
    operation("translateUV", "n n n", c, 41),
    operation("offsetUV", "n n n", c, 11),
    operation("rotateUV", "n n", c, 35),
    operation("normalizeUV", "n <normalised> <face_grouping>", c, 29),
    operation("copyUV", "n n", c),
    operation("deleteUV", "n", c, 26),
    operation("color", "s | n n n n?", b, 247),
    operation("set", "i a", b, 246),
    missing("setMaterial", "S", g),
    operation("resetMaterial", " | <material_part>", g),
    // Telling.
    operation("report", "s v", b, 84),
    operation("print", "a", b, 45),
    operation("label", "s", b, 24),
};

}  // namespace

std::span<const BuiltIn> operation_rows() { return kRows; }

}  // namespace blockrand::grammar::tables
