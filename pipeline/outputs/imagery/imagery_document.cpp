#include "pipeline/outputs/imagery/imagery_document.h"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "pipeline/outputs/output.h"

namespace blockrand::outputs {
namespace {

using Json = nlohmann::ordered_json;
using observation::OutlineReceipt;

double rounded(double value, double steps) { return std::round(value * steps) / steps + 0.0; }
Json metres(model::Point2 p) { return {rounded(p.x, 1000), rounded(p.y, 1000)}; }
model::Point2 point(const nlohmann::json& j) { return {j.at(0).get<double>(), j.at(1).get<double>()}; }

Json image_json(const observation::ImageReceipt& image) {
  const importers::imagery::ImageDescription& d = image.description;
  const observation::ImageFit& fit = image.fit;
  Json j;
  j["path"] = d.source.path;
  if (!d.source.date.empty()) j["date"] = d.source.date;
  if (!d.source.licence.empty()) j["licence"] = d.source.licence;
  if (!d.source.attribution.empty()) j["attribution"] = d.source.attribution;
  j["crs"] = d.crs_code.empty() ? d.crs_name : d.crs_code;
  j["operation"] = d.operation;
  j["accuracy_m"] = d.accuracy_m;
  j["pixel_m"] = rounded(d.pixel_m, 1000);
  j["speaks_of"] = image.buildings;
  j["state"] = observation::name(fit.state);
  j["why"] = fit.why;
  j["outlines"] = fit.outlines;
  j["shift_m"] = metres(fit.shift);
  j["score"] = rounded(fit.score, 100);
  j["margin"] = rounded(fit.margin, 100);
  if (image.shift != model::Point2{}) j["ground_shift_m"] = metres(image.shift);
  if (image.alike != model::Point2{}) j["rows_off_alike_m"] = metres(image.alike);
  j["leans"] = image.leans;
  j["flight_height_m"] = rounded(image.flight_height, 1);
  if (image.sun_azimuth) j["sun_azimuth_deg"] = rounded(*image.sun_azimuth, 1);
  if (image.shadow_azimuth >= 0) {
    j["shadow_sun_azimuth_deg"] = rounded(image.shadow_azimuth, 1);
    j["shadow_per_metre"] = rounded(image.shadow_per_metre, 1000);
    j["shadow_houses"] = image.shadow_houses;
    j["shadow_by_tags"] = image.shadow_by_tags;
  }
  j["lean_support"] = rounded(image.support, 1000);
  j["haze"] = image.haze;
  j["clouded"] = image.clouded;
  if (image.edited_later > 0) j["buildings_edited_later"] = image.edited_later;
  return j;
}

Json rings_json(const std::vector<std::vector<model::Point2>>& rings) {
  Json all = Json::array();
  for (const auto& ring : rings) {
    Json numbers = Json::array();  // x, y, x, y ...
    for (const model::Point2 p : ring) {
      numbers.push_back(rounded(p.x, 1000));
      numbers.push_back(rounded(p.y, 1000));
    }
    all.push_back(std::move(numbers));
  }
  return all;
}

std::vector<std::vector<model::Point2>> rings_of(const nlohmann::json& j) {
  std::vector<std::vector<model::Point2>> rings;
  for (const nlohmann::json& numbers : j) {
    rings.emplace_back();
    for (std::size_t i = 0; i + 1 < numbers.size(); i += 2)
      rings.back().push_back({numbers[i].get<double>(), numbers[i + 1].get<double>()});
  }
  return rings;
}

void add_refinement(Json& j, const observation::RefinedOutline& r) {
  if (r.state == observation::RefinementState::none) return;
  Json& told = j["walls"];
  told["state"] = observation::name(r.state);
  if (!r.reason.empty()) told["reason"] = r.reason;
  if (r.walls > 0) {
    told["shifted"] = r.walls;
    told["largest_shift_m"] = rounded(r.largest, 1000);
  }
  if (!r.evidence.empty()) {
    told["evidence_before"] = rounded(r.before, 10000);
    told["evidence_after"] = rounded(r.after, 10000);
    told["confidence"] = rounded(r.confidence, 1000);
  }
  if (!r.to.empty()) {
    told["outline_before"] = rings_json(r.from);
    told["outline_after"] = rings_json(r.to);
  }
  for (const observation::WallEvidence& e : r.evidence)
    told["seen_elsewhere"].push_back({{"at", metres(e.at)},
                                      {"normal", {e.normal.x, e.normal.y}},
                                      {"shift_m", e.shift},
                                      {"before", rounded(e.here, 1000)},
                                      {"after", rounded(e.there, 1000)},
                                      {"elsewhere", rounded(e.second, 1000)},
                                      {"usual", rounded(e.usual, 1000)},
                                      {"length_m", rounded(e.length, 10)},
                                      {"rim_m", rounded(e.rim, 10)},
                                      {"lean_m", rounded(e.lean, 100)},
                                      {"side", rounded(e.side, 100)},
                                      {"others", rounded(e.others, 1000)},
                                      {"steady", rounded(e.steady, 100)},
                                      {"margin", rounded(e.margin, 1000)},
                                      {"confidence", e.confidence},
                                      {"taken", e.taken}});
}

Json building_json(const std::string& id, const OutlineReceipt& r) {
  Json j;
  j["id"] = id;
  j["state"] = observation::name(r.state);
  if (!r.reason.empty()) j["reason"] = r.reason;
  if (r.image != OutlineReceipt::kNoImage) {
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
    j["height_doubt_m"] = rounded(r.height_doubt, 100);
    if (r.gone > 0) j["perhaps_gone"] = rounded(r.gone, 100);
    add_refinement(j, r.refined);
  }
  return j;
}

void add_roof(Json& j, const observation::RoofView& roof) {
  if (roof.pixels == 0) return;
  if (roof.colour) {
    j["roof_colour"] = model::text(*roof.colour);
    j["roof_colour_confidence"] = rounded(roof.colour_confidence, 100);
  }
  if (roof.form != observation::RoofForm::unknown) {
    j["roof_form"] = observation::name(roof.form);
    j["roof_form_confidence"] = rounded(roof.form_confidence, 100);
  }
  if (roof.ridge) {
    j["ridge_azimuth_deg"] = rounded(*roof.ridge, 10);
    j["ridge_confidence"] = rounded(roof.ridge_confidence, 100);
  }
  Json& evidence = j["roof_evidence"];
  evidence = {{"image", roof.image},
              {"pixels", roof.pixels},
              {"long_m", rounded(roof.long_side, 10)},
              {"short_m", rounded(roof.short_side, 10)},
              {"spread", rounded(roof.spread, 1000)},
              {"green", rounded(roof.green, 100)}};
  const observation::EdgeStrips& e = roof.strips;
  evidence["strips"] = {rounded(e.count, 1), rounded(e.b, 1),    rounded(e.bb, 1),   rounded(e.nx, 10),
                        rounded(e.ny, 10),   rounded(e.bnx, 10), rounded(e.bny, 10), rounded(e.nxx, 10),
                        rounded(e.nxy, 10),  rounded(e.nyy, 10)};
  for (const observation::RidgeEvidence& r : roof.ridges)
    evidence["lines"].push_back({rounded(r.angle, 10), rounded(r.contrast, 1000), rounded(r.consistency, 100),
                                 rounded(r.line, 1000), rounded(r.offset, 100), rounded(r.length, 10),
                                 rounded(r.wide, 1000), rounded(r.within, 1000), rounded(r.halves, 1000)});
  for (const observation::CourtyardView& c : roof.courtyards) {
    const observation::CourtyardEvidence& seen = c.evidence;
    Json courtyard = {{"area_m2", rounded(c.area, 10)},
                      {"courtyard", observation::name(c.state)},
                      {"built_over", rounded(c.built_over, 100)}};
    for (const double value : {seen.alike, seen.level, seen.dark, seen.green, seen.edge, seen.around})
      courtyard["evidence"].push_back(rounded(value, 1000));
    j["courtyards"].push_back(std::move(courtyard));
  }
}

void add_height(Json& j, const observation::SeenHeight& seen) {
  if (seen.image == observation::SeenHeight::kNoImage) return;
  j["height_from_shadow_m"] = rounded(seen.height, 10);
  j["height_from_shadow_within_m"] = rounded(seen.uncertainty, 10);
  if (seen.confidence > 0) j["height_from_shadow_confidence"] = rounded(seen.confidence, 100);
  j["shadow"] = {{"image", seen.image},
                 {"length_m", rounded(seen.shadow.length, 100)},
                 {"step", rounded(seen.shadow.step, 1000)},
                 {"clearness", rounded(seen.shadow.clearness, 1000)},
                 {"second", rounded(seen.shadow.second, 1000)},
                 {"walls_m", rounded(seen.shadow.walls, 10)}};
}

Json unmapped_json(const observation::UnmappedBuilding& u) {
  Json j;
  j["id"] = u.id;
  j["image"] = u.image;
  j["probability"] = rounded(u.probability, 1000);
  j["area_m2"] = rounded(u.area, 10);
  j["outline_of"] = u.of_roof ? "roof" : "ground";
  j["lean_m"] = metres(u.lean);
  j["outline"] = Json::array();
  for (const model::Point2 p : u.outline) j["outline"].push_back({p.x, p.y});
  const observation::UnmappedEvidence& e = u.evidence;
  j["evidence"] = Json::array();
  for (const double value :
       {e.score, e.around, e.filled, e.elongation, e.likeness, e.green_around, e.mapped_around, e.shadow, e.brightness})
    j["evidence"].push_back(rounded(value, 1000));
  return j;
}

model::OsmId id_of(const std::string& text) {
  model::OsmId id;
  id.type = text.at(0) == 'n'   ? model::OsmType::node
            : text.at(0) == 'w' ? model::OsmType::way
                                : model::OsmType::relation;
  id.number = std::stoll(text.substr(1));
  return id;
}

/// The member of an enumeration whose name is `text`.
template <class Enum>
Enum named(const std::string& text, Enum last) {
  for (int i = 0; i <= static_cast<int>(last); ++i)
    if (name(static_cast<Enum>(i)) == text) return static_cast<Enum>(i);
  throw std::runtime_error("unknown state '" + text + "'");
}

observation::RefinedOutline refinement_of(const nlohmann::json& j) {
  observation::RefinedOutline r;
  if (!j.contains("walls")) return r;
  const nlohmann::json& told = j.at("walls");
  r.state = named(told.at("state").get<std::string>(), observation::RefinementState::refined);
  r.reason = told.value("reason", std::string());
  r.walls = told.value("shifted", 0U);
  r.largest = told.value("largest_shift_m", 0.0);
  r.before = told.value("evidence_before", 0.0);
  r.after = told.value("evidence_after", 0.0);
  r.confidence = told.value("confidence", 0.0);
  if (!told.contains("outline_before")) return r;
  r.from = rings_of(told.at("outline_before"));
  r.to = rings_of(told.at("outline_after"));
  if (r.from.size() != r.to.size()) throw std::runtime_error("rings are missing");
  for (std::size_t k = 0; k < r.from.size(); ++k)
    if (r.from[k].size() != r.to[k].size()) throw std::runtime_error("corners are missing");
  return r;
}

OutlineReceipt receipt_of(const nlohmann::json& j) {
  OutlineReceipt r;
  r.state = named(j.at("state").get<std::string>(), observation::RowState::corrected);
  r.reason = j.value("reason", std::string());
  if (!j.contains("image")) return r;
  r.image = j.at("image").get<std::uint32_t>();
  r.row = j.at("row").get<std::uint32_t>();
  r.shift = point(j.at("shift_m"));
  r.turn = j.at("rotation_deg").get<double>();
  r.centre = point(j.at("centre"));
  r.before = j.at("evidence_before").get<double>();
  r.after = j.at("evidence_after").get<double>();
  r.confidence = j.at("confidence").get<double>();
  r.lean = point(j.at("lean_m"));
  r.eaves = j.at("eaves_m").get<double>();
  r.gone = j.value("perhaps_gone", 0.0);
  r.refined = refinement_of(j);
  return r;
}

observation::RoofView roof_of(const nlohmann::json& j) {
  observation::RoofView roof;
  if (!j.contains("roof_evidence")) return roof;
  roof.image = j.at("roof_evidence").at("image").get<std::uint32_t>();
  roof.pixels = j.at("roof_evidence").at("pixels").get<std::uint32_t>();
  if (j.contains("roof_colour")) {
    unsigned colour = 0;
    const std::string text = j.at("roof_colour").get<std::string>();
    if (std::sscanf(text.c_str(), "#%6x", &colour) != 1) throw std::runtime_error("no colour: " + text);
    roof.colour = model::Colour{static_cast<std::uint8_t>(colour >> 16), static_cast<std::uint8_t>(colour >> 8),
                                static_cast<std::uint8_t>(colour)};
    roof.colour_confidence = j.at("roof_colour_confidence").get<double>();
  }
  if (j.contains("roof_form")) {
    roof.form = named(j.at("roof_form").get<std::string>(), observation::RoofForm::pitched);
    roof.form_confidence = j.at("roof_form_confidence").get<double>();
  }
  if (j.contains("ridge_azimuth_deg")) {
    roof.ridge = j.at("ridge_azimuth_deg").get<double>();
    roof.ridge_confidence = j.at("ridge_confidence").get<double>();
  }
  if (j.contains("courtyards"))
    for (const nlohmann::json& c : j.at("courtyards"))
      roof.courtyards.push_back({c.at("area_m2").get<double>(),
                                 c.at("built_over").get<double>(),
                                 named(c.at("courtyard").get<std::string>(), observation::CourtyardState::built_over),
                                 {}});
  return roof;
}

observation::SeenHeight height_of(const nlohmann::json& j) {
  observation::SeenHeight seen;
  if (!j.contains("shadow")) return seen;
  seen.image = j.at("shadow").at("image").get<std::uint32_t>();
  seen.shadow.length = j.at("shadow").at("length_m").get<double>();
  seen.height = j.at("height_from_shadow_m").get<double>();
  seen.uncertainty = j.at("height_from_shadow_within_m").get<double>();
  seen.confidence = j.value("height_from_shadow_confidence", 0.0);
  return seen;
}

observation::UnmappedBuilding unmapped_of(const nlohmann::json& j) {
  observation::UnmappedBuilding u;
  u.id = j.at("id").get<std::string>();
  u.image = j.at("image").get<std::uint32_t>();
  u.probability = j.at("probability").get<double>();
  u.area = j.at("area_m2").get<double>();
  u.of_roof = j.at("outline_of").get<std::string>() == "roof";
  u.lean = point(j.at("lean_m"));
  for (const nlohmann::json& p : j.at("outline")) u.outline.push_back(point(p));
  if (u.outline.size() < 3) throw std::runtime_error("no outline: " + u.id);
  return u;
}

}  // namespace

std::string imagery_json(const observation::ImageryObservations& seen, const footprints::FootprintStore& footprints,
                         const std::vector<bool>& here) {
  Json j;
  j["attribution"] = attribution(seen.images);
  j["applied"] = seen.applied;
  j["images"] = Json::array();
  for (const observation::ImageReceipt& image : seen.images) j["images"].push_back(image_json(image));
  j["buildings"] = Json::array();
  for (std::uint32_t b = 0; b < seen.outlines.size(); ++b) {
    if (!here[b]) continue;
    j["buildings"].push_back(building_json(footprints[b].id.text(), seen.outlines[b]));
    if (b < seen.roofs.size()) add_roof(j["buildings"].back(), seen.roofs[b]);
    if (b < seen.heights.size()) add_height(j["buildings"].back(), seen.heights[b]);
  }
  j["unmapped"] = Json::array();
  for (const observation::UnmappedBuilding& u : seen.unmapped) j["unmapped"].push_back(unmapped_json(u));
  j["unmapped_unsure"] = Json::array();
  for (const observation::UnmappedBuilding& u : seen.unmapped_unsure) j["unmapped_unsure"].push_back(unmapped_json(u));
  return j.dump(1) + "\n";
}

ReadImagery read_imagery_json(const std::string& text) {
  const nlohmann::json j = nlohmann::json::parse(text);
  ReadImagery read;
  read.applied = j.at("applied").get<bool>();
  for (const nlohmann::json& i : j.at("images")) {
    observation::ImageReceipt& image = read.images.emplace_back();
    image.description.source.path = i.at("path").get<std::string>();
    image.description.source.date = i.value("date", std::string());
    image.description.source.licence = i.value("licence", std::string());
    image.description.source.attribution = i.value("attribution", std::string());
    image.description.crs_code = i.at("crs").get<std::string>();
    image.description.operation = i.at("operation").get<std::string>();
    image.description.accuracy_m = i.at("accuracy_m").get<double>();
    image.description.pixel_m = i.at("pixel_m").get<double>();
    image.buildings = i.at("speaks_of").get<std::uint64_t>();
    image.fit.state = named(i.at("state").get<std::string>(), observation::ImageState::undecided);
    image.fit.shift = point(i.at("shift_m"));
  }
  for (const nlohmann::json& b : j.at("buildings")) {
    const OutlineReceipt receipt = receipt_of(b);
    const observation::RoofView roof = roof_of(b);
    if (roof.pixels > 0 && roof.image >= read.images.size()) throw std::runtime_error("an image is not there");
    if (receipt.image != OutlineReceipt::kNoImage && receipt.image >= read.images.size())
      throw std::runtime_error("an image is not there");
    const observation::SeenHeight height = height_of(b);
    if (height.image != observation::SeenHeight::kNoImage && height.image >= read.images.size())
      throw std::runtime_error("an image is not there");
    read.buildings.push_back({id_of(b.at("id").get<std::string>()), receipt, roof, height});
  }
  for (const nlohmann::json& u : j.at("unmapped")) {
    read.unmapped.push_back(unmapped_of(u));
    if (read.unmapped.back().image >= read.images.size()) throw std::runtime_error("an image is not there");
  }
  return read;
}

}  // namespace blockrand::outputs
