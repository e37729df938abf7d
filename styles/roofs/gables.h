// Ornamental gables: walls of the front that stand before the roof and hide it. docs/sources.md, Holtmeier 4.4, 4.5 and
// 5.2.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "pipeline/model/polygon.h"
#include "pipeline/model/roof_shape.h"
#include "styles/roofs/plan_cells.h"
#include "styles/roofs/roof.h"
#include "styles/roofs/roof_outline.h"

namespace blockrand::roofs {

enum class GableForm : std::uint8_t {
  stepped,  ///< Treppengiebel
  curved,   ///< Schweifgiebel
  attic,    ///< Attika: a level top, with or without a low pediment
};
constexpr std::string_view name(GableForm form) {
  constexpr std::string_view names[] = {"stepped", "curved", "attic"};
  return names[static_cast<int>(form)];
}

/// Measures of a gable.
struct GableOptions {
  GableForm form = GableForm::stepped;
  int steps = 4;                ///< 3 to 5, counted as levels with the middle one (docs/sources.md, Holtmeier 5.2).
  int curves = 1;               ///< 1 or 2 on each flank (docs/sources.md, Holtmeier 5.2).
  int segments = 9;             ///< pieces of each Bezier curve (docs/sources.md, Holtmeier 4.4).
  double overtop = 0.30;        ///< m above what it hides, everywhere (docs/sources.md, Holtmeier HD9).
  double thickness = 0.30;      ///< m, inwards from the wall's face: one and a quarter bricks, as firewalls [P].
  double attic_height = 0.90;   ///< m above the eaves: 0.6 to 1.4 (docs/style_measures.md 2.5, S24).
  double pediment = 0;          ///< share of the width that a triangle on the attic takes; 0 for none
  double pediment_rise = 0.20;  ///< of the triangle, height over width: low, 22 degrees [P].
  double least_tread = 0.10;    ///< m. Steps narrower than that are none.
};

/// A point in the plane of a wall: metres along its edge from the edge's start, and z.
struct OutlinePoint {
  double along = 0, height = 0;
  friend bool operator==(const OutlinePoint&, const OutlinePoint&) = default;
};

/// What is seen of a roof from before a plan edge, of as much of it as lies straight behind the edge, at most `depth`
/// metres: the upper outline, from 0 to the edge's length.
std::vector<OutlinePoint> roof_silhouette(const Roof& roof, const PlanEdge& edge, double depth);

/// The upper outline of a stepped or curved gable that overtops a silhouette everywhere.
///
/// Levels lie at equal heights between the eaves + overtop and the top + overtop; each reaches as far in as it overtops
/// the roof, but at most width / (2 levels - 1), so that the middle one is at least as wide as every other. On a plain
/// gable that makes the treads width / (2 levels), Holtmeier's formula (4.5) with the overtop put under the first step:
/// his own touches the roof at every inner corner. Curves round each step by two quadratic Bezier curves (4.4). \param
/// lead_in, lead_out  m that stay level at both ends Empty where a tread becomes narrower than `least_tread`, and for
/// counts out of range.
std::optional<std::vector<OutlinePoint>> gable_outline(std::span<const OutlinePoint> silhouette, double lead_in,
                                                       double lead_out, const GableOptions& options);

/// Why there is no gable.
enum class GableRefusal : std::uint8_t {
  none,
  form,     ///< the outline does not fit this roof
  no_room,  ///< the plan behind the edge is thinner than the gable, or bent so that it would leave it
  no_body,  ///< steps in the roof right behind, or the solid failed its check
};

struct BuiltGable {
  std::optional<model::RoofInstallation> body;
  GableRefusal refusal = GableRefusal::none;
  std::vector<OutlinePoint> outline;
  std::vector<model::Point2> place;  ///< the piece of plan it stands on, counter-clockwise
};

/// A gable on a plan edge: its front is the wall's continuation, it stands on the roof's surface, `thickness` deep.
/// Stepped and curved ones hide all of the roof straight behind, as deep as they are wide; an attic overtops the roof
/// under it.
BuiltGable ornamental_gable(const model::Polygon& plan, const Roof& roof, std::uint32_t edge,
                            const GableOptions& options);

// ---- which gable

/// May such a gable stand before such a roof? Stepped and curved ones before gables, half-hips and mansards, which they
/// hide; attics before hips and flat roofs alone (docs/sources.md, Holtmeier 5.2).
bool may_stand_before(GableForm form, model::RoofShape roof);

}  // namespace blockrand::roofs
