// Writes a small good build for tests/validators/selftest.mjs: three tiles with their tileset, and CityGML.
//   make_sample FOLDER
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <vector>

#include "pipeline/georef/frames.h"
#include "pipeline/outputs/citygml/citygml_writer.h"
#include "pipeline/outputs/gltf/glb_writer.h"
#include "pipeline/outputs/tileset/tileset.h"
#include "tests/unit/outputs/sample_region.h"

using namespace blockrand;

namespace {

void write(const std::filesystem::path& path, const std::string& bytes) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << bytes;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: make_sample FOLDER\n", stderr);
    return 1;
  }
  const std::filesystem::path folder = argv[1];
  struct Place {
    std::uint32_t x, y;
    double lon, lat;
    outputs::test::SampleRegion sample;
  };
  std::vector<Place> places;
  places.push_back({17604, 12942, 13.4, 52.5, outputs::test::SampleRegion::zoo()});
  places.push_back({17605, 12942, 13.411, 52.5, outputs::test::SampleRegion::settlement(120, true)});
  places.push_back({17612, 12950, 13.49, 52.54, outputs::test::SampleRegion::settlement(3, true)});

  std::vector<outputs::TileEntry> entries;
  for (const Place& place : places) {
    const georef::EnuFrame enu({place.lon, place.lat, 0});
    outputs::GlbOptions options;
    options.crs = "EPSG:25833";
    options.height_reference = "heights above local ground";
    options.generator = "blockrand test";
    options.attribution = "\xC2\xA9 OpenStreetMap contributors, ODbL 1.0";
    options.frame.longitude = place.lon;
    options.frame.latitude = place.lat;
    options.frame.enu_to_ecef = enu.local_to_ecef();
    options.frame.to_enu = [](std::span<const model::Point3> in, std::span<model::Point3> out) {
      for (std::size_t i = 0; i < in.size(); ++i) out[i] = {in[i].x - 391050.3, in[i].y - 5819050.7, in[i].z};
    };
    const outputs::Glb glb = outputs::write_glb(place.sample.region(), options);
    outputs::TileEntry entry;
    entry.id = {15, place.x, place.y};
    entry.uri = "tiles/15/" + std::to_string(place.x) + "/" + std::to_string(place.y) + ".glb";
    entry.enu_to_ecef = options.frame.enu_to_ecef;
    entry.min = glb.min;
    entry.max = glb.max;
    entry.west = entry.south = entry.min_height = 1e9;
    entry.east = entry.north = entry.max_height = -1e9;
    for (int corner = 0; corner < 8; ++corner) {
      const georef::Geodetic g =
          georef::from_ecef(enu.to_ecef({corner & 1 ? glb.max.x : glb.min.x, corner & 2 ? glb.max.y : glb.min.y,
                                         corner & 4 ? glb.max.z : glb.min.z}));
      entry.west = std::min(entry.west, g.lon);
      entry.east = std::max(entry.east, g.lon);
      entry.south = std::min(entry.south, g.lat);
      entry.north = std::max(entry.north, g.lat);
      entry.min_height = std::min(entry.min_height, g.height);
      entry.max_height = std::max(entry.max_height, g.height);
    }
    write(folder / entry.uri, glb.bytes);
    entries.push_back(entry);
    outputs::CityGmlOptions gml;
    gml.srs_name = "urn:ogc:def:crs:EPSG::25833";
    write(folder / "citygml" / (std::to_string(place.x) + "_" + std::to_string(place.y) + ".gml"),
          outputs::write_citygml(place.sample.region(), gml));
  }
  outputs::TilesetOptions options;
  options.crs = "EPSG:25833";
  options.height_reference = "heights above local ground";
  options.generator = "blockrand test";
  options.attribution = "OpenStreetMap contributors";
  write(folder / "tileset.json", outputs::write_tileset(entries, options));
}
