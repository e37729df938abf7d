#include <fmt/format.h>

#include <algorithm>

#include "pipeline/base/text.h"
#include "pipeline/validate/checked_json.h"
#include "pipeline/validate/validate_build.h"

namespace blockrand::validate {
namespace {

constexpr std::size_t kShown = 20;  // findings of one code in the text

std::string number_of(std::uint64_t count, const char* one, const char* many) {
  return fmt::format("{} {}", base::with_thousands(count), count == 1 ? one : many);
}

std::string validity(const Validation& v) {
  if (v.sound()) return "sound: nothing found";
  std::size_t codes = 0;
  for (int c = 0; c < kCheckCount; ++c) codes += v.findings.count(static_cast<Check>(c)) > 0;
  return fmt::format("NOT SOUND: {} of {}", number_of(v.findings.count(), "finding", "findings"),
                     number_of(codes, "kind", "kinds"));
}

}  // namespace

std::string validation_text(const ValidateOptions& options, const Validation& v) {
  std::string out = fmt::format("{}\n\nchecked\n", options.folder);
  for (const Checked& c : v.checked)
    out += fmt::format("  {:<13} {:>11} {:<24} {}\n", c.what, base::with_thousands(c.count), c.unit, c.how);
  if (v.positions > 0)
    out += fmt::format(
        "\nlargest distance of a corner from OpenStreetMap: {:.2f} mm in GLB, {:.2f} mm in CityGML and CityJSON\n",
        v.worst_glb * 1e3, v.worst_crs * 1e3);
  if (v.positions_moved > 0)
    out += fmt::format("where repair moved corners: {:.2f} m; all together: {:.1f} mm\n", v.worst_moved,
                       v.worst_median * 1e3);
  for (const std::string& note : v.notes) out += fmt::format("\nnote: {}\n", note);
  for (int c = 0; c < kCheckCount; ++c) {
    const auto check = static_cast<Check>(c);
    const std::uint64_t count = v.findings.count(check);
    if (count == 0) continue;
    out += fmt::format("\n{}: {} ({})\n", info(check).text, info(check).meaning, base::with_thousands(count));
    std::size_t shown = 0;
    for (const Finding& f : v.findings.kept()) {
      if (f.check != check || shown == kShown) continue;
      ++shown;
      out += fmt::format("  {}{}{}: {}\n", f.file, f.object.empty() ? "" : " ", f.object, f.detail);
    }
    if (count > shown) out += fmt::format("  … and {} more\n", base::with_thousands(count - shown));
  }
  return out + fmt::format("\n{}\n", validity(v));
}

std::string validation_json(const ValidateOptions& options, const Validation& v) {
  using Ordered = nlohmann::ordered_json;
  Ordered j;
  j["build"] = options.folder;
  j["sound"] = v.sound();
  j["checked"] = Ordered::array();
  for (const Checked& c : v.checked)
    j["checked"].push_back({{"what", c.what}, {"how", c.how}, {"count", c.count}, {"unit", c.unit}});
  j["notes"] = v.notes;
  if (v.positions > 0)
    j["positions"] = {{"source", v.position_source},        {"corners", v.positions},
                      {"worst_glb_m", v.worst_glb},         {"worst_crs_m", v.worst_crs},
                      {"corners_moved", v.positions_moved}, {"worst_moved_m", v.worst_moved},
                      {"median_m", v.worst_median}};
  j["counts"] = Ordered::object();
  for (int c = 0; c < kCheckCount; ++c)
    if (const std::uint64_t count = v.findings.count(static_cast<Check>(c)); count > 0)
      j["counts"][std::string(kChecks[c].text)] = count;
  j["findings"] = Ordered::array();
  for (const Finding& f : v.findings.kept()) {
    Ordered row = {{"code", info(f.check).text}, {"file", f.file}, {"object", f.object}, {"detail", f.detail}};
    if (f.number > 0) row["number"] = f.number;
    j["findings"].push_back(std::move(row));
  }
  return j.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace blockrand::validate
