#include "pipeline/attributes/pigments.h"

#include <algorithm>
#include <cmath>

namespace blockrand::attributes {
namespace {

using base::TomlTable;
using model::Colour;

/// Steps between fresh and weathered and between dark and light: colours are materials in some outputs, so few are enough.
constexpr int kWeatheringSteps = 4, kToneSteps = 3;

std::uint8_t channel(double value) {
  return static_cast<std::uint8_t>(std::clamp(std::floor(value + 0.5), 0.0, 255.0));
}

std::optional<Colour> colour(TomlTable& table, std::string_view key) {
  const auto text = table.text(key);
  if (!text) return std::nullopt;
  const auto parsed = model::colour_of_hex(*text);
  if (!parsed) table.fail(key, "`" + *text + "` is no colour", "Write it as #rrggbb");
  return parsed;
}

Colour needed(TomlTable& table, std::string_view key) {
  const auto found = colour(table, key);
  if (!found) table.fail(key, "no `" + std::string(key) + "`", "Write " + std::string(key) + " = \"#rrggbb\"");
  return *found;
}

DrawnRoofs read_drawn_roofs(TomlTable& table) {
  DrawnRoofs out;
  if (const auto v = table.number("alike", 0, 1)) out.alike = *v;
  if (const auto v = table.number("least_weathered", 0, 1)) out.least_weathered = *v;
  if (const auto v = table.number("most_weathered", 0, 1)) out.most_weathered = *v;
  if (out.least_weathered > out.most_weathered)
    table.fail("least_weathered", "it is above most_weathered", "Give least_weathered <= most_weathered");
  if (const auto v = table.number("tone", 0, 0.5)) out.tone = *v;
  out.dirt = needed(table, "dirt");
  table.finish();
  return out;
}

}  // namespace

Colour less_saturated(Colour colour, double most) {
  const int high = std::max({colour.r, colour.g, colour.b}), low = std::min({colour.r, colour.g, colour.b});
  if (high == 0 || static_cast<double>(high - low) <= most * high) return colour;
  const double share = most * high / (high - low);
  const auto nearer = [&](std::uint8_t v) { return channel(high - (high - v) * share); };
  return {nearer(colour.r), nearer(colour.g), nearer(colour.b)};
}

Colour Pigments::on_material(Colour screen, std::uint8_t material) const {
  if (by_screen_colour.empty()) return screen;
  const auto pigment = by_screen_colour.find(screen);
  if (pigment == by_screen_colour.end()) return muted(screen, material);
  const auto found = pigment->second.on_material.find(material);
  return found == pigment->second.on_material.end() ? pigment->second.elsewhere : found->second;
}

Colour Pigments::muted(Colour drawn, std::uint8_t material) const {
  return material < most_saturated.size() ? less_saturated(drawn, most_saturated[material]) : drawn;
}

Colour Pigments::weathered(Colour drawn, std::uint64_t bits) const {
  if (!drawn_roofs) return drawn;
  const DrawnRoofs& d = *drawn_roofs;
  const int dirty = static_cast<int>(bits % kWeatheringSteps);
  const int light = static_cast<int>(bits / kWeatheringSteps % kToneSteps) - kToneSteps / 2;
  const double share = d.least_weathered + (d.most_weathered - d.least_weathered) * dirty / (kWeatheringSteps - 1);
  const double tone = 1 + d.tone * light / (kToneSteps / 2);
  const auto aged = [&](std::uint8_t fresh, std::uint8_t dirt) {
    return channel((fresh + (dirt - fresh) * share) * tone);
  };
  return {aged(drawn.r, d.dirt.r), aged(drawn.g, d.dirt.g), aged(drawn.b, d.dirt.b)};
}

Pigments read_pigments(TomlTable& file, const std::function<int(std::string_view)>& material) {
  Pigments out;
  if (auto table = file.table("drawn_roofs")) out.drawn_roofs = read_drawn_roofs(*table);
  auto pigments = file.table("pigment");
  if (!pigments) return out;
  for (const std::string& name : pigments->keys()) {
    TomlTable table = *pigments->table(name);
    Pigment pigment;
    pigment.name = name;
    const Colour screen = needed(table, "screen");
    pigment.elsewhere = needed(table, "elsewhere");
    if (auto on = table.table("on")) {
      for (const std::string& value : on->keys()) {
        const int index = material(value);
        if (index < 0) on->fail(value, "no material class `" + value + "`", "Name a class of this file");
        pigment.on_material[static_cast<std::uint8_t>(index)] = needed(*on, value);
      }
      on->finish();
    }
    table.finish();
    const auto [at, is_new] = out.by_screen_colour.emplace(screen, std::move(pigment));
    if (!is_new)
      table.fail("screen", "`" + at->second.name + "` has this colour, too", "Give each word a colour of its own");
  }
  pigments->finish();
  return out;
}

}  // namespace blockrand::attributes
