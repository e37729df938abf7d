// Text of the output files: numbers, escapes, and the tags of an object. Independent of locale and C library.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "pipeline/base/markup.h"
#include "pipeline/model/building.h"
#include "pipeline/model/extract.h"

namespace blockrand::outputs {

/// Appends the shortest decimal text that reads back as the same value; "0" for -0. `value` must be finite.
void append_number(std::string& out, double value);
void append_number(std::string& out, float value);
void append_number(std::string& out, std::int64_t value);

/// Appends a coordinate of the model grid with at most four decimals and no trailing zeros.
///
/// Works on the integer number of 1/1024 m, so that no printf is involved: what is read back lies within 0.05 mm of
/// the grid point, equal coordinates give equal text, and rounding the text to the grid gives the coordinate again.
/// \param metres  a multiple of 1/1024 m, below 2^40 in magnitude
void append_grid(std::string& out, double metres);

/// Appends a length in tenths of a millimetre as metres with at most four decimals and no trailing zeros: coordinates of
/// elements, which lie on no grid.
void append_ten_thousandths_of_a_metre(std::string& out, std::int64_t steps);

using base::append_clean;
using base::append_json;
using base::append_xml;

/// Appends the tags as a JSON object of strings, in the order of the extract.
void append_tags_json(std::string& out, const model::Extract& extract, model::Range tags);

/// The object's page at openstreetmap.org; empty for an editor's new object (negative number), which has none.
std::string osm_page(model::OsmId id);

/// The addr:* tags of an object; views into the extract, empty where absent.
struct Address {
  std::string_view country, city, suburb, postcode, street, place, house_number, house_name;
  bool empty() const;
  /// "Kastanienallee 12, 10435 Berlin"; street falls back to place, number to house name.
  std::string line() const;
  /// "Kastanienallee 12"; empty where street or number, or what stands for it, is missing.
  std::string street_line() const;
};

/// Finds tags by their interned keys, which it looks up once: one per writer call.
class TagReader {
 public:
  explicit TagReader(const model::Extract* extract);
  /// Empty for a region without extract.
  std::string_view value(model::Range tags, base::StringId key) const {
    return extract_ ? extract_->tag(tags, key) : std::string_view{};
  }
  std::string_view name(model::Range tags) const { return value(tags, name_); }
  std::string_view start_date(model::Range tags) const { return value(tags, start_date_); }
  std::string_view building_use(model::Range tags) const { return value(tags, building_use_); }
  Address address(model::Range tags) const;
  /// A part's own, else its building's.
  std::string_view name_of(const model::Building& building, const model::BuildingPart& part) const;
  Address address_of(const model::Building& building, const model::BuildingPart& part) const;
  const model::Extract* extract() const { return extract_; }

 private:
  const model::Extract* extract_;
  base::StringId name_ = 0, start_date_ = 0, building_use_ = 0;
  base::StringId country_ = 0, city_ = 0, suburb_ = 0, postcode_ = 0, street_ = 0, place_ = 0, house_number_ = 0,
                 house_name_ = 0;
};

}  // namespace blockrand::outputs
