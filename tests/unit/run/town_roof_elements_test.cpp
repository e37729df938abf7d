// All roof elements on all roofs of real towns: how many fit, and that what stands then is valid and keeps the rules.
// Flat roofs take chimneys alone. Skipped without the data.
#include <gtest/gtest.h>

#include <array>
#include <cctype>
#include <cstdio>
#include <filesystem>
#include <map>

#include "tests/unit/roofs/fitted_roof.h"
#include "tests/unit/run/built_town.h"

namespace blockrand::run::test {
namespace {

namespace fs = std::filesystem;
using model::BuildingPart;
using model::RoofElementKind;
using model::RoofShape;
using roof_checks::Fitted;
using roof_checks::Fitting;

/// What was tried on roofs of one shape.
struct Tally {
  int roofs = 0, slopes = 0, invalid = 0, broken = 0;
  int roofs_with_chimney = 0;
  std::map<RoofElementKind, int> built, slopes_with;
};

std::string validity(const model::Polygon& plan, double bottom, const roofs::Roof& roof) {
  const model::Solid solid = masses::envelope(plan, bottom, roof, {});
  const auto triangles = geometry::triangulate(solid);
  return triangles ? geometry::check_solid(solid, *triangles).text() : "a face is no simple polygon";
}

/// The roof of a part as its LoD2 has it; empty where that took a fallback.
std::optional<roofs::BuiltRoof> bare_roof(const BuildingPart& part, const model::Polygon& plan, double bottom) {
  const model::Attributes& a = part.attributes;
  roofs::RoofRequest request;
  request.shape = part.built_roof;
  request.measures.height = part.built_roof == RoofShape::flat ? 0 : model::snap(a.roof_height.value);
  request.measures.eaves = model::snap(a.height.value) - request.measures.height;
  if (a.roof_direction) request.down = roofs::compass_vector(a.roof_direction->value);
  request.across = a.roof_orientation.value == model::RoofOrientation::across;
  for (const double coarseness : roofs::kCoarseness) {
    request.coarseness = coarseness;
    auto built = roofs::build_roof(plan, request);
    if (built && validity(plan, bottom, built->roof) == "none") return built;
  }
  return std::nullopt;
}

/// Elements by turns, so that each kind meets every kind of roof.
Fitting turn(std::size_t count) {
  Fitting with;
  with.dormer = roofs::usual_dormer(roofs::kDormerKinds[count % 6]);
  with.cross_gable.kind = roofs::kDormerKinds[count / 6 % 5];
  if (with.cross_gable.kind == roofs::DormerKind::shed) with.cross_gable.roof_pitch = 10;
  with.cross_gable.wall_height = with.cross_gable.kind == roofs::DormerKind::gabled && count % 2 == 0 ? 0 : 1;
  with.cross_gables = count % 3 != 0;
  with.most_dormers = 1 + static_cast<int>(count % 4);
  return with;
}

class TownRoofElements : public testing::TestWithParam<const char*> {};

TEST_P(TownRoofElements, AreValidOnEveryRoof) {
  const fs::path file = fs::path(BLOCKRAND_SHARED_DIR) / "data/osm" / GetParam();
  if (!fs::exists(file)) GTEST_SKIP() << "no " << file;
  const BuiltTown town(file);
  std::map<RoofShape, Tally> tallies;
  std::size_t count = 0;
  int not_rebuilt = 0;
  for (std::size_t shard = 0; shard < town.shards().size(); ++shard) {
    const model::Region region = town.tile(shard, 2);
    for (const model::Building& building : region.buildings)
      for (const BuildingPart& part : building.parts) {
        if (!building.owned || part.lod != 2 || part.built_roof == RoofShape::lined) continue;
        model::Polygon plan = part.plan;
        geometry::remove_collinear(plan.outer, usual_generation().collinear_tolerance);
        for (model::Ring& hole : plan.holes) geometry::remove_collinear(hole, usual_generation().collinear_tolerance);
        const double bottom = model::snap(part.attributes.height.value - part.attributes.roof_height.value - 3);
        const auto bare = bare_roof(part, plan, bottom);
        if (!bare) {
          ++not_rebuilt;
          continue;
        }
        Tally& tally = tallies[bare->shape];
        const auto edges = roof_checks::gables_as_party_walls(bare->roof);
        Fitting with = turn(count++);
        const auto extent = geometry::extent_along(plan.outer.points, geometry::long_axis(plan.outer.points));
        with.frontage = extent.maximum - extent.minimum;
        const Fitted fitted = roof_checks::fit_out(plan, edges, bare->roof, with);
        ++tally.roofs;
        tally.slopes += fitted.slopes_asked;
        for (const auto& [kind, n] : fitted.built) tally.built[kind] += n;
        for (const auto& [kind, n] : fitted.slopes) tally.slopes_with[kind] += n;
        tally.roofs_with_chimney += fitted.built.contains(RoofElementKind::chimney);
        const std::string body = validity(plan, bottom, fitted.roof),
                          bodies = roof_checks::installations_validity(fitted.installations);
        if (body != "none" || bodies != "none") {
          ++tally.invalid;
          ADD_FAILURE() << part.id << " (" << model::name(bare->shape) << "): " << body << "; " << bodies;
        }
        for (const auto* complaints : {&fitted.faults}) {
          tally.broken += !complaints->empty();
          for (const std::string& complaint : *complaints) ADD_FAILURE() << part.id << ": " << complaint;
        }
        const auto rules = roof_checks::broken_rules(fitted.roof, fitted.installations);
        tally.broken += !rules.empty();
        for (const std::string& rule : rules)
          ADD_FAILURE() << part.id << " (" << model::name(bare->shape) << "): " << rule;
      }
  }
  Tally all;
  std::printf(
      "%s\n| shape | roofs | slopes of 15-80 degrees | cross gables | slopes with dormers | dormers | slopes with roof "
      "windows "
      "| roof windows | roofs with chimney | chimneys | invalid | rules broken |\n",
      GetParam());
  const auto line = [](const char* name, Tally& t) {
    std::printf("| %s | %d | %d | %d | %d | %d | %d | %d | %d | %d | %d | %d |\n", name, t.roofs, t.slopes,
                t.built[RoofElementKind::cross_gable], t.slopes_with[RoofElementKind::dormer],
                t.built[RoofElementKind::dormer], t.slopes_with[RoofElementKind::roof_window],
                t.built[RoofElementKind::roof_window], t.roofs_with_chimney, t.built[RoofElementKind::chimney],
                t.invalid, t.broken);
  };
  for (auto& [shape, tally] : tallies) {
    line(std::string(model::name(shape)).c_str(), tally);
    all.roofs += tally.roofs;
    all.slopes += tally.slopes;
    all.invalid += tally.invalid;
    all.broken += tally.broken;
    all.roofs_with_chimney += tally.roofs_with_chimney;
    for (const auto& [kind, n] : tally.built) all.built[kind] += n;
    for (const auto& [kind, n] : tally.slopes_with) all.slopes_with[kind] += n;
  }
  line("all", all);
  std::printf("%d roofs are fallbacks that this test does not follow\n", not_rebuilt);
  EXPECT_LE(not_rebuilt, all.roofs / 50);
  EXPECT_EQ(all.invalid, 0);
  EXPECT_EQ(all.broken, 0);
  EXPECT_GT(all.roofs, 100);
  EXPECT_GT(all.slopes_with[RoofElementKind::dormer], all.slopes / 10);
  EXPECT_GT(all.built[RoofElementKind::cross_gable], 0);
  EXPECT_GT(all.roofs_with_chimney, all.roofs / 2);
}

std::string town_name(const testing::TestParamInfo<const char*>& tested) {
  std::string name = tested.param;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
}

INSTANTIATE_TEST_SUITE_P(Small, TownRoofElements,
                         testing::Values("husum_altstadt.osm.pbf", "berlin-luisenstadt-2021.osm"), town_name);
INSTANTIATE_TEST_SUITE_P(Large, TownRoofElements,
                         testing::Values("lauf-2020-clipped.osm.pbf", "dortmund-innenstadt.osm.gz",
                                         "berlin-mitte-2014.osm.pbf", "liechtenstein-2022-12.osm.pbf"),
                         town_name);

}  // namespace
}  // namespace blockrand::run::test
