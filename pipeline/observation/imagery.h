// What aerial images say about an extract: whether each image fits, where each row of buildings is seen.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "importers/imagery/aerial_image.h"
#include "pipeline/model/point.h"
#include "pipeline/model/polygon.h"
#include "pipeline/observation/roof_view.h"
#include "pipeline/observation/shadows.h"

namespace blockrand::observation {

enum class ImageState : std::uint8_t { used, misfit, undecided };
constexpr std::string_view name(ImageState s) {
  constexpr std::string_view names[] = {"used", "misfit", "undecided"};
  return names[static_cast<int>(s)];
}

/// An image against the map.
struct ImageFit {
  ImageState state = ImageState::undecided;
  std::uint64_t outlines = 0;  ///< around which it shows edges
  model::Point2 shift;         ///< m: the image shows the map's outlines moved by it
  double score = 0;            ///< how far the best shift stands out of places elsewhere, in their deviations
  double margin = 0;           ///< Student's t of it against the best place elsewhere
  std::string why;             ///< a sentence
};

enum class RowState : std::uint8_t { outside, undecided, left_alone, refused, corrected };
constexpr std::string_view name(RowState s) {
  constexpr std::string_view names[] = {"outside", "undecided", "left_alone", "refused", "corrected"};
  return names[static_cast<int>(s)];
}

/// What states of buildings are called where they are counted: "12 seen elsewhere".
constexpr std::string_view words(RowState s) {
  constexpr std::string_view all[] = {"in no image that fits", "not decided", "as mapped", "refused", "seen elsewhere"};
  return all[static_cast<int>(s)];
}

/// What became of the search for the edges of single walls.
enum class RefinementState : std::uint8_t { none, left_alone, refused, refined };
constexpr std::string_view name(RefinementState s) {
  constexpr std::string_view names[] = {"none", "left_alone", "refused", "refined"};
  return names[static_cast<int>(s)];
}

/// What the image shows of walls on one line, if they are shifted along their normal (edge_refinement.h).
struct WallEvidence {
  model::Point2 at, normal;      ///< m, middle of the longest of them; unit vector, outwards
  double shift = 0;              ///< m outwards: the best within the bound
  double here = 0, there = 0;    ///< how clear the edge is where the wall stands, and where it is seen, [0, 1]
  double second = 0, usual = 0;  ///< at the next best shift, and on the average of all
  double length = 0;             ///< m of wall
  double rim = 0;                ///< m: how far outside all its walls the building's roof seems to end
  double lean = 0;               ///< m outwards: how far the image shows the roof from its ground there
  double side = 0;        ///< from -1 to 1: what lies between looks like roof if shifted outwards, else like ground
  double others = 0;      ///< how clear the building's other walls are where they stand
  double steady = 0;      ///< share of them that is clearer nowhere else
  double margin = 0;      ///< clearness that no place of the roof, and no shift of other walls, explains as well
  double confidence = 0;  ///< that they stand nearer to the truth afterwards
  bool taken = false;
};

/// A building's outline with walls shifted to where the image shows them; the receipt of it.
struct RefinedOutline {
  RefinementState state = RefinementState::none;
  std::string reason;            ///< a sentence; empty for `refined` and `none`
  std::uint32_t walls = 0;       ///< that were shifted; those on one line count as one
  double largest = 0;            ///< m: the largest of their shifts
  double before = 0, after = 0;  ///< how clear the edges of all its walls are, [0, 1]
  double confidence = 0;         ///< of the least sure wall, that it stands nearer to the truth afterwards
  /// Rings point by point, m: as repaired where it is mapped, and where the image shows them. Empty but for `refined`, `refused`.
  std::vector<std::vector<model::Point2>> from, to;
  std::vector<WallEvidence> evidence;  ///< of walls that the image shows elsewhere
};

/// The receipt of a building; all buildings of a row have the same movement.
struct OutlineReceipt {
  static constexpr std::uint32_t kNoImage = 0xffffffff;
  RowState state = RowState::outside;
  std::string reason;     ///< a sentence; empty for `corrected`
  std::uint32_t row = 0;  ///< of its rows, counted as they come
  std::uint32_t image = kNoImage;
  model::Point2 shift, centre;   ///< m: turned about `centre`, then shifted
  double turn = 0;               ///< degrees, counter-clockwise
  double before = 0, after = 0;  ///< score of the walls on edges, [0, 1]
  double confidence = 0;
  model::Point2 lean;  ///< m, of the roof in the image
  double eaves = 0;    ///< m: the height that it was reckoned with
  double mean = 0, deviation = 0, second = 0, weight = 0, height_doubt = 0;
  double gone = 0;  ///< probability that no building stands there, where that is likely (kPerhapsGone); else 0
  RefinedOutline refined;
};

/// A height that a shadow tells.
struct SeenHeight {
  static constexpr std::uint32_t kNoImage = 0xffffffff;
  std::uint32_t image = kNoImage;  ///< whose shadow it is; kNoImage: none was found
  ShadowLength shadow;
  double height = 0;       ///< m above ground of the edge that casts it
  double uncertainty = 0;  ///< m
  double confidence = 0;   ///< that storeys can be counted by it; 0: they are not
};

/// What was measured of a thing that may be a building.
struct UnmappedEvidence {
  /// Houses have more, yards less.
  static constexpr double kUnknownShadow = 0.1;
  double score = 0, around = 0;  ///< EdgedRectangle
  double filled = 0;             ///< FilledRectangle
  double elongation = 1;         ///< longer side by the shorter one
  double area = 0;               ///< m2
  double likeness = 0;           ///< mean of RoofColours::likeness()
  double green_around = 0;       ///< share of the pixels within 3 m that have the colour of leaves and grass
  double mapped_around = 0;      ///< share of them that the map has something on
  double shadow =
      kUnknownShadow;     ///< how much darker it is behind than before it as the sun stands; kUnknownShadow: unknown
  double brightness = 0;  ///< by that of the image's mapped roofs
};

/// What looks like a building where none is mapped (find_unmapped).
struct UnmappedBuilding {
  std::string id;           ///< by its place: "u" and the square of 2 m of the build CRS in which its middle lies
  std::uint32_t image = 0;  ///< that shows it
  std::vector<model::Point2> outline;  ///< m in the build CRS on its grid, counter-clockwise
  bool of_roof = false;  ///< the image's lean is not known there: `outline` is where the image shows the roof
  model::Point2 lean;    ///< m: where the image shows the roof from `outline`
  double area = 0;       ///< m2
  double probability = 0;
  UnmappedEvidence evidence;
};

struct ImageReceipt {
  bool leans = false;
  model::Point2 shift;  ///< m: how far it shows all ground from the map, where that is clear; it was undone
  model::Point2 alike;  ///< m: most rows that it shows elsewhere are shown so far off, and none is moved; else (0, 0)
  double shadow_azimuth = -1;   ///< degrees clockwise from grid north where the sun stands, by the shadows; -1: unknown
  double shadow_per_metre = 0;  ///< m of shadow for each metre of height; 0: unknown
  std::uint64_t shadow_houses = 0;
  bool shadow_by_tags = false;
  std::optional<double> sun_azimuth;      ///< degrees clockwise from north, by the roofs
  double flight_height = 0, support = 0;  ///< LeanField
  std::uint64_t buildings = 0;            ///< that it says something of
  importers::imagery::ImageDescription description;
  ImageFit fit;
  double haze = 0, clouded = 0;    ///< ImageQuality; 0 where too few houses lie in it
  std::uint64_t edited_later = 0;  ///< buildings in it that somebody edited after it was taken
};

struct ImageryObservations {
  std::vector<ImageReceipt> images;
  std::vector<OutlineReceipt> outlines;  ///< by building number; empty: nobody looked for them
  std::vector<RoofView> roofs;           ///< as `outlines`
  std::vector<SeenHeight> heights;       ///< as `outlines`
  /// What looks like a building where none is mapped, the likeliest first; what was measured and is not told, being less
  /// likely (kTellUnmapped).
  std::vector<UnmappedBuilding> unmapped, unmapped_unsure;
  bool applied = false;  ///< what is `corrected` stands where the image shows it, not where it is mapped
  /// The repaired outlines of what was moved, from before, by building number in ascending order.
  std::vector<std::pair<std::uint32_t, std::vector<model::Polygon>>> before;
};

}  // namespace blockrand::observation
