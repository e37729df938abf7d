// A CityGML file read back: bodies, solids and colours, and whether it keeps the standard's rules.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/validate/contents.h"

namespace blockrand::validate {

struct CityGml {
  bool readable = false;  ///< false: not well-formed, what was read before is not to be trusted
  Contents contents;      ///< in the build CRS, on the grid; findings: CITYGML_RULE, OFF_GRID, SOURCE_WRONG
  std::string srs_name;   ///< of the envelope; empty without one
};

/// Reads CityGML 2.0 as Blockrand writes it (LoD 0 to 3) and checks: known elements in their places, gml:ids given
/// once, references that resolve, an envelope that holds every point, rings closed with at least four points, boundary
/// surfaces that are the shells of their LoD2 and LoD3 solids, each used once, what check_detail() says of windows and
/// doors, attributes of their type, colours that exist.
/// Attributes without a `_source` come from tags: the bodies say so. Never throws on account of the bytes.
/// \param name  of the file, for findings
CityGml read_citygml(std::string_view xml, const std::string& name);

/// The OGC schemas of CityGML 2.0, parsed once.
class CityGmlSchema {
 public:
  /// \param folder  with citygml2.xsd, and catalog.xml that leads addresses of schemas to files
  /// \throws base::InputError  where the schemas cannot be read
  explicit CityGmlSchema(const std::string& folder);
  ~CityGmlSchema();
  CityGmlSchema(const CityGmlSchema&) = delete;
  CityGmlSchema& operator=(const CityGmlSchema&) = delete;

  /// What the schema says against the document; at most a few of its errors. Safe from several threads.
  std::vector<Finding> validate(std::string_view xml, const std::string& name) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace blockrand::validate
