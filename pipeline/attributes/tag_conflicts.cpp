#include "pipeline/attributes/tag_conflicts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pipeline/base/portable_math.h"
#include "pipeline/geometry/polygon_measures.h"

namespace blockrand::attributes {

using model::IssueCode;
using model::MappedAttributes;
using model::Polygon;
using model::RoofOrientation;
using model::RoofShape;

namespace {

// Two heights contradict each other when they differ by more than both: mappers estimate, storeys differ, and eaves
// hang over.
constexpr double kApart = 0.5;        ///< m
constexpr double kApartShare = 0.25;  ///< of the larger one
constexpr double kRoughShare = 0.5;   ///< the same where the plan tells the run of the slope only roughly
/// m. On a flat roof, roof:height up to this is the parapet: balustrades are 0.9 to 1.1 m high.
constexpr double kParapet = 1.2;
constexpr double kFlatPitch = 10;        ///< degrees. Flat roofs drain; the German rules for them end here.
constexpr double kLowestRoofStorey = 1;  ///< m of roof per storey in it: the rest stands behind knee walls
/// m from floor to floor. Parking decks measure 2.3; lower storeys are a slip in one of the tags.
constexpr double kLeastStorey = 1.9;
/// Ratio of a plan's sides. On rounder plans, along and across are a matter of taste.
constexpr double kOblong = 1.25;
/// Cosine of 30 degrees: a direction nearer to a side than this falls along it.
constexpr double kAlong = 0.86602540378443865;

bool apart(double a, double b, double share) {
  return std::fabs(a - b) > kApart && std::fabs(a - b) > share * std::max(a, b);
}

/// Straight slopes up to an apex, as towers have: they may be steeper than others. What is vaulted on plans without an
/// apex is a dome.
bool is_pointed(RoofShape shape) {
  if (const auto* crossed = model::constructed_as<model::CrossedRoof>(shape)) return crossed->gable_height < 1;
  const auto* rings = model::constructed_as<model::ApexRoof>(shape);
  return rings && model::rises_from_edges(rings->relative);
}

/// Both ends of a wing are alike: no direction is needed to tell one from the other.
bool ends_are_alike(model::WingEnds ends) {
  switch (ends) {
    case model::WingEnds::hips:
    case model::WingEnds::gables:
    case model::WingEnds::half_hips:
    case model::WingEnds::gablets:
      return true;
    case model::WingEnds::one_hip:
    case model::WingEnds::one_half_hip:
      break;
  }
  return false;
}

/// Roofs with a ridge across which they fall, so that direction and orientation speak of one thing. Those of saltboxes
/// are decks, or lie to one side.
bool falls_across_ridge(RoofShape shape) {
  const auto* edges = model::constructed_as<model::EdgeRoof>(shape);
  return edges && ends_are_alike(edges->ends) && model::traits(shape).group != model::RoofGroup::saltbox;
}

std::string shape_text(RoofShape shape) { return "roof:shape=" + std::string(model::name(shape)); }

class Finder {
 public:
  Finder(const MappedAttributes& tags, const TaggedRoof& roof)
      : tags_(tags),
        shape_(roof.shape),
        plan_(roof.plan),
        edges_(roof.edges),
        storey_height_(roof.storey_height),
        ridges_(roof.ridges),
        plain_(roof.plan.outer.size() >= 3 && roofs::has_plain_extents(roof.plan)) {}

  std::vector<TagConflict> find() {
    if (tags_.roof_shape == RoofShape::flat) {
      flat();
    } else if (shape_ != RoofShape::flat) {
      empty_values();
      heights();
      directions();
    }
    storeys();
    return std::move(out_);
  }

 private:
  template <class... Args>
  void note(fmt::format_string<Args...> format, Args&&... args) {
    out_.push_back({IssueCode::values_conflict, fmt::format(format, std::forward<Args>(args)...)});
  }

  void flat() {
    if (tags_.roof_height && *tags_.roof_height > kParapet)
      note("roof:height={:g} against roof:shape=flat, which has no height: the shape won", *tags_.roof_height);
    if (tags_.roof_angle && *tags_.roof_angle > kFlatPitch)
      note("roof:angle={:g} against roof:shape=flat: the shape won", *tags_.roof_angle);
    if (ridges_) note("mapped ridges against roof:shape=flat: the shape won");
  }

