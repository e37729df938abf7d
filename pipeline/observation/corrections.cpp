#include "pipeline/observation/corrections.h"

#include <algorithm>
#include <map>
#include <utility>

#include "pipeline/geometry/valid_polygon.h"

namespace blockrand::observation {

namespace {

using footprints::Movement;
using model::Polygon;

constexpr std::string_view kKept = "an override keeps it where it is mapped",
                           kInTheWay = "it would stand on a neighbour";

/// m2: more of two houses on each other is more than the rounding of their corners.
constexpr double kNewOverlap = 0.05;

void move(std::vector<Polygon>& polygons, const Movement& movement) {
  const auto ring = [&](model::Ring& r) {
    for (model::Point2& p : r.points) p = model::snap(movement(p));
  };
  for (Polygon& polygon : polygons) {
    ring(polygon.outer);
    for (model::Ring& hole : polygon.holes) ring(hole);
  }
}

class Refuser {
 public:
  Refuser(ImageryObservations& observations, const footprints::FootprintStore& store)
      : receipts_(observations.outlines), store_(store) {
    for (std::uint32_t b = 0; b < receipts_.size(); ++b)
      if (corrected(b)) rows_[receipts_[b].row].push_back(b);
  }

  void refuse(std::uint32_t row, std::string_view reason) {
    for (const std::uint32_t b : rows_[row]) {
      receipts_[b].state = RowState::refused, receipts_[b].reason = reason;
      // They were looked for where the row would have stood.
      refuse_walls(b, reason);
    }
  }

  void refuse_walls(std::uint32_t b, std::string_view reason) {
    RefinedOutline& refined = receipts_[b].refined;
    if (refined.state == RefinementState::refined) refined.state = RefinementState::refused, refined.reason = reason;
  }

  void refuse_kept(const std::function<bool(std::uint32_t)>& keeps) {
    for (const auto& [row, buildings] : rows_)
      if (std::ranges::any_of(buildings, keeps)) refuse(row, kKept);
    for (std::uint32_t b = 0; b < receipts_.size(); ++b)
      if (refined(b) && keeps(b)) refuse_walls(b, kKept);
  }

  void refuse_overlapping() {
    find_pairs();
    for (bool again = true; again;) {
      again = false;
      for (const auto& [a, b] : pairs_) {
        if (!corrected(a) && !corrected(b)) continue;
        if (!overlap(a, b)) continue;
        refuse(corrected(b) && (!corrected(a) || surer(a, b)) ? receipts_[b].row : receipts_[a].row, kInTheWay);
        again = true;
      }
    }
  }

  /// Once rows stand where they are to: of two that would lie more on each other by their shifted walls, the less sure one keeps
  /// them where they are.
  void refuse_overlapping_walls() {
    std::vector<geometry::PlanBox> boxes(store_.size());
    bool any = false;
    for (std::uint32_t b = 0; b < store_.size(); ++b) {
      if (store_[b].box.empty() || store_[b].settled != model::ObjectState::pending) continue;
      boxes[b] = store_[b].box;
      any = any || refined(b);
      if (!corrected(b) && !refined(b)) continue;
      for (const Polygon& polygon : at(b)) boxes[b].include(geometry::box_of(polygon.outer.points));
      for (const Polygon& polygon : in_row(b)) boxes[b].include(geometry::box_of(polygon.outer.points));
    }
    if (!any) return;
    const auto pairs = geometry::BoxIndex(std::move(boxes)).pairs(0);
    for (bool again = true; again;) {
      again = false;
      for (const auto& [a, b] : pairs) {
        if (!refined(a) && !refined(b)) continue;
        if (geometry::common_area(at(a), at(b)) <= geometry::common_area(in_row(a), in_row(b)) + kNewOverlap) continue;
        const bool first =
            refined(a) && (!refined(b) || receipts_[a].refined.confidence < receipts_[b].refined.confidence);
        refuse_walls(first ? a : b, kInTheWay);
        again = true;
      }
    }
  }

