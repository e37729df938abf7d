#include "importers/polygons/read_polygons.h"

#include <ogr_api.h>
#include <ogr_srs_api.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>

#include "pipeline/base/error.h"
#include "pipeline/base/toml_file.h"
#include "pipeline/gdal/gdal_scope.h"
#include "pipeline/georef/transform.h"

namespace blockrand::importers::polygons {

namespace {

struct DestroyFeature {
  void operator()(void* f) const { gdal::api().OGR_F_Destroy(f); }
};
struct DestroyGeometry {
  void operator()(void* g) const { gdal::api().OGR_G_DestroyGeometry(g); }
};
using Dataset = std::unique_ptr<void, gdal::CloseDataset>;
using Feature = std::unique_ptr<void, DestroyFeature>;
using Geometry = std::unique_ptr<void, DestroyGeometry>;

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& n : names) text += (text.empty() ? "" : ", ") + n;
  return text;
}

OGRLayerH choose_layer(GDALDatasetH data, const std::string& path, const std::string& wanted) {
  std::vector<std::string> names;
  for (int i = 0; i < gdal::api().GDALDatasetGetLayerCount(data); ++i)
    names.emplace_back(gdal::api().OGR_L_GetName(gdal::api().GDALDatasetGetLayer(data, i)));
  if (names.empty()) throw base::InputError(path, "", "has no layer", "Name a vector file with polygons");
  if (wanted.empty()) {
    if (names.size() > 1) throw base::InputError(path, "", "has several layers", "Name one of them: " + listed(names));
    return gdal::api().GDALDatasetGetLayer(data, 0);
  }
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i] == wanted) return gdal::api().GDALDatasetGetLayer(data, static_cast<int>(i));
  const std::string near = base::nearest(wanted, names);
  throw base::InputError(path, wanted, "has no such layer",
                         near.empty() ? "Its layers: " + listed(names) : "Did you mean " + near + "?");
}

/// Indices of the fields that the choice names.
std::vector<int> field_indices(OGRLayerH layer, const std::string& path, const VectorChoice& choice) {
  OGRFeatureDefnH definition = gdal::api().OGR_L_GetLayerDefn(layer);
  std::vector<std::string> names;
  for (int i = 0; i < gdal::api().OGR_FD_GetFieldCount(definition); ++i)
    names.emplace_back(gdal::api().OGR_Fld_GetNameRef(gdal::api().OGR_FD_GetFieldDefn(definition, i)));
  std::vector<int> out;
  for (const auto& [field, value] : choice.attributes) {
    const auto found = std::find(names.begin(), names.end(), field);
    if (found == names.end()) {
      const std::string near = base::nearest(field, names);
      throw base::InputError(path, gdal::api().OGR_L_GetName(layer), "has no field " + field,
                             near.empty() ? "Its fields: " + listed(names) : "Did you mean " + near + "?");
    }
    out.push_back(static_cast<int>(found - names.begin()));
  }
  return out;
}

/// Polygons of collections too, each with its rings.
void collect(OGRGeometryH geometry, std::vector<std::vector<std::vector<model::Point2>>>& polygons) {
  const OGRwkbGeometryType type = gdal::api().OGR_GT_Flatten(gdal::api().OGR_G_GetGeometryType(geometry));
  if (type == wkbPolygon) {
    std::vector<std::vector<model::Point2>> rings;
    for (int r = 0; r < gdal::api().OGR_G_GetGeometryCount(geometry); ++r) {
      OGRGeometryH ring = gdal::api().OGR_G_GetGeometryRef(geometry, r);
      std::vector<model::Point2> points;
      for (int i = 0; i < gdal::api().OGR_G_GetPointCount(ring); ++i)
        points.push_back({gdal::api().OGR_G_GetX(ring, i), gdal::api().OGR_G_GetY(ring, i)});
      if (points.size() > 1 && points.front() == points.back()) points.pop_back();
      if (points.size() >= 3) rings.push_back(std::move(points));
    }
    if (!rings.empty()) polygons.push_back(std::move(rings));
    return;
  }
  if (type == wkbMultiPolygon || type == wkbGeometryCollection)
    for (int i = 0; i < gdal::api().OGR_G_GetGeometryCount(geometry); ++i)
      collect(gdal::api().OGR_G_GetGeometryRef(geometry, i), polygons);
}

/// From the layer's CRS to WGS 84; empty: the layer says no CRS.
std::optional<georef::Transform> transform_of(OGRLayerH layer, const std::string& path) {
  OGRSpatialReferenceH crs = gdal::api().OGR_L_GetSpatialRef(layer);
  if (!crs) return std::nullopt;
  char* wkt = nullptr;
  gdal::api().OSRExportToWktEx(crs, &wkt, nullptr);
  const std::string definition = wkt ? wkt : "";
  gdal::api().VSIFree(wkt);
  try {
    return georef::Transform(definition, "EPSG:4326");
  } catch (const base::UsageError& error) {
    throw base::InputError(path, gdal::api().OGR_L_GetName(layer),
                           std::string("cannot be brought to WGS 84: ") + error.what(),
                           "Reproject it, for example with ogr2ogr -t_srs EPSG:4326");
  }
}

