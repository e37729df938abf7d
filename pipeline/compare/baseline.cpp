// --baseline: is this comparison worse than an earlier one?
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "pipeline/base/error.h"
#include "pipeline/base/markup.h"
#include "pipeline/base/portable_math.h"
#include "pipeline/base/text.h"
#include "pipeline/compare/comparison_report.h"
#include "pipeline/compare/report_numbers.h"
#include "pipeline/compare/summary.h"

namespace blockrand::compare {
namespace {

using Json = nlohmann::json;

constexpr std::string_view kRemedy = "Give the compare.json that `blockrand compare` of this version wrote";

/// What a measure's values are rounded to: a change within it is none.
double rounding(const MeasureInfo& measure) {
  return measure.unit == "m" ? 1e-3 : measure.unit == "deg" ? 1e-2 : measure.unit == "m²" ? 0.1 : 1e-6;
}

/// Values of headline().
BaselineResult::Line judge(const MeasureInfo& measure, double before, double after, double allowed) {
  BaselineResult::Line line{std::string(measure.id), before, after, 0, false};
  const double step = rounding(measure);
  switch (measure.better) {
    case Better::higher:
      line.worse_by = (before - after) / std::max(before, step);
      line.fails = line.worse_by > allowed && before - after > step;
      break;
    case Better::lower:
    case Better::zero:
      line.worse_by = (after - before) / std::max(before, step);
      line.fails = line.worse_by > allowed && after - before > step;
      break;
    case Better::one:
      line.worse_by = base::log(after) - base::log(before);
      line.fails = line.worse_by > allowed && std::abs(after - before) > step;
      break;
    case Better::none:
      break;
  }
  return line;
}

/// For how much a measure has a value.
struct Reach {
  std::size_t matches = 0, buildings = 0;  // of the reference
  void add(std::size_t buildings_of_match) {
    ++matches;
    buildings += buildings_of_match;
  }
};

Reach reach_of(const Comparison& comparison, std::size_t measure) {
  Reach reach;
  for (const MatchResult& match : comparison.matches)
    if (match.values[measure].counted) reach.add(match.reference.buildings.size());
  return reach;
}

/// Whether a measure lost values. Joining two matches leaves it fewer matches with a value, and dividing one fewer
/// buildings, where one half has nothing to measure; both fall only where something is gone.
bool fell(const Reach& before, const Reach& after, double allowed) {
  const auto less = [&](std::size_t was, std::size_t is) {
    return static_cast<double>(is) < (1 - allowed) * static_cast<double>(was) - 1e-9;
  };
  return less(before.matches, after.matches) && less(before.buildings, after.buildings);
}

/// Reads what is needed of a compare.json and says where it is none.
class Baseline {
 public:
  Baseline(const std::string& text, const std::string& path) : path_(path) {
    try {
      json_ = Json::parse(text);
    } catch (const Json::parse_error& error) {
      fail("byte " + std::to_string(error.byte), "is no JSON");
    } catch (const Json::exception& error) {
      fail("", std::string("cannot be read: ") + error.what());  // numbers beyond what a double holds
    }
    if (!json_.is_object()) fail("", "is no comparison: a JSON object is expected");
    const auto format = json_.find("format");
    if (format == json_.end() || !format->is_string() || format->get_ref<const std::string&>() != kJsonFormat)
      fail("format", "is no comparison: \"" + std::string(kJsonFormat) + "\" is expected");
    const auto version = json_.find("format_version");
    if (version == json_.end() || !version->is_number_integer()) fail("format_version", "has no number of its format");
    if (version->get<std::int64_t>() != kJsonFormatVersion)
      fail("format_version", fmt::format("has format version {}, and this program reads {}",
                                         version->get<std::int64_t>(), kJsonFormatVersion));
    if (!member(json_, "summary").is_object()) fail("summary", "has no summary of its measures");
    if (!member(json_, "matches").is_array()) fail("matches", "has no list of its matches");
  }