  void empty_values() {
    if (!tags_.roof_shape) return;
    if (tags_.roof_height && *tags_.roof_height < kNoRoofHeight)
      note("roof:height={:g} against {}: the shape won", *tags_.roof_height, shape_text(shape_));
    if (tags_.roof_angle && *tags_.roof_angle < kNoRoofAngle)
      note("roof:angle={:g} against {}: the shape won", *tags_.roof_angle, shape_text(shape_));
  }

  void heights() {
    const auto height = useful_roof_height(tags_, shape_);
    if (tags_.roof_angle) {
      const double limit = is_pointed(shape_) ? kSteepestSpire : kSteepestRoof;
      if (*tags_.roof_angle > limit)
        out_.push_back(
            {IssueCode::value_clamped, fmt::format("roof:angle={:g}, limited to {:g}", *tags_.roof_angle, limit)});
    }
    // What an angle means hangs on the shape, which must not be a guess.
    std::optional<double> from_angle;
    if (tags_.roof_shape && model::traits(shape_).one_pitch) from_angle = height_of_angle(tags_, shape_, plan_, edges_);
    const double share = plain_ ? kApartShare : kRoughShare;
    if (height && from_angle && apart(*height, *from_angle, share))
      note("roof:height={:g} against roof:angle={:g}, which gives {:.1f} m: roof:height won", *height,
           *tags_.roof_angle, *from_angle);

    const double inner = tags_.roof_storeys.value_or(0) * kLowestRoofStorey;
    if (height && *height < inner)
      note("roof:height={:g} has no room for roof:levels={:g}: roof:height won", *height, *tags_.roof_storeys);
    else if (!height && from_angle && share == kApartShare && *from_angle < inner &&
             apart(*from_angle, inner, kApartShare))
      note("roof:angle={:g} gives {:.1f} m, no room for roof:levels={:g}: roof:angle won", *tags_.roof_angle,
           *from_angle, *tags_.roof_storeys);

    if (!tags_.height) return;
    const double whole = *tags_.height - tags_.min_height.value_or(0);
    if (whole <= 0) return;  // reported below
    if (height && *height > whole + kNoRoofHeight)
      note("roof:height={:g} against height={:g}{}: height won", *height, *tags_.height, above_minimum());
    const double limit = roof_limit(tags_, *tags_.height);
    if (!height && from_angle && *from_angle > limit && apart(*from_angle, limit, share))
      note("roof:angle={:g} gives {:.1f} m, height={:g}{} leaves {:.1f} m: height won", *tags_.roof_angle, *from_angle,
           *tags_.height, tags_.storeys ? fmt::format(" with building:levels={:g}", *tags_.storeys) : above_minimum(),
           limit);
  }

  std::string above_minimum() const {
    return tags_.min_height && *tags_.min_height > 0 ? fmt::format(" above min_height={:g}", *tags_.min_height)
                                                     : std::string();
  }

  void directions() {
    if (!tags_.roof_direction || !tags_.roof_orientation || !falls_across_ridge(shape_) || !plain_) return;
    const model::Point2 axis = geometry::long_axis(plan_.outer.points);
    const auto extent = [&](model::Point2 d) {
      const geometry::Extent e = geometry::extent_along(plan_.outer.points, d);
      return e.maximum - e.minimum;
    };
    if (extent(axis) < kOblong * extent({-axis.y, axis.x})) return;
    const model::Point2 down = roofs::compass_vector(*tags_.roof_direction);
    const bool falls_along = std::fabs(down.x * axis.x + down.y * axis.y) > kAlong;
    const bool falls_across = std::fabs(down.x * axis.y - down.y * axis.x) > kAlong;
    const bool ridge_along = *tags_.roof_orientation == RoofOrientation::along;
    if (falls_along && ridge_along)
      note("roof:direction={:g} falls along the longer side against roof:orientation=along: roof:direction won",
           *tags_.roof_direction);
    if (falls_across && !ridge_along)
      note("roof:direction={:g} falls across the longer side against roof:orientation=across: roof:direction won",
           *tags_.roof_direction);
  }