/// GDAL gives coordinates in the axis order of the file's data; in the order of people, longitude or easting first.
model::Point2 east_first(OGRLayerH layer, model::Point2 p) {
  OGRSpatialReferenceH crs = gdal::api().OGR_L_GetSpatialRef(layer);
  int count = 0;
  const int* axes = crs ? gdal::api().OSRGetDataAxisToSRSAxisMapping(crs, &count) : nullptr;
  const bool authority_order = crs && axes && count >= 2 && axes[0] == 1 && gdal::api().OSREPSGTreatsAsLatLong(crs);
  return authority_order ? model::Point2{p.y, p.x} : p;
}

}  // namespace

std::vector<PolygonFeature> read_polygons(const std::string& path, const VectorChoice& choice) {
  const gdal::GdalScope scope;
  std::error_code error;
  if (!std::filesystem::exists(path, error))
    throw base::InputError(path, "", "does not exist",
                           "Check the path; it starts at the folder of the file that names it");
  gdal::register_drivers();
  const Dataset data(
      gdal::api().GDALOpenEx(path.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY, nullptr, nullptr, nullptr));
  if (!data)
    throw base::InputError(path, "", "is no vector file that GDAL reads" + gdal::GdalScope::last_words(),
                           "Name a GeoJSON, GeoPackage, Shapefile, GML ...");
  OGRLayerH layer = choose_layer(data.get(), path, choice.layer);
  const std::vector<int> fields = field_indices(layer, path, choice);
  const std::optional<georef::Transform> transform = transform_of(layer, path);
  const std::string layer_name = gdal::api().OGR_L_GetName(layer);
  OGRFeatureDefnH definition = gdal::api().OGR_L_GetLayerDefn(layer);

  std::vector<PolygonFeature> out;
  gdal::api().OGR_L_ResetReading(layer);
  while (const Feature feature{gdal::api().OGR_L_GetNextFeature(layer)}) {
    bool chosen = true;
    for (std::size_t i = 0; i < fields.size() && chosen; ++i)
      chosen = choice.attributes[i].second == gdal::api().OGR_F_GetFieldAsString(feature.get(), fields[i]);
    OGRGeometryH geometry = gdal::api().OGR_F_GetGeometryRef(feature.get());
    if (!chosen || !geometry) continue;
    const Geometry straight(gdal::api().OGR_G_GetLinearGeometry(geometry, 0, nullptr));
    if (!straight) continue;
    PolygonFeature polygon;
    polygon.fid = gdal::api().OGR_F_GetFID(feature.get());
    for (int i = 0; i < gdal::api().OGR_FD_GetFieldCount(definition); ++i)
      polygon.attributes.emplace_back(gdal::api().OGR_Fld_GetNameRef(gdal::api().OGR_FD_GetFieldDefn(definition, i)),
                                      gdal::api().OGR_F_GetFieldAsString(feature.get(), i));
    const auto to_place = [&](model::Point2 as_stored) {
      const model::Point2 p = east_first(layer, as_stored);
      const model::Point2 degrees = transform ? transform->forward(p) : p;
      if (!(std::fabs(degrees.x) <= 180 && std::fabs(degrees.y) <= 90))
        throw base::InputError(path, layer_name,
                               "feature " + std::to_string(polygon.fid) + " lies outside of longitude and latitude",
                               transform ? "Check the coordinate system of the file"
                                         : "The file names no coordinate system: give it one, or degrees");
      return model::Location{static_cast<std::int32_t>(std::lround(degrees.x * 1e7)),
                             static_cast<std::int32_t>(std::lround(degrees.y * 1e7))};
    };
    std::vector<std::vector<std::vector<model::Point2>>> polygons;
    collect(straight.get(), polygons);
    for (const auto& rings : polygons) {
      auto& placed = polygon.polygons.emplace_back();
      for (const auto& ring : rings)
        std::transform(ring.begin(), ring.end(), std::back_inserter(placed.emplace_back()), to_place);
    }
    if (!polygon.polygons.empty()) out.push_back(std::move(polygon));
  }
  if (scope.failed())
    throw base::InputError(path, layer_name,
                           "breaks off or is damaged (GDAL: " + scope.failure("no reason given") + ")",
                           "Export or download the file again");
  if (out.empty())
    throw base::InputError(path, layer_name,
                           choice.attributes.empty() ? "holds no polygon" : "holds no polygon with these attributes",
                           "Name a layer with polygons, or other attributes");
  std::sort(out.begin(), out.end(), [](const PolygonFeature& a, const PolygonFeature& b) { return a.fid < b.fid; });
  return out;
}

}  // namespace blockrand::importers::polygons
