// What libcitygml, the library behind several CityGML viewers, finds in a CityGML file: objects by type, polygons,
// triangles, colours. Nothing of ours helps it.
//   citygml_viewer FILE.gml …   one line of JSON per file
#include <citygml/citygml.h>
#include <citygml/citygmllogger.h>
#include <citygml/citymodel.h>
#include <citygml/cityobject.h>
#include <citygml/geometry.h>
#include <citygml/implictgeometry.h>
#include <citygml/material.h>
#include <citygml/polygon.h>

#include <cmath>
#include <cstdio>
#include <exception>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace {

class Messages : public citygml::CityGMLLogger {
 public:
  Messages() : CityGMLLogger(LOGLEVEL::LL_WARNING) {}
  void log(LOGLEVEL, const std::string& message, const char*, int) const override { all.push_back(message); }
  mutable std::vector<std::string> all;
};

struct Seen {
  std::map<std::string, int> objects;    ///< by type
  std::map<std::string, int> filled;     ///< by type: objects with a polygon that has triangles, of any level of detail
  std::map<std::string, int> implicits;  ///< by type of their object: elements that are placed, with polygons
  std::vector<std::string> buildings;    ///< ids
  std::map<std::string, std::string> names;  ///< gml:name by id of buildings and parts that have one
  std::map<std::string, int> polygons;       ///< by level of detail
  std::map<std::string, int> colours;        ///< polygons by the diffuse colour of their material, "#rrggbb" or "none"
  std::size_t triangles = 0;
};

std::string colour_of(const citygml::Polygon& polygon, const std::vector<std::string>& themes) {
  for (const std::string& theme : themes)
    if (const auto material = polygon.getMaterialFor(theme)) {
      const TVec3f d = material->getDiffuse();
      char text[8];
      std::snprintf(text, sizeof text, "#%02x%02x%02x", static_cast<unsigned>(std::lround(255 * d.x)),
                    static_cast<unsigned>(std::lround(255 * d.y)), static_cast<unsigned>(std::lround(255 * d.z)));
      return text;
    }
  return "none";
}

/// \return whether a polygon of it has triangles
bool look(const citygml::Geometry& geometry, const std::vector<std::string>& themes, Seen& seen) {
  const std::size_t before = seen.triangles;
  for (unsigned i = 0; i < geometry.getPolygonsCount(); ++i) {
    const auto polygon = geometry.getPolygon(i);
    ++seen.polygons[std::to_string(geometry.getLOD())];
    if (geometry.getLOD() == 2) ++seen.colours[colour_of(*polygon, themes)];
    seen.triangles += polygon->getIndices().size() / 3;
  }
  for (unsigned i = 0; i < geometry.getGeometriesCount(); ++i) look(geometry.getGeometry(i), themes, seen);
  return seen.triangles > before;
}

void look(const citygml::CityObject& object, const std::vector<std::string>& themes, Seen& seen) {
  ++seen.objects[object.getTypeAsString()];
  if (object.getType() == citygml::CityObject::CityObjectsType::COT_Building) seen.buildings.push_back(object.getId());
  if (const std::string name = object.getAttribute("gml:name"); !name.empty()) seen.names[object.getId()] = name;
  bool filled = false;
  for (unsigned i = 0; i < object.getGeometriesCount(); ++i) filled |= look(object.getGeometry(i), themes, seen);
  if (filled) ++seen.filled[object.getTypeAsString()];
  // A template stands in the file once and is counted wherever it is placed; its triangles are not.
  for (unsigned i = 0; i < object.getImplicitGeometryCount(); ++i) {
    const citygml::ImplicitGeometry& placed = object.getImplicitGeometry(i);
    Seen of_template;
    bool drawn = false;
    for (unsigned k = 0; k < placed.getGeometriesCount(); ++k)
      drawn |= look(placed.getGeometry(k), themes, of_template);
    if (drawn) ++seen.implicits[object.getTypeAsString()];
  }
  for (unsigned i = 0; i < object.getChildCityObjectsCount(); ++i) look(object.getChildCityObject(i), themes, seen);
}

}  // namespace

int main(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    const auto messages = std::make_shared<Messages>();
    Seen seen;
    std::string srs;
    std::vector<std::string> themes;
    try {
      const auto model = citygml::load(std::string(argv[i]), citygml::ParserParams(), messages);
      if (!model) throw std::runtime_error("nothing was read");
      srs = model->getEnvelope().srsName();
      themes = model->themes();
      for (unsigned n = 0; n < model->getNumRootCityObjects(); ++n) look(model->getRootCityObject(n), themes, seen);
    } catch (const std::exception& error) {
      messages->all.push_back(error.what());
    } catch (...) {  // Xerces throws what is no std::exception
      messages->all.push_back("an exception of Xerces: the file is no well-formed XML");
    }
    std::puts(nlohmann::json({{"file", argv[i]},
                              {"objects", seen.objects},
                              {"filled", seen.filled},
                              {"implicits", seen.implicits},
                              {"buildings", seen.buildings},
                              {"names", seen.names},
                              {"polygons", seen.polygons},
                              {"triangles", seen.triangles},
                              {"colours", seen.colours},
                              {"themes", themes},
                              {"srs", srs},
                              {"messages", messages->all}})
                  .dump()
                  .c_str());
  }
  return 0;
}
