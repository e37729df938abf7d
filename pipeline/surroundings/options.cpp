#include "pipeline/surroundings/options.h"

#include "pipeline/base/option.h"
#include "pipeline/base/text.h"

namespace blockrand::surroundings {

SurroundingOptions SurroundingOptions::settled(int lod) const {
  if (!automatic) return *this;
  return lod >= 3 ? SurroundingOptions{true, true, true} : SurroundingOptions{};
}

SurroundingOptions usual_surroundings() { return {.automatic = true}; }

SurroundingOptions parse_surroundings(const std::string& text) {
  if (text == "off") return {};
  if (text == "auto") return {.automatic = true};
  if (text == "on") return {true, true, true};
  SurroundingOptions out;
  for (const std::string& layer : base::split(text, ',')) {
    if (layer == "ground") {
      out.ground = true;
    } else if (layer == "bodies") {
      out.bodies = true;
    } else if (layer == "objects") {
      out.objects = true;
    } else {
      throw base::ValueError(base::in_quotes(layer) + " is no layer of the surroundings",
                             "Write auto, on, off, or some of ground, bodies, objects with commas between them.");
    }
  }
  return out;
}

std::string show_surroundings(const SurroundingOptions& options) {
  if (options == SurroundingOptions{}) return "off";
  if (options.automatic) return "auto";
  if (options == SurroundingOptions{true, true, true}) return "on";
  std::string out;
  const auto add = [&](bool is, const char* name) {
    if (!is) return;
    if (!out.empty()) out += ',';
    out += name;
  };
  add(options.ground, "ground"), add(options.bodies, "bodies"), add(options.objects, "objects");
  return out;
}

}  // namespace blockrand::surroundings
