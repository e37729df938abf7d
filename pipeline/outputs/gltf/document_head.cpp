#include "pipeline/outputs/gltf/document_head.h"

#include <nlohmann/json.hpp>
#include <string>

#include "pipeline/outputs/number_text.h"

namespace blockrand::outputs {
namespace {

nlohmann::json georeference(const GlbOptions& options) {
  std::string crs, height_reference;
  append_clean(crs, options.crs);
  append_clean(height_reference, options.height_reference);
  return {{"georeference",
           {{"crs", crs},
            {"height_reference", height_reference},
            {"origin",
             {{"longitude", options.frame.longitude},
              {"latitude", options.frame.latitude},
              {"height", options.frame.height}}},
            {"local_to_ecef", options.frame.enu_to_ecef}}}};
}

}  // namespace

void write_head(GlbDocument& document, const GlbOptions& options) {
  std::string generator, attribution;
  append_clean(generator, options.generator);
  append_clean(attribution, options.attribution);
  document.asset() = {{"version", "2.0"}};
  if (!generator.empty()) document.asset()["generator"] = generator;
  if (!attribution.empty()) document.asset()["copyright"] = attribution;
  document.asset()["extras"] = georeference(options);
}

}  // namespace blockrand::outputs
