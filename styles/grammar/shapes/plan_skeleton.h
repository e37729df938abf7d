// Faces swept by the edges of a face moving inwards: what roofs, offsets and setbacks have in common.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "pipeline/geometry/weighted_skeleton.h"
#include "styles/grammar/shapes/flat_face.h"

namespace blockrand::grammar {

/// One face of what is swept; loops into SweptPlan::points. The first loop of faces that rise from an edge starts with
/// that edge, if it is still there.
struct SweptFace {
  static constexpr std::int32_t kDeck = -1;
  std::int32_t edge = kDeck;  ///< which corner of FlatFace it rises from; kDeck
  bool upright = false;
  std::vector<std::vector<std::uint32_t>> loops;
};

struct SweptPlan {
  /// In the plane of the FlatFace: x, y and height in z, metres. The first ones are its corners, exactly.
  std::vector<Vector3> points;
  std::vector<SweptFace> faces;
  double height() const;
};

/// \param slopes  rise over run, by corner of the face (the edge that starts there); geometry::kUpright for edges that
/// stay \param deck    metres: where everything stops; none by default
std::optional<SweptPlan> sweep_plan(const FlatFace& face, std::span<const double> slopes,
                                    std::optional<double> deck = {});

/// As above with whole profiles; heights in metres.
std::optional<SweptPlan> sweep_plan(const FlatFace& face, std::vector<geometry::EdgeProfile> profiles,
                                    std::optional<double> deck = {});

/// The face with every edge moved outwards by its distance (metres; negative ones inwards) with its corners mitred;
/// nothing when the result would cross itself. Corners keep their numbers.
std::optional<FlatFace> expanded(const FlatFace& face, std::span<const double> distances);

/// Edges by corner: where each begins and ends among the corners, ring by ring.
std::vector<std::pair<std::uint32_t, std::uint32_t>> edges_of(const FlatFace& face);

}  // namespace blockrand::grammar
