// Reads CityJSON 1.0, 1.1 and 2.0, as documents and as text sequences.
#pragma once

#include <string>

#include "importers/reference/read_options.h"
#include "importers/reference/reference_model.h"

namespace blockrand::importers::reference {

/// Reads a CityJSON document (.json), or a text sequence (.jsonl: a CityJSON object in the first line, a
/// CityJSONFeature in each that follows), plain or gzipped, told by the content. Of a sequence one line is in memory
/// at a time.
///
/// Solid, MultiSolid, CompositeSolid (a solid each), MultiSurface, CompositeSurface and templates are read; points and
/// lines are noted. Of a MultiSurface with semantics `Building::geometries` holds the surfaces without a class only.
/// Windows and doors become openings of the surface that is their parent. BuildingInstallation and
/// BuildingConstructiveElement become surfaces of class installation, BuildingRoom, BuildingStorey and BuildingUnit
/// interior ones, BuildingFurniture is counted. "lod" 2.2 counts as 2; of several levels of one number (1.2 and 1.3)
/// the finest is read. City objects that are no buildings, those of extensions among them, are counted.
///
/// CRS: metadata.referenceSystem as urn or address, `+metadata`'s or `+metadata-extended`'s referenceSystem, or
/// metadata.crs.epsg, understood as read_citygml does; the axis order likewise.
///
/// \throws base::InputError   when there is no such file, it is no JSON, no CityJSON of these versions, its transform
/// is
///         none, or its CRS is not stated or unknown while `reference_crs` is empty
/// \throws base::UsageError   when `reference_crs` is unknown
ReferenceModel read_cityjson(const std::string& path, const ReadOptions& options = {});

}  // namespace blockrand::importers::reference
