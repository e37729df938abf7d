#include "pipeline/surroundings/street_controls.h"

#include "pipeline/model/osm_keys.h"

namespace blockrand::surroundings {

namespace osm_key = model::osm_key;

CrossingMarking crossing_of(const TagOf& tag) {
  if (tag(osm_key::kHighway) != "crossing") return CrossingMarking::none;
  const std::string_view painted = tag(osm_key::kCrossingMarkings), kind = tag(osm_key::kCrossing);
  if (painted == "no" || kind == "no" || kind == "unmarked" || kind == "informal") return CrossingMarking::none;
  if (painted.starts_with("zebra") || kind == "zebra") return CrossingMarking::zebra;
  if (!painted.empty()) return CrossingMarking::lines;
  if (kind == "marked" || kind == "uncontrolled") return CrossingMarking::zebra;
  return kind == "traffic_signals" ? CrossingMarking::lines : CrossingMarking::none;
}

StreetControl control_of(const TagOf& tag) {
  StreetControl out;
  const std::string_view highway = tag(osm_key::kHighway);
  if (highway == "stop") {
    out.kind = ControlKind::stop;
  } else if (highway == "give_way") {
    out.kind = ControlKind::give_way;
  } else if (highway == "traffic_signals") {
    out.kind = ControlKind::signals;
    const std::string_view crossing = tag(osm_key::kCrossing);
    out.crossing = !crossing.empty() && crossing != "no";
  } else {
    return out;
  }
  std::string_view told = tag(osm_key::kTrafficSignalsDirection);
  if (told.empty()) told = tag(osm_key::kDirection);
  out.forward = told == "forward" || told == "both";
  out.backward = told == "backward" || told == "both";
  return out;
}

}  // namespace blockrand::surroundings
