// How far an image shows roofs from their ground: everything but true orthophotos leans away from where the camera stood.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/model/point.h"
#include "pipeline/observation/outline_score.h"

namespace blockrand::observation {

/// A displacement at which an image shows an outline well.
struct Sighting {
  model::Point2 at;  ///< m
  double weight = 0;
};
inline constexpr std::size_t kMostSightings = 6;

/// What an image shows of one building before its lean is known.
struct SightedOutline {
  model::Point2 place;  ///< m
  double height = 0;    ///< m, of the eaves
  bool guessed = true;  ///< nobody tagged it
  double weight = 1;    ///< less in a row: houses that were drawn together are off together
  std::uint32_t row = 0;
  std::array<Sighting, kMostSightings> sightings;  ///< weights sum to 1, or all 0: not seen
};

/// The best displacements of a map, with weights by how far they stand out.
std::array<Sighting, kMostSightings> sightings_of(const ScoreMap& map);

/// Where an image shows roofs, compared with the map.
///
/// Perspective: a roof of height h at the place c lies h * (c - n) / H from its ground, n being the place under the camera
/// and H the height of the flight (Kraus, Photogrammetrie, 2004, "Orthophoto"). A mosaic has one n for each of its
/// pictures, so the lean is k(c) = k + (c - node) / H with a k for each node of a fixed grid, found by vote: of all
/// outlines within 150 m as many as possible must be where it says. Where the votes are for one shift of all roofs, high or
/// low, the image is shifted and does not lean. Where it leans, one shift of the whole image is looked for: that with which
/// the votes of low and high roofs are for the same lean.
class LeanField {
 public:
  LeanField() = default;
  /// \param outlines  all of the image
  /// \param workers  threads; the same field for any number
  explicit LeanField(std::span<const SightedOutline> outlines, int workers = 1);

  /// m: how far the image shows the roof of a building from the map; nothing where too few agree on it, (0, 0) where no
  /// place of the image says anything.
  std::optional<model::Point2> at(model::Point2 place, double height) const;
  /// m for each metre of height, without the image's shift; as at().
  std::optional<model::Point2> per_metre(model::Point2 place) const;
  /// m: how far the image shows all ground from where it is mapped, where its roofs lean as well; else (0, 0).
  model::Point2 shift() const { return found() && leans_ ? shift_ : model::Point2{}; }
  /// Something is known of some place.
  bool found() const { return !nodes_.empty(); }
  bool leans() const { return leans_ && !nodes_.empty(); }
  bool shifted() const { return !leans_ && !nodes_.empty(); }
  /// m, of the flight above ground; 0: none found.
  double flight_height() const { return curvature_ > 0 ? 1 / curvature_ : 0; }
  /// Of the outlines, by weight: that are where the field says.
  double support() const { return support_; }

 private:
  struct Node {
    std::pair<long long, long long> cell;
    model::Point2 k;
    double support = 0;
    friend auto operator<=>(const Node& a, const Node& b) { return a.cell <=> b.cell; }
    friend bool operator==(const Node& a, const Node& b) { return a.cell == b.cell; }
  };
  /// Of the nodes around a place: lean for each metre, or shift.
  std::optional<model::Point2> told(model::Point2 place) const;

  std::vector<Node> nodes_;  ///< sorted by cell
  model::Point2 shift_;
  bool leans_ = false;
  double curvature_ = 0, support_ = 0;
};

}  // namespace blockrand::observation
