// Speed of the GeoPackage writer on invented settlements: the rows made on worker threads, and the part that is serial.
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>

#include "pipeline/outputs/geopackage/geopackage_writer.h"
#include "tests/unit/outputs/sample_region.h"

namespace {

using namespace blockrand;
using outputs::test::SampleRegion;

std::string scratch() {
  return (std::filesystem::temp_directory_path() / ("blockrand-benchmark-" + std::to_string(::getpid()) + ".gpkg"))
      .string();
}

void geopackage_rows(benchmark::State& state) {
  const SampleRegion sample = SampleRegion::settlement(1000, true);
  for (auto _ : state) benchmark::DoNotOptimize(outputs::geopackage_rows(sample.region(), 2));
  state.SetItemsProcessed(state.iterations() * 1000);
}
BENCHMARK(geopackage_rows);

/// `range(0)` tiles of 1000 houses; the time of close() counts as well.
void geopackage_file(benchmark::State& state) {
  const SampleRegion sample = SampleRegion::settlement(1000, true);
  const outputs::GeoPackageRows rows = outputs::geopackage_rows(sample.region(), 2);
  const std::string path = scratch();
  for (auto _ : state) {
    std::remove(path.c_str());
    outputs::GeoPackageWriter writer(path, {"EPSG:25833", "2024-05-01T00:00:00Z", "", ""});
    for (int i = 0; i < state.range(0); ++i) writer.add(rows);
    writer.close();
  }
  state.SetItemsProcessed(state.iterations() * state.range(0) * 1000);
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(std::filesystem::file_size(path)));
  std::remove(path.c_str());
}
BENCHMARK(geopackage_file)->Arg(10)->Arg(100)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
