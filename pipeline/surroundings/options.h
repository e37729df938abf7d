// What is made around the houses.
#pragma once

#include <string>

#include "pipeline/base/option_table.h"

namespace blockrand::surroundings {

struct SurroundingOptions {
  bool ground = false;     ///< streets, water, green, yards: the ground cut into surfaces
  bool bodies = false;     ///< walls, fences, hedges, rails, bridges
  bool objects = false;    ///< trees, lamps, benches, signs
  bool automatic = false;  ///< all layers at LoD3, none below; `settled` says which
  bool any() const { return ground || bodies || objects; }
  /// The layers of a build of this level of detail: never automatic.
  SurroundingOptions settled(int lod) const;
  friend bool operator==(const SurroundingOptions&, const SurroundingOptions&) = default;
};

/// What is made where nothing else is asked for.
SurroundingOptions usual_surroundings();

/// \param text  "auto", "on", "off", or layers with commas between them: "ground,objects"
/// \throws base::ValueError
SurroundingOptions parse_surroundings(const std::string& text);
/// As parse_surroundings reads it.
std::string show_surroundings(const SurroundingOptions& options);

}  // namespace blockrand::surroundings
