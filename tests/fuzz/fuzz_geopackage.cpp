// libFuzzer target: whatever a GeoPackage holds, `validate` reads its layers and rows, or says what is wrong.
#include <cstdint>
#include <cstdlib>

#include "pipeline/validate/geopackage.h"
#include "tests/fuzz/input_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace blockrand;
  validate::GeoPackageReader reader(fuzz::write_file("f.gpkg", data, size), "f.gpkg");
  validate::FindingLog log;
  if (!reader.check(log)) {
    if (log.count() == 0) std::abort();
    return 0;
  }
  (void)reader.srs_id();
  for (const std::string& tile : reader.tiles()) (void)reader.rows(tile);
  (void)reader.reported();
  (void)reader.tile_rows();
  (void)reader.repairs();
  return 0;
}
