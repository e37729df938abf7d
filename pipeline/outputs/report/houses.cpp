#include "pipeline/outputs/report/houses.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <numeric>

#include "pipeline/outputs/report/html_text.h"

namespace blockrand::outputs {
namespace {

constexpr std::array<std::string_view, model::kStyleClassCount> kStyleLabels = {"Gr\u00fcnderzeit", "Tenement",
                                                                                "Modern", "Other"};
constexpr std::array<std::string_view, model::kEraCount> kEraLabels = {"Before 1840", "1840 to 1918", "1919 to 1945",
                                                                       "After 1945"};

std::string_view name_at(const MapFootprints& footprints, std::uint32_t number) {
  return number == 0 ? std::string_view{} : std::string_view(footprints.names[number - 1]);
}

/// "Allee 9" before "Allee 10": runs of digits count as numbers.
bool in_natural_order(std::string_view a, std::string_view b) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  std::size_t i = 0, k = 0;
  while (i < a.size() && k < b.size()) {
    if (is_digit(a[i]) && is_digit(b[k])) {
      while (i < a.size() && a[i] == '0') ++i;
      while (k < b.size() && b[k] == '0') ++k;
      std::size_t m = i, n = k;
      while (m < a.size() && is_digit(a[m])) ++m;
      while (n < b.size() && is_digit(b[n])) ++n;
      if (m - i != n - k) return m - i < n - k;
      if (const int order = a.substr(i, m - i).compare(b.substr(k, n - k)); order != 0) return order < 0;
      i = m, k = n;
    } else {
      if (a[i] != b[k]) return static_cast<unsigned char>(a[i]) < static_cast<unsigned char>(b[k]);
      ++i, ++k;
    }
  }
  return a.size() - i < b.size() - k;
}

/// JSON that is XML as it stands: & < > are written as \u0026 and so on.
void append_safe_json(std::string& out, std::string_view text) {
  std::string json;
  append_json(json, text);
  for (const char c : json) {
    if (c == '&')
      out += "\\u0026";
    else if (c == '<')
      out += "\\u003c";
    else if (c == '>')
      out += "\\u003e";
    else
      out += c;
  }
}

/// Words that many houses share, numbered as they come.
class Words {
 public:
  std::size_t number(const std::string& word) {
    const auto found = std::ranges::find(words_, word);
    if (found != words_.end()) return static_cast<std::size_t>(found - words_.begin());
    words_.push_back(word);
    return words_.size() - 1;
  }
  std::string json() const {
    std::string out = "[";
    for (const std::string& word : words_) {
      if (out.size() > 1) out += ',';
      append_safe_json(out, word);
    }
    return out + "]";
  }

 private:
  std::vector<std::string> words_;
};

std::string square_metres(Area area) { return base::with_thousands(static_cast<std::uint64_t>((area + 50) / 100)); }

/// "4", "2.5": halves are tagged now and then.
std::string storeys_text(float storeys) {
  const auto tenths = static_cast<std::int64_t>(static_cast<double>(storeys) * 10 + 0.5);
  return tenths % 10 == 0 ? std::to_string(tenths / 10)
                          : std::to_string(tenths / 10) + "." + std::to_string(tenths % 10);
}

std::string spaced(std::string_view name) {
  std::string out(name);
  std::ranges::replace(out, '_', ' ');
  return out;
}

// ---- CSV

/// Quoted where it must be.
void append_cell(std::string& out, std::string_view text) {
  if (text.find_first_of("\",\r\n") == std::string_view::npos) {
    out += text;
    return;
  }
  out += '"';
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  out += '"';
}

class CsvLine {
 public:
  explicit CsvLine(std::string& out) : out_(out) {}
  /// Text of others: spreadsheets run what begins with = + - @, also behind blanks.
  CsvLine& text(std::string_view text) {
    std::string clean;
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    const std::string_view head = first == std::string_view::npos ? std::string_view() : text.substr(first, 3);
    // The wide ones as well: \uFF1D \uFF0B \uFF0D \uFF20 (OWASP, CSV injection).
    if (!head.empty() && (std::string_view("=+-@").find(head[0]) != std::string_view::npos || head == "\xEF\xBC\x9D" ||
                          head == "\xEF\xBC\x8B" || head == "\xEF\xBC\x8D" || head == "\xEF\xBC\xA0"))
      clean = "'";
    append_clean(clean, text);
    return cell(clean);
  }
  CsvLine& cell(std::string_view own) {
    if (!first_) out_ += ',';
    first_ = false;
    append_cell(out_, own);
    return *this;
  }
  CsvLine& number(double value, int decimals) {
    const bool negative = value < 0;
    std::string digits = rounded(negative ? -value : value, decimals);
    std::erase(digits, ',');
    return cell((negative ? "-" : "") + digits);
  }
  CsvLine& area(Area area) { return number(static_cast<double>(area) / 100, 1); }
  CsvLine& nothing() { return cell({}); }
  void end() { out_ += "\r\n"; }

