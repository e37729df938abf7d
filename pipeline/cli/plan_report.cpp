#include "pipeline/cli/plan_report.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "pipeline/base/text.h"
#include "pipeline/outputs/output.h"
#include "pipeline/run/build.h"

namespace blockrand::cli {
namespace {

using base::with_byte_unit;
using base::with_thousands;

std::vector<std::pair<std::string, std::string>> places(const run::BuildOptions& options, const run::BuildPlan& plan) {
  std::vector<std::pair<std::string, std::string>> all;
  if (options.areas > 0)
    all.emplace_back("areas/", fmt::format("{} areas, each a build of its own", with_thousands(plan.areas)));
  for (const outputs::OutputFormat& format : outputs::all_outputs()) {
    if (!format.asked(options.outputs) || options.areas > 0) continue;
    for (const outputs::OutputPlace& p : format.places)
      if (!p.written || p.written(options.outputs, plan.size.all.buildings)) all.emplace_back(p.path, p.about);
  }
  all.emplace_back("build.json, run.json", "inputs, coordinate system, counts, hashes; times");
  return all;
}

}  // namespace

std::string rough_time(double seconds) {
  if (seconds < 10) return "some seconds";
  if (seconds < 45) return "about half a minute";
  if (seconds < 100) return "a minute or two";
  if (seconds < 5400) return fmt::format("about {:.0f} minutes", std::ceil(seconds / 60));
  return fmt::format("about {:.0f} hours", std::ceil(seconds / 3600));
}

std::string plan_report(const run::BuildOptions& options, const run::BuildPlan& plan) {
  std::string text = "A build would\n";
  const auto row = [&](const char* what, const std::string& value) {
    text += fmt::format("  {:<10}{}\n", what, value);
  };
  row("read",
      fmt::format("{}: {} buildings, {} parts; {} of them have an outline to build from", run::told_input(options),
                  with_thousands(plan.buildings), with_thousands(plan.parts), with_thousands(plan.size.all.buildings)));
  row("make", fmt::format("{} tiles, up to level of detail {}, in {} {}", with_thousands(plan.size.tiles), options.lod,
                          plan.crs.authority_code, plan.crs.name));
  row("heights", plan.heights);
  row("write", plan.folder + (plan.replaces ? ", in place of the build that lies there" : ""));
  for (const auto& [path, about] : places(options, plan)) text += fmt::format("    {:<24}{}\n", path, about);
  row("take", fmt::format("about {} of memory, about {} of disk ({} are free), {}",
                          with_byte_unit(plan.estimate.memory_bytes), with_byte_unit(plan.estimate.disk_bytes),
                          with_byte_unit(plan.free_bytes), rough_time(plan.estimate.seconds)));
  if (options.areas > 0) text += "  Memory is told as for a build at once: one area after the other takes less.\n";
  return text + "Nothing was written.\n";
}

std::string plan_report_json(const run::BuildOptions& options, const run::BuildPlan& plan) {
  nlohmann::ordered_json j;
  j["output"] = plan.folder;
  j["replaces"] = plan.replaces;
  j["input"] = run::told_input(options);
  j["buildings_in"] = plan.buildings;
  j["parts_in"] = plan.parts;
  j["to_build"] = plan.size.all.buildings;
  j["tiles"] = plan.size.tiles;
  if (options.areas > 0) j["areas"] = plan.areas;
  j["lod"] = options.lod;
  j["crs"] = plan.crs.authority_code;
  j["heights"] = plan.heights;
  j["files"] = nlohmann::ordered_json::array();
  for (const auto& [path, about] : places(options, plan)) j["files"].push_back(path);
  j["estimate"] = {{"seconds", plan.estimate.seconds},
                   {"memory_bytes", plan.estimate.memory_bytes},
                   {"disk_bytes", plan.estimate.disk_bytes}};
  j["free_bytes"] = plan.free_bytes;
  return j.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace blockrand::cli
