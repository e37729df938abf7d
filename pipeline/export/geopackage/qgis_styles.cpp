#include "pipeline/export/geopackage/qgis_styles.h"

#include <array>
#include <string_view>
#include <utility>

#include "pipeline/export/text.h"
#include "pipeline/model/building.h"
#include "pipeline/model/issue_codes.h"

namespace blockrand::export_ {
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

std::string rgba(Colour c, int alpha = 255) {
  return std::to_string(c.r) + ',' + std::to_string(c.g) + ',' + std::to_string(c.b) + ',' + std::to_string(alpha);
}

enum class Shape { marker, fill };

/// Puts a style together. QGIS reads symbol properties from <Option> elements since 3.22.
class Qml {
 public:
  explicit Qml(Shape shape, bool labels = false) : shape_(shape) {
    out_ = "<qgis version=\"3.22.0\" styleCategories=\"Symbology|Labeling\" labelsEnabled=\"";
    out_ += labels ? "1\">\n" : "0\">\n";
  }

  void categories(std::string_view attribute) {
    out_ += "<renderer-v2 type=\"categorizedSymbol\" attr=\"";
    append_xml(out_, attribute);
    out_ += "\" enableorderby=\"0\" forceraster=\"0\" symbollevels=\"0\">\n";
    classes_ = "<categories>\n";
    end_of_classes_ = "</categories>\n";
  }
  void category(std::string_view value, std::string_view label, Colour colour) {
    classes_ += "<category render=\"true\" symbol=\"" + std::to_string(symbols_) + "\" type=\"string\" value=\"";
    append_xml(classes_, value);
    classes_ += "\" label=\"";
    append_xml(classes_, label);
    classes_ += "\"/>\n";
    symbol(colour);
  }
  void ranges(std::string_view attribute) {
    out_ += "<renderer-v2 type=\"graduatedSymbol\" graduatedMethod=\"GraduatedColor\" attr=\"";
    append_xml(out_, attribute);
    out_ += "\" enableorderby=\"0\" forceraster=\"0\" symbollevels=\"0\">\n";
    classes_ = "<ranges>\n";
    end_of_classes_ = "</ranges>\n";
  }
  void range(std::string_view lower, std::string_view upper, std::string_view label, Colour colour) {
    classes_ += "<range render=\"true\" symbol=\"" + std::to_string(symbols_) + "\" lower=\"";
    classes_ += lower;
    classes_ += "\" upper=\"";
    classes_ += upper;
    classes_ += "\" label=\"";
    append_xml(classes_, label);
    classes_ += "\"/>\n";
    symbol(colour);
  }
  void single(Colour colour, int alpha) {
    out_ += "<renderer-v2 type=\"singleSymbol\" enableorderby=\"0\" forceraster=\"0\" symbollevels=\"0\">\n";
    symbol(colour, alpha);
  }
  void label(std::string_view attribute) {
    labelling_ = "<labeling type=\"simple\">\n<settings calloutType=\"simple\">\n<text-style fieldName=\"";
    append_xml(labelling_, attribute);
    labelling_ +=
        "\" isExpression=\"0\" fontSize=\"8\" fontSizeUnit=\"Point\" textColor=\"70,70,70,255\" textOpacity=\"1\">\n"
        "<text-buffer bufferDraw=\"1\" bufferSize=\"0.8\" bufferSizeUnits=\"MM\" bufferColor=\"255,255,255,255\" "
        "bufferOpacity=\"1\"/>\n</text-style>\n</settings>\n</labeling>\n";
  }

  std::string done() && {
    out_ += classes_ + end_of_classes_ + "<symbols>\n" + symbol_list_ + "</symbols>\n</renderer-v2>\n" + labelling_;
    // QGIS counts points, lines, polygons as 0, 1, 2.
    out_ +=
        std::string("<layerGeometryType>") + (shape_ == Shape::marker ? "0" : "2") + "</layerGeometryType>\n</qgis>\n";
    return std::move(out_);
  }

 private:
  void option(std::string_view name, std::string_view value) {
    symbol_list_ += "<Option type=\"QString\" name=\"";
    symbol_list_ += name;
    symbol_list_ += "\" value=\"";
    append_xml(symbol_list_, value);
    symbol_list_ += "\"/>\n";
  }
  void symbol(Colour colour, int alpha = 255) {
    const bool marker = shape_ == Shape::marker;
    symbol_list_ += "<symbol type=\"";
    symbol_list_ += marker ? "marker" : "fill";
    symbol_list_ +=
        "\" name=\"" + std::to_string(symbols_++) + "\" alpha=\"1\" clip_to_extent=\"1\" force_rhr=\"0\">\n";
    symbol_list_ += "<layer class=\"";
    symbol_list_ += marker ? "SimpleMarker" : "SimpleFill";
    symbol_list_ += "\" enabled=\"1\" locked=\"0\" pass=\"0\">\n<Option type=\"Map\">\n";
    option("color", rgba(colour, alpha));
    if (marker) {
      option("name", "circle");
      option("size", "2.4");
      option("size_unit", "MM");
    } else {
      option("style", "solid");
      option("joinstyle", "bevel");
    }
    option("outline_color", rgba({70, 70, 70}));
    option("outline_style", "solid");
    option("outline_width", marker ? "0.2" : alpha == 0 ? "0.3" : "0.1");
    option("outline_width_unit", "MM");
    symbol_list_ += "</Option>\n</layer>\n</symbol>\n";
  }

  Shape shape_;
  std::string out_, classes_, end_of_classes_, symbol_list_, labelling_;
  int symbols_ = 0;
};

constexpr Colour kOthers{215, 215, 215};

std::string storeys() {
  Qml qml(Shape::fill);
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

std::string built_roof() {
  Qml qml(Shape::fill);
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
  Qml qml(Shape::fill);
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

}  // namespace

std::vector<QgisStyle> qgis_styles() {
  return {
      {"buildings", "Storeys", "Full storeys above ground", storeys(), true},
      {"buildings", "Roofs", "The roof that was built", built_roof(), false},
      {"buildings", "Source of the storeys", "Mapped, concluded or assumed", source_of("storeys"), false},
      {"parts", "Roofs", "The roof that was built", built_roof(), true},
      {"parts", "Level of detail", "Where less than asked was built", level_of_detail(), false},
      {"reported", "Reasons", "Why an object was not built itself", codes(), true},
      {"tiles", "Outlines", "Tile borders with their numbers", outlines(), true},
  };
}

}  // namespace blockrand::export_
