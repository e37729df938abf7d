#include "pipeline/georef/proj_library.h"

#include "pipeline/base/shared_library.h"

namespace blockrand::georef::detail {

const ProjFunctions& proj() {
  static const ProjFunctions functions = [] {
    const base::SharedLibrary library(BLOCKRAND_PROJ_SONAME, "PROJ, which knows coordinate systems");
    ProjFunctions all;
#define BLOCKRAND_PROJ_FIND(name) library.find(all.name, #name);
    BLOCKRAND_PROJ_FUNCTIONS(BLOCKRAND_PROJ_FIND)
#undef BLOCKRAND_PROJ_FIND
    return all;
  }();
  return functions;
}

}  // namespace blockrand::georef::detail
