// The rule for non-houses on whole extracts. Skipped where the data is absent.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>

#include "importers/osm/read_extract.h"
#include "styles/classify/non_houses.h"

namespace blockrand::classify {
namespace {

const std::string kConfigs = std::string(BLOCKRAND_SOURCE_DIR) + "/configs";

struct Tally {
  std::size_t buildings = 0;
  std::map<std::string, int> kinds;
  int stelae = 0, stelae_kept = 0;        ///< kept: taken for houses
  int addressed_fields = 0;               ///< with an address, and yet in a field of equals
  int dwellings = 0, dwellings_lost = 0;  ///< building=apartments and their like, of 60 m² and more
};

Tally tally(const std::string& name) {
  const std::filesystem::path file = std::filesystem::path(BLOCKRAND_SHARED_DIR) / "data/osm" / name;
  Tally out;
  if (!std::filesystem::exists(file)) return out;
  const NonHouseRules rules = read_non_houses(kConfigs, read_catalogue(kConfigs));
  const model::Extract extract = importers::osm::read_extract(file.string());
  std::vector<SmallPlan> plans;
  std::vector<std::uint32_t> of;
  for (std::uint32_t b = 0; b < extract.buildings.size(); ++b) {
    const model::MappedBuilding& building = extract.buildings[b];
    if (building.kind != model::ObjectKind::building || building.rings.count == 0) continue;
    const model::Range ring = extract.rings[building.rings.first].vertices;
    // Metres on a plate carree of the place: good enough for sizes and distances of metres.
    const double latitude = extract.vertices[ring.first].lat_degrees() * 3.14159265358979 / 180;
    std::vector<model::Point2> points;
    for (std::uint32_t i = 0; i < ring.count; ++i) {
      const model::Location v = extract.vertices[ring.first + i];
      points.push_back({v.lon_degrees() * 111320 * std::cos(latitude), v.lat_degrees() * 111200});
    }
    SmallPlan plan{{0, 0}, 0, static_cast<int>(points.size())};
    for (std::size_t i = 0; i < points.size(); ++i) {
      const model::Point2 a = points[i], c = points[(i + 1) % points.size()], o = points[0];
      plan.area += ((a.x - o.x) * (c.y - o.y) - (c.x - o.x) * (a.y - o.y)) / 2;
      plan.place.x += a.x / static_cast<double>(points.size());
      plan.place.y += a.y / static_cast<double>(points.size());
    }
    plan.area = std::abs(plan.area);
    plans.push_back(plan);
    of.push_back(b);
  }
  const std::vector<int> equal = equal_neighbours(plans, rules);
  out.buildings = plans.size();
  for (std::size_t i = 0; i < plans.size(); ++i) {
    const model::MappedBuilding& b = extract.buildings[of[i]];
    NonHouseFacts facts;
    facts.use = extract.tag(b.tags, "building");
    facts.tag = [&](std::string_view key) { return extract.tag(b.tags, key); };
    facts.area = plans[i].area;
    facts.has_address = !extract.tag(b.tags, "addr:housenumber").empty();
    if (b.attributes.storeys) facts.storeys = *b.attributes.storeys;
    facts.equal_neighbours = equal[i];
    const auto found = non_house(facts, rules);
    ++out.kinds[found ? found->kind : "house"];
    // The stelae of the memorial in Berlin are the only rectangles below 4 m² with colour, material and height.
    if (facts.area < 4 && facts.use == "yes" && b.attributes.height && b.attributes.wall_colour) {
      ++out.stelae;
      out.stelae_kept += !found;
    }
    out.addressed_fields += found && found->kind == "field_of_equals" && facts.has_address;
    if (facts.area >= 60 && (facts.use == "apartments" || facts.use == "house" || facts.use == "residential")) {
      ++out.dwellings;
      out.dwellings_lost += found.has_value();
    }
  }
  std::string text;
  for (const auto& [kind, n] : out.kinds) text += " " + kind + " " + std::to_string(n);
  std::printf("%s: %zu buildings:%s\n", name.c_str(), out.buildings, text.c_str());
  return out;
}

TEST(RealNonHouses, StelaeOfBerlinAreNoHouses) {
  const Tally t = tally("berlin-mitte-2014.osm.pbf");
  if (t.buildings == 0) GTEST_SKIP() << "no data";
  EXPECT_GE(t.stelae, 2600);
  EXPECT_EQ(t.stelae_kept, 0);
  EXPECT_GE(t.kinds.at("field_of_equals"), 2600);
  EXPECT_LE(t.kinds.at("field_of_equals"), 2620) << "and little else";
}

TEST(RealNonHouses, HousesStayHouses) {
  for (const char* name : {"berlin-mitte-2014.osm.pbf", "dortmund-innenstadt.osm.gz", "helsinki-centre-2019.osm.pbf",
                           "liechtenstein-2022-12.osm.pbf", "husum_altstadt.osm.pbf"}) {
    const Tally t = tally(name);
    if (t.buildings == 0) continue;
    EXPECT_EQ(t.addressed_fields, 0) << name;
    // A dwelling is lost only where the rule says so for any building (ruins).
    EXPECT_LE(t.dwellings_lost, t.dwellings / 500) << name;
    EXPECT_GE(t.kinds.at("house"), 500) << name;
  }
}

}  // namespace
}  // namespace blockrand::classify
