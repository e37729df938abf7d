#include "pipeline/facades/element_library.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <optional>
#include <variant>

#include "pipeline/model/usual_glass.h"
#include "styles/grammar/evaluation/colour_text.h"

namespace blockrand::facades {
namespace {

using model::ElementPart;

/// Steps a metre of sizes and of parameters: equal elements are one.
constexpr double kSizeSteps = 100, kParameterSteps = 1000;
/// Steps a metre of what stands in openings: 5 cm across, 10 cm up. Windows come in few sizes, as joiners make them;
/// each stored once, they are most of a town's forms (own choice: coarser steps show in the piers between windows).
constexpr double kOpeningWidthSteps = 20, kOpeningHeightSteps = 10;
constexpr double kRounding = 0.001;  ///< of a step: what floats may lack of a whole one
/// Colours of parts that neither rule nor building says.
constexpr model::Colour kFrame{0xF6, 0xF6, 0xF6}, kLeaf{0x5A, 0x3A, 0x29}, kMetal{0x37, 0x3F, 0x43},
    kTrim{0xFD, 0xF4, 0xE3}, kSill{0xE9, 0xE5, 0xCE};

/// "#rrggbb", as rule files write colours.
std::optional<model::Colour> colour_of_text(std::string_view text) {
  const auto parsed = grammar::parse_colour(text);
  if (!parsed) return std::nullopt;
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(std::nearbyint((*parsed)[i] * 255)); };
  return model::Colour{byte(0), byte(1), byte(2)};
}

/// What is left of the parameter "ends" of a run that is cut at one side.
std::string_view ends_kept(std::string_view ends, bool keep_left, bool keep_right) {
  const bool left = keep_left && (ends == "returned" || ends == "left_returned");
  const bool right = keep_right && (ends == "returned" || ends == "right_returned");
  return left && right ? "returned" : left ? "left_returned" : right ? "right_returned" : "cut";
}

}  // namespace

ElementLibrary::ElementLibrary(model::Region& region, const attributes::Defaults& defaults,
                               elements::ElementCatalogue catalogue)
    : region_(region), catalogue_(std::move(catalogue)) {
  const auto material = [&](const char* name) {
    return static_cast<std::uint8_t>(std::max(defaults.material(name), 0));
  };
  plaster_ = material("plaster");
  wood_ = material("wood");
  glass_ = material("glass");
  metal_ = material("metal");
}

double ElementLibrary::size(double metres) { return std::floor(metres * kSizeSteps + kRounding) / kSizeSteps; }

std::pair<double, double> ElementLibrary::size(const elements::ElementKind* kind, double width, double height) {
  if (!kind || kind->semantic == model::ElementClass::installation) return {size(width), size(height)};
  const auto opening = [](double metres, double steps, double least) {
    const double coarse = std::floor(metres * steps + kRounding) / steps;
    return coarse >= least ? coarse : size(metres);
  };
  return {opening(width, kOpeningWidthSteps, kind->width.least),
          opening(height, kOpeningHeightSteps, kind->height.least)};
}

PartMaterials ElementLibrary::usual_materials(const model::BuildingPart& part) const {
  PartMaterials out;
  const auto set = [&](ElementPart p, std::uint8_t material, model::Colour colour) {
    out[static_cast<std::size_t>(p)] = {material, colour};
  };
  model::PartMaterial wall{plaster_, part.attributes.shown_wall_colour};
  for (const model::Face& face : part.lod2.faces)
    if (face.kind == model::SurfaceKind::wall) {
      wall = {face.material, face.colour};
      break;
    }
  set(ElementPart::frame, wood_, kFrame);
  set(ElementPart::glass, glass_, model::kUsualGlass);
  set(ElementPart::leaf, wood_, kLeaf);
  set(ElementPart::surround, plaster_, kTrim);
  set(ElementPart::sill, plaster_, kSill);
  set(ElementPart::wall, wall.material, wall.colour);
  set(ElementPart::metal, metal_, kMetal);
  set(ElementPart::panel, wood_, kLeaf);
  return out;
}

void ElementLibrary::add_key(char type, std::string_view text) {
  const std::uint64_t length = text.size();
  std::array<char, sizeof(length)> bytes;
  std::memcpy(bytes.data(), &length, sizeof(length));
  key_.push_back(type);
  key_.append(bytes.data(), bytes.size());
  key_.append(text);
}

void ElementLibrary::add_key(double value, double steps) {
  const long long whole = std::llrint(value * steps);
  std::array<char, sizeof(whole)> bytes;
  std::memcpy(bytes.data(), &whole, sizeof(whole));
  key_.push_back('#');
  key_.append(bytes.data(), bytes.size());
}

void ElementLibrary::ask(std::string_view kind, double width, double height, const PartMaterials& materials) {
  kind_ = kind;
  width_ = width;
  height_ = height;
  materials_of_parts_ = materials;
  parameters_.clear();
  key_.clear();
  add_key('k', kind);
  add_key(width, kSizeSteps);
  add_key(height, kSizeSteps);
}

void ElementLibrary::add(const std::string& name, std::string_view word) {
  parameters_.push_back({name, std::string(word)});
  add_key('n', name);
  add_key('t', word);
}

void ElementLibrary::add(const std::string& name, double number) {
  parameters_.push_back({name, std::nearbyint(number * kParameterSteps) / kParameterSteps});
  add_key('n', name);
  add_key(number, kParameterSteps);
}

