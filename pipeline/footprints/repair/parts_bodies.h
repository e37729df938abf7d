// The parts of one building among themselves: walls shared, overlaps resolved.
#pragma once

#include <span>
#include <vector>

#include "pipeline/footprints/repair/options.h"
#include "pipeline/model/building.h"
#include "pipeline/model/region.h"
#include "pipeline/model/report.h"

namespace blockrand::repair {

/// From where to where a part stands, as far as its tags tell. Metres above the ground.
struct HeightSpan {
  double low = 0, high = 0;  ///< high may be infinite: unknown
  bool low_counted = false;  ///< from storeys, not from metres
  bool high_counted = false;
  bool slab = false;  ///< a roof without walls whose underside is unknown: only its own kind is in its way
};

/// What the tags of a part say, of `building` where the part says nothing: height, else storeys of 3 m each; without
/// any, infinite.
HeightSpan height_span(const model::MappedAttributes& part, bool canopy, const model::MappedAttributes& building);

/// True when both stand at some height together. Bounds of one kind (metres with metres, storeys with storeys) are
/// compared with a margin of 0.1 m, of different kinds with half a storey.
bool heights_meet(const HeightSpan& a, const HeightSpan& b);

/// A mapped part as polygons.
struct PartBody {
  std::size_t part = 0;  ///< index into Building::parts
  model::OsmId osm;
  HeightSpan heights;
  std::vector<model::Polygon> polygons;
};

/// Makes parts at one height that almost meet share their walls: corners of different parts within `snap_distance` and
/// within a third of their shortest walls become one point, their mean (a corner of the outline, where one of them is
/// that), nearest first; corners so near to a wall of another part go to its nearest point, which becomes a corner of
/// that wall. Only where all polygons stay strictly simple and keep their area to `max_area_change`: else the same is
/// tried with a quarter of the distance, else nothing is changed. Points that several parts have move together.
/// \return how many corners were joined to another part's corner or wall that did not have them before
int share_part_walls(std::vector<PartBody>& bodies, std::span<const model::Polygon> outline,
                     const RepairOptions& options);

/// What is left of a plan without `taken`. Pieces narrower than 0.3 m or smaller than 0.5 m² are drawing tolerance and
/// go; empty where there are only such. Nodes of both are kept.
std::vector<model::Polygon> plan_without(std::span<const model::Polygon> plan, std::span<const model::Polygon> taken,
                                         const RepairOptions& options);

/// False of slivers: polygons narrower than 0.3 m or smaller than 0.5 m².
bool worth_a_part(const model::Polygon& polygon);

/// Appends bodies that are pieces of one thing: a single one keeps the plain id, of several each gets a number.
void add_pieces(std::vector<model::BuildingPart>& parts, const model::BuildingPart& pattern,
                std::vector<model::Polygon> polygons);

/// Cuts the plans of parts that stand at one height apart, exactly: all rings are noded against each other on the
/// 1/1024 m grid (geometry::noded_edges), so that a corner on another part's wall becomes a corner of that wall; ground
/// that several plans cover goes to the smallest, of equal ones to that of the lower id. A slab yields to what reaches
/// through it. After it two such plans share points and walls or nothing. A part that others cover to the last and that
/// is nowhere known to be higher is settled: the one with most of its ground stands for it. One that is higher keeps its
/// plan. One whose rings would touch takes a wall's width from the others if they can give it, else it keeps its plan.
/// Rows PARTS_OVERLAP where a part loses more than 0.01 m².
/// \param building  its `parts` have plans
/// \param settled   gets the mapped parts that are represented by others
void separate_parts(model::Building& building, const RepairOptions& options, std::vector<model::SettledPart>& settled,
                    model::Report& report);

/// Resolves overlaps of more than `min_overlap_area` between parts at overlapping heights: in order of area (smaller
/// first), then id, each part loses what those before it cover (plan_without); a part of which nothing would be left
/// keeps its plan until separate_parts(). Where what is left would touch itself, those before it give a corner
/// (cut_corners). A PARTS_OVERLAP row each.
void resolve_part_overlaps(std::vector<PartBody>& bodies, const RepairOptions& options, model::Report& report);

}  // namespace blockrand::repair
