#include "pipeline/gdal/gdal_library.h"

#include "pipeline/base/shared_library.h"

namespace blockrand::gdal {

const Functions& api() {
  static const Functions functions = [] {
    const base::SharedLibrary library(BLOCKRAND_GDAL_SONAME,
                                      "GDAL, which reads rasters and polygons and writes GeoPackages");
    Functions all;
#define BLOCKRAND_GDAL_FIND(name) library.find(all.name, #name);
    BLOCKRAND_GDAL_FUNCTIONS(BLOCKRAND_GDAL_FIND)
#undef BLOCKRAND_GDAL_FIND
    return all;
  }();
  return functions;
}

}  // namespace blockrand::gdal