  /// What headline() was; nothing where the measure had no value or did not exist.
  std::optional<double> headline(const MeasureInfo& measure) const {
    const std::string place = "summary/" + std::string(measure.id);
    const Json& summary = member(json_, "summary");
    const Json& entry = member(summary, std::string(measure.id));
    if (entry.is_null()) return std::nullopt;
    if (measure.better == Better::one) {
      std::vector<double> ratios;
      for (const Json& match : member(json_, "matches"))
        if (const std::optional<double> ratio = value_in(match, measure)) ratios.push_back(*ratio);
      return ratios.empty() ? std::nullopt : finite(mean_factor(ratios));
    }
    const Json& counted = member(entry, "counted");
    const Json& value = member(counted, measure.better == Better::zero ? "mean_abs" : "pooled");
    if (value.is_null()) {
      if (!member(counted, "count").is_number_unsigned()) fail(place + "/counted", "is no summary of a measure");
      return std::nullopt;
    }
    if (!value.is_number()) fail(place, "has no number where a value is expected");
    return value.get<double>();
  }

  /// Ids of the reference's buildings that had a match.
  std::vector<std::string> matched_buildings() const {
    std::vector<std::string> ids;
    const Json& matches = member(json_, "matches");
    for (std::size_t i = 0; i < matches.size(); ++i) {
      const Json& buildings = buildings_of(matches[i]);
      if (!buildings.is_array()) fail("matches/" + std::to_string(i), "has a match without buildings");
      for (const Json& id : buildings) {
        if (!id.is_string()) fail("matches/" + std::to_string(i), "has a building without an id");
        ids.push_back(id.get<std::string>());
      }
    }
    return ids;
  }

  Reach reach(const MeasureInfo& measure) const {
    Reach reach;
    for (const Json& match : member(json_, "matches"))
      if (value_in(match, measure)) reach.add(buildings_of(match).size());
    return reach;
  }

  std::optional<double> count(const std::string& key) const {
    const Json& value = member(member(json_, "counts"), key);
    return value.is_number() ? std::optional(value.get<double>()) : std::nullopt;
  }

  /// A text, or nothing.
  std::string text(const std::string& key) const { return text_of(member(json_, key)); }

  std::map<std::string, std::string> options() const {
    std::map<std::string, std::string> out;
    const Json& options = member(json_, "options");
    if (options.is_object())
      for (auto item = options.begin(); item != options.end(); ++item) out[item.key()] = text_of(*item);
    return out;
  }

 private:
  static std::string text_of(const Json& value) { return value.is_string() ? value.get<std::string>() : std::string(); }
  static const Json& buildings_of(const Json& match) { return member(member(match, "reference"), "buildings"); }
  static std::optional<double> value_in(const Json& match, const MeasureInfo& measure) {
    const Json& value = member(member(member(match, "measures"), std::string(measure.id)), "counted");
    return value.is_number() ? std::optional(value.get<double>()) : std::nullopt;
  }
  static const Json& member(const Json& of, const std::string& key) {
    static const Json kNull;
    if (!of.is_object()) return kNull;
    const auto found = of.find(key);
    return found == of.end() ? kNull : *found;
  }
  [[noreturn]] void fail(const std::string& place, const std::string& what) const {
    throw base::InputError(path_, place, what, std::string(kRemedy));
  }

