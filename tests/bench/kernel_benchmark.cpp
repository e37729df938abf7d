// Kernels of a build on typical plans: skeletons, roofs, triangulation, the solid check.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include "pipeline/geometry/box_index.h"
#include "pipeline/geometry/check_solid.h"
#include "pipeline/geometry/straight_skeleton.h"
#include "pipeline/geometry/triangulate.h"
#include "pipeline/geometry/valid_polygon.h"
#include "pipeline/geometry/weighted_skeleton.h"
#include "pipeline/masses/envelope.h"
#include "styles/roofs/roof.h"
#include "tests/unit/geometry/shapes.h"

namespace {

using namespace blockrand;

model::Polygon plan(int kind) {
  using testing_shapes::polygon;
  switch (kind) {
    case 0:
      return testing_shapes::turned(polygon({{0, 0}, {14.2, 0.03}, {14.15, 10.1}, {0.02, 10}}));
    case 1:
      return testing_shapes::turned(polygon({{0, 0}, {20, 0.02}, {20, 8}, {8.03, 8}, {8, 18}, {0, 18.01}}));
    default: {
      auto court = testing_shapes::turned(polygon({{0, 0}, {40, 0.1}, {40.05, 30}, {0, 30.1}}));
      const auto hole = testing_shapes::turned(polygon({{11, 11}, {11.1, 19}, {29, 19.05}, {29, 11}}));
      court.holes.push_back(hole.outer);
      return court;
    }
  }
}

roofs::Roof hips(const model::Polygon& p) {
  roofs::RoofRequest request;
  request.shape = model::RoofShape::hipped;
  request.measures = {36, 4};
  return roofs::build_roof(p, request)->roof;
}

void weighted_skeleton(benchmark::State& state) {
  const auto p = plan(static_cast<int>(state.range(0)));
  const std::vector<geometry::EdgeProfile> profiles(p.outer.size() + (p.holes.empty() ? 0 : p.holes[0].size()),
                                                    {0.84, {}});
  for (auto _ : state) benchmark::DoNotOptimize(geometry::weighted_skeleton(p, profiles));
}
void skeleton_by_cgal(benchmark::State& state) {
  const auto p = plan(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(geometry::straight_skeleton(p));
}
void hipped_roof(benchmark::State& state) {
  const auto p = plan(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(hips(p));
}
void envelope_of_hips(benchmark::State& state) {
  const auto p = plan(static_cast<int>(state.range(0)));
  const auto roof = hips(p);
  for (auto _ : state) benchmark::DoNotOptimize(masses::envelope(p, 30, roof, {}));
}
void triangulate(benchmark::State& state) {
  const auto p = plan(static_cast<int>(state.range(0)));
  const auto solid = masses::envelope(p, 30, hips(p), {});
  for (auto _ : state) benchmark::DoNotOptimize(geometry::triangulate(solid));
}
void check(benchmark::State& state) {
  const auto p = plan(static_cast<int>(state.range(0)));
  const auto solid = masses::envelope(p, 30, hips(p), {});
  const auto triangles = geometry::triangulate(solid);
  for (auto _ : state) benchmark::DoNotOptimize(geometry::check_solid(solid, *triangles));
}
void strictly_simple(benchmark::State& state) {
  const auto p = plan(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(geometry::strictly_simple(p));
}

// ---- what stands near a house: BoxIndex against an R-tree, both with the answer in ascending order ----------------

/// Houses of 8 to 23 m on a lattice of 20 m, each moved within it.
std::vector<geometry::PlanBox> town(std::int64_t houses) {
  std::vector<geometry::PlanBox> out;
  std::uint32_t dice = 12345;
  const auto roll = [&](double most) { return most * ((dice = dice * 1664525u + 1013904223u) >> 8) / 16777216.0; };
  for (std::int64_t i = 0; i < houses; ++i) {
    const model::Point2 low{5e5 + static_cast<double>(i % 300) * 20 + roll(10),
                            5e6 + static_cast<double>(i / 300) * 20 + roll(10)};
    out.push_back({low, {low.x + 8 + roll(15), low.y + 8 + roll(15)}});
  }
  return out;
}

void near_by_box_index(benchmark::State& state) {
  const auto boxes = town(state.range(0));
  const geometry::BoxIndex index(boxes);
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(index.near(boxes[i], static_cast<double>(state.range(1))));
    i = (i + 7919) % boxes.size();
  }
}
void make_box_index(benchmark::State& state) {
  const auto boxes = town(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(geometry::BoxIndex(boxes));
}
}  // namespace

// Houses; metres around one of them.
BENCHMARK(near_by_box_index)->ArgsProduct({{1000, 100000}, {1, 40, 250}});
BENCHMARK(make_box_index)->Arg(100000);
// 0: four corners, 1: L, 2: courtyard.
BENCHMARK(weighted_skeleton)->DenseRange(0, 2);
BENCHMARK(hipped_roof)->DenseRange(0, 2);
BENCHMARK(skeleton_by_cgal)->DenseRange(0, 2);
BENCHMARK(envelope_of_hips)->DenseRange(0, 2);
BENCHMARK(triangulate)->DenseRange(0, 2);
BENCHMARK(check)->DenseRange(0, 2);
BENCHMARK(strictly_simple)->DenseRange(0, 2);
BENCHMARK_MAIN();
