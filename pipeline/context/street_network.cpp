#include "pipeline/context/street_network.h"

#include <cmath>
#include <optional>
#include <string_view>

#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/model/osm_keys.h"

namespace blockrand::context {

namespace {

namespace osm_key = model::osm_key;
using model::Extract;
using model::Feature;
using model::FeatureKind;

constexpr std::pair<std::string_view, LineClass> kStreets[] = {
    {"motorway", LineClass::motorway},
    {"trunk", LineClass::trunk},
    {"primary", LineClass::primary},
    {"secondary", LineClass::secondary},
    {"tertiary", LineClass::tertiary},
    {"residential", LineClass::residential},
    {"unclassified", LineClass::residential},
    {"road", LineClass::residential},
    {"living_street", LineClass::living_street},
    {"pedestrian", LineClass::pedestrian},
};

LineClass street_class(std::string_view highway) {
  constexpr std::string_view kLink = "_link";
  if (highway.ends_with(kLink)) highway.remove_suffix(kLink.size());
  for (const auto& [name, c] : kStreets)
    if (name == highway) return c;
  return LineClass::other;
}

bool is_yes(std::string_view value) { return !value.empty() && value != "no"; }

/// The tags that decide, looked up once.
class Classifier {
 public:
  explicit Classifier(const Extract& extract) : extract_(extract) {}

  /// Class and properties of a feature; nothing when it belongs to no network.
  std::optional<NetworkLine> classify(const Feature& f) const {
    NetworkLine line;
    line.id = f.id;
    line.area = f.area;
    const std::optional<LineClass> kind = kind_of(f);
    if (!kind) return std::nullopt;
    line.kind = *kind;
    const std::string_view tunnel = tag(f, osm_key::kTunnel);
    line.tunnel = (is_yes(tunnel) && tunnel != "building_passage") || tag(f, osm_key::kLocation) == "underground";
    line.bridge = is_yes(tag(f, osm_key::kBridge));
    line.roundabout = tag(f, osm_key::kJunction) == "roundabout" || tag(f, osm_key::kJunction) == "circular";
    const std::string_view oneway = tag(f, osm_key::kOneway);
    // Motorways and roundabouts run one way without a word.
    line.oneway = oneway == "yes" || oneway == "true" || oneway == "1" || oneway == "-1" || line.roundabout ||
                  (line.kind == LineClass::motorway && oneway != "no");
    if (is_street(line.kind)) line.name = tag(f, osm_key::kName);
    line.layer = layer_of(tag(f, osm_key::kLayer));
    return line;
  }

 private:
  std::string_view tag(const Feature& f, std::string_view key) const { return extract_.tag(f.tags, key); }

  static int layer_of(std::string_view text) {
    const bool negative = text.starts_with("-");
    if (negative) text.remove_prefix(1);
    if (text.size() != 1 || text[0] < '0' || text[0] > '9') return 0;
    return negative ? '0' - text[0] : text[0] - '0';
  }

  std::optional<LineClass> kind_of(const Feature& f) const {
    if (f.is(FeatureKind::street)) {
      if (const std::string_view highway = tag(f, osm_key::kHighway); !highway.empty()) {
        const LineClass c = street_class(highway);
        if (tag(f, osm_key::kIndoor) == "yes") return LineClass::other;
        // An area of another class is a yard or a car park; its outline is no street.
        if (f.area && c != LineClass::pedestrian) return std::nullopt;
        return c;
      }
    }
    if (f.is(FeatureKind::railway) && !f.area) {
      const std::string_view railway = tag(f, osm_key::kRailway);
      if (railway == "rail" || railway == "light_rail" || railway == "narrow_gauge")
        return is_yes(tag(f, osm_key::kService)) ? LineClass::other : LineClass::railway;
    }
    if (f.is(FeatureKind::water)) {
      const std::string_view natural = tag(f, osm_key::kNatural), waterway = tag(f, osm_key::kWaterway);
      if (natural == "coastline") return LineClass::coastline;
      if (f.area && (natural == "water" || waterway == "riverbank" || waterway == "dock")) return LineClass::shore;
      if (!f.area && (waterway == "river" || waterway == "canal")) return LineClass::waterway;
    }
    return std::nullopt;
  }

  const Extract& extract_;
};

}  // namespace

bool bounds_blocks(const NetworkLine& line) { return line.kind != LineClass::other && !line.tunnel; }

std::vector<NetworkLine> network_lines(const Extract& extract, const Project& project) {
  constexpr std::uint32_t kKinds = static_cast<std::uint32_t>(FeatureKind::street) |
                                   static_cast<std::uint32_t>(FeatureKind::railway) |
                                   static_cast<std::uint32_t>(FeatureKind::water);
  const Classifier classifier(extract);
  std::vector<NetworkLine> out;
  for (const Feature& f : extract.features) {
    if ((f.kinds & kKinds) == 0 || f.id.type == model::OsmType::node) continue;
    const std::optional<NetworkLine> found = classifier.classify(f);
    if (!found) continue;
    std::vector<NetworkLine> rings;
    double size = 0;
    for (const model::MappedRing& ring : extract.rings_of(f.rings)) {
      NetworkLine line = *found;
      for (const model::Location v : extract.vertices_of(ring)) line.points.push_back(model::snap(project(v)));
      const auto nodes = extract.nodes_of(ring);
      line.nodes.assign(nodes.begin(), nodes.end());
      if (line.points.size() < 2) continue;
      if (f.area) {
        size += (ring.inner ? -1 : 1) * std::fabs(geometry::signed_area(line.points));
        line.points.push_back(line.points.front());
        line.nodes.push_back(line.nodes.front());
      }
      rings.push_back(std::move(line));
    }
    if (found->kind == LineClass::shore && size < kMinWaterArea) continue;
    for (NetworkLine& line : rings) out.push_back(std::move(line));
  }
  return out;
}

}  // namespace blockrand::context
