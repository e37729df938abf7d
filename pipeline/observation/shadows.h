// Shadows of buildings in an image: where its sun stands, and how high the edges are that cast them.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/geometry/box_index.h"
#include "pipeline/observation/outline_score.h"

namespace blockrand::observation {

/// How bright a patch is, without the blue of the sky, which lights the shadows: one number a pixel, levels of 255; no
/// number where the image has none.
struct Brightness {
  Brightness(const Patch& patch);        // NOLINT(google-explicit-constructor): any patch is one
  double west = 0, north = 0, size = 0;  ///< as Patch has them
  int width = 0, height = 0;
  std::vector<float> values;  ///< width * height
};

/// What lies beside the walls of all houses of an image: where it is brighter than around the rest of its house, there is
/// the sun. Sums in a fixed order make it deterministic.
class SunnySides {
 public:
  /// \param pieces  walls of one house, outward normal (along.y, -along.x)
  /// \param roof    m: how far the image shows them from where they are mapped
  void add(std::span<const WallPiece> pieces, const Brightness& patch, model::Point2 roof);
  void add(const SunnySides& other);
  /// Unit vector towards the sun; nothing where houses do not agree.
  std::optional<model::Point2> to_sun() const;

 private:
  model::Point2 sum_;
  double weight_ = 0;
  std::uint64_t houses_ = 0;
};

/// m between the lengths at which a shadow may end, and the longest one.
inline constexpr double kShadowStep = 0.25, kLongestShadow = 60;

/// Where the ground behind a house turns from dark to bright.
struct ShadowScan {
  std::vector<float>
      step;  ///< by length in steps of kShadowStep: change of brightness there, by the brightness; 0 at first
  std::vector<float> sharp;  ///< the same, however strong
  std::vector<float> walls;  ///< m of wall that speak, as many
  double weight = 0;         ///< m of wall that cast a shadow
};

/// The length of a house's shadow.
struct ShadowLength {
  double length = 0;     ///< m, from where the image shows the roof's edge to where it shows the shadow's
  double step = 0;       ///< ShadowScan there
  double second = 0;     ///< the best one that is another edge
  double walls = 0;      ///< m of wall that speak there
  double clearness = 0;  ///< `step` less half of `second`, less what an unusual length costs
};

/// Other houses near one: a shadow that reaches one of them ends there for another reason.
struct Obstacles {
  geometry::PlanBox box;
  std::vector<std::vector<model::Point2>> rings;  ///< where the image shows them
};

/// Scans along one direction. \param roof  m: how far the image shows the walls' upper edges from `pieces`
/// \param away  unit vector: where the image shows the shadow of an edge from the edge itself
ShadowScan scan_shadow(std::span<const WallPiece> pieces, const Brightness& patch, model::Point2 roof,
                       model::Point2 away, std::span<const Obstacles> others, double reach);

/// The clearest end of a shadow between two lengths; nothing where no wall shows one. \param usual  m: length that is
/// likely before anything is seen; 0: nobody knows
std::optional<ShadowLength> shadow_length(const ShadowScan& scan, double least, double most, double usual);

}  // namespace blockrand::observation
