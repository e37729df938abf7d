#include "pipeline/run/region_shards.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <set>

#include "pipeline/base/error.h"
#include "pipeline/base/text.h"
#include "pipeline/run/tile_choice.h"
#include "pipeline/run/update_region.h"

namespace blockrand::run {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

constexpr int kMostShards = 10000;

std::string plan_file(const RegionFolder& region) { return region.plan() + "/plan.json"; }

bool is_planned(const RegionFolder& region) {
  std::error_code error;
  return fs::exists(plan_file(region), error);
}

std::string drop(const RegionFolder& region) { return "blockrand region drop " + region.path(); }

}  // namespace

Shard parse_shard(const std::string& text) {
  Shard shard;
  const char *at = text.data(), *end = at + text.size();
  const auto [slash, bad] = std::from_chars(at, end, shard.number);
  const bool one = bad == std::errc() && slash != end && *slash == '/';
  const auto [last, bad_too] = one ? std::from_chars(slash + 1, end, shard.of) : std::from_chars(at, at, shard.of);
  if (!one || bad_too != std::errc() || last != end || shard.of < 1 || shard.of > kMostShards || shard.number < 1 ||
      shard.number > shard.of)
    throw base::UsageError(
        fmt::format("--shard {}: give number and count, as 2/8: the second of eight, counted from 1", text));
  return shard;
}

void RegionShards::write(const RegionFolder& region) const {
  Json j = {{"run", number}, {"shards", shards}, {"before", before ? Json(*before) : Json()}};
  j["planned"] = now_utc();
  j["state"] = state.json();
  j["told"] = told;
  j["areas"] = Json::object();
  for (const PlannedArea& area : areas)
    j["areas"][text_of(area.id)] = {{"shard", area.shard},
                                    {"buildings", area.objects},
                                    {"in_part", area.in_part},
                                    {"made_from", area.key},
                                    {"cpu_seconds", std::nearbyint(area.cpu_seconds * 1000) / 1000}};
  write_whole(plan_file(region), dumped(j, 1));
}

RegionShards RegionShards::read(const RegionFolder& region) {
  if (!is_planned(region))
    throw base::UsageError(
        fmt::format("{} has no plan to work on: blockrand region plan {} --shards N", region.path(), region.path()));
  const Json j = read_json(plan_file(region));
  RegionShards plan;
  try {
    plan.number = j.at("run").get<int>(), plan.shards = j.at("shards").get<int>();
    if (!j.at("before").is_null()) plan.before = j.at("before").get<int>();
    plan.state = DataState::of(j.at("state"));
    plan.told = j.at("told");
    for (const auto& [name, area] : j.at("areas").items()) {
      PlannedArea& planned = plan.areas.emplace_back();
      planned.id = parse_tile(name, "areas", kLowestArea);
      planned.shard = area.at("shard").get<int>(), planned.objects = area.at("buildings").get<std::uint64_t>();
      planned.in_part = area.at("in_part").get<bool>(), planned.key = area.at("made_from").get<std::string>();
      planned.cpu_seconds = area.at("cpu_seconds").get<double>();
    }
  } catch (const std::exception&) {
    throw base::InputError(plan_file(region), "", "is damaged", "Give the plan up and make a new one: " + drop(region));
  }
  return plan;
}

void RegionShards::note(const UpdateSummary& s) {
  told = {{"why", s.why},         {"created", s.created}, {"modified", s.modified},
          {"deleted", s.deleted}, {"known", s.known},     {"outside", s.outside}};
}

void RegionShards::restore(UpdateSummary& s) const {
  s.number = number, s.sequence = state.sequence;
  s.why = told.value("why", std::vector<std::string>());
  s.created = told.value("created", std::uint64_t{0}), s.modified = told.value("modified", std::uint64_t{0});
  s.deleted = told.value("deleted", std::uint64_t{0}), s.known = told.value("known", std::uint64_t{0});
  s.outside = told.value("outside", std::uint64_t{0});
}

void RegionShards::check_same(const RegionFolder& region, const std::string& settings) const {
  if (settings != state.settings)
    throw base::UsageError(fmt::format(
        "region.toml, rules, rasters or the program are not those of the plan of run {}. Give it up, and plan anew: {}",
        number, drop(region)));
  if (region.current() != before)
    throw base::UsageError(fmt::format("another build is published than when run {} was planned. Give the plan up: {}",
                                       number, drop(region)));
}

void RegionShards::check_shard(const Shard& shard) const {
  if (shard.of != shards)
    throw base::UsageError(
        fmt::format("--shard {}/{}: the plan of run {} has {} shards", shard.number, shard.of, number, shards));
}

void RegionShards::check_done(const RegionFolder& region) const {
  const SharedAreas work = shared(region);
  std::set<int> lacking;
  std::size_t missing = 0;
  for (const PlannedArea& area : areas)
    if (!work.is_done(area.id, area.key)) ++missing, lacking.insert(area.shard);
  if (missing == 0) return;
  std::string names;
  for (const int shard : lacking) names += fmt::format("{}{}/{}", names.empty() ? "" : ", ", shard, shards);
  throw base::UsageError(fmt::format("run {} is not done: {} of {} areas are missing. Work on these shards: {}", number,
                                     missing, areas.size(), names));
}

bool RegionShards::tell_unended(const RegionFolder& region, base::Progress& progress) const {
  const std::vector<std::string> names = shared(region).unended();
  for (const std::string& name : names)
    progress.warn(fmt::format("process {} did not end, or works still: all kept work is checked", name));
  return !names.empty();
}

std::optional<PlanStatus> plan_status(const RegionFolder& region) {
  if (!is_planned(region)) return std::nullopt;
  const RegionShards plan = RegionShards::read(region);
  const SharedAreas work = plan.shared(region);
  PlanStatus status{plan.number, plan.shards, plan.areas.size(), 0};
  for (const PlannedArea& area : plan.areas)
    if (work.is_done(area.id, area.key)) ++status.done;
  return status;
}

void refuse_while_planned(const RegionFolder& region) {
  if (!is_planned(region)) return;
  throw base::UsageError(
      fmt::format("a plan for {} is under way, and nothing else is built meanwhile. Work on its shards, then: "
                  "blockrand region finish {}. Or give it up: {}",
                  region.path(), region.path(), drop(region)));
}

bool remove_broken_plan(const RegionFolder& region) {
  std::error_code error;
  if (is_planned(region) || !fs::exists(region.plan(), error)) return false;
  fs::remove_all(region.plan(), error);
  return true;
}

void remove_plan(const RegionFolder& region) {
  std::error_code error;
  fs::remove(plan_file(region), error);  // first: without it there is no plan
  fs::remove_all(region.plan(), error);
}

int drop_region_plan(const std::string& folder, bool break_lock, base::Progress& progress) {
  const RegionFolder region(folder);
  if (!region.exists()) throw base::UsageError(folder + " is no region.");
  const RegionLock lock(region, break_lock, progress);
  const Json j = read_json(plan_file(region));  // a damaged one is given up, too
  if (!is_planned(region)) throw base::UsageError(folder + " has no plan to give up.");
  const int number = j.value("run", 0);
  remove_plan(region);
  region.remove_unfinished();
  return number;
}

}  // namespace blockrand::run
