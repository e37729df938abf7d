// Names of enumerators as reports print them.
#include "pipeline/compare/comparison.h"

namespace blockrand::compare {

std::string_view name_of(Hull hull) {
  static constexpr std::string_view kNames[kHullCount] = {"ground",        "wall",        "roof",        "closure",
                                                          "outer_ceiling", "outer_floor", "installation"};
  return kNames[static_cast<int>(hull)];
}

std::string_view name_of(LeftOut left_out) {
  static constexpr std::string_view kNames[kLeftOutCount] = {"counted", "ground", "covered", "blank"};
  return kNames[static_cast<int>(left_out)];
}

std::string_view name_of(RoofForm form) {
  static constexpr std::string_view kNames[kRoofFormCount] = {"flat",    "shed",    "gabled", "hipped",
                                                              "mansard", "complex", "none"};
  return kNames[static_cast<int>(form)];
}

}  // namespace blockrand::compare
