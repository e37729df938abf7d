#include "pipeline/outputs/geopackage/qgis_styles.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "pipeline/model/building.h"
#include "pipeline/model/issue_codes.h"
#include "pipeline/model/wall_segment_colours.h"
#include "pipeline/outputs/geopackage/qml.h"

namespace blockrand::outputs {
namespace {

using model::Colour;

/// Well-spread colours for classes without an order: hue goes round by the golden angle, lightness alternates. Integers
/// only. The second class, gabled roofs, is tile red.
Colour class_colour(int i) {
  const int hue = (i * 137 + 233) % 360, top = i % 2 ? 205 : 235, low = i % 3 == 0 ? 90 : 130;
  const int rise = low + (top - low) * (hue % 60) / 60, fall = top + low - rise;
  const auto c = [](int v) { return static_cast<std::uint8_t>(v); };
  switch (hue / 60) {
    case 0:
      return {c(top), c(rise), c(low)};
    case 1:
      return {c(fall), c(top), c(low)};
    case 2:
      return {c(low), c(top), c(rise)};
    case 3:
      return {c(low), c(fall), c(top)};
    case 4:
      return {c(rise), c(low), c(top)};
    default:
      return {c(top), c(low), c(fall)};
  }
}

constexpr Colour kOthers{215, 215, 215};

/// "mid row" of "mid_row".
std::string spaced(std::string_view name) {
  std::string out(name);
  std::replace(out.begin(), out.end(), '_', ' ');
  return out;
}

/// Every style of buildings has house numbers.
Qml buildings_qml() {
  Qml qml(Shape::fill, true);
  qml.label("house_number", 2500);
  return qml;
}

std::string storeys() {
  Qml qml = buildings_qml();
  qml.ranges("storeys");
  // Yellow to dark red; a class a storey where most buildings are. QGIS counts an upper end to its class.
  struct Class {
    const char *lower, *upper, *label;
    Colour colour;
  };
  constexpr std::array<Class, 8> kClasses{{
      {"0", "1", "up to 1 storey", {255, 247, 204}},
      {"1", "2", "2 storeys", {255, 232, 150}},
      {"2", "3", "3 storeys", {254, 204, 104}},
      {"3", "4", "4 storeys", {253, 165, 74}},
      {"4", "5", "5 storeys", {247, 118, 55}},
      {"5", "6", "6 storeys", {222, 70, 40}},
      {"6", "10", "7 to 10 storeys", {176, 26, 42}},
      {"10", "1000", "more than 10 storeys", {106, 10, 60}},
  }};
  for (const Class& c : kClasses) qml.range(c.lower, c.upper, c.label, c.colour);
  return std::move(qml).done();
}

/// \param qml  of buildings or of parts
std::string built_roof(Qml qml) {
  qml.categories("built_roof");
  int i = 0;
  for (const std::string_view shape : model::kRoofShapeNames) {
    qml.category(shape, shape, shape == "flat" ? Colour{196, 196, 190} : class_colour(i));
    ++i;
  }
  qml.category("", "other", kOthers);
  return std::move(qml).done();
}

/// What mappers said is blue and green, what was concluded yellow and orange, what is assumed grey.
std::string source_of(std::string_view attribute) {
  constexpr std::array<Colour, model::kSourceCount> kColours{{
      {84, 39, 136},
      {33, 102, 172},
      {90, 160, 205},
      {120, 190, 200},
      {27, 120, 55},
      {100, 175, 90},
      {160, 205, 120},
      {250, 215, 90},
      {250, 190, 80},
      {245, 165, 75},
      {235, 140, 70},
      {225, 115, 70},
      {205, 185, 170},
      {190, 190, 190},
  }};
  Qml qml = buildings_qml();
  qml.categories(std::string(attribute) + "_source");
  for (int i = 0; i < model::kSourceCount; ++i) {
    const std::string_view source = model::name(static_cast<model::Source>(i));
    qml.category(source, source == "tag" ? "tag (mapped)" : source, kColours[static_cast<std::size_t>(i)]);
  }
  qml.category("", "unknown", kOthers);
  return std::move(qml).done();
}

std::string level_of_detail() {
  Qml qml(Shape::fill);
  qml.categories("lod");
  qml.category("2", "LoD2: with its roof", {120, 180, 120});
  qml.category("1", "LoD1: block", {245, 190, 90});
  qml.category("0", "LoD0: footprint", {220, 110, 80});
  qml.category("-1", "nothing built", {150, 40, 60});
  qml.category("", "unknown", kOthers);
  return std::move(qml).done();
}

std::string codes() {
  Qml qml(Shape::marker);
  qml.categories("coalesce(\"code\", \"state\")");
  int i = 0;
  for (const model::IssueInfo& about : model::kIssueInfo) {
    if (about.issue_class != model::IssueClass::reported) continue;
    qml.category(about.text, std::string(about.text) + ": " + std::string(about.meaning), class_colour(i++));
  }
  qml.category("duplicate", "duplicate of another object", {170, 170, 170});
  qml.category("represented", "represented by its parts", {120, 150, 180});
  qml.category("", "other", kOthers);
  return std::move(qml).done();
}

std::string outlines() {
  Qml qml(Shape::fill, true);
  qml.single({255, 255, 255}, 0);
  qml.label("id");
  return std::move(qml).done();
}

std::string surface_classes() {
  Qml qml(Shape::fill);
  qml.categories("class");
  qml.category("roof", "roof", {178, 84, 66});
  qml.category("wall", "wall", {232, 222, 200});
  qml.category("ground", "ground", {150, 150, 140});
  qml.category("outer_ceiling", "underside of what stands out", {170, 160, 190});
  qml.category("outer_floor", "terrace", {200, 190, 150});
  qml.category("", "other", kOthers);
  return std::move(qml).done();
}

std::string wall_segment_kinds() {
  Qml qml(Shape::line);
  qml.categories("kind");
  for (int k = 1; k < model::kWallSegmentKindCount; ++k) {
    const auto kind = static_cast<model::WallSegmentKind>(k);
    qml.category(model::name(kind), spaced(model::name(kind)) + ": " + std::string(model::meaning(kind)),
                 model::colour_of(kind));
  }
  qml.category("", "not known", model::colour_of(model::WallSegmentKind::unknown));
  return std::move(qml).done();
}

std::string positions() {
  constexpr std::array<Colour, model::kBuildingPositionCount> kColours{{
      {190, 185, 180},  // unknown
      {150, 200, 120},  // free-standing
      {120, 170, 220},  // end of row
      {60, 105, 185},   // mid-row
      {220, 70, 50},    // corner house
      {240, 200, 90},   // rear building
      {235, 150, 50},   // side wing
  }};
  Qml qml = buildings_qml();
  qml.categories("position");
  for (std::size_t k = 1; k < kColours.size(); ++k) {
    const std::string_view name = model::name(static_cast<model::BuildingPosition>(k));
    qml.category(name, spaced(name), kColours[k]);
  }
  qml.category("", "not known", kColours[0]);
  return std::move(qml).done();
}

std::string style_classes() {
  // Gruenderzeit in the red of its bricks, tenements brown, modern blue.
  constexpr std::array<std::pair<std::string_view, Colour>, model::kStyleClassCount> kClasses{{
      {"Gr\u00fcnderzeit: front house of 1840 to 1918", {200, 70, 55}},
      {"tenement: wings, rear buildings, workers' houses", {165, 120, 75}},
      {"modern: designed after 1918", {95, 145, 200}},
      {"other: church, shed, garage, before 1840", {170, 185, 130}},
  }};
  Qml qml = buildings_qml();
  qml.categories("style");
  for (std::size_t i = 0; i < kClasses.size(); ++i)
    qml.category(model::kStyleClassNames[i], kClasses[i].first, kClasses[i].second);
  qml.category("", "not known", kOthers);
  return std::move(qml).done();
}

std::string eras() {
  constexpr std::array<std::pair<std::string_view, Colour>, model::kEraCount> kEras{{
      {"before 1840", {90, 35, 90}},
      {"1840 to 1918", {200, 70, 55}},
      {"1919 to 1945", {245, 175, 85}},
      {"after 1945", {150, 190, 220}},
  }};
  Qml qml = buildings_qml();
  qml.categories("era");
  for (std::size_t i = 0; i < kEras.size(); ++i) qml.category(model::kEraNames[i], kEras[i].first, kEras[i].second);
  qml.category("", "not known", kOthers);
  return std::move(qml).done();
}

/// Sure is dark green, a guess is red; what has no style is grey.
std::string style_confidence() {
  Qml qml = buildings_qml();
  qml.ranges("coalesce(\"style_confidence\", -1)");
  qml.range("-1", "-0.5", "not known", kOthers);
  qml.range("-0.5", "0.4", "up to 40 %", {215, 48, 39});
  qml.range("0.4", "0.55", "40 to 55 %", {252, 141, 89});
  qml.range("0.55", "0.7", "55 to 70 %", {254, 224, 139});
  qml.range("0.7", "0.85", "70 to 85 %", {145, 207, 96});
  qml.range("0.85", "1", "more than 85 %", {26, 125, 70});
  return std::move(qml).done();
}

/// A class of a graduated style: from `lower`, excluded, to `upper`.
struct Step {
  const char *lower, *upper, *label;
};

/// Pale to dark, as storeys; what has no value is grey.
std::string steps(std::string_view attribute, const std::array<Step, 6>& classes) {
  constexpr std::array<Colour, 6> kColours{
      {{255, 247, 204}, {255, 222, 130}, {253, 180, 85}, {244, 120, 60}, {205, 50, 45}, {125, 15, 60}}};
  Qml qml(Shape::fill);
  qml.ranges("coalesce(\"" + std::string(attribute) + "\", -1)");
  qml.range("-1", "-0.5", "not known", kOthers);
  for (std::size_t i = 0; i < classes.size(); ++i)
    qml.range(classes[i].lower, classes[i].upper, classes[i].label, kColours[i]);
  return std::move(qml).done();
}

std::string floor_area_ratio() {
  return steps("floor_area_ratio", {{{"0", "0.3", "up to 0.3"},
                                     {"0.3", "0.7", "0.3 to 0.7"},
                                     {"0.7", "1.2", "0.7 to 1.2"},
                                     {"1.2", "2", "1.2 to 2"},
                                     {"2", "3", "2 to 3"},
                                     {"3", "100", "more than 3"}}});
}

std::string shares(std::string_view attribute) {
  return steps(attribute, {{{"0", "0.1", "up to 10 %"},
                            {"0.1", "0.2", "10 to 20 %"},
                            {"0.2", "0.35", "20 to 35 %"},
                            {"0.35", "0.5", "35 to 50 %"},
                            {"0.5", "0.75", "50 to 75 %"},
                            {"0.75", "100", "more than 75 %"}}});
}

std::string storeys_mean() {
  return steps("storeys_mean", {{{"0", "1.5", "up to 1.5 storeys"},
                                 {"1.5", "2.5", "1.5 to 2.5"},
                                 {"2.5", "3.5", "2.5 to 3.5"},
                                 {"3.5", "4.5", "3.5 to 4.5"},
                                 {"4.5", "6", "4.5 to 6"},
                                 {"6", "1000", "more than 6"}}});
}

std::string closed_or_open() {
  Qml qml(Shape::fill);
  qml.categories("closed");
  qml.category("1", "closed", {120, 190, 130});
  qml.category("0", "open to the street", {215, 230, 160});
  qml.category("", "not known", kOthers);
  return std::move(qml).done();
}

std::string unmapped_probability() {
  Qml qml(Shape::fill);
  qml.ranges("probability");
  qml.range("0", "0.9", "likely a building", {190, 220, 90});
  qml.range("0.9", "1", "very likely a building", {60, 170, 60});
  return std::move(qml).done();
}

std::string image_states() {
  Qml qml(Shape::fill);
  qml.categories("state");
  qml.category("moved", "moved to where the image shows it", {214, 96, 77});
  qml.category("seen_elsewhere", "the image shows it elsewhere", {244, 165, 130});
  qml.category("reshaped", "walls shifted to where the image shows them", {223, 140, 40});
  qml.category("seen_reshaped", "the image shows walls elsewhere", {246, 200, 120});
  qml.category("as_mapped", "where the image shows it", {120, 190, 130});
  qml.category("refused", "not moved: in the way, or as ordered", {150, 120, 190});
  qml.category("", "not decided", kOthers);
  return std::move(qml).done();
}

}  // namespace

std::vector<QgisStyle> qgis_styles(bool images) {
  std::vector<QgisStyle> styles = {
      {"buildings", "Storeys", "Full storeys above ground", storeys(), true},
      {"buildings", "Roofs", "The roof that was built", built_roof(buildings_qml()), false},
      {"buildings", "Source of the storeys", "Mapped, concluded or assumed", source_of("storeys"), false},
      {"buildings", "Position", "How a building stands to its neighbours", positions(), false},
      {"buildings", "Style", "Class of appearance", style_classes(), false},
      {"buildings", "Confidence of the style", "How sure the class of appearance is", style_confidence(), false},
      {"buildings", "Era", "When it was built", eras(), false},
      {"parts", "Roofs", "The roof that was built", built_roof(Qml(Shape::fill)), true},
      {"parts", "Level of detail", "Where less than asked was built", level_of_detail(), false},
      {"facade_edges", "Kinds", "What each stretch of an outline faces", wall_segment_kinds(), true},
      {"blocks", "Floor area ratio", "Floor area by area of the block", floor_area_ratio(), true},
      {"blocks", "Closure", "Share of the street front that is built", shares("closure"), false},
      {"courtyards", "Closed and open", "Whether an open way leads out", closed_or_open(), true},
      {"cells", "Built share", "Area of footprints by area of the square", shares("built_share"), true},
      {"cells", "Storeys", "Mean of the mapped storeys", storeys_mean(), false},
      {"reported", "Reasons", "Why an object was not built itself", codes(), true},
      {"tiles", "Outlines", "Tile borders with their numbers", outlines(), true},
      {"surfaces", "Classes", "Ground, walls and roofs", surface_classes(), true},
  };
  if (images) {
    styles.push_back({"footprint_before", "What was done", "Moved or left where it is mapped", image_states(), true});
    styles.push_back({"unmapped", "Probability", "How likely a building stands there", unmapped_probability(), true});
  }
  return styles;
}

}  // namespace blockrand::outputs
