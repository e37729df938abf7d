#include "tests/unit/elements/shipped_elements.h"

#include <string>
#include <vector>

namespace blockrand::elements {

const ElementCatalogue& shipped() {
  static const ElementCatalogue catalogue =
      read_element_catalogue(std::vector<std::string>{BLOCKRAND_SOURCE_DIR "/configs"});
  return catalogue;
}

}  // namespace blockrand::elements