 private:
  std::string& out_;
  bool first_ = true;
};

}  // namespace

std::string_view style_label(std::uint8_t style) { return style < kStyleLabels.size() ? kStyleLabels[style] : ""; }
std::string_view era_label(std::uint8_t era) { return era < kEraLabels.size() ? kEraLabels[era] : ""; }
std::string use_label(std::string_view use) { return use == "yes" ? std::string() : spaced(use); }

base::Values house_values(const MapFootprints& footprints, const ReportMap& map,
                          const std::vector<std::uint32_t>& block_number, const HouseLimits& limits) {
  const std::vector<MapBuilding>& all = footprints.buildings;
  std::vector<std::uint32_t> order(all.size());
  std::iota(order.begin(), order.end(), 0u);
  const bool some = order.size() > limits.searched;
  if (some) std::erase_if(order, [&](std::uint32_t b) { return all[b].address == 0 && all[b].name == 0; });
  std::ranges::sort(order, [&](std::uint32_t a, std::uint32_t b) {
    const std::string_view x = name_at(footprints, all[a].address), y = name_at(footprints, all[b].address);
    if (x.empty() != y.empty()) return y.empty();
    if (x != y) return in_natural_order(x, y);
    return all[a].osm < all[b].osm;
  });
  const std::size_t found = order.size();
  order.resize(std::min(order.size(), limits.searched));

  base::Values values;
  Words uses, roofs;
  std::string json = "[";
  std::size_t row = 0;
  for (const std::uint32_t i : order) {
    const MapBuilding& b = all[i];
    const std::string use = use_label(name_at(footprints, b.use)), roof = b.built ? spaced(model::name(b.roof)) : "";
    const std::uint32_t block = b.block == 0 ? 0 : block_number[b.block - 1];
    json += row == 0 ? "[\"" : ",\n[\"";
    json += b.osm.text() + "\",";
    append_safe_json(json, name_at(footprints, b.address));
    json += ',';
    append_safe_json(json, name_at(footprints, b.name));
    json += ',' + std::to_string(uses.number(use)) + ',' + (b.built ? storeys_text(b.storeys) : "-1") + ',' +
            std::to_string(static_cast<int>(b.storeys_source)) + ',' + (b.built ? storeys_text(b.height) : "-1") + ',' +
            std::to_string(static_cast<int>(b.height_source)) + ',' + std::to_string(roofs.number(roof)) + ',' +
            std::to_string(static_cast<int>(b.roof_source)) + ',' +
            std::to_string(b.style == kNotClassified ? -1 : b.style) + ',' +
            std::to_string(static_cast<int>(b.style_source)) + ',' +
            std::to_string(b.era == kNotClassified ? -1 : b.era) + ',' + std::to_string((b.floors + 50) / 100) + ',' +
            std::to_string((b.roof_floors + 50) / 100) + ',' + std::to_string(block);
    if (const auto& place = map.places[i]) json += ',' + std::to_string(place->x) + ',' + std::to_string(place->y);
    json += ']';
    if (row++ >= limits.rows) continue;
    base::Values house;
    house.set("id", b.osm.text()).set("link", has_page(b.osm) ? osm_address(b.osm) : std::string());
    house.set("address", name_at(footprints, b.address)).set("name", name_at(footprints, b.name)).set("use", use);
    house.set("built", b.built).set("storeys", storeys_text(b.storeys)).set("height", rounded(b.height, 1));
    house.set("roof", roof).set("style", style_label(b.style)).set("era", era_label(b.era));
    house.set("source", model::name(b.storeys_source)).set("area", square_metres(b.floors));
    values.add("rows", std::move(house));
  }
  json += "]";
  std::string words;
  const auto list = [&](std::string_view name, const auto& labels) {
    words += '"' + std::string(name) + "\":[";
    bool first = true;
    for (const std::string_view label : labels) {
      if (!first) words += ',';
      first = false;
      append_safe_json(words, label);
    }
    words += "],";
  };
  list("styles", kStyleLabels);
  list("eras", kEraLabels);
  std::vector<std::string_view> sources;
  for (int s = 0; s < model::kSourceCount; ++s) sources.push_back(model::name(static_cast<model::Source>(s)));
  list("sources", sources);
  values.set("data",
             "{" + words + "\"uses\":" + uses.json() + ",\"roofs\":" + roofs.json() + ",\n\"houses\":" + json + "}");
  values.set("shown", base::with_thousands(std::min(order.size(), limits.rows)));
  values.set("known", base::with_thousands(order.size())).set("all", base::with_thousands(all.size()));
  values.set("more_than_shown", order.size() > limits.rows).set("some", some).set("cut", found > order.size());
  values.set("any", !order.empty());
  return values;
}

