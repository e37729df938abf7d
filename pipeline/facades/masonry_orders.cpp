#include "pipeline/facades/masonry_orders.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <iterator>

namespace blockrand::facades {
namespace {

using masonry::Bond;

/// Triangles of a wall: a front of 10 x 12 m has 60 bricks a m2, of 2 triangles without their sides.
constexpr double kMostTriangles = 40000;

constexpr std::string_view kNames[] = {
    "masonry",           "masonry_bond",   "masonry_format", "masonry_length",        "masonry_height",
    "masonry_joint",     "masonry_relief", "masonry_colour", "masonry_mortar_colour", "masonry_dressing_colour",
    "masonry_triangles", "masonry_walls"};

class Orders {
 public:
  Orders(std::span<const std::pair<std::string, grammar::Value>> values, std::vector<std::string>& complaints)
      : values_(values), complaints_(complaints) {}

  std::string text(std::string_view name) const {
    for (const auto& [known, value] : values_)
      if (known == name) {
        if (const auto* number = std::get_if<double>(&value)) return fmt::format("{}", *number);
        const auto* text = std::get_if<std::string>(&value);
        return text ? *text : std::string();
      }
    return {};
  }

  /// Index of the word asked for; none where nothing, or nothing known, is asked for.
  template <class Names>
  std::optional<std::size_t> word(std::string_view name, const Names& names) const {
    const std::string asked = text(name);
    if (asked.empty()) return std::nullopt;
    const auto found = std::ranges::find(names, std::string_view(asked));
    if (found != std::end(names)) return static_cast<std::size_t>(found - std::begin(names));
    complaints_.push_back(fmt::format("{} = \"{}\" is none of {}", name, asked, fmt::join(names, ", ")));
    return std::nullopt;
  }

  std::optional<double> number(std::string_view name, double least, double most) const {
    const std::string asked = text(name);
    if (asked.empty()) return std::nullopt;
    char* end = nullptr;
    const double value = std::strtod(asked.c_str(), &end);
    if (end && *end == 0 && value >= least && value <= most) return value;
    complaints_.push_back(
        fmt::format("{} = {} is no number within {} to {}; what is usual is taken", name, asked, least, most));
    return std::nullopt;
  }

  std::optional<model::Colour> colour(std::string_view name) const {
    const std::string asked = text(name);
    if (asked.empty()) return std::nullopt;
    const auto out = model::colour_of_hex(asked);
    if (!out) complaints_.push_back(fmt::format("{} = \"{}\" is no colour: #rrggbb", name, asked));
    return out;
  }

 private:
  std::span<const std::pair<std::string, grammar::Value>> values_;
  std::vector<std::string>& complaints_;
};

}  // namespace

std::span<const std::string_view> masonry_parameters() { return kNames; }

bool is_masonry_parameter(std::string_view name) { return std::ranges::find(kNames, name) != std::end(kNames); }

std::optional<MasonryOrders> read_masonry_orders(std::span<const std::pair<std::string, grammar::Value>> values,
                                                 std::vector<std::string>& complaints) {
  const Orders said(values, complaints);
  constexpr std::string_view kKinds[] = {"none", "fitted"}, kWalls[] = {"outside", "street"};
  if (said.word("masonry", kKinds).value_or(0) == 0) return std::nullopt;
  MasonryOrders out;
  if (const auto bond = said.word("masonry_bond", masonry::kBondNames)) out.bond = static_cast<Bond>(*bond);
  std::array<std::string_view, std::size(masonry::kBrickFormats)> formats;
  std::ranges::transform(masonry::kBrickFormats, formats.begin(), &masonry::BrickFormat::name);
  if (const auto format = said.word("masonry_format", formats)) out.format = formats[*format];
  out.length = said.number("masonry_length", 0.1, 2.5);
  out.height = said.number("masonry_height", 0.03, 1.5);
  out.joint = said.number("masonry_joint", 0.002, 0.05);
  out.relief = said.number("masonry_relief", 0.002, 0.02);
  out.colour = said.colour("masonry_colour");
  out.mortar = said.colour("masonry_mortar_colour");
  out.dressings = said.colour("masonry_dressing_colour");
  out.most_triangles = static_cast<std::size_t>(said.number("masonry_triangles", 0, 1e6).value_or(kMostTriangles));
  out.street_only = said.word("masonry_walls", kWalls).value_or(0) == 1;
  return out;
}

masonry::Masonry masonry_of(const MasonryOrders& orders, Bond bond, std::vector<std::string>& complaints) {
  masonry::Masonry out = masonry::usual_masonry(bond);
  if (masonry::is_brick(bond))
    for (const masonry::BrickFormat& f : masonry::kBrickFormats)
      if (f.name == orders.format)
        out.length = f.length, out.width = f.width, out.height = f.height, out.perpend = f.perpend, out.bed = f.bed;
  const masonry::Masonry usual = out;
  // Other stones keep their proportions.
  if (orders.length) out.width *= *orders.length / out.length, out.length = *orders.length;
  if (orders.height) out.height = *orders.height;
  if (orders.joint) out.perpend = out.bed = *orders.joint;
  if (orders.relief) out.relief = *orders.relief;
  if (masonry::can_be_laid(out)) return out;
  complaints.push_back(fmt::format(
      "masonry: stones of {:.3f} x {:.3f} m with joints of {:.3f} m cannot be laid; the usual ones are taken",
      out.length, out.height, out.perpend));
  return usual;
}

}  // namespace blockrand::facades
