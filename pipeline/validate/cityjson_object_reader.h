// City objects of one CityJSON object or feature: their rules, and what they hold.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "pipeline/model/point.h"
#include "pipeline/validate/checked_json.h"
#include "pipeline/validate/contents.h"

namespace blockrand::validate {

/// Findings of one file; a damaged one is not listed without end.
class CityJsonFindings {
 public:
  CityJsonFindings(std::string file, Contents& out) : file_(std::move(file)), out_(out) {}
  void rule(std::string object, std::string detail, int number = 0) {
    add(Check::cityjson_rule, std::move(object), std::move(detail), number);
  }
  void add(Check check, std::string object, std::string detail, int number = 0) {
    if (out_.findings.size() < kMost)
      out_.findings.push_back({check, file_, std::move(object), std::move(detail), number});
  }

 private:
  static constexpr std::size_t kMost = 1000;
  std::string file_;
  Contents& out_;
};

/// What the city objects of one CityJSON object or feature refer to.
struct CityJsonScope {
  std::vector<model::Point3> vertices;  ///< metres; not finite where a vertex could not be read
  std::vector<bool> used;               ///< by vertex
  std::vector<std::string> colours;     ///< "#rrggbb" by material; empty for one without
  std::string theme;                    ///< of materials, to be preferred

  /// Whether there is such a vertex, of finite coordinates. Others have no order: what sorts points would not end where
  /// they end.
  bool lies_somewhere(std::uint64_t vertex) const {
    if (vertex >= vertices.size()) return false;
    const model::Point3& p = vertices[vertex];
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
  }
};

struct CityJsonTemplates;

/// Checks every city object and appends buildings and bodies.
/// \param order  ids in the order of the file
/// \param ids    of the file so far, to find those given twice
void read_city_objects(const Json& objects, const std::vector<std::string>& order, CityJsonScope& scope,
                       CityJsonTemplates& templates, std::unordered_set<std::string>& ids, Contents& out,
                       CityJsonFindings& findings);

/// "Building", "Bridge" …: city objects that stand by themselves.
bool is_first_level(std::string_view type);

/// "#rrggbb" of an array of three numbers from 0 to 1, else nothing.
std::optional<std::string> read_colour(const Json* value);

}  // namespace blockrand::validate
