// Eaves, verges, caps, parapets, firewalls and ornamental gables on all roofs of real extracts: every body is valid,
// and none reaches into its house. Skipped without the data. BLOCKRAND_ROOF_CASES=1 prints what is refused,
// ROOF_EDGES_GLB=<folder> writes a GLB per extract.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>

#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/outputs/gltf/glb_writer.h"
#include "tests/unit/roofs/drawn_gables.h"
#include "tests/unit/roofs/element_checks.h"
#include "tests/unit/roofs/roof_with_edges.h"
#include "tests/unit/run/built_town.h"

namespace blockrand::run::test {
namespace {

namespace fs = std::filesystem;
using model::BuildingPart;
using model::Point2;
using model::Point3;
using model::Polygon;
using model::Solid;
using model::SurfaceKind;
using roof_checks::Neighbourhood;
using roof_checks::RoofWithEdges;

/// A part that stands, read back from its solid: its plan, its roof, and what neighbours see of it.
struct Siting {
  const model::Building* building = nullptr;
  const BuildingPart* part = nullptr;
  Polygon plan;
  roofs::Roof roof;
  std::vector<std::array<Point3, 3>> above;  ///< triangles of the roof
  Point2 low, high;                          ///< of its box
};

model::Ring ring_of(const Solid& solid, const Solid::Loop& loop) {
  model::Ring out;
  const auto indices = solid.indices_of(loop);
  for (auto i = indices.rbegin(); i != indices.rend(); ++i) out.points.push_back(solid.vertices[*i].xy());
  out.nodes.assign(out.points.size(), 0);
  return out;
}

/// Plan and roof of a solid that masses::envelope() made. Empty where walls have no height: they are no faces then.
std::optional<Siting> read_back(const model::Building& building, const BuildingPart& part) {
  const Solid& solid = part.lod2;
  if (part.lod != 2 || solid.empty() || part.canopy) return std::nullopt;
  Siting out;
  out.building = &building;
  out.part = &part;
  const model::Face& under = solid.faces[0];
  const auto loops = solid.loops_of(under);
  // The underside runs from its ring's last corner back.
  for (std::size_t l = 0; l < loops.size(); ++l) {
    model::Ring ring = ring_of(solid, loops[l]);
    if (l == 0)
      out.plan.outer = std::move(ring);
    else
      out.plan.holes.push_back(std::move(ring));
  }
  std::size_t count = out.plan.outer.size();
  for (const auto& hole : out.plan.holes) count += hole.size();
  out.roof.wall_tops.resize(count);
  const auto edges = roofs::plan_edges(out.plan);
  for (std::size_t f = 1; f < solid.faces.size(); ++f) {
    const model::Face& face = solid.faces[f];
    const auto points = [&](const Solid::Loop& loop) {
      std::vector<Point3> p;
      for (const std::uint32_t i : solid.indices_of(loop)) p.push_back(solid.vertices[i]);
      return p;
    };
    if (face.kind == SurfaceKind::wall && face.edge >= 0) {
      auto loop = points(solid.loops_of(face)[0]);
      if (loop.size() < 4 || static_cast<std::size_t>(face.edge) >= count) return std::nullopt;
      const roofs::PlanEdge& e = edges[static_cast<std::size_t>(face.edge)];
      if (loop[0].xy() != e.from || loop[1].xy() != e.to) return std::nullopt;
      out.roof.wall_tops[static_cast<std::size_t>(face.edge)].assign(loop.begin() + 2, loop.end());
      continue;
    }
    roofs::Roof::Surface surface;
    surface.upright = face.kind == SurfaceKind::wall;
    surface.edge = face.edge;
    for (const auto& loop : solid.loops_of(face)) surface.loops.push_back(points(loop));
    out.roof.surfaces.push_back(std::move(surface));
    if (face.kind != SurfaceKind::roof) continue;
    for (std::uint32_t t = part.lod2_triangles.first[f]; t < part.lod2_triangles.first[f + 1]; ++t) {
      const auto& [i, j, k] = part.lod2_triangles.triangles[t];
      out.above.push_back({solid.vertices[i], solid.vertices[j], solid.vertices[k]});
    }
  }
  for (const auto& top : out.roof.wall_tops)
    if (top.size() < 2) return std::nullopt;
  out.low = out.high = out.plan.outer.points[0];
  for (const Point2 p : out.plan.outer.points) {
    out.low = {std::min(out.low.x, p.x), std::min(out.low.y, p.y)};
    out.high = {std::max(out.high.x, p.x), std::max(out.high.y, p.y)};
  }
  return out;
}

std::optional<double> height_over(const Siting& s, Point2 p) {
  for (const auto& [a, b, c] : s.above) {
    const double det = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    if (std::fabs(det) < 1e-9) continue;
    const double u = ((p.x - a.x) * (c.y - a.y) - (p.y - a.y) * (c.x - a.x)) / det,
                 v = ((b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x)) / det;
    if (u >= -1e-9 && v >= -1e-9 && u + v <= 1 + 1e-9) return a.z + u * (b.z - a.z) + v * (c.z - a.z);
  }
  return std::nullopt;
}

/// What stands before each edge of a plan, felt for with points every half metre, and 0.4 m beyond its free corners,
/// where a mitre goes.
std::vector<Neighbourhood> neighbourhoods(const Siting& self, const std::vector<const Siting*>& others) {
  constexpr double kTouching = 0.05, kFarthest = 0.6, kEvery = 0.5;  // m
  const auto edges = roofs::plan_edges(self.plan);
  const auto holder = [&](Point2 p) -> const Siting* {
    for (const Siting* o : others)
      if (p.x >= o->low.x && p.x <= o->high.x && p.y >= o->low.y && p.y <= o->high.y && geometry::contains(o->plan, p))
        return o;
    return nullptr;
  };
  const auto before = [](const roofs::PlanEdge& e, double along, double by) {
    return Point2{e.from.x + e.along.x * along - e.inward().x * by, e.from.y + e.along.y * along - e.inward().y * by};
  };
  const auto feel = [&](const roofs::PlanEdge& e, double along, Neighbourhood& n) {
    for (double by = kTouching; by <= kFarthest; by += kTouching)
      if (holder(before(e, along, by))) {
        n.room = std::min(n.room, by - kTouching);
        return;
      }
  };
  std::vector<Neighbourhood> out;
  for (const roofs::PlanEdge& e : edges) {
    Neighbourhood n;
    const int samples = std::max(2, static_cast<int>(e.length / kEvery));
    const double inset = std::min(0.02, e.length / 3);
    int touching = 0;
    for (int i = 0; i <= samples; ++i) {
      const double along = std::clamp(e.length * i / samples, inset, e.length - inset);
      const Siting* const beside = holder(before(e, along, kTouching));
      touching += beside != nullptr;
      n.neighbour.push_back({along, beside ? height_over(*beside, before(e, along, kTouching)).value_or(-1e9) : -1e9});
      feel(e, along, n);
    }
    n.party_wall = 2 * touching > samples;
    if (!n.party_wall) n.neighbour.clear();
    out.push_back(std::move(n));
  }
  for (std::size_t i = 0; i < edges.size(); ++i)
    for (const double beyond : {0.1, 0.2, 0.3, 0.4}) {
      // Beside a party wall the overhang ends on that wall's line, which may lean outwards.
      constexpr double kLeaning = 0.2;  // m
      if (!out[edges[i].before].party_wall || beyond <= kLeaning) feel(edges[i], -beyond, out[i]);
      if (!out[edges[i].after].party_wall || beyond <= kLeaning) feel(edges[i], edges[i].length + beyond, out[i]);
    }
  return out;
}

struct Tally {
  int asked = 0, shortened = 0, refused = 0;
  void add(const roofs::BuiltElements& e) {
    asked += e.asked;
    shortened += e.shortened;
    refused += e.refused;
  }
};

struct RealExtract {
  const char* file;
  int least_parts;      ///< roofs that must be dressed
  double most_refused;  ///< share of what is asked
};

class RoofEdges : public testing::TestWithParam<RealExtract> {};

TEST_P(RoofEdges, AllBodiesAreValid) {
  const fs::path file = fs::path(BLOCKRAND_SHARED_DIR) / "data/osm" / GetParam().file;
  if (!fs::exists(file)) GTEST_SKIP() << "no " << file;
  const BuiltTown town(file);
  const bool cases = std::getenv("BLOCKRAND_ROOF_CASES") != nullptr;
  const char* const folder = std::getenv("ROOF_EDGES_GLB");
  int parts = 0, unread = 0, bodies = 0, invalid = 0, reaching = 0;
  std::map<model::RoofElementKind, int> by_kind;
  std::map<model::RoofElementKind, int> in_neighbour;
  std::map<std::string, int> by_gable;
  Tally gables, firewalls, parapets, overhangs, caps;
  model::Region picture;
  const model::Extract no_tags;
  picture.extract = &no_tags;
  picture.materials.push_back({"plaster", 0.9f, 0.0f});
  picture.buildings.emplace_back().osm = {model::OsmType::way, 1};
  Point2 origin;
  for (std::size_t shard = 0; shard < town.shards().size(); ++shard) {
    const model::Region region = town.tile(shard, 2);
    std::vector<Siting> standing;
    for (const model::Building& b : region.buildings)
      for (const BuildingPart& p : b.parts) {
        if (auto s = read_back(b, p))
          standing.push_back(std::move(*s));
        else if (b.owned && p.lod == 2 && !p.canopy)
          ++unread;
      }
    for (const Siting& s : standing) {
      if (!s.building->owned) continue;
      ++parts;
      std::vector<const Siting*> near;
      for (const Siting& o : standing)
        if (&o != &s && o.low.x < s.high.x + 1 && s.low.x < o.high.x + 1 && o.low.y < s.high.y + 1 &&
            s.low.y < o.high.y + 1)
          near.push_back(&o);
      const auto around = neighbourhoods(s, near);
      std::optional<std::pair<std::uint32_t, roofs::GableOptions>> gable;
      if (const auto drawn = roofs::draw_gable(1, s.part->osm.key(), s.part->built_roof))
        if (const auto edge = roof_checks::gable_edge(s.plan, s.roof, around)) gable.emplace(*edge, *drawn);
      const RoofWithEdges with_edges = roof_checks::dress(s.plan, s.roof, around, gable);
      constexpr const char* reasons[] = {"", ": no such outline", ": no room", ": no body"};
      if (gable)
        ++by_gable[std::string(roofs::name(gable->second.form)) + reasons[static_cast<int>(with_edges.refusal)]];
      gables.add(with_edges.gables);
      firewalls.add(with_edges.firewalls);
      parapets.add(with_edges.parapets);
      overhangs.add(with_edges.overhangs);
      caps.add(with_edges.caps);
      if (cases && with_edges.gables.refused)
        std::printf("%s: no %s gable, %s\n", s.part->id.c_str(), std::string(roofs::name(gable->second.form)).c_str(),
                    std::string(model::name(s.part->built_roof)).c_str());
      bodies += static_cast<int>(with_edges.bodies.size());
      for (const auto& body : with_edges.bodies) {
        ++by_kind[body.kind];
        if (const std::string v = roof_checks::validity(body.solid); v != "none") {
          ++invalid;
          std::printf("%s: %s %s\n", s.part->id.c_str(), std::string(model::name(body.kind)).c_str(), v.c_str());
        }
      }
      if (const std::string fault = roof_checks::fault(s.part->lod2, with_edges.bodies); !fault.empty()) {
        ++reaching;
        std::printf("%s (%s): %s\n", s.part->id.c_str(), std::string(model::name(s.part->built_roof)).c_str(),
                    fault.c_str());
      }
      for (const auto& body : with_edges.bodies) {
        const roof_checks::Measured mine(body.solid);
        for (const Siting* o : near)
          if (mine.overlap(roof_checks::Measured(o->part->lod2)) > 1e-3) {
            ++in_neighbour[body.kind];
            if (cases)
              std::printf("%s: %s in %s\n", s.part->id.c_str(), std::string(model::name(body.kind)).c_str(),
                          o->part->id.c_str());
            break;
          }
      }
      if (folder) {
        if (picture.buildings[0].parts.empty()) origin = s.low;
        const auto add = [&](Solid solid, bool keep, model::Colour colour) {
          BuildingPart p;
          p.id = "w1." + std::to_string(picture.buildings[0].parts.size());
          p.osm = {model::OsmType::way, static_cast<std::int64_t>(picture.buildings[0].parts.size()) + 1};
          p.lod = 2;
          for (auto& v : solid.vertices) v = {v.x - origin.x, v.y - origin.y, v.z};
          for (auto& f : solid.faces) {
            f.material = 0;
            if (!keep) f.colour = colour;
          }
          p.lod2_triangles = *geometry::triangulate(solid);
          p.lod2 = std::move(solid);
          picture.buildings[0].parts.push_back(std::move(p));
        };
        add(s.part->lod2, true, {});
        constexpr model::Colour colours[] = {{},
                                             {},
                                             {},
                                             {},
                                             {190, 190, 196},
                                             {206, 160, 120},
                                             {150, 96, 84},
                                             {214, 196, 170},
                                             {214, 196, 170},
                                             {110, 46, 36},
                                             {110, 46, 36}};
        for (const auto& body : with_edges.bodies) add(body.solid, false, colours[static_cast<int>(body.kind)]);
      }
    }
  }
  std::printf("%s: %d roofs (%d more are no envelope with upright walls), %d bodies\n", GetParam().file, parts, unread,
              bodies);
  std::printf("| element | asked | shortened | refused |\n|---|---|---|---|\n");
  Tally all;
  for (const auto& [name, tally] :
       {std::pair("gables", &gables), std::pair("firewalls", &firewalls), std::pair("parapets", &parapets),
        std::pair("eaves and verges", &overhangs), std::pair("ridge and hip caps", &caps)}) {
    std::printf("| %s | %d | %d | %d |\n", name, tally->asked, tally->shortened, tally->refused);
    all.asked += tally->asked;
    all.refused += tally->refused;
  }
  for (const auto& [kind, count] : by_kind) std::printf("%s %d; ", std::string(model::name(kind)).c_str(), count);
  for (const auto& [form, count] : by_gable) std::printf("%s %d; ", form.c_str(), count);
  std::printf("\nin a neighbour by more than 1 dm³:");
  for (const auto& [kind, count] : in_neighbour) std::printf(" %s %d;", std::string(model::name(kind)).c_str(), count);
  std::printf("\n");
  EXPECT_GE(parts, GetParam().least_parts);
  EXPECT_EQ(invalid, 0);
  EXPECT_EQ(reaching, 0);
  for (const auto kind :
       {model::RoofElementKind::eaves, model::RoofElementKind::verge, model::RoofElementKind::hip_cap})
    EXPECT_EQ(in_neighbour[kind], 0) << model::name(kind);
  EXPECT_LE(all.refused, GetParam().most_refused * all.asked);
  if (folder) {
    const std::string path = std::string(folder) + "/" + fs::path(GetParam().file).stem().stem().string() + ".glb";
    std::ofstream(path, std::ios::binary) << outputs::write_glb(picture, {}).bytes;
  }
}

INSTANTIATE_TEST_SUITE_P(Extracts, RoofEdges,
                         testing::Values(RealExtract{"husum_altstadt.osm.pbf", 500, 0.2},
                                         RealExtract{"berlin-luisenstadt-2021.osm", 200, 0.2}),
                         [](const auto& info) { return std::string(info.index == 0 ? "Husum" : "Luisenstadt"); });

}  // namespace
}  // namespace blockrand::run::test
