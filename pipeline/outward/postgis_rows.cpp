#include "pipeline/outward/postgis_rows.h"

#include <charconv>
#include <cstring>

#include "pipeline/base/sha256.h"

namespace blockrand::outward {

using gdal::api;

std::string key_of(OGRLayerH layer) {
  OGRFeatureDefnH fields = api().OGR_L_GetLayerDefn(layer);
  for (const char* name : {"id", "osm_id"})
    if (api().OGR_FD_GetFieldIndex(fields, name) >= 0) return name;
  return api().OGR_Fld_GetNameRef(api().OGR_FD_GetFieldDefn(fields, 0));
}

RowReader::RowReader(OGRLayerH layer, const std::string& key)
    : layer_(layer), key_(api().OGR_FD_GetFieldIndex(api().OGR_L_GetLayerDefn(layer), key.c_str())) {
  again();
}

void RowReader::again() { api().OGR_L_ResetReading(layer_); }

bool RowReader::next() {
  row_.reset(api().OGR_L_GetNextFeature(layer_));
  return row_ != nullptr;
}

std::string RowReader::key() const {
  return api().OGR_F_IsFieldSetAndNotNull(row_.get(), key_) ? api().OGR_F_GetFieldAsString(row_.get(), key_) : "";
}

std::uint64_t RowReader::hash() const {
  base::Sha256 digest;
  const auto add = [&digest](const auto& value) {
    char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    digest.add({bytes, sizeof value});
  };
  OGRFeatureDefnH fields = api().OGR_L_GetLayerDefn(layer_);
  for (int i = 0; i < api().OGR_FD_GetFieldCount(fields); ++i) {
    if (!api().OGR_F_IsFieldSetAndNotNull(row_.get(), i)) continue;
    OGRFieldDefnH field = api().OGR_FD_GetFieldDefn(fields, i);
    const char* const name = api().OGR_Fld_GetNameRef(field);
    digest.add({name, std::strlen(name) + 1});
    const OGRFieldType type = api().OGR_Fld_GetType(field);
    if (type == OFTReal) {
      add(api().OGR_F_GetFieldAsDouble(row_.get(), i));
    } else if (type == OFTInteger || type == OFTInteger64) {
      add(api().OGR_F_GetFieldAsInteger64(row_.get(), i));
    } else {
      const char* const text = api().OGR_F_GetFieldAsString(row_.get(), i);
      digest.add({text, std::strlen(text) + 1});
    }
  }
  if (OGRGeometryH geometry = api().OGR_F_GetGeometryRef(row_.get())) {
    std::string wkb(static_cast<std::size_t>(api().OGR_G_WkbSize(geometry)), '\0');
    api().OGR_G_ExportToIsoWkb(geometry, wkbNDR, reinterpret_cast<unsigned char*>(wkb.data()));
    digest.add(wkb);
  }
  constexpr std::size_t kDigits = 16;
  constexpr int kHex = 16;
  const std::string hex = digest.finish();
  std::uint64_t value = 0;
  std::from_chars(hex.data(), hex.data() + kDigits, value, kHex);
  return value;
}

RowInserter::RowInserter(OGRLayerH from, OGRLayerH to, std::string area) : to_(to), area_(std::move(area)) {
  OGRFeatureDefnH fields = api().OGR_L_GetLayerDefn(from), into = api().OGR_L_GetLayerDefn(to);
  for (int i = 0; i < api().OGR_FD_GetFieldCount(fields); ++i)
    columns_.push_back(
        api().OGR_FD_GetFieldIndex(into, api().OGR_Fld_GetNameRef(api().OGR_FD_GetFieldDefn(fields, i))));
  area_column_ = api().OGR_FD_GetFieldIndex(into, kAreaColumn);
  row_column_ = api().OGR_FD_GetFieldIndex(into, kRowColumn);
  row_.reset(api().OGR_F_Create(into));
}

bool RowInserter::insert(const RowReader& reader) {
  OGRFeatureH to = row_.get(), from = reader.row();
  api().OGR_F_SetFID(to, OGRNullFID);
  OGRFeatureDefnH into = api().OGR_L_GetLayerDefn(to_);
  for (int i = 0; i < static_cast<int>(columns_.size()); ++i) {
    const int column = columns_[static_cast<std::size_t>(i)];
    if (column < 0) return false;
    if (!api().OGR_F_IsFieldSetAndNotNull(from, i)) {
      api().OGR_F_SetFieldNull(to, column);
      continue;
    }
    const OGRFieldType type = api().OGR_Fld_GetType(api().OGR_FD_GetFieldDefn(into, column));
    if (type == OFTReal)
      api().OGR_F_SetFieldDouble(to, column, api().OGR_F_GetFieldAsDouble(from, i));
    else if (type == OFTInteger || type == OFTInteger64)
      api().OGR_F_SetFieldInteger64(to, column, api().OGR_F_GetFieldAsInteger64(from, i));
    else
      api().OGR_F_SetFieldString(to, column, api().OGR_F_GetFieldAsString(from, i));
  }
  api().OGR_F_SetFieldString(to, area_column_, area_.c_str());
  api().OGR_F_SetFieldInteger64(to, row_column_, static_cast<GIntBig>(reader.hash()));
  if (api().OGR_F_SetGeometry(to, api().OGR_F_GetGeometryRef(from)) != OGRERR_NONE) return false;
  return api().OGR_L_CreateFeature(to_, to) == OGRERR_NONE;
}

}  // namespace blockrand::outward
