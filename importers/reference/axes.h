// Which coordinate comes first: decided for a whole model. Internal to this folder.
#pragma once

#include "importers/reference/note_log.h"
#include "importers/reference/read_options.h"
#include "importers/reference/reference_model.h"

namespace blockrand::importers::reference {

/// A bounding box that grows; inside out while it is empty.
struct Box {
  model::Point3 lowest{kFar, kFar, kFar}, highest{-kFar, -kFar, -kFar};
  void add(const model::Point3& p);

 private:
  static constexpr double kFar = 1e300;
};

/// Of all outer rings.
Box box_of(const ReferenceModel& model);

/// Decides which coordinate comes first and turns the polygons' points to x east, y north where need be.
void settle_axes(ReferenceModel& model, const ReadOptions& options, NoteLog& notes);

}  // namespace blockrand::importers::reference
