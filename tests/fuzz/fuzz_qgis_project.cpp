// libFuzzer target: whatever a QGIS project holds, `validate` reads it or says what is wrong. The first byte chooses: an
// archive (.qgz) where it is even, else the project in it (.qgs).
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "pipeline/validate/qgis_project.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace blockrand::validate;
  if (size == 0) return 0;
  std::string_view bytes(reinterpret_cast<const char*>(data + 1), size - 1);
  std::string why;
  std::optional<std::string> unpacked;
  if (data[0] % 2 == 0) {
    unpacked = qgs_of(bytes, why);
    if (!unpacked && why.empty()) std::abort();
    if (!unpacked) return 0;
    bytes = *unpacked;
  }
  const TableColumns tables = {{"buildings", {"storeys", "house_number"}}, {"tiles", {"id"}}};
  FindingLog log;
  if (check_qgis_project(bytes, "f.qgz", "buildings.gpkg", tables, "EPSG:25833", log) == 0 && log.count() == 0)
    std::abort();
  return 0;
}