void ElementLibrary::add_request(const grammar::ElementRequest& order, bool keep_left, bool keep_right,
                                 std::vector<std::string>& complaints) {
  for (std::size_t i = 1; i + 1 < order.arguments.size(); i += 2) {
    if (!std::holds_alternative<std::string>(order.arguments[i])) continue;
    const std::string& name = std::get<std::string>(order.arguments[i]);
    const grammar::Value& value = order.arguments[i + 1];
    const auto* text = std::get_if<std::string>(&value);
    if (text && name.ends_with("_colour")) {
      const std::string_view part = std::string_view(name).substr(0, name.size() - 7);
      const auto at = std::find(std::begin(model::kElementPartNames), std::end(model::kElementPartNames), part);
      const auto colour = colour_of_text(*text);
      if (at != std::end(model::kElementPartNames) && colour)
        materials_of_parts_[static_cast<std::size_t>(at - std::begin(model::kElementPartNames))].colour = *colour;
      else if (!text->empty())
        complaints.push_back(fmt::format("{} = {} is no colour of a part", name, *text));
      continue;
    }
    if ((!keep_left && name == "left_turn") || (!keep_right && name == "right_turn")) continue;
    if (text)
      add(name, name == "ends" && !(keep_left && keep_right) ? ends_kept(*text, keep_left, keep_right) : *text);
    else if (const auto* number = std::get_if<double>(&value))
      add(name, *number);
    else if (const auto* truth = std::get_if<bool>(&value))
      add(name, std::string_view(*truth ? "yes" : "no"));
  }
}

std::uint32_t ElementLibrary::take(std::string& error) {
  auto made = made_.find(key_);
  if (made == made_.end()) {
    auto fitted = catalogue_.make_fitting(kind_, width_, height_, parameters_);
    Made entry;
    if (fitted) {
      model::Element& element = fitted->element;
      const elements::ElementKind* kind = catalogue_.find(kind_);
      // Element files are checked with their defaults; what a rule asks of them may still be no element.
      if (std::string defect = catalogue_.defect_of(element, kind ? std::min(width_, kind->width.most) : width_,
                                                    kind ? std::min(height_, kind->height.most) : height_);
          !defect.empty()) {
        entry.error = fmt::format("{} {} x {} m: {}", kind_, width_, height_, defect);
        made = made_.emplace(key_, std::move(entry)).first;
        error = made->second.error;
        return kNone;
      }
      for (const model::ElementFace& face : element.mesh.faces) entry.parts[static_cast<std::size_t>(face.part)] = true;
      // Outputs add the reveal, which looks like the wall.
      if (element.opening.reveal > 0) entry.parts[static_cast<std::size_t>(ElementPart::wall)] = true;
      entry.element = std::make_shared<const model::Element>(std::move(element));
      entry.error = std::move(fitted->told);
    } else {
      entry.error = fitted.error();
    }
    made = made_.emplace(key_, std::move(entry)).first;
  }
  error = made->second.error;
  if (!made->second.element) return kNone;
  // A part that the form lacks has no look: windows without trim are the same on walls of all colours.
  for (std::size_t p = 0; p < materials_of_parts_.size(); ++p)
    if (!made->second.parts[p]) materials_of_parts_[p] = {};
  return number_of(*made, materials_of_parts_);
}

std::uint32_t ElementLibrary::add_made(model::Element&& element, const PartMaterials& materials) {
  key_.clear();
  add_key('g', element.name);
  add_key('c', element.semantic == model::ElementClass::door ? "door" : "");
  add_key(element.opening.reveal, model::kGridStepsPerMetre);
  for (const model::Point2& p : element.opening.outline)
    add_key(p.x, model::kGridStepsPerMetre), add_key(p.y, model::kGridStepsPerMetre);
  for (const model::ElementFace& face : element.mesh.faces) {
    add_key('f', model::name(face.part));
    for (std::uint32_t i = face.first; i < face.first + face.count; ++i) {
      const model::Point3& v = element.mesh.vertices[element.mesh.indices[i]];
      for (const double c : {v.x, v.y, v.z}) add_key(c, model::kGridStepsPerMetre);
    }
  }
  auto made = made_.find(key_);
  if (made == made_.end()) {
    Made entry;
    entry.element = std::make_shared<const model::Element>(std::move(element));
    made = made_.emplace(key_, std::move(entry)).first;
  }
  return number_of(*made, materials);
}

std::uint32_t ElementLibrary::number_of(Entry& entry, const PartMaterials& materials) {
  for (const auto& [known, number] : entry.second.coloured)
    if (known == materials) return number;
  const auto number = static_cast<std::uint32_t>(region_.elements.size());
  entry.second.coloured.emplace_back(materials, number);
  region_.elements.push_back({entry.second.element, materials});
  of_number_.push_back(&entry);
  return number;
}

std::vector<std::uint32_t> ElementLibrary::take_over(ElementLibrary& other) {
  std::vector<std::uint32_t> numbers;
  for (std::size_t i = 0; i < other.of_number_.size(); ++i) {
    const Entry& theirs = *other.of_number_[i];
    auto [ours, is_new] = made_.try_emplace(theirs.first, theirs.second);
    if (is_new) ours->second.coloured.clear();
    numbers.push_back(number_of(*ours, other.region_.elements[i].materials));
  }
  other.made_.clear(), other.of_number_.clear(), other.region_.elements.clear();
  return numbers;
}

}  // namespace blockrand::facades
