#include "pipeline/outputs/citygml/citygml_output.h"
#include "pipeline/outputs/cityjson/cityjson_output.h"
#include "pipeline/outputs/explain/explain_output.h"
#include "pipeline/outputs/geopackage/geopackage_output.h"
#include "pipeline/outputs/gltf/gltf_output.h"
#include "pipeline/outputs/imagery/imagery_output.h"
#include "pipeline/outputs/output.h"
#include "pipeline/outputs/report/report_json_output.h"
#include "pipeline/outputs/report/report_output.h"

namespace blockrand::outputs {

const std::vector<OutputFormat>& all_outputs() {
  // Explanations name the files of their tile: they come behind those.
  static const std::vector<OutputFormat> all = {gltf_output(),       citygml_output(), cityjson_output(),
                                                geopackage_output(), report_output(),  report_json_output(),
                                                imagery_output(),    explain_output()};
  return all;
}

}  // namespace blockrand::outputs
