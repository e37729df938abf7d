// What tests of CityGML at LoD3 share, lean or full.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "pipeline/geometry/cgal_validator.h"
#include "pipeline/outputs/citygml/citygml_writer.h"
#include "tests/validators/citygml_reader.h"

namespace blockrand::outputs::test {

inline CityGmlOptions gml_options(bool lean) {
  CityGmlOptions o;
  o.lod = 3;
  o.lean = lean;
  o.srs_name = "urn:ogc:def:crs:EPSG::25833";
  return o;
}

/// How often `what` stands in a text.
inline std::size_t times(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

/// Empty for a valid solid.
inline std::string validity(const validators::GmlSolid& solid) {
  std::vector<geometry::PolygonRings> polygons;
  for (const auto& p : solid.polygons) polygons.push_back(p.rings);
  return geometry::validate_solid(polygons);
}

inline std::filesystem::path citygml_schemas() { return std::filesystem::path(BLOCKRAND_SHARED_DIR) / "schemas"; }

/// What xmllint says of a document that is not valid; empty for a valid one. \param name  of a folder for it
inline std::string schema_complaints(const std::string& text, const std::string& name) {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / name;
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "a.gml", std::ios::binary) << text;
  const std::string command = "XML_CATALOG_FILES=" + (citygml_schemas() / "catalog.xml").string() +
                              " xmllint --nonet --noout --schema " + (citygml_schemas() / "citygml2.xsd").string() +
                              " " + (folder / "a.gml").string() + " > " + (folder / "log").string() + " 2>&1";
  std::ostringstream out;
  if (const int status = std::system(command.c_str()); status != 0)
    out << "status " << status << ": " << std::ifstream(folder / "log").rdbuf();
  std::filesystem::remove_all(folder);
  return out.str();
}

}  // namespace blockrand::outputs::test
