// Roofs on all repaired outlines of an extract: how many a second on one core, and how many solids the checker refuses.
//
//   roof_benchmark EXTRACT [SHAPE|all]     by default hipped at 40 degrees
//
// Times are of build_roof() alone: plan in, surfaces out; reading, repair, solids and their checks are not in them.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <string>

#include "importers/osm/read_extract.h"
#include "pipeline/base/parallel.h"
#include "pipeline/footprints/area.h"
#include "pipeline/footprints/repair_extract.h"
#include "pipeline/geometry/check_solid.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/straight_skeleton.h"
#include "pipeline/geometry/triangulate.h"
#include "pipeline/geometry/valid_polygon.h"
#include "pipeline/georef/crs.h"
#include "pipeline/georef/projection.h"
#include "pipeline/masses/envelope.h"
#include "styles/roofs/roof.h"

using namespace blockrand;

namespace {

std::vector<model::Polygon> repaired_plans(const std::string& path) {
  const model::Extract extract = importers::osm::read_extract(path);
  const auto area = footprints::area_of(extract);
  if (!area) return {};
  const georef::Crs crs = georef::open_crs(georef::choose_crs(area->centre.lon, area->centre.lat), area->box);
  const georef::Projection projection(crs, area->box);
  model::Report report;
  const auto shards = footprints::make_shards(extract, report);
  base::Progress progress;
  const repair::KeptNodes kept(extract);
  const auto repaired =
      footprints::repair_extract(extract, shards, projection, kept, {}, base::worker_count(0), progress);
  std::vector<model::Polygon> plans;
  for (std::uint32_t b = 0; b < repaired.footprints.size(); ++b)
    for (model::Polygon plan : repaired.footprints.polygons(b)) {
      constexpr double kStraight = 0.01;  // m, as GenerateOptions::collinear_tolerance
      model::Polygon simpler = plan;
      geometry::remove_collinear(simpler.outer, kStraight);
      for (model::Ring& hole : simpler.holes) geometry::remove_collinear(hole, kStraight);
      plans.push_back(geometry::strictly_simple(simpler) ? std::move(simpler) : std::move(plan));
    }
  return plans;
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

roofs::RoofRequest request_for(const model::Polygon& plan, model::RoofShape shape, double coarseness) {
  constexpr double kTangentOf40Degrees = 0.83909963117728;
  roofs::RoofRequest request;
  request.shape = shape;
  request.measures = {10, std::max(0.5, kTangentOf40Degrees * geometry::equivalent_width(plan) / 2)};
  request.coarseness = coarseness;
  return request;
}

bool sound(const model::Polygon& plan, const roofs::Roof& roof) {
  const model::Solid solid = masses::envelope(plan, 0, roof, {});
  const auto triangles = geometry::triangulate(solid);
  return triangles && geometry::check_solid(solid, *triangles).valid();
}

void measure(const std::vector<model::Polygon>& plans, model::RoofShape shape) {
  const auto start = std::chrono::steady_clock::now();
  std::size_t built = 0;
  for (const model::Polygon& plan : plans) built += roofs::build_roof(plan, request_for(plan, shape, 1)).has_value();
  const double seconds = seconds_since(start);
  std::size_t adapted = 0, fallbacks = 0, coarser = 0, refused = 0;
  for (const model::Polygon& plan : plans) {
    bool valid = false;
    for (const double coarseness : roofs::kCoarseness) {
      const auto roof = roofs::build_roof(plan, request_for(plan, shape, coarseness));
      if (!roof || !sound(plan, roof->roof)) continue;
      valid = true;
      adapted += roof->note == model::IssueCode::roof_shape_adapted;
      fallbacks += roof->note == model::IssueCode::skeleton_fallback;
      coarser += coarseness != roofs::kCoarseness[0];
      break;
    }
    refused += !valid;
  }
  std::printf(
      "| %-19s | %7.0f roofs/s | %zu of %zu | %6zu adapted | %3zu skeleton fallbacks | %3zu at the second try | %3zu "
      "refused (%.4f %%) |\n",
      std::string(model::name(shape)).c_str(), static_cast<double>(plans.size()) / seconds, built, plans.size(),
      adapted, fallbacks, coarser, refused, 100.0 * static_cast<double>(refused) / static_cast<double>(plans.size()));
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fputs("usage: roof_benchmark EXTRACT [SHAPE|all]\n", stderr);
    return 1;
  }
  const auto plans = repaired_plans(argv[1]);
  std::size_t corners = 0;
  for (const auto& p : plans) corners += p.outer.size();
  std::printf("%zu plans, %.2f corners\n", plans.size(),
              static_cast<double>(corners) / static_cast<double>(plans.size()));
  const std::string wanted = argc > 2 ? argv[2] : "hipped";
  if (wanted == "hipped") {
    const std::size_t step = std::max<std::size_t>(1, plans.size() / 5000);
    std::size_t tried = 0;
    const auto start = std::chrono::steady_clock::now();
    for (std::size_t i = 0; i < plans.size(); i += step, ++tried)
      if (plans[i].outer.size() < 200) (void)geometry::straight_skeleton(plans[i]);
    std::printf("CGAL's skeleton alone (EPECK), every %zu-th plan: %.0f/s\n", step,
                static_cast<double>(tried) / seconds_since(start));
  }
  for (int s = 0; s < static_cast<int>(model::RoofShape::many); ++s) {
    const auto shape = static_cast<model::RoofShape>(s);
    if (wanted == "all" || wanted == model::name(shape)) measure(plans, shape);
  }
}
