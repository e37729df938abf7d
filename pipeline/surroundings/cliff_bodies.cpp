#include "pipeline/surroundings/cliff_bodies.h"

#include <algorithm>

#include "pipeline/model/osm_keys.h"
#include "pipeline/surroundings/line_strips.h"
#include "pipeline/surroundings/street_profile.h"

namespace blockrand::surroundings {

using model::Point2;
namespace osm_key = model::osm_key;

namespace {
/// m: of a cliff that nobody measured [E]; the highest that is believed.
constexpr double kUsualHeight = 2, kMostHeight = 100;
/// m: what stands of a cliff above terrain that falls as far as it does.
constexpr double kLeastShown = 0.5;
/// m: thickness at the top.
constexpr double kThickness = 0.6;
/// m beside the line where the terrain is asked: half a triangle of it.
constexpr double kBeside = 6.25;
/// m: how deep the face reaches into the ground.
constexpr double kSunk = 0.3;
}  // namespace

std::optional<model::SurroundingBody> cliff_bodies(const BodySite& site, const Thing& thing) {
  const TagOf tag = site.claims.tags_of(thing.feature);
  const std::string_view natural = tag(osm_key::kNatural);
  if (natural != "cliff" && natural != "earth_bank") return std::nullopt;
  const std::optional<double> told = length_of(tag(osm_key::kHeight));
  const double height = told && *told > 0.1 && *told <= kMostHeight ? *told : kUsualHeight;
  model::SurroundingBody made = body_of(site, thing, model::BodyClass::cliff, natural == "cliff" ? "rock" : "ground");
  for (const std::vector<Point2>& mapped : site.claims.lines_of(thing)) {
    if (mapped.size() < 2) continue;
    const OffsetLine line(following(mapped, site.ground, site.around));
    if (line.size() < 2) continue;
    const auto takes = [&](std::size_t i) {
      const Point2 a = line.points()[i], b = line.points()[i + 1], middle{(a.x + b.x) / 2, (a.y + b.y) / 2};
      if (!site.is_own(middle)) return false;
      using enum model::GroundClass;
      for (const Point2 p : {middle, line.beside(i, -kThickness, i), line.beside(i + 1, -kThickness, i)}) {
        const GroundAt at = site.ground(p);
        if (at.building || at.ground == carriageway || at.ground == parking_lane || at.ground == rail_bed ||
            at.ground == steps)
          return false;
      }
      return true;
    };
    const auto heights = [&](std::size_t i) {
      const std::size_t segment = std::min(i, line.size() - 2);
      const double fall = site.terrain_height(line.beside(i, -kBeside, segment)) -
                          site.terrain_height(line.beside(i, kBeside, segment));
      const double z = site.terrain_height(line.points()[i]);
      return std::pair(z - kSunk, z + std::max(std::min(kLeastShown, height), height - std::max(0.0, fall)));
    };
    add_strip(line, -kThickness, 0, heights, takes, false, made.faces);
  }
  if (made.faces.empty()) return std::nullopt;
  return made;
}

}  // namespace blockrand::surroundings
