#include "pipeline/context/address_points.h"

#include <algorithm>
#include <charconv>
#include <optional>

#include "pipeline/model/osm_keys.h"

namespace blockrand::context {

namespace {

namespace osm_key = model::osm_key;
using model::Extract;
using model::Feature;
using model::FeatureKind;

/// Metres of a plain number with or without the unit; anything else tells nothing.
std::optional<double> metres(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc()) return std::nullopt;
  std::string_view rest(end, static_cast<std::size_t>(text.data() + text.size() - end));
  while (rest.starts_with(' ')) rest.remove_prefix(1);
  if (!rest.empty() && rest != "m") return std::nullopt;
  if (!(value >= kMinPassageWidth && value <= kMaxPassageWidth)) return std::nullopt;
  return value;
}

double assumed_width(std::string_view highway) {
  constexpr std::string_view kOnFoot[] = {"footway", "path", "steps", "cycleway", "corridor", "bridleway", "platform"};
  if (std::find(std::begin(kOnFoot), std::end(kOnFoot), highway) != std::end(kOnFoot)) return kFootPassageWidth;
  if (highway == "service" || highway == "track" || highway.empty()) return kServicePassageWidth;
  return kStreetPassageWidth;
}

}  // namespace

std::vector<PassageWay> passage_ways(const Extract& extract, const Project& project) {
  std::vector<PassageWay> out;
  for (const Feature& f : extract.features) {
    if (!f.is(FeatureKind::passage) || f.area || f.id.type != model::OsmType::way) continue;
    if (extract.tag(f.tags, osm_key::kIndoor) == "yes") continue;
    for (const model::MappedRing& ring : extract.rings_of(f.rings)) {
      PassageWay way;
      way.id = f.id;
      way.name = extract.tag(f.tags, osm_key::kName);
      way.width =
          metres(extract.tag(f.tags, osm_key::kWidth)).value_or(assumed_width(extract.tag(f.tags, osm_key::kHighway)));
      way.covered_only = extract.tag(f.tags, osm_key::kTunnel) != "building_passage";
      for (const model::Location v : extract.vertices_of(ring)) way.points.push_back(model::snap(project(v)));
      const auto nodes = extract.nodes_of(ring);
      way.nodes.assign(nodes.begin(), nodes.end());
      if (way.points.size() >= 2) out.push_back(std::move(way));
    }
  }
  return out;
}

std::vector<SitePoint> site_points(const Extract& extract, const Project& project, const UseOfTags& use_of) {
  std::vector<SitePoint> out;
  for (const Feature& f : extract.features) {
    if (f.id.type != model::OsmType::node) continue;
    SitePoint point;
    if (use_of && (f.is(FeatureKind::shop) || f.is(FeatureKind::amenity)))
      point.use = use_of([&](std::string_view key) { return extract.tag(f.tags, key); });
    if (f.is(FeatureKind::entrance) && extract.tag(f.tags, osm_key::kEntrance) != "no")
      point.kind = SitePointKind::entrance;
    else if (f.is(FeatureKind::address))
      point.kind = SitePointKind::address;
    else if (f.is(FeatureKind::tree))
      point.kind = SitePointKind::tree;
    else if (!point.use.empty())
      point.kind = SitePointKind::shop;
    else
      continue;
    if (point.kind == SitePointKind::tree) point.use.clear();
    const auto rings = extract.rings_of(f.rings);
    if (rings.empty() || extract.vertices_of(rings[0]).empty()) continue;
    point.id = f.id;
    point.place = model::snap(project(extract.vertices_of(rings[0])[0]));
    point.street = extract.tag(f.tags, osm_key::kAddrStreet);
    point.house_number = extract.tag(f.tags, osm_key::kAddrHousenumber);
    out.push_back(std::move(point));
  }
  return out;
}

BuildingAddress building_address(const Extract& extract, model::OsmId id, model::Range tags) {
  return {id, extract.tag(tags, osm_key::kAddrStreet), extract.tag(tags, osm_key::kAddrHousenumber)};
}

std::string_view address_street(const Extract& extract, model::Range tags) {
  return extract.tag(tags, osm_key::kAddrStreet);
}

}  // namespace blockrand::context
