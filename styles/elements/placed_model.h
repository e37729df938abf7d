// Elements that come from a model: glTF triangles, placed and stretched. Internal to this folder.
#pragma once

#include "styles/elements/element_catalogue.h"
#include "styles/elements/element_piece.h"

namespace blockrand::elements {

/// A model in the element's frame at its natural size.
struct PlacedModel {
  struct Triangle {
    std::array<model::Point3, 3> corners;
    Part part = Part::panel;
  };
  std::vector<Triangle> triangles;
  bool stretched = false;        ///< to the width and height that are asked for
  bool stands_at_reveal = true;  ///< anchored by its bounding box: in openings at the reveal's end
  double width = 0, height = 0;  ///< m, natural size
};

/// Reads `model`, `anchor`, `fit` and `parts` of an element file. \param folder  where the file lies
/// \param opening   of windows and doors
/// \param path      gets the model's path
/// \throws base::InputError
PlacedModel read_placed_model(base::TomlTable& table, const std::string& folder, bool opening,
                              const ModelReader& reader, std::string& path);

/// Adds the triangles, on the grid; those that are nothing there are left out.
void add_model(MeshBuilder& builder, const PlacedModel& placed, const Request& request, double reveal);

}  // namespace blockrand::elements