std::string csv_head() {
  return "\xef\xbb\xbfid,osm,name,address,street,house_number,postcode,city,use,storeys,storeys_source,roof_storeys,"
         "height_m,height_source,roof_shape,roof_shape_source,style,style_source,era,era_source,construction_date,"
         "footprint_m2,floor_area_m2,floor_area_on_guessed_storeys_m2,roof_floor_area_m2,block,level_of_detail,bodies,"
         "longitude,latitude\r\n";
}

std::string csv_lines(const model::Region& region, const ReportTile& tile, const georef::Projection& projection) {
  std::string out;
  const TagReader tags(region.extract);
  auto next = tile.footprints.buildings.begin();
  for (const model::Building& building : region.buildings) {
    if (!building.owned) continue;
    const MapBuilding& b = *next++;
    const model::Attributes& a = building.attributes;
    const Address address = tags.address(building.tags);
    CsvLine line(out);
    line.cell(b.osm.text()).cell(osm_page(b.osm)).text(tags.name(building.tags));
    line.text(address.empty() ? std::string() : address.line());
    line.text(address.street.empty() ? address.place : address.street);
    line.text(address.house_number.empty() ? address.house_name : address.house_number);
    line.text(address.postcode).text(address.city).text(a.use.value);
    if (b.built) {
      line.number(a.storeys.value, 1).cell(model::name(a.storeys.source)).number(a.roof_storeys.value, 1);
      line.number(a.height.value, 2).cell(model::name(a.height.source));
      line.cell(model::name(b.roof)).cell(model::name(b.roof_source));
    } else {
      for (int i = 0; i < 7; ++i) line.nothing();
    }
    if (b.style != kNotClassified)
      line.cell(model::kStyleClassNames[b.style]).cell(model::name(b.style_source));
    else
      line.nothing().nothing();
    if (b.era != kNotClassified)
      line.cell(model::kEraNames[b.era]).cell(model::name(b.era_source));
    else
      line.nothing().nothing();
    line.text(a.construction_date.value);
    line.area(b.footprint).area(b.floors).area(b.guessed).area(b.roof_floors);
    line.cell(building.situation.block);
    line.cell(b.lod < 0 ? std::string() : std::to_string(b.lod)).cell(std::to_string(building.parts.size()));
    if (const auto middle = middle_of(tile.footprints, b)) {
      const georef::LonLat place = projection.inverse({middle->x / kMapUnitsPerMetre, middle->y / kMapUnitsPerMetre});
      line.number(place.lon, 6).number(place.lat, 6);
    } else {
      line.nothing().nothing();
    }
    line.end();
  }
  return out;
}

}  // namespace blockrand::outputs
