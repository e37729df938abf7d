// Roof tags that contradict each other. docs/roofs.md, "Tags", states which one wins and what is no contradiction.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pipeline/model/extract.h"
#include "pipeline/model/polygon.h"
#include "styles/roofs/roof.h"

namespace blockrand::attributes {

/// A roof as low as this is none: roof:height=0 on a gabled roof is a value that nobody measured. m
inline constexpr double kNoRoofHeight = 0.1;
/// roof:angle below this is none, either. Degrees
inline constexpr double kNoRoofAngle = 1;
/// m. No inhabited storey is lower; a roof gives way before its storeys do.
inline constexpr double kLowestStorey = 2.2;
/// Degrees. Steeper roofs are limited to this; those around an apex are spires, which may be steeper.
inline constexpr double kSteepestRoof = 80, kSteepestSpire = 86;

/// roof:height where it says something about a roof of this shape, m.
std::optional<double> useful_roof_height(const model::MappedAttributes& tags, model::RoofShape shape);
/// roof:angle where it says something about a roof of this shape, limited to what stands. Degrees
std::optional<double> useful_roof_angle(const model::MappedAttributes& tags, model::RoofShape shape);

/// What is asked of the roof by tags and the row. \param edges  of the plan, or none (RoofRequest::edges)
roofs::RoofRequest tagged_request(const model::MappedAttributes& tags, model::RoofShape shape,
                                  const std::vector<model::RoofEdge>& edges = {});

/// The height that roof:angle gives over the main slope, m; empty without a useful angle or on plans without area.
std::optional<double> height_of_angle(const model::MappedAttributes& tags, model::RoofShape shape,
                                      const model::Polygon& plan, const std::vector<model::RoofEdge>& edges = {});

/// What the tags' height allows for a roof whose height comes from its angle: less than all, and space for the storeys.
double roof_limit(const model::MappedAttributes& tags, double height);

struct TagConflict {
  model::IssueCode code = model::IssueCode::values_conflict;
  std::string text;  ///< both values and which of them won
};

/// The scheme counts storeys from the ground. Where building:levels ends at or below building:min_level or min_height
/// and no height is tagged, the mapper has counted the part's own: the number of storeys that lie below them; 0
/// otherwise. \param storey_height  m
double storeys_below(const model::MappedAttributes& tags, double storey_height);

inline const std::vector<model::RoofEdge> kNoRoofEdges;

/// What tags are held against.
struct TaggedRoof {
  model::RoofShape shape = model::RoofShape::flat;  ///< that is asked for
  const model::Polygon& plan;
  double storey_height = 3;                                  ///< m
  bool ridges = false;                                       ///< roof:ridge ways lie on the plan
  const std::vector<model::RoofEdge>& edges = kNoRoofEdges;  ///< of the plan
};

/// The contradictions among one object's tags, each once, in a fixed order.
std::vector<TagConflict> tag_conflicts(const model::MappedAttributes& tags, const TaggedRoof& roof);

}  // namespace blockrand::attributes
