// Facades: the wall planes of buildings with their openings in rows and columns, and which of two models' belong
// together.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/compare/city.h"
#include "pipeline/compare/measures.h"

namespace blockrand::compare {

struct FacadeOptions {
  double max_tilt = 0.26;       ///< rad (15 degrees). Walls lean less; more is a roof.
  double plane_angle = 0.09;    ///< rad (5 degrees). Walls within it are one facade, where they lie in one plane.
  double plane_distance = 0.6;  ///< m. Pilasters, plinths, reveals and shallow bays stay with their facade.
  double min_width = 2.0;       ///< m. Narrower walls are jogs and reveals, no facades.
  double min_height = 2.0;      ///< m. Lower walls are parapets, plinths and the sides of dormers.
  double pair_angle = 0.35;     ///< rad (20 degrees). Facades of two models that belong together differ by less,
  double pair_distance = 3.0;   ///< m … lie so near to each other (across),
  double pair_overlap = 0.5;    ///< … and have this share of the narrower one's width in common.
  double match_iou = 0.5;       ///< of bounding rectangles in the facade's plane: an opening is found from here on
  double row_gap = 0.5;      ///< share of an opening's height: centres nearer than that are one row (likewise columns)
  double blank_width = 4.0;  ///< m. Narrower facades may have no window by design.
};

/// An opening in its facade's plane: the rectangle around it, of those of its polygons that look (within 60 degrees)
/// along the facade's normal or against it: panes and frames, not the sides of reveals.
struct FacadeOpening {
  double left = 0, right = 0;  ///< m along the facade, from its left end as seen from outside
  double bottom = 0, top = 0;  ///< m above the match's zero (facades_of)
  double area = 0;             ///< m² of the opening itself in the facade's plane
  bool door = false;
  int row = -1,
      column = -1;  ///< counted from below and from the left; -1: in none (transom, half-landing; between axes)
  std::uint32_t building = 0, opening = 0;  ///< index into the City's buildings, and into Building::openings
};

/// Walls in (nearly) one plane, and their openings. How they are gathered is said at wall_groups (facade_planes.h), how
/// rows, columns and storeys are found at find_rows_and_columns (opening_grid.h).
struct Facade {
  std::size_t building = 0;  ///< index into its City's buildings: the one with most of its area
  std::vector<std::pair<std::uint32_t, std::uint32_t>> faces;  ///< (building, index into its faces), sorted
  Point2 left, right;           ///< plan, relative to City::origin; left and right as seen from outside
  double bottom = 0, top = 0;   ///< m above the match's zero (facades_of)
  double area = 0;              ///< m² of its walls and openings in the facade's plane, each place once
  double opening_area = 0;      ///< m² of its openings in the facade's plane, each place once
  double covered = 0;           ///< m² of `area` that faces with LeftOut::covered make
  std::vector<Rings3> outline;  ///< of its walls in the facade's plane: x along the facade from `left`, y above the
                                ///< zero, z 0; for drawings, may overlap
  std::vector<FacadeOpening> openings;             ///< from left to right, then from below
  int storeys = 0;                                 ///< rows of openings that are storeys
  int axes = 0;                                    ///< columns of openings that are axes
  std::optional<double> storey_pitch, axis_pitch;  ///< m: median distance of neighbouring rows, columns; from two on
  bool blank = false;    ///< no openings, at least blank_width wide and not covered, though the building has
                         ///< openings elsewhere
  double width() const;  ///< m
  /// More than half of it stands against a neighbour.
  bool is_covered() const { return covered > 0.5 * area; }
  /// Takes no part in `counted`, where it is the reference's: blank, or covered and without openings. (What has
  /// openings above a low neighbour was modelled and counts.)
  bool left_out() const { return blank || (is_covered() && openings.empty()); }
};

/// The facades of buildings that are compared as one (a block against several houses), largest first. Walls of faces
/// with another class than wall do not count, nor do closures.
///
/// An opening belongs to the facade whose plane is nearest to the middle of its polygons, among those that it is
/// parallel to (pair_angle), at most 0.6 m behind the rearmost place where the facade's walls may be, at most 1.5 m
/// before its plane (bays too narrow to be facades), and whose extent its middle lies in (0.3 m margin). All polygons
/// of an opening (frame, panes, reveals) are one opening. Openings whose rectangles have an IoU above 0.9 are one (a
/// leaf drawn as a window in its window); the larger stays, as a door if one is. Openings without a facade near them
/// (in roofs and dormers, on curved walls in narrow pieces, in niches, or without an area) are in none; `loose` counts
/// them.
///
/// Heights are above `zero` (z in m), which is one for all buildings: on a slope the houses of a block have grounds of
/// their own, and the block has one.
///
/// Neither the order of buildings, faces and openings nor the way in which walls are cut into polygons matters.
/// Cost: O(pieces x planes) for walls, for openings O(openings x facades) plus a sweep over each one's polygons.
std::vector<Facade> facades_of(const City& city, std::span<const std::uint32_t> buildings, double zero,
                               const FacadeOptions& options = {}, std::size_t* loose = nullptr);

/// Marks the faces of blank facades LeftOut::blank: the groups are the reference's sides of the matches. Faces that are
/// left out for another reason keep it.
///
/// A facade is blank when it has no opening, is at least blank_width wide and no more than half covered, while another
/// facade of the same group has openings. So courtyard sides that a survey from the street did not see are left out,
/// and likewise fire walls that really have no window where no neighbour of the same model covers them: from geometry
/// alone the two cannot be told apart. \return how many facades are blank
std::size_t mark_blank(City& reference, std::span<const std::vector<std::uint32_t>> groups,
                       const FacadeOptions& options = {});

/// Facades of both models that stand for each other, one to one. Facades without a partner make a pair with kNone.
struct FacadePair {
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  std::size_t model = kNone, reference = kNone;  ///< indices into the lists of facades; kNone: has no partner
  /// Openings that match at match_iou, one to one: (index into the model's openings, into the reference's), ascending.
  /// Both are seen in the direction half way between both facades (which are one plane's in most pairs), so that the
  /// model and the reference can be exchanged; heights above each side's zero.
  std::vector<std::pair<std::size_t, std::size_t>> matches;
  /// Takes no part in `counted`: the reference's facade is left_out(); or there is none and the model's is covered and
  /// without openings. (What stands where the reference has nothing is wrong, also in a yard.)
  bool left_out = false;
};
/// Pairs facades within pair_angle and pair_distance (across, in the middle of what they have in common) that have
/// pair_overlap of the narrower one's width and of the lower one's height in common. Best first: overlap over union of
/// both rectangles, times one minus half the distance over pair_distance. Openings likewise by their IoU. Equal ones by
/// place, so that neither the order nor which model is the reference matters.
/// \return every facade once: pairs by the reference's area, then the reference's facades without a partner, then the
///         model's, each by area
std::vector<FacadePair> pair_facades(std::span<const Facade> model, std::span<const Facade> reference,
                                     const FacadeOptions& options = {});

/// Everything about the facades of one match.
struct FacadeComparison {
  std::vector<Facade> model, reference;
  std::vector<FacadePair> pairs;  ///< the reference's largest facade first, then facades without a partner
  std::size_t model_loose = 0, reference_loose = 0;  ///< openings that are in no facade, and in no measure
};
/// Requires marks of what is left out (Face::left_out). The zeros are the z (m) of both models that are one height.
FacadeComparison compare_facades(const City& model, std::span<const std::uint32_t> model_buildings, double model_zero,
                                 const City& reference, std::span<const std::uint32_t> reference_buildings,
                                 double reference_zero, const FacadeOptions& options = {});

/// Sets the measures of Scope::facades, none else.
///
/// - storeys_error: rows of openings that are storeys, of the facade with the most; where a side has no openings its
///   stated storeys; no value without both. Weight 1.
/// - axes_error: mean over pairs of facades whose reference has openings. Weight: their number. (The reference's
/// facades
///   without a partner are recall's business: that a facade is missing says nothing about its axes.)
/// - openings_ratio, window_to_wall_error: sums over the facades, those without a partner too.
/// - opening_precision, opening_recall: shares of all openings in facades. Weight: those.
/// - storey_pitch_error, axis_pitch_error: mean over pairs of facades that both have a pitch. Weight: their number.
///
/// `counted` leaves out pairs that are FacadePair::left_out. `all` takes all. `left_out` is the share of the area of
/// the reference's facades that is left out. No value where the reference's facades that take part have no openings at
/// all (but storeys). A model without openings against a reference with some has recall 0, ratio 0 and no precision.
/// Openings in no facade take no part.
void measure_facades(const FacadeComparison& facades, const City& model, std::span<const std::uint32_t> model_buildings,
                     const City& reference, std::span<const std::uint32_t> reference_buildings, MeasureValues& values);

}  // namespace blockrand::compare
