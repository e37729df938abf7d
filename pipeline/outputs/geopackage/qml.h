// QGIS layer styles as text. Internal to this folder.
#pragma once

#include <string>
#include <string_view>

#include "pipeline/model/colour.h"
#include "pipeline/outputs/number_text.h"

namespace blockrand::outputs {

inline std::string rgba(model::Colour c, int alpha = 255) {
  return std::to_string(c.r) + ',' + std::to_string(c.g) + ',' + std::to_string(c.b) + ',' + std::to_string(alpha);
}

enum class Shape { marker, line, fill };

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
  void category(std::string_view value, std::string_view label, model::Colour colour) {
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
  void range(std::string_view lower, std::string_view upper, std::string_view label, model::Colour colour) {
    classes_ += "<range render=\"true\" symbol=\"" + std::to_string(symbols_) + "\" lower=\"";
    classes_ += lower;
    classes_ += "\" upper=\"";
    classes_ += upper;
    classes_ += "\" label=\"";
    append_xml(classes_, label);
    classes_ += "\"/>\n";
    symbol(colour);
  }
  void single(model::Colour colour, int alpha) {
    out_ += "<renderer-v2 type=\"singleSymbol\" enableorderby=\"0\" forceraster=\"0\" symbollevels=\"0\">\n";
    symbol(colour, alpha);
  }
  /// \param smallest_scale  labels are drawn at 1:smallest_scale and larger; 0: always
  void label(std::string_view attribute, int smallest_scale = 0) {
    labelling_ = "<labeling type=\"simple\">\n<settings calloutType=\"simple\">\n<text-style fieldName=\"";
    append_xml(labelling_, attribute);
    labelling_ +=
        "\" isExpression=\"0\" fontSize=\"8\" fontSizeUnit=\"Point\" textColor=\"70,70,70,255\" textOpacity=\"1\">\n"
        "<text-buffer bufferDraw=\"1\" bufferSize=\"0.8\" bufferSizeUnits=\"MM\" bufferColor=\"255,255,255,255\" "
        "bufferOpacity=\"1\"/>\n</text-style>\n";
    if (smallest_scale > 0)
      labelling_ += "<rendering scaleVisibility=\"1\" scaleMin=\"1\" scaleMax=\"" + std::to_string(smallest_scale) +
                    "\" drawLabels=\"1\" obstacle=\"1\"/>\n";
    labelling_ += "</settings>\n</labeling>\n";
  }

  std::string done() && {
    out_ += classes_ + end_of_classes_ + "<symbols>\n" + symbol_list_ + "</symbols>\n</renderer-v2>\n" + labelling_;
    // QGIS counts points, lines, polygons as 0, 1, 2.
    out_ += "<layerGeometryType>" + std::to_string(static_cast<int>(shape_)) + "</layerGeometryType>\n</qgis>\n";
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
  void symbol(model::Colour colour, int alpha = 255) {
    const bool marker = shape_ == Shape::marker;
    constexpr std::string_view kTypes[] = {"marker", "line", "fill"};
    constexpr std::string_view kClasses[] = {"SimpleMarker", "SimpleLine", "SimpleFill"};
    symbol_list_ += "<symbol type=\"";
    symbol_list_ += kTypes[static_cast<std::size_t>(shape_)];
    symbol_list_ +=
        "\" name=\"" + std::to_string(symbols_++) + "\" alpha=\"1\" clip_to_extent=\"1\" force_rhr=\"0\">\n";
    symbol_list_ += "<layer class=\"";
    symbol_list_ += kClasses[static_cast<std::size_t>(shape_)];
    symbol_list_ += "\" enabled=\"1\" locked=\"0\" pass=\"0\">\n<Option type=\"Map\">\n";
    if (shape_ == Shape::line) {
      option("line_color", rgba(colour, alpha));
      option("line_style", "solid");
      option("line_width", "0.6");
      option("line_width_unit", "MM");
      option("capstyle", "flat");
      option("joinstyle", "bevel");
      symbol_list_ += "</Option>\n</layer>\n</symbol>\n";
      return;
    }
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

}  // namespace blockrand::outputs
