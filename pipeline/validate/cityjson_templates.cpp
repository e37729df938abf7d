#include "pipeline/validate/cityjson_templates.h"

#include <fmt/format.h>

#include <algorithm>

#include "pipeline/geometry/check_solid.h"
#include "pipeline/validate/detail_check.h"
#include "pipeline/validate/polygon_order.h"

namespace blockrand::validate {
namespace {

using model::Point3;

class TemplateReader {
 public:
  TemplateReader(const std::vector<std::string>& colours, CityJsonFindings& findings)
      : colours_(colours), findings_(findings) {}

  CityJsonTemplates read(const Json& all) {
    CityJsonTemplates out;
    const Json *templates = member(all, "templates"), *vertices = member(all, "vertices-templates");
    if (!templates || !templates->is_array() || !vertices || !vertices->is_array()) {
      findings_.rule("", "geometry-templates without templates or vertices");
      return out;
    }
    for (const Json& v : *vertices) {
      const auto p = numbers(&v, 3);
      if (!p) findings_.rule("", "a vertex of the templates is not three numbers");
      points_.push_back(p ? Point3{(*p)[0], (*p)[1], (*p)[2]} : Point3{});
    }
    used_.assign(points_.size(), false);
    for (const Json& t : *templates) {
      where_ = fmt::format("template {}", out.digests.size());
      std::vector<ReadPolygon> read = polygons(t);
      sort_polygons(read);
      out.digests.push_back(element_digest(read));
      out.elements.push_back(element_of(read));
    }
    out.used.assign(out.digests.size(), false);
    if (const auto unused = std::count(used_.begin(), used_.end(), false); unused > 0)
      findings_.rule("", fmt::format("{} vertices of the templates are used by nothing", unused));
    return out;
  }

 private:
  void rule(const std::string& what) { findings_.rule("", where_ + ' ' + what); }

  std::vector<ReadPolygon> polygons(const Json& t) {
    std::vector<ReadPolygon> out;
    if (text(member(t, "type")) != "MultiSurface") rule("is no MultiSurface");
    if (text(member(t, "lod")) != "3") rule("is not of LoD 3");
    const Json* boundaries = member(t, "boundaries");
    if (!boundaries || !boundaries->is_array() || boundaries->empty()) {
      rule("has no boundaries");
      return out;
    }
    const Json* material = member(t, "material");
    const Json* theme = material && material->is_object() && !material->empty() ? &material->begin().value() : nullptr;
    const Json* values = member(theme, "values");
    if (values && values->size() != boundaries->size()) rule("has not one material for each surface");
    for (std::size_t i = 0; i < boundaries->size(); ++i) {
      ReadPolygon polygon;
      for (const Json& r : (*boundaries)[i].is_array() ? (*boundaries)[i] : Json::array()) ring(r, polygon);
      if (polygon.rings.empty())
        rule("has a surface without rings");
      else if (const geometry::SolidCheck c = geometry::check_polygon(polygon.rings); !c.valid())
        rule(fmt::format("has a surface that is invalid: {}", c.text()));
      if (const Json* value = element(values, i); value && !value->is_null()) {
        const auto m = whole(value);
        if (m && *m < colours_.size())
          polygon.colour = colours_[*m];
        else
          rule(fmt::format("has the material index {} of {}", value->dump(), colours_.size()));
      }
      out.push_back(std::move(polygon));
    }
    return out;
  }

  void ring(const Json& r, ReadPolygon& polygon) {
    if (!r.is_array() || r.size() < 3) return rule("has a ring of fewer than three points");
    auto& points = polygon.rings.emplace_back();
    std::vector<std::uint64_t> indices;
    for (const Json& v : r) {
      const auto i = whole(&v);
      if (!i || *i >= points_.size()) return rule("names a vertex that does not exist: " + v.dump().substr(0, 20));
      indices.push_back(*i);
      used_[*i] = true;
      points.push_back(points_[*i]);
    }
    indices.push_back(indices.front());
    if (std::adjacent_find(indices.begin(), indices.end()) != indices.end()) rule("has a point twice in a row");
  }

  const std::vector<std::string>& colours_;
  CityJsonFindings& findings_;
  std::vector<Point3> points_;
  std::vector<bool> used_;
  std::string where_;
};

}  // namespace

CityJsonTemplates read_templates(const Json& root, const std::vector<std::string>& colours,
                                 CityJsonFindings& findings) {
  const Json* all = member(root, "geometry-templates");
  return all ? TemplateReader(colours, findings).read(*all) : CityJsonTemplates{};
}

}  // namespace blockrand::validate
