// How many shapes a second the rule language derives: rules alone, and a facade with its geometry.
#include <benchmark/benchmark.h>

#include <optional>
#include <string>

#include "styles/grammar/evaluation/derive.h"
#include "styles/grammar/language/program.h"
#include "styles/grammar/shapes/initial_shape.h"

namespace {

using namespace blockrand::grammar;

Program program_of(const std::string& rules) {
  LoadOptions options;
  options.read = [&](const std::string& path) {
    return path.ends_with("main.cga") ? std::optional<std::string>(rules) : std::nullopt;
  };
  return load("main.cga", options);
}
Shape lot() { return initial_shape({{0, 0, 0}, {14, 0, 0}, {14, 0, -11}, {0, 0, -11}}); }

void run(benchmark::State& state, const std::string& rules) {
  const Program program = program_of(rules);
  if (has_errors(program.diagnostics)) return state.SkipWithError("the rules have errors");
  const Deriver deriver(program);
  const Shape initial = lot();
  DeriveOptions options;
  std::int64_t shapes = 0;
  for (auto _ : state) {
    ++options.seed;
    const Derivation result = deriver.run(initial, options);
    shapes += static_cast<std::int64_t>(result.shapes);
    benchmark::DoNotOptimize(result.leaves.data());
  }
  state.SetItemsProcessed(shapes);
  state.counters["shapes"] = benchmark::Counter(static_cast<double>(shapes), benchmark::Counter::kAvgIterations);
}

/// Symbols, parameters, cases, chances and arithmetic; no geometry: what a shape costs besides it.
void BM_RulesAlone(benchmark::State& state) {
  run(state, R"(
attr depth = 10
share(n) = case n > 5 : 0.25 else : 0.75
Lot --> Tree(0, scope.sx)
Tree(n, w) -->
  case n >= depth : Tip(w)
  else : Tree(n + 1, w * share(n)) Tree(n + 1, w * (1 - share(n)))
Tip(w) --> 50% : A. else : B.
)");
}

constexpr const char* kFacade = R"(
attr storey = 3.2
attr tile = 2.4
attr wall = "#d8c8a8"
height = 5 * storey
Lot --> extrude(height) comp(f){ front : Facade | side : Wall | top : Roof. }
Facade --> split(y){ 4 : Ground | { ~storey : Floor }* | 0.6 : Cornice. }
Ground --> split(x){ 0.5 : Wall | { ~3 : Shop }* | 0.5 : Wall }
Shop --> split(x){ ~0.3 : Wall | ~2 : set(material.color.r, 0.3) Glass. | ~0.3 : Wall }
Floor --> split(x){ 0.5 : Wall | { ~tile : Tile }* | 0.5 : Wall }
Tile -->
  case split.index % 2 == 0 : Opening(0.9)
  else : Opening(0.7)
Opening(h) --> split(x){ ~1 : Wall | 1.1 : split(y){ ~1 : Wall | '0.6 : Window(h) | ~0.5 : Wall } | ~1 : Wall }
Window(h) --> 60% : Glass. else : Casement
Casement --> split(x){ '0.5 : Glass. | '0.5 : Glass. }
Wall --> color(wall) Wall.
)";
void BM_Facade(benchmark::State& state) { run(state, kFacade); }

BENCHMARK(BM_RulesAlone)->Unit(benchmark::kMicrosecond);
BENCHMARK(BM_Facade)->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
