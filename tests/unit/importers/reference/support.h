// Small CityGML files, written by hand for one property each.
#pragma once

#include <string>
#include <string_view>

#include "importers/reference/citygml.h"

namespace blockrand::importers::reference::test {

/// A folder that is gone with the object.
class TempFolder {
 public:
  TempFolder();
  ~TempFolder();
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;
  /// Writes the bytes and returns the path.
  std::string write(std::string_view name, std::string_view bytes) const;
  /// The same, gzipped.
  std::string write_gzipped(std::string_view name, const std::string& bytes) const;
  const std::string& path() const { return folder_; }

 private:
  std::string folder_;
};

/// The bytes of a file.
std::string all_text(const std::string& path);

/// A CityGML 2.0 document with the usual prefixes (bldg, gml, gen, xlink; CityGML's own without one) around members.
/// \param srs  srsName of the envelope; empty: no envelope
std::string document(std::string_view members, std::string_view srs = "EPSG:25833");

/// <cityObjectMember><bldg:Building gml:id="…">inside</…>
std::string building(std::string_view id, std::string_view inside);

/// A gml:Polygon with one ring; the first point is repeated at the end. \param points  "0 0 0 1 0 0 1 1 0"
std::string polygon(std::string_view points, std::string_view id = "", std::string_view holes = "");

/// bldg:boundedBy with a surface of LoD2. \param element  "GroundSurface"
std::string surface(std::string_view element, std::string_view polygons, std::string_view id = "");

/// Reads a document through a file.
ReferenceModel read(const std::string& xml, const ReadOptions& options = {});

/// The message that reading ends with; "read" where it does not.
std::string refusal(const std::string& path, const ReadOptions& options = {});

/// Ground of a 10 m x 8 m house at (east, north) in EPSG:25833, counter-clockwise from below.
std::string house_ground(double east, double north, double z = 30);

}  // namespace blockrand::importers::reference::test