 private:
  bool refined(std::uint32_t b) const { return receipts_[b].refined.state == RefinementState::refined; }
  bool corrected(std::uint32_t b) const { return receipts_[b].state == RowState::corrected; }
  bool surer(std::uint32_t a, std::uint32_t b) const {
    return receipts_[a].confidence > receipts_[b].confidence ||
           (receipts_[a].confidence == receipts_[b].confidence && receipts_[a].row < receipts_[b].row);
  }

  /// Buildings of different rows, one of which at least is to move, that come near each other before or after.
  void find_pairs() {
    std::vector<geometry::PlanBox> boxes(store_.size());
    for (std::uint32_t b = 0; b < store_.size(); ++b) {
      if (store_[b].box.empty() || store_[b].settled != model::ObjectState::pending) continue;
      boxes[b] = store_[b].box;
      if (corrected(b))
        for (const Polygon& polygon : in_row(b)) boxes[b].include(geometry::box_of(polygon.outer.points));
    }
    for (const auto& pair : geometry::BoxIndex(std::move(boxes)).pairs(0)) {
      const auto [a, b] = pair;
      if (!corrected(a) && !corrected(b)) continue;
      if (corrected(a) && corrected(b) && receipts_[a].row == receipts_[b].row) continue;
      pairs_.push_back(pair);
    }
  }

  /// Where a building stands by what is decided so far: of its row, and of its walls.
  std::vector<Polygon> in_row(std::uint32_t b) const {
    std::vector<Polygon> polygons = store_.polygons(b);
    if (corrected(b)) move(polygons, {receipts_[b].shift, receipts_[b].centre, receipts_[b].turn});
    return polygons;
  }
  std::vector<Polygon> at(std::uint32_t b) const {
    std::vector<Polygon> polygons = store_.polygons(b);
    if (corrected(b) || refined(b)) move(polygons, movement_of(receipts_[b]));
    return polygons;
  }

  /// More of the two lies on each other than did.
  bool overlap(std::uint32_t a, std::uint32_t b) const {
    const double after = geometry::common_area(in_row(a), in_row(b));
    const double allowed = kOverlapShare * std::min(store_[a].record.area, store_[b].record.area);
    return after > allowed && after > allowed + geometry::common_area(store_.polygons(a), store_.polygons(b));
  }

  std::vector<OutlineReceipt>& receipts_;
  const footprints::FootprintStore& store_;
  std::map<std::uint32_t, std::vector<std::uint32_t>> rows_;  ///< the corrected ones
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs_;
};

}  // namespace

void refuse_corrections(ImageryObservations& observations, const footprints::FootprintStore& footprints,
                        const std::function<bool(std::uint32_t)>& keeps) {
  Refuser refuser(observations, footprints);
  refuser.refuse_kept(keeps);
  refuser.refuse_overlapping();
  refuser.refuse_overlapping_walls();
}

Movement movement_of(const OutlineReceipt& receipt) {
  Movement movement;
  if (receipt.state == RowState::corrected) movement = {receipt.shift, receipt.centre, receipt.turn};
  if (receipt.refined.state == RefinementState::refined) movement.reshape = {receipt.refined.from, receipt.refined.to};
  return movement;
}

std::vector<footprints::MovedBuilding> movements(const ImageryObservations& observations,
                                                 const footprints::FootprintStore& footprints) {
  std::vector<footprints::MovedBuilding> out;
  const footprints::BuildingNumbers numbers(footprints);
  for (std::uint32_t b = 0; b < observations.outlines.size(); ++b) {
    std::uint32_t by = b;
    // Whom a settled one stands for may be settled itself.
    for (int step = 0; step < 4 && by != model::kNoIndex && footprints[by].settled != model::ObjectState::pending;
         ++step)
      by = numbers.find(footprints[by].related);
    if (by == model::kNoIndex) continue;
    const OutlineReceipt& receipt = observations.outlines[by];
    if (receipt.state == RowState::corrected || receipt.refined.state == RefinementState::refined)
      out.push_back({b, movement_of(receipt)});
  }
  return out;
}

}  // namespace blockrand::observation
