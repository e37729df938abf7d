// Aerial images in a build: looked at once the outlines are repaired, which then may move.
#pragma once

#include <optional>
#include <span>

#include "pipeline/base/progress.h"
#include "pipeline/footprints/repair_extract.h"
#include "pipeline/observation/imagery.h"
#include "pipeline/run/build_inputs.h"
#include "pipeline/run/documents.h"
#include "pipeline/run/prepare_extract.h"

namespace blockrand::run {

class ImageryStage {
 public:
  /// All references outlive this. Warns of images that show nothing of the extract.
  /// \throws base::InputError  there are images, and none of them shows any of it
  ImageryStage(const BuildOptions& options, const BuildInputs& inputs, LocatedExtract& located,
               base::Progress& progress);

  /// Compares the outlines with the images; of a tile alone takes what the build of the whole found. Moves what is to be
  /// moved in the extract. \returns  whether something was moved
  bool correct(std::span<const footprints::Shard> shards, const footprints::RepairedExtract& repaired);

  /// Null: no images.
  const observation::ImageryObservations* observations() const { return seen_ ? &*seen_ : nullptr; }
  /// Puts into the record what was found, and warns of images that do not fit.
  void tell(BuildRecord& record) const;

 private:
  void take_pinned(const footprints::FootprintStore& footprints);
  bool keeps_place(std::uint32_t building, const footprints::FootprintStore& footprints) const;

  const BuildOptions& options_;
  const BuildInputs& inputs_;
  LocatedExtract& located_;
  base::Progress& progress_;
  std::vector<std::vector<model::Point2>> kept_areas_;  ///< in which a user keeps all buildings where they are mapped
  std::optional<observation::ImageryObservations> seen_;
};

}  // namespace blockrand::run
