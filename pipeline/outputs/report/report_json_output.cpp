#include "pipeline/outputs/report/report_json_output.h"

#include <map>
#include <nlohmann/json.hpp>

namespace blockrand::outputs {
namespace {

using Json = nlohmann::ordered_json;

/// Sorted by object; and what codes mean.
std::string report_json(const model::Extract& extract, const std::vector<model::ReportRow>& rows,
                        const std::string& attribution) {
  // Details that the importer noted about objects that end as reported stand with the object.
  std::map<std::pair<model::OsmId, model::IssueCode>, std::string> details;
  Json fallbacks = Json::array(), notices = Json::array();
  for (const model::ReportRow& row : rows) {
    const auto& about = info(row.code);
    if (about.issue_class == model::IssueClass::reported) {
      details.emplace(std::pair(row.object, row.code), row.detail);
      continue;
    }
    Json entry = {{"id", row.object.text()}, {"code", about.text}};
    if (!row.detail.empty()) entry["detail"] = row.detail;
    (about.issue_class == model::IssueClass::fallback ? fallbacks : notices).push_back(std::move(entry));
  }
  Json objects = Json::array();
  for (const model::MappedBuilding& b : extract.buildings) {
    if (b.state == model::ObjectState::modelled) continue;
    Json entry = {{"id", b.id.text()},
                  {"kind", b.kind == model::ObjectKind::building ? "building" : "building_part"},
                  {"state", model::name(b.state)}};
    if (b.state == model::ObjectState::reported) {
      entry["code"] = info(b.code).text;
      if (const auto found = details.find({b.id, b.code}); found != details.end() && !found->second.empty())
        entry["detail"] = found->second;
    } else {
      entry["related"] = b.related.text();
    }
    objects.push_back(std::move(entry));
  }
  Json codes = Json::object();
  for (int i = 1; i < model::kIssueCodeCount; ++i)
    codes[std::string(model::kIssueInfo[i].text)] = model::kIssueInfo[i].meaning;
  Json j;
  j["attribution"] = attribution;
  j["objects"] = std::move(objects);
  j["fallbacks"] = std::move(fallbacks);
  j["notices"] = std::move(notices);
  j["codes"] = std::move(codes);
  return j.dump(1) + "\n";
}

class ReportJsonOutput : public OutputOf<std::monostate> {
 public:
  explicit ReportJsonOutput(const OutputContext& context) : context_(context) {}

  std::any write_tile(FinishedTile&) const override { return std::monostate(); }
  void finish(const FinishedBuild& build) override {
    build.files.push_back(
        context_.folder.write("report.json", report_json(context_.extract, build.rows, attribution(context_))));
  }

 private:
  const OutputContext& context_;
};

}  // namespace

OutputFormat report_json_output() {
  return {
      .name = "report.json",
      .in_formats = false,
      .places = {{"report.json", "every object that is not modelled as asked, with its reason"}},
      .manual = {{"report.json", "every object that was not modelled, and why; every fallback"}},
      .asked = [](const OutputOptions&) { return true; },
      .size = [](const OutputOptions&, std::size_t) { return OutputSize{.once = 30'000, .per_building = 40}; },
      .open = [](const OutputContext& c) -> std::unique_ptr<Output> { return std::make_unique<ReportJsonOutput>(c); }};
}

}  // namespace blockrand::outputs
