// What a comparison says in plain words. Internal to this folder.
#pragma once

#include <string>

#include "pipeline/compare/comparison.h"

namespace blockrand::compare {

struct Words {
  std::string matching;                  ///< how many buildings stand for each other
  std::string agrees, between, differs;  ///< lists of measures with their values; empty where there are none
  std::string limits;                    ///< from where on "agrees" and "differs" are said
};
/// Texts are escaped for XML.
Words words_of(const Comparison& comparison);

}  // namespace blockrand::compare