  void storeys() {
    if (storeys_below(tags_, storey_height_) > 0)
      note("building:levels={:g} ends below {}: taken for the part's own storeys", *tags_.storeys,
           tags_.min_height ? fmt::format("min_height={:g}", *tags_.min_height)
                            : fmt::format("building:min_level={:g}", *tags_.min_storey));
    if (tags_.height && tags_.min_height && *tags_.min_height > 0 && *tags_.min_height >= *tags_.height) {
      note("min_height={:g} against height={:g}: height won", *tags_.min_height, *tags_.height);
      return;
    }
    if (!tags_.height || !tags_.storeys || *tags_.storeys < 2) return;  // one storey may be a low shed
    double roof = 0;
    std::string with;
    if (shape_ != RoofShape::flat) {
      if (const auto height = useful_roof_height(tags_, shape_)) {
        roof = *height;
        with = fmt::format(" and roof:height={:g}", roof);
      } else if (tags_.roof_storeys && *tags_.roof_storeys > 0) {
        roof = *tags_.roof_storeys * kLowestRoofStorey;
        with = fmt::format(" and roof:levels={:g}", *tags_.roof_storeys);
      }
    }
    const double each = (*tags_.height - roof) / *tags_.storeys;
    if (each >= kLeastStorey || roof > *tags_.height) return;
    note("height={:g}{} against building:levels={:g}, {:.1f} m each: height won", *tags_.height, with, *tags_.storeys,
         each);
  }

  const MappedAttributes& tags_;
  const RoofShape shape_;
  const Polygon& plan_;
  const std::vector<model::RoofEdge>& edges_;
  const double storey_height_;
  const bool ridges_;
  const bool plain_;  ///< the plan tells how far slopes run
  std::vector<TagConflict> out_;
};

}  // namespace

std::optional<double> useful_roof_height(const MappedAttributes& tags, RoofShape shape) {
  if (!tags.roof_height || shape == RoofShape::flat || *tags.roof_height < kNoRoofHeight) return std::nullopt;
  return *tags.roof_height;
}

std::optional<double> useful_roof_angle(const MappedAttributes& tags, RoofShape shape) {
  if (!tags.roof_angle || shape == RoofShape::flat || *tags.roof_angle < kNoRoofAngle) return std::nullopt;
  return std::min<double>(*tags.roof_angle, is_pointed(shape) ? kSteepestSpire : kSteepestRoof);
}

roofs::RoofRequest tagged_request(const MappedAttributes& tags, RoofShape shape,
                                  const std::vector<model::RoofEdge>& edges) {
  roofs::RoofRequest request;
  request.shape = shape;
  request.edges = edges;
  request.along_eaves_lines = true;
  request.shape_is_mapped = tags.roof_shape.has_value();
  request.axis_is_mapped = tags.roof_direction || tags.roof_orientation;
  if (tags.roof_direction) request.down = roofs::compass_vector(*tags.roof_direction);
  request.across = tags.roof_orientation == RoofOrientation::across;
  request.side_pitches = tags.side_pitches;
  request.other_sides_pitch = useful_roof_angle(tags, shape).value_or(0);
  return request;
}

std::optional<double> height_of_angle(const MappedAttributes& tags, RoofShape shape, const Polygon& plan,
                                      const std::vector<model::RoofEdge>& edges) {
  const auto angle = useful_roof_angle(tags, shape);
  if (!angle || plan.outer.size() < 3) return std::nullopt;
  constexpr double kSteepSlope = 55;  // degrees: a broken roof's pitch beyond is that of its lower slope
  const roofs::MainSlope slope = roofs::main_slope(plan, tagged_request(tags, shape, edges), *angle > kSteepSlope);
  return slope.run * base::tan(*angle * base::kRadiansPerDegree) / slope.rise;
}

double storeys_below(const MappedAttributes& tags, double storey_height) {
  if (tags.height || !tags.storeys || *tags.storeys <= 0) return 0;
  double below = 0;
  if (tags.min_height)
    below = std::floor(*tags.min_height / storey_height + 0.5);
  else if (tags.min_storey)
    below = *tags.min_storey;
  return below >= *tags.storeys ? below : 0;
}

std::vector<TagConflict> tag_conflicts(const MappedAttributes& tags, const TaggedRoof& roof) {
  return Finder(tags, roof).find();
}

double roof_limit(const MappedAttributes& tags, double height) {
  const double whole = std::max(height - tags.min_height.value_or(0), 0.0);
  if (!tags.storeys || *tags.storeys <= 0) return whole;
  return std::clamp(height - *tags.storeys * kLowestStorey, 0.1 * whole, whole);
}

}  // namespace blockrand::attributes
