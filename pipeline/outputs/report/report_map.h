// The report's map: footprints as inline SVG, coloured through CSS classes. Internal to this folder.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "pipeline/outputs/report/report_tile.h"

namespace blockrand::outputs {

/// What a footprint can be coloured by. The class of a footprint is the letter and the number of its value.
enum class MapTheme : std::uint8_t { storeys, source, roof, issue };
inline constexpr int kMapThemes = 4;
inline constexpr char kThemeLetter[kMapThemes] = {'s', 'q', 'r', 'i'};

/// Storeys: 0 none built, 1 to 6, 7 for 7 to 9, 8 for ten and more.
inline constexpr int kStoreyClasses = 9;
int storey_class(const MapBuilding& building);
/// Roofs: 0 none built, 1 flat, 2 gabled, 3 hipped and pyramidal, 4 mansard and gambrel, 5 shed, 6 round, 7 other.
inline constexpr int kRoofClasses = 8;
int roof_class(const MapBuilding& building);
/// Issues: 0 built as asked, 1 notice, 2 fallback, 3 not built.
inline constexpr int kIssueClasses = 4;
/// Sources: 0 none built, else 1 + Source of the storeys.
inline constexpr int kSourceClasses = model::kSourceCount + 1;

/// How large the map's text may become, and how it gets smaller.
struct MapBudget {
  std::size_t bytes = 8'000'000;          ///< of path data; 8 MB still scroll smoothly in a browser
  std::size_t single_footprints = 8'000;  ///< up to here each footprint is an element with title and link
};

struct ReportMap {
  std::string svg;   ///< empty where there is no footprint
  std::string note;  ///< how the map was simplified, escaped; empty: not at all
  std::array<std::vector<std::uint64_t>, kMapThemes> counts;  ///< buildings by theme and class
  std::vector<std::uint32_t> marks;  ///< of `marked` those that lie in the frame, in the same order
  std::uint64_t outside = 0;         ///< buildings beyond the map's frame
  std::uint64_t without_area = 0;    ///< buildings that have no footprint
};

/// \param issue    worst issue class per building, parallel to footprints.buildings
/// \param marked   buildings that the page links to: each gets an element `at-w123` that shows up when it is the target;
///                 without repetition
ReportMap report_map(const MapFootprints& footprints, const std::vector<std::uint8_t>& issue,
                     const std::vector<std::uint32_t>& marked, const MapBudget& budget = {});

}  // namespace blockrand::outputs
