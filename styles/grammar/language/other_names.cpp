// Attributes of shapes, selectors, words, annotations, keywords and forms of syntax
// (docs/rule_language.md §1, §2.4, §3.1, §6.2).
#include <array>
#include <deque>
#include <string>
#include <vector>

#include "styles/grammar/language/name_tables.h"

namespace blockrand::grammar::tables {

namespace {

using enum Tier;

constexpr BuiltIn attribute(std::string_view name, std::string_view signature, Tier tier, std::uint32_t files) {
  return {.kind = NameKind::attribute, .name = name, .signature = signature, .tier = tier, .corpus_files = files};
}
/// An attribute that `set` may change.
constexpr BuiltIn settable(std::string_view name, std::string_view signature, Tier tier, std::uint32_t files) {
  return {.kind = NameKind::attribute,
          .name = name,
          .signature = signature,
          .tier = tier,
          .settable = true,
          .corpus_files = files};
}
constexpr BuiltIn selector(std::string_view name, Tier tier, std::uint32_t files = 0) {
  return {.kind = NameKind::selector, .name = name, .tier = tier, .corpus_files = files};
}
constexpr BuiltIn annotation(std::string_view name, std::uint32_t files = 0) {
  return {.kind = NameKind::annotation, .name = name, .tier = a, .corpus_files = files};
}
constexpr BuiltIn word(std::string_view name) { return {.kind = NameKind::word, .name = name, .tier = b}; }
constexpr BuiltIn keyword(std::string_view name) { return {.kind = NameKind::keyword, .name = name, .tier = a}; }
constexpr BuiltIn form(std::string_view name, Tier tier, std::uint32_t files, Status status = Status::runs) {
  return {.kind = NameKind::syntax, .name = name, .tier = tier, .status = status, .corpus_files = files};
}

constexpr BuiltIn kRows[] = {
    settable("scope.tx", "-> n", g, 5),
    settable("scope.ty", "-> n", g, 5),
    settable("scope.tz", "-> n", g, 5),
    settable("scope.rx", "-> n", g, 0),
    settable("scope.ry", "-> n", g, 0),
    settable("scope.rz", "-> n", g, 0),
    settable("scope.sx", "-> n", b, 219),
    settable("scope.sy", "-> n", b, 219),
    settable("scope.sz", "-> n", b, 219),
    attribute("scope.elevation", "-> n", b, 24),
    attribute("pivot.px", "-> n", g, 2),
    attribute("pivot.py", "-> n", g, 2),
    attribute("pivot.pz", "-> n", g, 2),
    attribute("pivot.ox", "-> n", g, 2),
    attribute("pivot.oy", "-> n", g, 2),
    attribute("pivot.oz", "-> n", g, 2),
    attribute("split.index", "-> n", b, 89),
    attribute("split.total", "-> n", b, 57),
    attribute("comp.sel", "-> s", d, 16),
    attribute("comp.index", "-> n", d, 16),
    attribute("comp.total", "-> n", d, 7),
    settable("seedian", "-> n", g, 2),
    attribute("uid", "-> n", g, 2),
    attribute("initialShape.name", "-> s", g, 1),
    attribute("initialShape.startRule", "-> s", d, 13),
    attribute("initialShape.symbol", "-> s", g, 1),
    attribute("initialShape.origin.px", "-> n", d, 9),
    attribute("initialShape.origin.py", "-> n", d, 9),
    attribute("initialShape.origin.pz", "-> n", d, 9),
    attribute("initialShape.origin.ox", "-> n", d, 0),
    attribute("initialShape.origin.oy", "-> n", d, 0),
    attribute("initialShape.origin.oz", "-> n", d, 0),
    settable("trim.vertical", "-> b", b, 50),
    settable("trim.horizontal", "-> b", b, 18),
    settable("material.name", "-> s", c, 0),
    settable("material.shader", "-> s", c, 0),
    settable("material.color.r", "-> n", b, 179),
    settable("material.color.g", "-> n", b, 179),
    settable("material.color.b", "-> n", b, 179),
    settable("material.color.a", "-> n", b, 179),
    settable("material.color.rgb", "-> s", b, 0),
    settable("material.ambient.r", "-> n", c, 0),
    settable("material.ambient.g", "-> n", c, 0),
    settable("material.ambient.b", "-> n", c, 0),
    settable("material.ambient.rgb", "-> s", c, 0),
    settable("material.specular.r", "-> n", c, 0),
    settable("material.specular.g", "-> n", c, 0),
    settable("material.specular.b", "-> n", c, 0),
    settable("material.specular.rgb", "-> s", c, 0),
    settable("material.emissive.r", "-> n", c, 0),
    settable("material.emissive.g", "-> n", c, 0),
    settable("material.emissive.b", "-> n", c, 0),
    settable("material.emissive.rgb", "-> s", c, 0),
    settable("material.opacity", "-> n", b, 0),
    settable("material.reflectivity", "-> n", c, 0),
    settable("material.shininess", "-> n", c, 0),
    settable("material.bumpValue", "-> n", c, 0),
    settable("material.metallic", "-> n", c, 0),
    settable("material.roughness", "-> n", c, 0),
    settable("material.doubleSided", "-> b", c, 0),
    settable("material.opacitymap.mode", "-> s", c, 0),
    settable("material.opacitymap.cutoff", "-> n", c, 0),

    selector("top", b, 175),
    selector("bottom", b, 88),
    selector("left", b, 59),
    selector("right", b, 54),
    selector("front", b, 102),
    selector("back", b, 54),
    selector("side", b, 149),
    selector("all", b, 148),
    selector("object.top", b),
    selector("object.bottom", b),
    selector("object.left", b),
    selector("object.right", b),
    selector("object.front", b, 10),
    selector("object.back", b),
    selector("object.side", b),
    selector("world.up", b),
    selector("world.down", b),
    selector("world.west", b),
    selector("world.east", b),
    selector("world.south", b, 13),
    selector("world.north", b),
    selector("world.side", b),
    selector("vertical", b, 43),
    selector("horizontal", b, 17),
    selector("aslant", b, 9),
    selector("nutant", b),
    selector("border", b, 52),
    selector("inside", b, 50),
    selector("eave", d, 5),
    selector("hip", d, 10),
    selector("valley", d, 9),
    selector("ridge", d, 12),
    selector("street.front", e, 19),
    selector("street.back", e, 19),
    selector("street.left", e, 19),
    selector("street.right", e, 19),
    selector("street.side", e, 19),
    selector("streetSide", e, 11),
    selector("noStreetSide", e, 12),
    selector("remainder", d, 40),
    selector("shape", d),
    selector("uv.left", g),
    selector("uv.right", g),
    selector("uv.top", g),
    selector("uv.bottom", g),
    selector("uv.uMin", g),
    selector("uv.uMax", g),
    selector("uv.vMin", g),
    selector("uv.vMax", g),

    annotation("StartRule", 230),
    annotation("Hidden", 154),
    annotation("Group", 190),
    annotation("Order", 170),
    annotation("Range", 246),
    annotation("Enum", 25),
    annotation("Color", 55),
    annotation("File", 33),
    annotation("Directory", 2),
    annotation("Description", 97),
    annotation("DisplayName"),
    annotation("Handle", 29),
    annotation("Distance", 14),
    annotation("Percent", 7),
    annotation("Angle", 3),
    annotation("Bool", 1),
    annotation("InPoint", 2),
    annotation("InMesh", 2),
    annotation("InCurve"),
    annotation("In"),
    annotation("Out"),
    // Ours: the rule takes the same branch in all of a building, or in all of a row (docs/sources.md, Bilke 4.7).
    annotation("Consistent"),

    keyword("version"),
    keyword("import"),
    keyword("attr"),
    keyword("const"),
    keyword("style"),
    keyword("extends"),
    keyword("extension"),
    keyword("start"),
    keyword("with"),
    keyword("inline"),
    keyword("case"),
    keyword("else"),
    keyword("true"),
    keyword("false"),

    form("attr", a, 464),
    form("case/else (rule)", a, 397),
    form("' in arg", a, 330),
    form("split size floating ~", a, 328),
    form("split size absolute", a, 321),
    form("const", a, 306),
    form("rule parameters", a, 269),
    form("function", a, 244),
    form("interleaved repeat {}*", a, 199),
    form("nested split block", a, 199),
    form("case/else (expr)", a, 198),
    form("repeat *", a, 186),
    form("trailing-dot leaf", a, 175),
    form("import", a, 167),
    form("call imported rule", a, 152),
    form("function parameters", a, 130),
    form("stochastic % (expr)", a, 127),
    form("ref imported attr/function", a, 114),
    form("split size relative '", a, 88),
    form("stochastic % (rule)", a, 80),
    form("comp/setback group \"=\"", b, 68),
    form("push/pop", a, 66),
    form("~ in arg", a, 44),
    form("style", a, 29),
    form("import attr override", a, 27),
    form("imported-rule override (imp.Rule -->)", d, 15),
    form("start rule", d, 14),
    form("element-wise array operator", g, 6),
    form("array index", g, 6),
    form("colon range", g, 6),
    form("import rule override", d, 6),
    form("import attr protect", d, 5),
    form("array literal", d, 3),
    form("comp() function", g, 3),
    form("import ()", g, 3),
    form("legacy split item without size", g, 2),
    form("2d array", g, 1),
    form("with bindings", g, 0),
    form("dynamic import", g, 0),
    form("connected group =:", g, 0),
    form("inline", g, 0, Status::not_yet),
    form("selector expression", g, 2),
    form("selector index", d, 38),
    form("comp kind: f", b, 254),
    form("comp kind: e", d, 26),
    form("comp kind: fe", g, 3),
    form("comp kind: v", g, 3),
    form("comp kind: fv", g, 0),
    form("comp kind: g", g, 0),
    form("comp kind: m", g, 0),
    form("comp kind: h", g, 0),
    form("split axis: xyz", b, 319),
    form("split axis: uv", e, 47),
    form("split mode: noAdjust", b, 112),
    form("extrude type: world.y", b, 44),
    form("extrude type: world.up", b, 29),
    form("extrude type: vertex.normal", d, 9),
    form("extrude type: world.up.flatTop", g, 2),
    form("extrude type: y", g, 2),
};

using W = std::string_view;
constexpr W kAxis[] = {"x", "y", "z"};
constexpr W kUvAxis[] = {"u", "v"};
constexpr W kAxes[] = {"x", "y", "z", "xy", "xz", "yz", "xyz"};
constexpr W kAdjustment[] = {"adjust", "noAdjust"};
constexpr W kUvSpace[] = {"uvSpace", "unitSpace"};
constexpr W kMode[] = {"abs", "rel"};
constexpr W kSystem[] = {"scope", "pivot", "object", "world"};
constexpr W kRotationCentre[] = {"scopeOrigin", "scopeCenter"};
constexpr W kAlignedAxis[] = {"x",       "y",         "z",        "xyz",      "world.x",  "world.y",
                              "world.z", "world.xyz", "object.x", "object.y", "object.z", "object.xyz"};
constexpr W kUp[] = {"yUp", "zUp"};
constexpr W kFaceChoice[] = {"world.lowest", "largest", "any", "auto"};
constexpr W kEdgeChoice[] = {"world.lowest", "longest", "auto"};
constexpr W kAxisPair[] = {"xy", "yx", "xz", "zx", "yz", "zy"};
constexpr W kAxisOrder[] = {"xyz", "yzx", "zxy"};
constexpr W kExtrusion[] = {"world.up", "world.y", "y", "world.up.flatTop", "face.normal", "vertex.normal"};
constexpr W kBy[] = {"byAngle", "byHeight"};
constexpr W kEnvelopeDirection[] = {"normal", "world.up"};
constexpr W kKeptPart[] = {"all", "inside", "border"};
constexpr W kInsertMode[] = {"alignSizeAndPosition", "keepSizeAndPosition", "keepSizeAlignPosition"};
constexpr W kComponent[] = {"f", "e", "fe", "v", "fv", "g", "m", "h"};
constexpr W kComponentAlignment[] = {"zUp", "noAlign", "yUp"};
constexpr W kRectangleChoice[] = {"scope", "edge"};
constexpr W kScatterDomain[] = {"surface", "volume", "scope"};
constexpr W kDistribution[] = {"uniform", "gaussian"};
constexpr W kScatterMean[] = {"center", "front", "back", "left", "right", "top", "bottom"};
constexpr W kCleaned[] = {"vertices", "edges", "faces", "all"};
constexpr W kNormals[] = {"hard", "soft", "auto", "conform"};
constexpr W kTagged[] = {"auto", "faces", "edges", "vertices", "all"};
constexpr W kTagPlace[] = {"e", "v", "f"};
constexpr W kProjection[] = {"scope.xy", "scope.xz", "scope.yx", "scope.yz", "scope.zx", "scope.zy",
                             "world.xy", "world.xz", "world.yx", "world.yz", "world.zx", "world.zy"};
constexpr W kNormalised[] = {"uv", "uvUniform", "u", "v"};
constexpr W kFaceGrouping[] = {"separatePerFace", "collectiveAllFaces"};
constexpr W kMaterialPart[] = {"shape", "geometry", "all"};
constexpr W kMaterialSource[] = {"used", "shape", "geometry"};
constexpr W kMaterialExtent[] = {"changed", "all"};
constexpr W kAngle[] = {"maxSlope", "azimuth", "zenith"};
constexpr W kAssetSize[] = {"sx", "sy", "sz", "tx", "ty", "tz"};
constexpr W kImageSize[] = {"sx", "sy"};
constexpr W kContext[] = {"intra", "inter", "all"};
constexpr W kConverted[] = {"pos", "orient"};
constexpr W kGeographic[] = {"X", "Y", "lon", "lat"};
constexpr W kInline[] = {"append", "unify", "recompose"};

constexpr WordSet kSets[] = {
    {"axis", kAxis},
    {"uv_axis", kUvAxis},
    {"axes", kAxes},
    {"adjustment", kAdjustment},
    {"uv_space", kUvSpace},
    {"mode", kMode},
    {"system", kSystem},
    {"rotation_centre", kRotationCentre},
    {"aligned_axis", kAlignedAxis},
    {"up", kUp},
    {"face_choice", kFaceChoice},
    {"edge_choice", kEdgeChoice},
    {"axis_pair", kAxisPair},
    {"axis_order", kAxisOrder},
    {"extrusion", kExtrusion},
    {"by", kBy},
    {"envelope_direction", kEnvelopeDirection},
    {"kept_part", kKeptPart},
    {"insert_mode", kInsertMode},
    {"component", kComponent},
    {"component_alignment", kComponentAlignment},
    {"rectangle_choice", kRectangleChoice},
    {"scatter_domain", kScatterDomain},
    {"distribution", kDistribution},
    {"scatter_mean", kScatterMean},
    {"cleaned", kCleaned},
    {"normals", kNormals},
    {"tagged", kTagged},
    {"tag_place", kTagPlace},
    {"projection", kProjection},
    {"normalised", kNormalised},
    {"face_grouping", kFaceGrouping},
    {"material_part", kMaterialPart},
    {"material_source", kMaterialSource},
    {"material_extent", kMaterialExtent},
    {"angle", kAngle},
    {"asset_size", kAssetSize},
    {"image_size", kImageSize},
    {"context", kContext},
    {"converted", kConverted},
    {"geographic", kGeographic},
    {"inline", kInline},
};

/// material.colormap and its nine sisters, each with how it is scaled, moved and turned.
std::vector<BuiltIn> with_material_maps() {
  static std::deque<std::string> names;
  std::vector<BuiltIn> rows(std::begin(kRows), std::end(kRows));
  for (const W map : {"colormap", "bumpmap", "dirtmap", "specularmap", "opacitymap", "normalmap", "emissivemap",
                      "occlusionmap", "roughnessmap", "metallicmap"}) {
    rows.push_back(settable(names.emplace_back("material." + std::string(map)), "-> s", b, 0));
    for (const W part : {".su", ".sv", ".tu", ".tv", ".rw"})
      rows.push_back(settable(names.emplace_back("material." + std::string(map) + std::string(part)), "-> n", c, 0));
  }
  // Every word once, whatever sets it stands in.
  std::vector<W> words;
  for (const WordSet& set : kSets)
    for (const W name : set.words) {
      bool known = false;
      for (const W other : words) known = known || other == name;
      if (!known) words.push_back(name);
    }
  for (const W name : words) rows.push_back(word(name));
  return rows;
}

}  // namespace

std::span<const BuiltIn> other_rows() {
  static const std::vector<BuiltIn> rows = with_material_maps();
  return rows;
}

std::span<const WordSet> word_sets() { return kSets; }

}  // namespace blockrand::grammar::tables
