// What srsName means, and which coordinate comes first. Internal to this folder.
#pragma once

#include <string>
#include <vector>

#include "importers/reference/note_log.h"
#include "importers/reference/read_options.h"
#include "importers/reference/reference_model.h"

namespace blockrand::importers::reference {

/// An srsName taken apart, before PROJ was asked.
struct SrsName {
  std::string horizontal;  ///< "EPSG:25832", "OGC:CRS84", or the text as it stands where it is of no known form
  std::string vertical;    ///< "EPSG:5783"; may be empty
  /// The form promises the authority's axis order (urn or http://www.opengis.net/def/crs), which binds geographic ones.
  bool authority_order = false;
};

/// Takes apart "EPSG:25833", "25833", "EPSG:25832+5783", "urn:ogc:def:crs:EPSG:6.9:25833",
/// "urn:ogc:def:crs,crs:EPSG::25832,crs:EPSG::5783", "http://www.opengis.net/def/crs/EPSG/0/25832",
/// "http://www.opengis.net/gml/srs/epsg.xml#25832", ".../def/crs-compound?1=...&2=...",
/// "urn:adv:crs:ETRS89_UTM32*DE_DHHN2016_NH", "urn:adv:crs:DE_DHDN_3GK4*DE_DHHN92_NH".
SrsName parse_srs_name(const std::string& text);

/// Decides about the CRS of a file. \param stated  different srsNames in order of appearance
/// \throws base::InputError, base::UsageError  as read_citygml
ReferenceCrs decide_crs(const std::string& path, const std::vector<std::string>& stated, const ReadOptions& options,
                        NoteLog& notes);

/// Decides which coordinate comes first, from the bounding box of the coordinates as they stand.
/// Sets `crs.axis_order`; notes where the decision was not the form's.
void decide_axis_order(ReferenceCrs& crs, const model::Point2& lowest, const model::Point2& highest,
                       const ReadOptions& options, NoteLog& notes);

}  // namespace blockrand::importers::reference
