// Reads CityGML 0.4, 1.0 and 2.0 leniently: surveyed and hand-built models as they are, not as the schema wants them.
#pragma once

#include <string>

#include "importers/reference/read_options.h"
#include "importers/reference/reference_model.h"

namespace blockrand::importers::reference {

/// Reads `.gml`, `.xml` and either with `.gz` (told by content), streaming: memory is the model, not the document.
///
/// Elements are known by their local names, in any of CityGML's namespaces of versions 0.x, 1.0 and 2.0 and any prefix,
/// also where the prefix is not declared. Xlinks within the file are resolved. Buildings inside of groups count; other
/// city objects are counted only. What breaks the rules is read as far as it makes sense and noted; after damage to the
/// XML itself reading goes on where libxml2 can, and a building without an end is left out.
///
/// Implicit geometry (a template with a matrix and a reference point) is placed, also where the template stands
/// elsewhere in the file; that of furniture is left out, that of other files (libraryObject) noted.
///
/// CRS: the first srsName. Understood are "EPSG:25833", OGC urns and addresses, compound ones ("urn:ogc:def:crs,crs:
/// EPSG::25832,crs:EPSG::5783"), AdV's urns ("urn:adv:crs:ETRS89_UTM32*DE_DHHN2016_NH") and names that PROJ knows.
/// Axis order: a geographic CRS named by urn or address is latitude first, "EPSG:4326" longitude first, a projected
/// one east first, all that unless only the other order lies in the CRS's area of use; where both do, `near` decides.
///
/// \throws base::InputError  when nothing can be read: no such file, no XML, no CityGML of these versions, a document
///         type definition, or a CRS that is not stated or unknown while `reference_crs` is empty
/// \throws base::UsageError  when `reference_crs` is unknown
ReferenceModel read_citygml(const std::string& path, const ReadOptions& options = {});

}  // namespace blockrand::importers::reference
