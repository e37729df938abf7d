// A side of a match as a body: its plan, heights, volume, roof, classes and soundness.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/compare/city.h"
#include "pipeline/compare/comparison.h"
#include "pipeline/geometry/plan_shape.h"

namespace blockrand::compare {

/// All but left-out areas, pitch and roof form.
SideFacts side_facts(const City& city, std::span<const std::uint32_t> buildings);

/// Footprints together, as measured by GEOS.
geometry::PlanShape plan_of(const City& city, std::span<const std::uint32_t> buildings);

/// Volume in m³ that a building's outer shells enclose, voids taken off. Where there are none, or one is open (walls
/// with holes for windows that are no part of the solid): that its faces enclose, where their area vectors cancel as
/// those of a closed surface do (to 0.1 % of the area), with the openings or without. Nothing where neither holds.
std::optional<double> volume_of(const Building& building);

/// Why a shell is no valid solid (ISO 19107 code and name), empty when it is. Points nearer than 1/1024 m are one, as
/// in val3dity with its usual snapping tolerance of 1 mm.
std::string shell_defect(const Shell& shell);

/// Roof forms of both sides, told from the planes above the same points of a grid within both footprints, and their
/// mean pitches. Flat: less than a fifth of the points slope by 5 degrees or more. Mansard: two main directions with
/// two pitches each. Shed: one direction. Gabled: two opposite ones (to 30 degrees). Hipped: three or four, of which
/// each has its opposite or stands square to the others. Complex: all else.
void tell_roofs(const City& model, SideFacts& model_side, const City& reference, SideFacts& reference_side);

/// Sets the measures of Scope::plan and Scope::body and the semantic ones from both sides.
/// \param absolute  both models' heights are absolute: sets base_error
void measure_bodies(const City& model, const SideFacts& model_side, const City& reference,
                    const SideFacts& reference_side, bool absolute, MeasureValues& values);

}  // namespace blockrand::compare