  std::string path_;
  Json json_;
};

/// What is compared otherwise than in the baseline.
std::vector<std::string> differences(const Baseline& baseline, const Comparison& c, const OptionList& options) {
  std::vector<std::string> out;
  const auto tell = [&](std::string_view what, const std::string& before, std::string_view now) {
    const auto shown = [](std::string_view v) { return v.empty() ? std::string_view("not set") : v; };
    if (before != now) out.push_back(fmt::format("{} was {} and is {}", what, shown(before), shown(now)));
  };
  if (c.matches.empty() && c.model.files.empty()) return out;  // nothing was compared yet
  tell("CRS", baseline.text("crs"), c.reference.crs.empty() ? c.model.crs : c.reference.crs);
  tell("heights", baseline.text("heights"), heights_key(c));
  if (options.empty()) return out;
  std::map<std::string, std::string> before = baseline.options();
  for (const auto& [key, value] : options) {
    tell("option " + key, before[key], value);
    before.erase(key);
  }
  for (const auto& [key, value] : before) tell("option " + key, value, "");
  return out;
}

/// As compare.json has it, so that an id with a broken character is found again.
std::string as_stored(const std::string& id) { return Json::parse(base::json_quoted(id)).get<std::string>(); }

void append_list(std::string& out, std::string_view what, const std::vector<std::string>& items) {
  constexpr std::size_t kListed = 20;
  for (std::size_t i = 0; i < std::min(kListed, items.size()); ++i) {
    std::string clean;
    base::append_clean(clean, items[i]);
    std::replace(clean.begin(), clean.end(), '\n', ' ');
    (out += what).append(clean) += '\n';
  }
  if (items.size() > kListed) out += fmt::format("{}{} more\n", what, items.size() - kListed);
}

}  // namespace

bool BaselineResult::worse() const {
  return !lost.empty() || !lost_buildings.empty() ||
         std::any_of(lines.begin(), lines.end(), [](const Line& line) { return line.fails; });
}

BaselineResult compare_with_baseline(const Comparison& comparison, const std::string& baseline_json,
                                     const std::string& baseline_path, double allowed, const OptionList& options) {
  const Baseline baseline(baseline_json, baseline_path);
  BaselineResult verdict;
  for (std::size_t m = 0; m < kMeasureCount; ++m) {
    const MeasureInfo& measure = kMeasures[m];
    if (measure.better == Better::none) continue;
    const std::optional<double> before = baseline.headline(measure);
    const std::optional<double> after = headline(measure, comparison.summaries[m].counted);
    if (before && after)
      verdict.lines.push_back(judge(measure, *before, *after, allowed));
    else if (before)
      verdict.lost.push_back("measure " + std::string(measure.id));
    if (!before || !after) continue;
    const Reach had = baseline.reach(measure), has = reach_of(comparison, m);
    if (fell(had, has, allowed))
      verdict.lost.push_back(
          fmt::format("measure {} (in {} matches, was in {})", measure.id, has.matches, had.matches));
  }
  for (const auto& [id, area] : {std::pair("missing_area", footprint_area(comparison.reference, comparison.missing)),
                                 std::pair("extra_area", footprint_area(comparison.model, comparison.extra))}) {
    const MeasureInfo measure{.id = id,
                              .unit = "m²",
                              .better = Better::lower,
                              .pool = Pool::sum,
                              .scope = Scope::plan,
                              .title = "",
                              .text = ""};
    if (const auto before = baseline.count(id))
      verdict.lines.push_back(judge(measure, *before, finite(area).value_or(0), allowed));
  }
  std::multiset<std::string> matched;
  for (const MatchResult& match : comparison.matches)
    for (const std::uint32_t b : match.reference.buildings)
      matched.insert(as_stored(comparison.reference.buildings[b].id));
  for (const std::string& id : baseline.matched_buildings()) {
    const auto found = matched.find(id);
    if (found == matched.end())
      verdict.lost_buildings.push_back(id);
    else
      matched.erase(found);
  }
  verdict.differs = differences(baseline, comparison, options);
  return verdict;
}

std::string failed_text(const BaselineResult& verdict) {
  std::vector<std::string> parts;
  for (const BaselineResult::Line& line : verdict.lines)
    if (line.fails) parts.push_back(line.measure);
  for (const std::string& lost : verdict.lost) parts.push_back("lost " + lost);
  if (const std::size_t n = verdict.lost_buildings.size(); n > 0)
    parts.push_back(fmt::format("{} {} lost", n, n == 1 ? "building" : "buildings"));
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::string baseline_text(const BaselineResult& verdict) {
  std::string out = fmt::format("{:<26}{:>12}{:>12}{:>11}\n", "against the baseline", "before", "now", "worse by");
  for (const BaselineResult::Line& line : verdict.lines) {
    if (line.worse_by == 0) continue;
    const std::string by = std::abs(line.worse_by) >= 10 ? fmt::format("{:>+.0f} x", line.worse_by)
                                                         : fmt::format("{:>+.1f} %", line.worse_by * 100);
    out += fmt::format("{:<26}{:>12.4f}{:>12.4f}{:>11}{}\n", line.measure, line.before, line.after, by,
                       line.fails ? "  WORSE" : "");
  }
  const auto same = std::count_if(verdict.lines.begin(), verdict.lines.end(),
                                  [](const BaselineResult::Line& line) { return line.worse_by == 0; });
  if (same > 0) out += fmt::format("{} of {} measures as before\n", same, verdict.lines.size());
  append_list(out, "LOST: ", verdict.lost);
  append_list(out, "LOST: building ", verdict.lost_buildings);
  append_list(out, "warning: ", verdict.differs);
  out += verdict.worse() ? "worse than the baseline\n" : "not worse than the baseline\n";
  return out;
}

}  // namespace blockrand::compare
