// The report's map: footprints as inline SVG, coloured through CSS classes. Internal to this folder.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pipeline/outputs/report/report_tile.h"

namespace blockrand::outputs {

/// What a footprint can be coloured by. The class of a footprint is the letter and the number of its value.
enum class MapTheme : std::uint8_t { style, era, storeys, roof, storeys_source, height_source, roof_source, issue };
inline constexpr int kMapThemes = 8;
inline constexpr char kThemeLetter[kMapThemes] = {'a', 'e', 's', 'r', 'q', 'h', 'k', 'i'};
/// Of a class, for the legend: "mansard, gambrel".
std::string_view class_name(MapTheme theme, std::size_t k);

/// Styles and eras: 0 not classified, else 1 + the value.
inline constexpr int kStyleClasses = model::kStyleClassCount + 1, kEraClasses = model::kEraCount + 1;

/// Storeys: 0 none built, 1 to 6, 7 for 7 to 9, 8 for ten and more.
inline constexpr int kStoreyClasses = 9;
int storey_class(const MapBuilding& building);
/// Roofs: 0 none built, 1 flat, 2 gabled, 3 hipped and pyramidal, 4 mansard and gambrel, 5 shed, 6 round, 7 other.
inline constexpr int kRoofClasses = 8;
int roof_class(const MapBuilding& building);
/// Issues: 0 built as asked, 1 notice, 2 fallback, 3 not built.
inline constexpr int kIssueClasses = 4;
/// Sources: 0 none built, else 1 + Source.
inline constexpr int kSourceClasses = model::kSourceCount + 1;

/// How large the map's text may become, and how it gets smaller.
struct MapBudget {
  std::size_t bytes = 8'000'000;          ///< of path data; 8 MB still scroll smoothly in a browser
  std::size_t single_footprints = 8'000;  ///< up to here each footprint is an element with title and link
};

struct ReportMap {
  bool drawn = false;  ///< false where there is no footprint: all below but `counts` and `without_area` is empty then
  std::string paths;   ///< the footprints, as SVG; by building, or in groups of one look
  std::string note;    ///< how the map was simplified; empty: not at all
  std::int64_t width = 0, height = 0;  ///< units of the map
  std::int64_t metres = 0;             ///< its width
  std::int64_t radius = 1;             ///< units, of a mark
  bool far = false;                    ///< houses are less than a pixel
  std::string ratio;                   ///< width by height, for CSS
  std::string bar_share, bar_length;   ///< of the scale bar: percent of the width; "200 m"
  std::vector<std::optional<MapPoint>>
      places;  ///< units, y down, parallel to the footprints; nothing outside of the map
  std::vector<std::pair<std::uint32_t, std::string>> blocks;  ///< number and path data of outlines
  std::array<std::vector<std::uint64_t>, kMapThemes> counts;  ///< buildings by theme and class
  std::vector<std::uint32_t> marks;  ///< of `marked` those that lie in the frame, in the same order
  std::uint64_t outside = 0;         ///< buildings beyond the map's frame
  std::uint64_t without_area = 0;    ///< buildings that have no footprint
};

/// An outline that shows up when a link leads to it.
struct MapOutline {
  std::uint32_t number = 0;
  std::vector<std::vector<MapPoint>> rings;
};

/// \param issue    worst issue class per building, parallel to footprints.buildings
/// \param marked   buildings that the page links to: each gets an element `at-w123` that shows up when it is the target;
///                 without repetition
ReportMap report_map(const MapFootprints& footprints, const std::vector<std::uint8_t>& issue,
                     const std::vector<std::uint32_t>& marked, const std::vector<MapOutline>& outlines = {},
                     const MapBudget& budget = {});

}  // namespace blockrand::outputs
