#include "pipeline/outputs/imagery/imagery_output.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace blockrand::outputs {
namespace {

using Json = nlohmann::ordered_json;

double rounded(double value, double steps) { return std::round(value * steps) / steps + 0.0; }
Json metres(model::Point2 p) { return {rounded(p.x, 1000), rounded(p.y, 1000)}; }

Json image_json(const observation::ImageReceipt& image) {
  const importers::imagery::ImageDescription& d = image.description;
  const observation::ImageFit& fit = image.fit;
  Json j;
  j["path"] = d.source.path;
  if (!d.source.date.empty()) j["date"] = d.source.date;
  if (!d.source.licence.empty()) j["licence"] = d.source.licence;
  if (!d.source.attribution.empty()) j["attribution"] = d.source.attribution;
  j["crs"] = d.crs_code.empty() ? d.crs_name : d.crs_code;
  j["pixel_m"] = rounded(d.pixel_m, 1000);
  j["state"] = observation::name(fit.state);
  j["why"] = fit.why;
  j["outlines"] = fit.outlines;
  j["shift_m"] = metres(fit.shift);
  j["score"] = rounded(fit.score, 100);
  j["margin"] = rounded(fit.margin, 100);
  j["leans"] = image.leans;
  j["flight_height_m"] = rounded(image.flight_height, 1);
  j["lean_support"] = rounded(image.support, 1000);
  return j;
}

Json building_json(const std::string& id, const observation::OutlineReceipt& r) {
  Json j;
  j["id"] = id;
  j["state"] = observation::name(r.state);
  if (!r.reason.empty()) j["reason"] = r.reason;
  if (r.image != observation::OutlineReceipt::kNoImage) {
    j["image"] = r.image;
    j["row"] = r.row;
    j["shift_m"] = metres(r.shift);
    j["rotation_deg"] = rounded(r.turn, 100);
    j["centre"] = metres(r.centre);
    j["evidence_before"] = rounded(r.before, 10000);
    j["evidence_after"] = rounded(r.after, 10000);
    j["gain"] = rounded(r.after - r.before, 10000);
    j["confidence"] = rounded(r.confidence, 1000);
    j["lean_m"] = metres(r.lean);
    j["eaves_m"] = rounded(r.eaves, 10);
    j["score_mean"] = rounded(r.mean, 10000);
    j["score_deviation"] = rounded(r.deviation, 10000);
    j["score_elsewhere"] = rounded(r.second, 10000);
    j["walls_m"] = rounded(r.weight, 10);
  }
  return j;
}

class ImageryOutput : public Output {
 public:
  explicit ImageryOutput(const OutputContext& context) : context_(context) {}

  std::any write_tile(FinishedTile&) const override { return {}; }
  void finish(const FinishedBuild& build) override {
    const observation::ImageryObservations& seen = *context_.imagery;
    Json j;
    j["images"] = Json::array();
    for (const observation::ImageReceipt& image : seen.images) j["images"].push_back(image_json(image));
    j["buildings"] = Json::array();
    for (std::uint32_t b = 0; b < seen.outlines.size(); ++b)
      j["buildings"].push_back(building_json(context_.repaired.footprints[b].id.text(), seen.outlines[b]));
    build.files.push_back(context_.folder.write("imagery.json", j.dump(1) + "\n"));
  }

 private:
  const OutputContext& context_;
};

}  // namespace

OutputFormat imagery_output() {
  return {.name = "imagery.json",
          .in_formats = false,
          .places = {{"imagery.json", "what the aerial images show: whether they fit, a receipt for every building"}},
          .manual = {{"imagery.json", "with --imagery: whether each image fits, and a receipt for every building"}},
          .asked = [](const OutputOptions& o) { return o.imagery; },
          .bytes_per_building = [](const OutputOptions&, std::size_t) { return 500.0; },
          .open = [](const OutputContext& c) -> std::unique_ptr<Output> { return std::make_unique<ImageryOutput>(c); }};
}

}  // namespace blockrand::outputs
