#include "pipeline/outputs/explain/places.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "pipeline/model/osm_keys.h"
#include "pipeline/outputs/wall_segment_ids.h"

namespace blockrand::outputs {
namespace {

constexpr std::size_t kPlaceFields = 7;

std::optional<double> decimal(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// As the explanation has it, but for line ends and tabs.
std::string one_field(std::string_view text) {
  std::string out;
  append_clean(out, text);
  for (char& c : out)
    if (const auto byte = static_cast<unsigned char>(c); byte < 0x20 || byte == 0x7F) c = ' ';
  return out;
}

std::string_view trimmed(std::string_view text) {
  while (text.starts_with(' ')) text.remove_prefix(1);
  while (text.ends_with(' ')) text.remove_suffix(1);
  return text;
}

/// Whether `entry` is one of `list`: "5;7", "5, 7".
bool has_entry(std::string_view list, std::string_view separators, std::string_view entry) {
  while (!list.empty()) {
    const std::size_t end = std::min(list.find_first_of(separators), list.size());
    if (trimmed(list.substr(0, end)) == entry) return true;
    list.remove_prefix(std::min(end + 1, list.size()));
  }
  return false;
}

}  // namespace

std::optional<Place> read_place(std::string_view line) {
  std::array<std::string_view, kPlaceFields> fields;
  for (std::size_t i = 0; i < kPlaceFields; ++i) {
    const std::size_t end = line.find('\t');
    if ((end == std::string_view::npos) != (i + 1 == kPlaceFields)) return std::nullopt;
    fields[i] = line.substr(0, end);
    line.remove_prefix(end == std::string_view::npos ? line.size() : end + 1);
  }
  const auto lon = decimal(fields[2]), lat = decimal(fields[3]), top = decimal(fields[4]);
  if (fields[0].empty() || fields[1].empty() || !lon || !lat || !top) return std::nullopt;
  return Place{std::string(fields[0]), std::string(fields[1]), *lon, *lat, *top,
               std::string(fields[5]), std::string(fields[6])};
}

std::string place_line(const Place& p) {
  return fmt::format("{}\t{}\t{:.7f}\t{:.7f}\t{:.1f}\t{}\t{}\n", p.id, p.tile, p.lon, p.lat, std::max(p.top, 0.0),
                     one_field(p.addresses), one_field(p.name));
}

AddressList::AddressList(std::string_view line, std::string_view street, std::string_view numbers)
    : street_(street), numbers_(numbers), text_(line) {}

void AddressList::add(std::string_view number, std::string_view own_street, std::string_view wall_street) {
  if (number.empty()) return;
  if ((own_street.empty() || own_street == street_) && has_entry(numbers_, ";,", number)) return;
  std::string_view street = own_street;
  if (street.empty()) street = street_.empty() ? wall_street : street_;
  const std::string address = street.empty() ? std::string(number) : fmt::format("{} {}", street, number);
  if (!has_entry(text_, ";", address)) text_ += (text_.empty() ? "" : "; ") + address;
}

std::string_view street_of_point(const model::Extract& extract, model::OsmId point) {
  const auto found = std::lower_bound(extract.features.begin(), extract.features.end(), point,
                                      [](const model::Feature& f, model::OsmId id) { return f.id < id; });
  if (found == extract.features.end() || found->id != point) return {};
  const std::string_view street = extract.tag(found->tags, model::osm_key::kAddrStreet);
  return street.empty() ? extract.tag(found->tags, model::osm_key::kAddrPlace) : street;
}

double top_of(const model::Building& building) {
  double top = 0;
  for (const model::BuildingPart& part : building.parts) top = std::max(top, part.attributes.height.value);
  return top;
}

std::string addresses_of(const model::Region& region, const TagReader& tags, const model::Building& building) {
  const Address own = tags.address(building.tags);
  AddressList list(own.line(), own.street.empty() ? own.place : own.street, own.house_number);
  for (const IdentifiedWallSegment& wall : wall_segments(building)) {
    const model::WallSegment& e = building.edges[wall.index];
    for (const model::WallPoint& point : e.points)
      list.add(point.house_number, region.extract ? street_of_point(*region.extract, point.id) : std::string_view(),
               e.street_name);
  }
  return list.text();
}

}  // namespace blockrand::outputs
