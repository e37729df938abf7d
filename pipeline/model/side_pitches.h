// Pitches of a roof's sides, as a tag, an override or a preset orders them: "street 60, yard 30".
#pragma once

#include <array>
#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

namespace blockrand::model {

/// A side by what it faces, or by where it looks: within 45 degrees of that quarter of the compass.
enum class PitchedSide : std::uint8_t { street, yard, north, east, south, west };
inline constexpr std::string_view kPitchedSideNames[] = {"street", "yard", "north", "east", "south", "west"};
inline constexpr std::size_t kPitchedSideCount = sizeof(kPitchedSideNames) / sizeof(kPitchedSideNames[0]);

/// Whole degrees by side; 0: that side has the roof's own pitch.
struct SidePitches {
  std::array<std::uint8_t, kPitchedSideCount> degrees{};
  bool any() const {
    for (const std::uint8_t d : degrees)
      if (d != 0) return true;
    return false;
  }
  bool operator==(const SidePitches&) const = default;
};

/// Degrees that may be ordered: flatter sides carry no tiles, steeper ones are walls (mansards go up to 80).
inline constexpr int kLeastSidePitch = 5, kMostSidePitch = 80;

/// Reads "street 60, yard 30"; commas and semicolons part sides. Error: what is wrong, in words.
inline tl::expected<SidePitches, std::string> parse_side_pitches(std::string_view whole) {
  const auto trimmed = [](std::string_view text) {
    const std::size_t from = text.find_first_not_of(" \t");
    return from == std::string_view::npos ? std::string_view()
                                          : text.substr(from, text.find_last_not_of(" \t") - from + 1);
  };
  SidePitches out;
  while (true) {
    const std::size_t end = whole.find_first_of(",;");
    const std::string_view item = trimmed(whole.substr(0, end));
    const std::string quoted = "\"" + std::string(item) + "\"";
    const std::size_t gap = item.find_first_of(" \t");
    std::size_t side = 0;
    while (side < kPitchedSideCount && kPitchedSideNames[side] != item.substr(0, gap)) ++side;
    if (side == kPitchedSideCount)
      return tl::unexpected(quoted + " begins with no side: street, yard, north, east, south or west");
    const std::string_view number = gap == std::string_view::npos ? std::string_view() : trimmed(item.substr(gap));
    int degrees = 0;
    const auto [last, error] = std::from_chars(number.data(), number.data() + number.size(), degrees);
    if (error != std::errc() || last != number.data() + number.size() || degrees < kLeastSidePitch ||
        degrees > kMostSidePitch)
      return tl::unexpected(quoted + ": a pitch is a whole number from " + std::to_string(kLeastSidePitch) + " to " +
                            std::to_string(kMostSidePitch) + " degrees");
    if (out.degrees[side] != 0) return tl::unexpected(std::string(kPitchedSideNames[side]) + " stands twice");
    out.degrees[side] = static_cast<std::uint8_t>(degrees);
    if (end == std::string_view::npos) return out;
    whole.remove_prefix(end + 1);
  }
}

/// The same form.
inline std::string text(const SidePitches& pitches) {
  std::string out;
  for (std::size_t i = 0; i < kPitchedSideCount; ++i)
    if (pitches.degrees[i] != 0)
      out += (out.empty() ? "" : ", ") + std::string(kPitchedSideNames[i]) + " " + std::to_string(pitches.degrees[i]);
  return out;
}

}  // namespace blockrand::model
