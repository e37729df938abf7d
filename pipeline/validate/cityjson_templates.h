// The geometry templates of a CityJSON file: the elements of LoD3, each once.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/validate/checked_json.h"
#include "pipeline/validate/cityjson_object_reader.h"
#include "pipeline/validate/contents.h"
#include "pipeline/validate/detail_check.h"

namespace blockrand::validate {

struct CityJsonTemplates {
  std::vector<std::uint64_t> digests;  ///< element_digest(), by template; 0 for those that cannot be read
  std::vector<ReadElement> elements;   ///< by template
  std::vector<bool> used;              ///< by template: placed somewhere in the file
};

/// Reads "geometry-templates" and checks: MultiSurfaces of LoD 3, every index one of a vertex, every vertex used, rings
/// of three different points. \param colours  "#rrggbb" by material of the appearance beside them
CityJsonTemplates read_templates(const Json& root, const std::vector<std::string>& colours, CityJsonFindings& findings);

/// A GeometryInstance: its place, with the digest of its template. Nothing where it breaks a rule, which `complain` is
/// told. \param vertices  of the object or feature
template <class Complain>
std::optional<ReadPlacement> read_instance(const Json& g, CityJsonScope& scope, CityJsonTemplates& templates,
                                           const Complain& complain) {
  for (const auto& [name, value] : g.items())
    if (name != "type" && name != "template" && name != "boundaries" && name != "transformationMatrix")
      complain("has an instance with the unknown member " + name);
  const auto number = whole(member(g, "template"));
  if (!number || *number >= templates.digests.size()) {
    complain("has an instance of a template that does not exist");
    return std::nullopt;
  }
  templates.used[*number] = true;
  const Json* corner = member(g, "boundaries");
  const auto vertex = corner && corner->is_array() && corner->size() == 1 ? whole(element(corner, 0)) : std::nullopt;
  if (vertex && *vertex < scope.used.size()) scope.used[*vertex] = true;
  if (!vertex || !scope.lies_somewhere(*vertex)) {
    complain("has an instance that stands at no vertex");
    return std::nullopt;
  }
  const auto m = numbers(member(g, "transformationMatrix"), 16);
  if (!m || !turns_about_the_vertical(*m)) {
    complain("has an instance whose matrix is no rotation about the vertical");
    return std::nullopt;
  }
  return ReadPlacement{templates.digests[*number], scope.vertices[*vertex], {(*m)[0], (*m)[4]}};
}

}  // namespace blockrand::validate
