#include "pipeline/outputs/explain/situation_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "pipeline/outputs/explain/places.h"
#include "pipeline/outputs/wall_segment_ids.h"

namespace blockrand::outputs {
namespace {

using model::Building;
using model::BuildingPosition;
using model::WallSegment;
using model::WallSegmentKind;

constexpr std::size_t kMostNames = 6;  // more is no help to a reader; "edges" has them all
constexpr double kAreaSeen = 0.05;     // m²: smaller changes vanish in the rounding of the text
constexpr double kSetbackSeen = 0.05;  // m, likewise

std::string_view in_words(BuildingPosition position) {
  switch (position) {
    case BuildingPosition::free_standing:
      return "free-standing house";
    case BuildingPosition::end_of_row:
      return "end of a row";
    case BuildingPosition::mid_row:
      return "within a row";
    case BuildingPosition::corner_house:
      return "corner house";
    case BuildingPosition::rear_building:
      return "rear building (Hinterhaus)";
    case BuildingPosition::side_wing:
      return "side wing (Seitenflügel)";
    case BuildingPosition::unknown:
      break;
  }
  return "how it stands to its block is not known";
}

/// A street as people name it.
std::string street_of(const WallSegment& e) {
  if (!e.street_name.empty()) return e.street_name;
  if (e.street.number == 0) return "a street";
  std::string kind = e.street_class.empty() ? "street" : e.street_class;
  std::replace(kind.begin(), kind.end(), '_', ' ');
  return fmt::format("{} ({} without a name)", e.street.text(), kind);
}

/// Lengths of wall segments by what they face, in the order met; the longest wall segment says where they look.
struct Tally {
  std::string name;
  double length = 0, longest = 0;
  std::string_view looks;
};
void add(std::vector<Tally>& tallies, const std::string& name, double length, std::string_view looks) {
  auto known = std::find_if(tallies.begin(), tallies.end(), [&](const Tally& t) { return t.name == name; });
  if (known == tallies.end()) known = tallies.insert(tallies.end(), {name, 0, 0, {}});
  known->length += length;
  if (length > known->longest) {
    known->longest = length;
    known->looks = looks;
  }
}
std::string text_of(const std::vector<Tally>& tallies, bool with_materials) {
  std::vector<std::string> names;
  for (const Tally& t : tallies)
    names.push_back(with_materials ? fmt::format("{} ({:.1f} m, looks {})", t.name, t.length, t.looks)
                                   : fmt::format("{} ({:.1f} m)", t.name, t.length));
  return listed(names, kMostNames);
}

std::string courtyards_text(const Building& building, const CourtyardLookup& lookup) {
  std::vector<std::string> names;
  for (const std::string& id : building.situation.courtyards) {
    const std::optional<CourtyardFacts> facts = lookup ? lookup(id) : std::nullopt;
    names.push_back(facts
                        ? fmt::format("{} courtyard of {:.0f} m2", facts->closed ? "a closed" : "an open", facts->area)
                        : "the courtyard " + id);
  }
  return names.empty() ? "" : "stands at " + listed(names, kMostNames);
}

/// To the millimetre; degrees to a tenth.
double rounded(double value) { return std::nearbyint(value * 1000) / 1000; }
double degrees(double value) { return std::nearbyint(value * 10) / 10; }

}  // namespace

std::string counted(std::size_t n, std::string_view noun) { return fmt::format("{} {}{}", n, noun, n == 1 ? "" : "s"); }

std::string listed(const std::vector<std::string>& names, std::size_t most) {
  std::string text;
  const std::size_t shown = std::min(names.size(), most);
  for (std::size_t i = 0; i < shown; ++i) {
    const bool last = i + 1 == shown && shown == names.size();
    text += (i == 0 ? "" : last ? " and " : ", ") + names[i];
  }
  if (shown < names.size()) text += fmt::format(" and {} more", names.size() - shown);
  return text;
}

std::string moved_text(const Building& building) {
  const model::RepairRecord& r = building.repaired;
  if (r.vertices == 0) return "";
  std::vector<std::string> neighbours;
  for (const WallSegment& e : building.edges)
    if (e.kind == WallSegmentKind::party_wall && e.neighbour.number != 0)
      if (std::string id = e.neighbour.text(); std::find(neighbours.begin(), neighbours.end(), id) == neighbours.end())
        neighbours.push_back(std::move(id));
  const std::string with = neighbours.empty() ? "" : " with " + listed(neighbours, kMostNames);
  std::vector<std::string> pieces;
  if (r.moved == 0) {
    pieces.push_back("no corner was moved");
    if (r.shared_walls > 0) pieces.push_back("it shares " + counted(r.shared_walls, "wall") + with);
  } else {
    std::vector<std::string> why;
    if (r.shared_walls > 0) why.push_back("to share " + counted(r.shared_walls, "wall") + with);
    if (r.direction >= 0) why.push_back("to make corners right");
    if (r.overlaps_resolved > 0) why.push_back("to resolve " + counted(r.overlaps_resolved, "overlap"));
    pieces.push_back(fmt::format("{} of {} moved by {:.2f} m on average, {:.2f} m at most{}{}", r.moved,
                                 counted(r.vertices, "corner"), r.mean_shift, r.max_shift, why.empty() ? "" : ", ",
                                 fmt::join(why, " and ")));
  }
  if (r.gaps_closed > 0) pieces.push_back(counted(r.gaps_closed, "gap") + " between walls closed");
  if (r.overlap_left > 0) pieces.push_back(fmt::format("{:.1f} m2 still overlap with others", r.overlap_left));
  if (!building.arcs.empty()) pieces.push_back(counted(building.arcs.size(), "curve") + " kept");
  if (std::fabs(r.area - r.mapped_area) >= kAreaSeen)
    pieces.push_back(fmt::format("area {:.1f} -> {:.1f} m2", r.mapped_area, r.area));
  return fmt::format("{}", fmt::join(pieces, "; "));
}

std::string situation_text(const Building& building, const CourtyardLookup& courtyard) {
  const model::BuildingSituation& s = building.situation;
  std::vector<Tally> fronts, walls;
  double passages = 0, nameless = 0;
  std::int64_t entrances = 0;
  bool chamfer = false;
  const std::vector<IdentifiedWallSegment> found = wall_segments(building);
  const auto on_front = [&](std::uint32_t index) {
    const auto wall_segment =
        std::find_if(found.begin(), found.end(), [&](const IdentifiedWallSegment& t) { return t.index == index; });
    if (wall_segment == found.end()) return;
    const WallSegment& e = building.edges[index];
    add(fronts, street_of(e), e.length(), compass(outward(wall_segment->from, wall_segment->to)));
  };
  for (const std::uint32_t index : s.fronts) on_front(index);
  for (const IdentifiedWallSegment& wall_segment : found) {
    const WallSegment& e = building.edges[wall_segment.index];
    if (s.fronts.empty() && e.kind == WallSegmentKind::street) on_front(wall_segment.index);
    if (e.kind == WallSegmentKind::party_wall) {
      if (e.neighbour.number != 0)
        add(walls, e.neighbour.text(), e.length(), {});
      else
        nameless += e.length();
    }
    if (e.kind == WallSegmentKind::passage) passages += e.length();
    entrances += e.entrances;
    chamfer = chamfer || e.chamfer;
  }
  std::vector<std::string> pieces{std::string(in_words(s.position))};
  if (!fronts.empty()) pieces.push_back((fronts.size() == 1 ? "front on " : "fronts on ") + text_of(fronts, true));
  if (chamfer) pieces.push_back("the street corner is cut off");
  if (passages > 0) pieces.push_back(fmt::format("a passage {:.1f} m wide", passages));
  if (entrances > 0) pieces.push_back(counted(static_cast<std::size_t>(entrances), "mapped entrance"));
  if (!walls.empty()) pieces.push_back("walls shared with " + text_of(walls, false));
  if (nameless > 0) pieces.push_back(fmt::format("{:.1f} m of party walls", nameless));
  if (walls.empty() && !(nameless > 0)) pieces.push_back("no wall is shared with a neighbour");
  if (s.depth && s.width) pieces.push_back(fmt::format("{:.1f} m deep and {:.1f} m wide", *s.depth, *s.width));
  if (s.setback && *s.setback >= kSetbackSeen)
    pieces.push_back(fmt::format("{:.1f} m behind the building line of the street", *s.setback));
  if (const std::string yards = courtyards_text(building, courtyard); !yards.empty()) pieces.push_back(yards);
  if (!building.trees.empty()) pieces.push_back(counted(building.trees.size(), "tree") + " before its walls");
  if (!s.block.empty()) pieces.push_back("in block " + s.block);
  return fmt::format("{}", fmt::join(pieces, "; "));
}

void append_repair(JsonText& json, const Building& building) {
  const model::RepairRecord& r = building.repaired;
  if (r.vertices == 0) return;
  json.key("repair");
  json.open('{');
  json.number("vertices", r.vertices);
  json.number("moved", r.moved);
  json.number("mean_shift", rounded(r.mean_shift));
  json.number("max_shift", rounded(r.max_shift));
  json.number("mapped_area", rounded(r.mapped_area));
  json.number("area", rounded(r.area));
  json.number("shared_walls", r.shared_walls);
  json.number("gaps_closed", r.gaps_closed);
  json.number("overlaps_resolved", r.overlaps_resolved);
  json.number("overlap_left", rounded(r.overlap_left));
  if (r.direction >= 0) json.number("direction", degrees(r.direction));
  json.close('}');
}

void append_imagery(JsonText& json, const SeenOutline& seen) {
  json.key("imagery");
  json.open('{');
  for (const auto& [name, value] : imagery_attributes(seen)) {
    const std::string_view key = name.substr(std::string_view("imagery_").size());
    if (const double* number = std::get_if<double>(&value))
      json.number(key, *number);
    else
      json.string(key, std::get<std::string>(value));
  }
  json.key("box");
  json.open('[');
  for (const double v : {seen.box.minimum.x, seen.box.minimum.y, seen.box.maximum.x, seen.box.maximum.y})
    json.element(rounded(v));
  json.close(']');
  json.key("lean");
  json.open('[');
  for (const double v : {seen.receipt.lean.x, seen.receipt.lean.y}) json.element(rounded(v));
  json.close(']');
  json.close('}');
}

void append_situation(JsonText& json, const Building& building) {
  const model::BuildingSituation& s = building.situation;
  if (s.position == BuildingPosition::unknown) return;
  json.key("situation");
  json.open('{');
  json.string("position", model::name(s.position));
  if (s.orientation) json.number("orientation", degrees(*s.orientation));
  if (s.depth) json.number("depth", rounded(*s.depth));
  if (s.width) json.number("width", rounded(*s.width));
  if (s.setback) json.number("setback", rounded(*s.setback));
  json.number("party_wall_length", rounded(s.party_wall_length));
  if (!s.block.empty()) json.string("block", s.block);
  json.key("courtyards");
  json.open('[');
  for (const std::string& id : s.courtyards) json.element(id);
  json.close(']');
  if (!building.trees.empty()) {
    json.key("trees");
    json.open('[');
    for (const model::NearTree& tree : building.trees) {
      json.open('{');
      json.string("id", tree.id.text());
      json.number("distance", rounded(tree.distance));
      json.close('}');
    }
    json.close(']');
  }
  json.close('}');
}

namespace {

void append_points(JsonText& json, const std::vector<model::WallPoint>& points, const model::Extract* extract) {
  if (points.empty()) return;
  json.key("points");
  json.open('[');
  for (const model::WallPoint& point : points) {
    json.open('{');
    json.string("id", point.id.text());
    json.flag("entrance", point.entrance);
    if (!point.house_number.empty()) {
      json.string("house_number", point.house_number);
      if (const auto street = extract ? street_of_point(*extract, point.id) : std::string_view(); !street.empty())
        json.string("street", street);
    }
    if (!point.use.empty()) json.string("use", point.use);
    json.close('}');
  }
  json.close(']');
}

}  // namespace

void append_edges(JsonText& json, const Building& building, const model::Extract* extract) {
  const std::vector<IdentifiedWallSegment> found = wall_segments(building);
  if (found.empty()) return;
  const std::vector<std::uint32_t>& fronts = building.situation.fronts;
  json.key("edges");
  json.open('[');
  for (const IdentifiedWallSegment& wall_segment : found) {
    const WallSegment& e = building.edges[wall_segment.index];
    json.open('{');
    json.string("id", wall_segment.id);
    json.string("kind", model::name(e.kind));
    json.number("confidence", rounded(e.confidence));
    json.number("length", rounded(e.length()));
    json.string("looks", compass(outward(wall_segment.from, wall_segment.to)));
    if (std::find(fronts.begin(), fronts.end(), wall_segment.index) != fronts.end()) json.flag("front", true);
    if (e.neighbour.number != 0) json.string("neighbour", e.neighbour.text());
    if (e.covered_height > 0) json.number("covered_height", rounded(e.covered_height));
    if (e.street.number != 0) {
      json.string("street", e.street.text());
      if (!e.street_name.empty()) json.string("street_name", e.street_name);
      if (!e.street_class.empty()) json.string("street_class", e.street_class);
      json.number("street_distance", rounded(e.street_distance));
      json.number("street_angle", degrees(e.street_angle));
    }
    if (e.visibility > 0) json.number("visibility", rounded(e.visibility));
    for (const auto& [name, set] : {std::pair("corner_start", e.corner_start), std::pair("corner_end", e.corner_end),
                                    std::pair("chamfer", e.chamfer)})
      if (set) json.flag(name, true);
    if (e.entrances > 0) json.number("entrances", e.entrances);
    append_points(json, e.points, extract);
    if (e.arc >= 0 && static_cast<std::size_t>(e.arc) < building.arcs.size())
      json.number("radius", rounded(building.arcs[static_cast<std::size_t>(e.arc)].radius));
    json.close('}');
  }
  json.close(']');
}

}  // namespace blockrand::outputs
