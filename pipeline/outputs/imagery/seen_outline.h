// What aerial images show of a building, as every output tells it.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "pipeline/footprints/footprint_store.h"
#include "pipeline/geometry/box_index.h"
#include "pipeline/observation/imagery.h"

namespace blockrand::outputs {

/// A building's receipt and the image that it is from; both outlive this.
struct SeenOutline {
  const observation::OutlineReceipt& receipt;
  const observation::ImageReceipt& image;
  bool applied = false;                                      ///< what is corrected stands where the image shows it
  geometry::PlanBox box{};                                   ///< m in the build CRS: of its outline as it stands
  std::span<const observation::CourtyardView> courtyards{};  ///< holes of its outline

  /// "moved" or "seen_elsewhere"; "reshaped" or "seen_reshaped" where its walls alone are; "as_mapped", "undecided", "refused".
  std::string_view state() const;
  /// What is surely seen in its courtyards: perhaps built over if one is; nothing where none is sure.
  std::optional<observation::CourtyardView> told_courtyard() const;
  bool walls_shifted() const { return receipt.refined.state == observation::RefinementState::refined; }
};

/// Receipts by building; nothing for one that no image shows. May be empty: no images.
using SeenOutlines = std::function<std::optional<SeenOutline>(model::OsmId)>;

/// \param observations, footprints  outlive the result; null: no images
SeenOutlines seen_outlines(const observation::ImageryObservations* observations,
                           const footprints::FootprintStore& footprints);

/// Attributes of a building in any format. Shifts in m east and north, `imagery_rotation` in degrees counter-clockwise,
/// `imagery_evidence` from 0 to 1 (score_outline), where it is mapped and where the image shows it.
using ImageryAttribute = std::pair<std::string_view, std::variant<double, std::string>>;
std::vector<ImageryAttribute> imagery_attributes(const SeenOutline& seen);

/// "moved 1.52 m to the NE as ortho.tif of 2023-06-18 shows it (confidence 0.86; ...)".
std::string imagery_text(const SeenOutline& seen);

}  // namespace blockrand::outputs
