#include "pipeline/outputs/geopackage/qgis_project.h"

#include <cassert>
#include <string_view>

#include "outputs/geopackage/qgis_project_template.h"
#include "pipeline/base/text.h"
#include "pipeline/outputs/geopackage/qgis_styles.h"
#include "pipeline/outputs/number_text.h"

namespace blockrand::outputs {
namespace {

void append_element(std::string& out, std::string_view name, std::string_view text) {
  out.append("<").append(name).append(">");
  append_xml(out, text);
  out.append("</").append(name).append(">");
}

/// The children of <projectCrs> and the like. QGIS finds a CRS by `authid` where `srsid` says that it is no user's own.
std::string crs_element(const QgisProject& project) {
  std::string out = "<spatialrefsys>";
  append_element(out, "srsid", "1");
  append_element(out, "srid", std::string_view(project.crs).substr(project.crs.find(':') + 1));
  append_element(out, "authid", project.crs);
  append_element(out, "description", project.crs_name);
  return out + "</spatialrefsys>";
}

/// The children of <extent>, with a margin around the buildings. Nothing without buildings.
std::string extent_element(const geometry::PlanBox& box) {
  if (box.empty()) return {};
  constexpr double kMargin = 0.05;  // of the larger side
  const double margin = kMargin * std::max(box.maximum.x - box.minimum.x, box.maximum.y - box.minimum.y) + 1;
  std::string out;
  append_element(out, "xmin", base::shortest(box.minimum.x - margin));
  append_element(out, "ymin", base::shortest(box.minimum.y - margin));
  append_element(out, "xmax", base::shortest(box.maximum.x + margin));
  append_element(out, "ymax", base::shortest(box.maximum.y + margin));
  return out;
}

/// What a layer style holds, which is what QGIS reads in the element of a layer.
std::string_view style_elements(std::string_view qml) {
  const std::size_t first = qml.find(">\n") + 2, last = qml.find("<layerGeometryType>");
  assert(first != 1 && last != std::string_view::npos);
  return qml.substr(first, last - first);
}

}  // namespace

std::string qgis_project(const QgisProject& project) {
  const std::vector<QgisStyle> styles = qgis_styles();
  const auto filled_in = [&](std::string_view mark) -> std::string {
    if (mark == "crs") return crs_element(project);
    if (mark == "extent") return extent_element(project.extent);
    std::string out;
    if (mark == "data") {
      append_xml(out, project.about);
      return out;
    }
    for (const QgisStyle& style : styles)
      if (mark == "style " + style.layer + '/' + style.name) out = style_elements(style.qml);
    assert(!out.empty());  // the template names a style that does not exist
    return out;
  };
  std::string out;
  std::string_view rest = kQgisProjectTemplate;
  for (std::size_t open = rest.find("{{"); open != std::string_view::npos; open = rest.find("{{")) {
    const std::size_t close = rest.find("}}", open);
    assert(close != std::string_view::npos);
    out += rest.substr(0, open);
    out += filled_in(rest.substr(open + 2, close - open - 2));
    rest.remove_prefix(close + 2);
  }
  out += rest;
  return out;
}

}  // namespace blockrand::outputs
