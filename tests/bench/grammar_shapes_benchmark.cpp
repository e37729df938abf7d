// How long splits take: a facade is some hundred pieces, and hundreds of buildings are derived a second.
#include <benchmark/benchmark.h>

#include "styles/grammar/shapes/components.h"
#include "styles/grammar/shapes/initial_shape.h"
#include "styles/grammar/shapes/mesh_tools.h"
#include "styles/grammar/shapes/operations.h"
#include "styles/grammar/shapes/split.h"

namespace blockrand::grammar {
namespace {

Shape house() {
  Shape lot = initial_shape({{0, 0, 0}, {18, 0, 0}, {18, 0, -12}, {0, 0, -12}});
  const Shape base = lot;
  const Argument height{Mark::plain, 20.0, {}};
  (void)find_operation("extrude")->run(lot, {base, base}, std::span(&height, 1));
  return lot;
}

void split_facade(benchmark::State& state) {
  const Shape wall = component_shape(components(house(), ComponentKind::faces), 2);
  const SplitItem item{Mark::floating, 18.0 / static_cast<double>(state.range(0)), 0, 0, false};
  for (auto _ : state) {
    const auto sizes = split_sizes(std::span(&item, 1), true, split_length(wall, 0));
    benchmark::DoNotOptimize(split_shape(wall, 0, sizes));
  }
  state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(split_facade)->Arg(4)->Arg(20)->Arg(100);

void split_box(benchmark::State& state) {
  const Shape box = house();
  const SplitItem item{Mark::floating, 20.0 / static_cast<double>(state.range(0)), 0, 0, false};
  for (auto _ : state) {
    const auto sizes = split_sizes(std::span(&item, 1), true, split_length(box, 1));
    benchmark::DoNotOptimize(split_shape(box, 1, sizes));
  }
  state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(split_box)->Arg(4)->Arg(20);

void sizes(benchmark::State& state) {
  const SplitItem items[]{{Mark::plain, 1, 0, 0, false},    {Mark::plain, 0, -1, 3, true},
                          {Mark::floating, 1, 1, 0, false}, {Mark::plain, 0.2, 2, 0, false},
                          {Mark::floating, 1, 1, 0, false}, {Mark::plain, 1, 0, 0, false}};
  for (auto _ : state) benchmark::DoNotOptimize(split_sizes(items, false, 10));
  state.SetItemsProcessed(state.iterations() * 14);
}
BENCHMARK(sizes);

void faces_of_a_house(benchmark::State& state) {
  const Shape box = house();
  for (auto _ : state) {
    const auto parts = components(box, ComponentKind::faces);
    for (std::size_t i = 0; i < parts.items.size(); ++i) benchmark::DoNotOptimize(component_shape(parts, i));
  }
  state.SetItemsProcessed(state.iterations() * 6);
}
BENCHMARK(faces_of_a_house);

void copy_shape(benchmark::State& state) {
  const Shape box = house();
  for (auto _ : state) {
    Shape copy = box;
    benchmark::DoNotOptimize(copy);
  }
}
BENCHMARK(copy_shape);

}  // namespace
}  // namespace blockrand::grammar

BENCHMARK_MAIN();
