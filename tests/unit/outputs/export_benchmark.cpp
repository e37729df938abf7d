// Speed of the writers on invented settlements: buildings and bytes per second, for tiles of 60 and of 1000 houses.
#include <benchmark/benchmark.h>

#include "pipeline/outputs/citygml/citygml_writer.h"
#include "pipeline/outputs/cityjson/cityjson_writer.h"
#include "pipeline/outputs/gltf/building_table.h"
#include "pipeline/outputs/gltf/glb_writer.h"
#include "pipeline/outputs/gltf/mesh_buffers.h"
#include "tests/unit/outputs/sample_region.h"

namespace {

using namespace blockrand;
using outputs::test::SampleRegion;

void count(benchmark::State& state, std::size_t bytes) {
  state.SetItemsProcessed(state.iterations() * state.range(0));
  state.SetBytesProcessed(static_cast<std::int64_t>(bytes));
}

outputs::GlbOptions options() {
  outputs::GlbOptions o;
  o.frame.to_enu = [](std::span<const model::Point3> in, std::span<model::Point3> out) {
    for (std::size_t i = 0; i < in.size(); ++i) out[i] = {in[i].x - 391250.1, in[i].y - 5819300.3, in[i].z - 34};
  };
  return o;
}

void write_glb(benchmark::State& state) {
  const SampleRegion sample = SampleRegion::settlement(static_cast<int>(state.range(0)), state.range(1) != 0);
  const outputs::GlbOptions o = options();
  std::size_t bytes = 0;
  for (auto _ : state) bytes += outputs::write_glb(sample.region(), o).bytes.size();
  count(state, bytes);
}
BENCHMARK(write_glb)->ArgsProduct({{60, 1000}, {0, 1}});

void build_mesh(benchmark::State& state) {
  const SampleRegion sample = SampleRegion::settlement(static_cast<int>(state.range(0)), true);
  const outputs::GlbOptions o = options();
  for (auto _ : state) benchmark::DoNotOptimize(outputs::build_mesh(sample.region(), 2, o.frame));
  count(state, 0);
}
BENCHMARK(build_mesh)->Arg(60)->Arg(1000);

void building_table(benchmark::State& state) {
  const SampleRegion sample = SampleRegion::settlement(static_cast<int>(state.range(0)), true);
  for (auto _ : state)
    benchmark::DoNotOptimize(outputs::building_table(sample.region(), outputs::AttributeProfile::all, false));
  count(state, 0);
}
BENCHMARK(building_table)->Arg(60)->Arg(1000);

void write_citygml(benchmark::State& state) {
  const SampleRegion sample = SampleRegion::settlement(static_cast<int>(state.range(0)), state.range(1) != 0);
  std::size_t bytes = 0;
  for (auto _ : state) bytes += outputs::write_citygml(sample.region(), {}).size();
  count(state, bytes);
}
BENCHMARK(write_citygml)->ArgsProduct({{60, 1000}, {0, 1}});

void write_cityjson_sequence(benchmark::State& state) {
  const SampleRegion sample = SampleRegion::settlement(static_cast<int>(state.range(0)), state.range(1) != 0);
  std::size_t bytes = 0;
  for (auto _ : state) bytes += outputs::write_cityjson_sequence(sample.region(), {}).size();
  count(state, bytes);
}
BENCHMARK(write_cityjson_sequence)->ArgsProduct({{60, 1000}, {0, 1}});

void single_cityjson(benchmark::State& state) {
  const SampleRegion sample = SampleRegion::settlement(static_cast<int>(state.range(0)), true);
  std::size_t bytes = 0;
  for (auto _ : state) {
    outputs::SingleCityJson writer({}, [&](std::string_view piece) { bytes += piece.size(); });
    writer.add(sample.region());
    writer.finish();
  }
  count(state, bytes);
}
BENCHMARK(single_cityjson)->Arg(1000);

}  // namespace

BENCHMARK_MAIN();
