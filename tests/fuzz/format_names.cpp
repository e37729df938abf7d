// Formats by name alone: options ask for nothing else, and the writers would take as long to compile as all readers.
#include "pipeline/outputs/output.h"

namespace blockrand::outputs {

const std::vector<OutputFormat>& all_outputs() {
  static const std::vector<OutputFormat> all = {
      {.name = "gltf", .other_names = {"tileset"}}, {.name = "citygml"}, {.name = "cityjson"}, {.name = "gpkg"}};
  return all;
}

}  // namespace blockrand::outputs
