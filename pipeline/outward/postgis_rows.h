// Rows of a layer: what they are known by, whether they are the same, and how they come into a table.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "pipeline/gdal/gdal_library.h"

namespace blockrand::outward {

/// Columns that tables have beside those of the layer.
inline constexpr const char* kAreaColumn = "blockrand_area";
inline constexpr const char* kRowColumn = "blockrand_row";

struct DestroyFeature {
  void operator()(OGRFeatureH feature) const { gdal::api().OGR_F_Destroy(feature); }
};
using FeaturePointer = std::unique_ptr<std::remove_pointer_t<OGRFeatureH>, DestroyFeature>;

/// The column by which rows belong together: `id`, else `osm_id`, else the first.
std::string key_of(OGRLayerH layer);

/// Goes through a layer.
class RowReader {
 public:
  RowReader(OGRLayerH layer, const std::string& key);
  /// Begins again.
  void again();
  /// \returns  false behind the last row
  bool next();
  std::string key() const;
  /// Of the names and values of all columns that are not NULL, and of the geometry; not of `fid`. 64 bits of SHA-256.
  std::uint64_t hash() const;
  OGRFeatureH row() const { return row_.get(); }

 private:
  OGRLayerH layer_;
  int key_ = -1;
  FeaturePointer row_;
};

/// Writes rows of one layer into another that has its columns and the two of this program.
class RowInserter {
 public:
  RowInserter(OGRLayerH from, OGRLayerH to, std::string area);
  /// \returns  false where GDAL refuses it
  bool insert(const RowReader& reader);

 private:
  OGRLayerH to_;
  std::string area_;
  int area_column_ = -1, row_column_ = -1;
  std::vector<int> columns_;  ///< in `to`, by those of `from`
  FeaturePointer row_;
};

}  // namespace blockrand::outward
