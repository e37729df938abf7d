#include "pipeline/outputs/number_text.h"

#include <charconv>
#include <cmath>

#include "pipeline/model/osm_keys.h"
#include "pipeline/model/point.h"

namespace blockrand::outputs {
namespace {

template <class T>
void append_shortest(std::string& out, T value) {
  if (value == 0) value = 0;  // to_chars would print the sign of -0
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof(buffer), value).ptr;
  out.append(buffer, end);
}

}  // namespace

void append_number(std::string& out, double value) { append_shortest(out, value); }
void append_number(std::string& out, float value) { append_shortest(out, value); }
void append_number(std::string& out, std::int64_t value) { append_shortest(out, value); }

namespace {

/// A number of ten-thousandths with its sign, without trailing zeros.
void append_ten_thousandths_of(std::string& out, std::uint64_t rest, bool negative) {
  char buffer[24];
  char* p = buffer + sizeof(buffer);
  auto fraction = static_cast<unsigned>(rest % 10000);
  rest /= 10000;
  if (fraction != 0) {
    int digits = 4;
    while (fraction % 10 == 0) {
      fraction /= 10;
      --digits;
    }
    for (; digits > 0; --digits) {
      *--p = static_cast<char>('0' + fraction % 10);
      fraction /= 10;
    }
    *--p = '.';
  }
  do {
    *--p = static_cast<char>('0' + rest % 10);
    rest /= 10;
  } while (rest != 0);
  if (negative) *--p = '-';
  out.append(p, static_cast<std::size_t>(buffer + sizeof(buffer) - p));
}

std::uint64_t magnitude(std::int64_t v) {
  return v < 0 ? static_cast<std::uint64_t>(-v) : static_cast<std::uint64_t>(v);
}

}  // namespace

void append_grid(std::string& out, double metres) {
  const auto steps = static_cast<std::int64_t>(std::nearbyint(metres * model::kGridStepsPerMetre));
  // 1/1024 m = 10000/1024 = 625/64 tenths of a millimetre, rounded half up.
  append_ten_thousandths_of(out, (magnitude(steps) * 625 + 32) / 64, steps < 0);
}

void append_ten_thousandths_of_a_metre(std::string& out, std::int64_t steps) {
  append_ten_thousandths_of(out, magnitude(steps), steps < 0);
}

std::string osm_page(model::OsmId id) {
  if (id.number <= 0) return {};
  const char* const kind = id.type == model::OsmType::node  ? "node/"
                           : id.type == model::OsmType::way ? "way/"
                                                            : "relation/";
  std::string page = std::string("https://www.openstreetmap.org/") + kind;
  append_number(page, id.number);
  return page;
}

void append_tags_json(std::string& out, const model::Extract& extract, model::Range tags) {
  out += '{';
  bool first = true;
  for (const model::Tag& tag : extract.tags_of(tags)) {
    if (!first) out += ',';
    first = false;
    append_json(out, extract.strings.view(tag.key));
    out += ':';
    append_json(out, extract.strings.view(tag.value));
  }
  out += '}';
}

bool Address::empty() const {
  return country.empty() && city.empty() && suburb.empty() && postcode.empty() && street.empty() && place.empty() &&
         house_number.empty() && house_name.empty();
}

std::string Address::line() const {
  std::string out;
  const auto add = [&](std::string_view text, std::string_view separator) {
    if (text.empty()) return;
    if (!out.empty()) out += separator;
    out += text;
  };
  add(street.empty() ? place : street, "");
  add(house_number.empty() ? house_name : house_number, " ");
  add(postcode, ", ");
  add(city, postcode.empty() ? ", " : " ");
  return out;
}

std::string Address::street_line() const {
  const std::string_view way = street.empty() ? place : street;
  const std::string_view number = house_number.empty() ? house_name : house_number;
  if (way.empty() || number.empty()) return {};
  return std::string(way) + " " + std::string(number);
}

TagReader::TagReader(const model::Extract* extract) : extract_(extract) {
  if (!extract) return;
  const auto key = [&](std::string_view text) { return extract->strings.find(text); };
  name_ = key(model::osm_key::kName);
  start_date_ = key(model::osm_key::kStartDate);
  building_use_ = key(model::osm_key::kBuildingUse);
  country_ = key(model::osm_key::kAddrCountry);
  city_ = key(model::osm_key::kAddrCity);
  suburb_ = key(model::osm_key::kAddrSuburb);
  postcode_ = key(model::osm_key::kAddrPostcode);
  street_ = key(model::osm_key::kAddrStreet);
  place_ = key(model::osm_key::kAddrPlace);
  house_number_ = key(model::osm_key::kAddrHousenumber);
  house_name_ = key(model::osm_key::kAddrHousename);
}

Address TagReader::address(model::Range tags) const {
  Address found;
  if (!extract_) return found;
  // One pass over the tags instead of eight searches: most objects have few tags, and many have none of these.
  for (const model::Tag& tag : extract_->tags_of(tags)) {
    if (tag.key == 0) continue;
    std::string_view* field = tag.key == country_        ? &found.country
                              : tag.key == city_         ? &found.city
                              : tag.key == suburb_       ? &found.suburb
                              : tag.key == postcode_     ? &found.postcode
                              : tag.key == street_       ? &found.street
                              : tag.key == place_        ? &found.place
                              : tag.key == house_number_ ? &found.house_number
                              : tag.key == house_name_   ? &found.house_name
                                                         : nullptr;
    if (field) *field = extract_->strings.view(tag.value);
  }
  return found;
}

std::string_view TagReader::name_of(const model::Building& building, const model::BuildingPart& part) const {
  const std::string_view own = name(part.tags);
  return own.empty() ? name(building.tags) : own;
}

Address TagReader::address_of(const model::Building& building, const model::BuildingPart& part) const {
  const Address own = address(part.tags);
  return own.empty() ? address(building.tags) : own;
}

}  // namespace blockrand::outputs
