// libFuzzer target: whatever a reference model holds, reading it gives a model whose numbers point to what is there, or
// an InputError. The first byte chooses the reader, the rest is the file. Seeds: any small model behind one of the
// bytes 0 to 4; where a tileset names content, it is the last GLB that was tried.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "importers/reference/citygml.h"
#include "importers/reference/cityjson.h"
#include "importers/reference/gltf.h"
#include "importers/reference/read_model.h"
#include "pipeline/base/error.h"
#include "tests/fuzz/input_file.h"

namespace {

using namespace blockrand::importers::reference;

void check(const std::vector<Geometry>& geometries, const ReferenceModel& model) {
  for (const Geometry& g : geometries) {
    if (g.faces.empty() || g.outer_faces > g.faces.size() || g.lod < 0 || g.lod > 4) std::abort();
    for (const Face& f : g.faces)
      if (f.polygon >= model.polygons.size()) std::abort();
  }
}

void check(const ReferenceModel& model) {
  for (std::size_t i = 0; i < model.buildings.size(); ++i) {
    const Building& b = model.buildings[i];
    if (b.parent >= static_cast<int>(i)) std::abort();  // a part stands after its building
    check(b.geometries, model);
    for (const Surface& s : b.surfaces) {
      check(s.geometries, model);
      for (const Opening& o : s.openings) check(o.geometries, model);
    }
  }
  for (const Polygon3& p : model.polygons) {
    if (p.outer.size() < 3) std::abort();
    for (const auto& q : p.outer)
      if (!std::isfinite(q.x) || !std::isfinite(q.y) || !std::isfinite(q.z)) std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  static constexpr const char* kNames[] = {"f.gml", "f.city.json", "f.glb", "tileset.json", "f"};
  const int kind = data[0] % 5;
  const std::string path = blockrand::fuzz::write_file(kNames[kind], data + 1, size - 1);
  ReadOptions options;
  if (kind < 2) {
    options.reference_crs = "EPSG:25833";
  } else {
    options.gltf_origin = blockrand::georef::Geodetic{13.4, 52.5, 0};
  }
  try {
    check(kind == 0   ? read_citygml(path, options)
          : kind == 1 ? read_cityjson(path, options)
          : kind < 4  ? read_gltf(path, options)
                      : read_model(path, options));
  } catch (const blockrand::base::InputError&) {
  }
  return 0;
}
