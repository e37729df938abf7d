// --baseline: is this comparison worse than an earlier one?
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "pipeline/base/error.h"
#include "pipeline/base/markup.h"
#include "pipeline/base/portable_math.h"
#include "pipeline/base/text.h"
#include "pipeline/compare/report.h"
#include "pipeline/compare/report_numbers.h"

namespace blockrand::compare {
namespace {

using Json = nlohmann::json;

constexpr std::string_view kRemedy = "Give the compare.json that `blockrand compare` of this version wrote";

/// What a measure's values are rounded to: a change within it is none.
double rounding(const MeasureInfo& measure) { return measure.unit == "m" ? 1e-3 : measure.unit == "deg" ? 1e-2 : 1e-6; }

/// Distance of a ratio from 1, alike for twice and half. A ratio of nothing is as far as one in a million.
double away_from_one(double ratio) { return std::abs(base::log(std::max(ratio, 1e-6))); }

BaselineVerdict::Line judge(const MeasureInfo& measure, double before, double after, double allowed) {
  BaselineVerdict::Line line{std::string(measure.id), before, after, 0, false};
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
      line.worse_by = away_from_one(after) - away_from_one(before);
      line.fails = line.worse_by > allowed && std::abs(after - before) > step;
      break;
    case Better::none:
      break;
  }
  return line;
}

/// Reads what is needed of a compare.json and says where it is none.
class Baseline {
 public:
  Baseline(const std::string& text, const std::string& path) : path_(path) {
    try {
      json_ = Json::parse(text);
    } catch (const Json::parse_error& error) {
      fail("byte " + std::to_string(error.byte), "is no JSON");
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
    const Json& counted = member(entry, "counted");
    const Json& value = member(counted, measure.better == Better::zero ? "mean_abs" : "pooled");
    if (value.is_null()) {
      if (!member(counted, "count").is_number_unsigned()) fail(place + "/counted", "is no summary of a measure");
      return std::nullopt;
    }
    if (!value.is_number()) fail(place, "has no number where a value is expected");
    return value.get<double>();
  }

  std::vector<std::string> match_ids() const {
    std::vector<std::string> ids;
    const Json& matches = member(json_, "matches");
    for (std::size_t i = 0; i < matches.size(); ++i) {
      const Json& id = member(matches[i], "id");
      if (!id.is_string()) fail("matches/" + std::to_string(i), "has a match without an id");
      ids.push_back(id.get<std::string>());
    }
    return ids;
  }

 private:
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

/// As compare.json has it, so that an id with a broken character is found again.
std::string as_stored(const std::string& id) { return Json::parse(base::json_quoted(id)).get<std::string>(); }

}  // namespace

bool BaselineVerdict::worse() const {
  return !lost.empty() || std::any_of(lines.begin(), lines.end(), [](const Line& line) { return line.fails; });
}

BaselineVerdict compare_with_baseline(const Comparison& comparison, const std::string& baseline_json,
                                      const std::string& baseline_path, double allowed) {
  const Baseline baseline(baseline_json, baseline_path);
  BaselineVerdict verdict;
  for (std::size_t m = 0; m < kMeasureCount; ++m) {
    const MeasureInfo& measure = kMeasures[m];
    if (measure.better == Better::none) continue;
    const std::optional<double> before = baseline.headline(measure);
    const std::optional<double> after = headline(measure, comparison.summaries[m].counted);
    if (before && after)
      verdict.lines.push_back(judge(measure, *before, *after, allowed));
    else if (before)
      verdict.lost.push_back("measure " + std::string(measure.id));
  }
  std::set<std::string> present;
  for (const MatchResult& match : comparison.matches) present.insert(as_stored(match.id));
  for (const std::string& id : baseline.match_ids())
    if (!present.contains(id)) verdict.lost.push_back("match " + id);
  return verdict;
}

std::string verdict_text(const BaselineVerdict& verdict) {
  std::string out = fmt::format("{:<26}{:>12}{:>12}{:>11}\n", "against the baseline", "before", "now", "worse by");
  for (const BaselineVerdict::Line& line : verdict.lines) {
    if (line.worse_by == 0) continue;
    const std::string by = std::abs(line.worse_by) >= 10 ? fmt::format("{:>+.0f} x", line.worse_by)
                                                         : fmt::format("{:>+.1f} %", line.worse_by * 100);
    out += fmt::format("{:<26}{:>12.4f}{:>12.4f}{:>11}{}\n", line.measure, line.before, line.after, by,
                       line.fails ? "  WORSE" : "");
  }
  const auto same = std::count_if(verdict.lines.begin(), verdict.lines.end(),
                                  [](const BaselineVerdict::Line& line) { return line.worse_by == 0; });
  if (same > 0) out += fmt::format("{} of {} measures as before\n", same, verdict.lines.size());
  constexpr std::size_t kListed = 20;
  for (std::size_t i = 0; i < std::min(kListed, verdict.lost.size()); ++i) {
    std::string clean;
    base::append_clean(clean, verdict.lost[i]);
    std::replace(clean.begin(), clean.end(), '\n', ' ');
    out += "LOST: " + clean + "\n";
  }
  if (verdict.lost.size() > kListed) out += fmt::format("LOST: {} more\n", verdict.lost.size() - kListed);
  out += verdict.worse() ? "worse than the baseline\n" : "not worse than the baseline\n";
  return out;
}

}  // namespace blockrand::compare
