#include "pipeline/validate/explanations.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <set>
#include <unordered_map>
#include <unordered_set>

#include "pipeline/base/text.h"
#include "pipeline/validate/attribute_names.h"
#include "pipeline/validate/checked_json.h"
#include "pipeline/validate/ids.h"

namespace blockrand::validate {
namespace {

/// A value in the text form of contents.h.
std::string value_text(const Json* value) {
  if (const auto n = number(value)) return base::shortest(*n);
  return text(value);
}

constexpr const char* kPlaces = "explain/places.tsv";
/// Half of the last decimal, and a little: degrees, m.
constexpr double kPlaceStep = 0.51e-7, kTopStep = 0.0501;

bool is_decimal(const std::string& text, double& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && std::isfinite(value);
}

std::string on_one_line(std::string text) {
  for (char& c : text)
    if (const auto byte = static_cast<unsigned char>(c); byte < 0x20 || byte == 0x7F) c = ' ';
  return text;
}

double height_of(const Json* attributes) {
  if (attributes && attributes->is_array())
    for (const Json& a : *attributes)
      if (text(member(a, "name")) == "height") return number(member(a, "value")).value_or(0);
  return 0;
}

/// m, of the highest body.
double told_top(const Json& json) {
  double top = 0;
  const Json* bodies = member(json, "bodies");
  if (bodies && bodies->is_array())
    for (const Json& body : *bodies) {
      const Json* own = member(body, "attributes");
      top = std::max(top, height_of(own ? own : member(json, "attributes")));
    }
  return top;
}

/// Whether "5" is one of "5;7" or "5, 7".
bool is_listed(std::string_view list, std::string_view separators, std::string_view wanted) {
  while (!list.empty()) {
    const std::size_t end = std::min(list.find_first_of(separators), list.size());
    std::string_view one = list.substr(0, end);
    while (one.starts_with(' ')) one.remove_prefix(1);
    while (one.ends_with(' ')) one.remove_suffix(1);
    if (one == wanted) return true;
    list.remove_prefix(std::min(end + 1, list.size()));
  }
  return false;
}

/// Its own address, then the house numbers at its walls, each with its own street, the building's, or the wall's.
std::string told_addresses(const Json& json) {
  const Json* tags = member(json, "tags");
  std::string street = text(member(tags, "addr:street"));
  if (street.empty()) street = text(member(tags, "addr:place"));
  const std::string numbers = text(member(tags, "addr:housenumber"));
  std::string all = text(member(json, "address"));
  const Json *edges = member(json, "edges"), none = Json::array();
  for (const Json& edge : edges && edges->is_array() ? *edges : none) {
    const Json* points = member(edge, "points");
    for (const Json& point : points && points->is_array() ? *points : none) {
      const std::string own = text(member(point, "street")), number = text(member(point, "house_number"));
      if (number.empty() || ((own.empty() || own == street) && is_listed(numbers, ";,", number))) continue;
      const std::string of = !own.empty() ? own : !street.empty() ? street : text(member(edge, "street_name"));
      const std::string address = of.empty() ? number : of + " " + number;
      if (!is_listed(all, ";", address)) all += (all.empty() ? "" : "; ") + address;
    }
  }
  return on_one_line(std::move(all));
}

class TileRecords {
 public:
  TileRecords(const std::string& file, const std::string& tile, const Contents* model, bool lean,
              const std::map<std::string, PlaceRow>* places, const BuildRecord& record, std::vector<Finding>& findings)
      : file_(file), tile_(tile), lean_(lean), places_(places), record_(record), findings_(findings) {
    if (!model) return;
    for (const ReadBody& body : model->bodies) bodies_[body.building].push_back(&body);
    has_model_ = true;
  }

  void read(std::string_view line, std::size_t number) {
    const auto json = parse_json(line);
    if (!json || !json->is_object()) return wrong(fmt::format("line {}", number), "no JSON object");
    const std::string id = text(member(*json, "id"));
    if (!is_osm_id(id)) return wrong(fmt::format("line {}", number), "has no id");
    if (!lines_.insert(id).second) return wrong(id, "has two lines");
    if (text(member(*json, "tile")) != tile_) wrong(id, "is said to be in tile " + text(member(*json, "tile")));
    const Json* stages = member(*json, "stages");
    if (!stages || !stages->is_array() || stages->empty()) wrong(id, "does not say what the stages did");
    if (const Json* files = member(*json, "files"); files && files->is_array())
      for (const Json& f : *files)
        if (const std::string path = text(&f); !record_.files.count(path) && gone_.insert(path).second)
          wrong(id, "names a file that is not there: " + path);
    if (places_) compare_place(id, *json);
    if (has_model_) compare(id, *json);
  }

  void finish(const std::vector<std::pair<std::string, std::string>>& entries) {
    for (const auto& [building, bodies] : bodies_)
      if (!lines_.count(building)) wrong(building, "stands in the model, but is not explained");
    std::unordered_set<std::string_view> indexed;
    for (const auto& [object, building] : entries) {
      indexed.insert(object);
      if (!lines_.count(building))
        wrong(object, fmt::format("the index leads to {}, which has no line here", building));
    }
    if (places_)
      for (const auto& [id, place] : *places_)
        if (!lines_.count(id))
          findings_.push_back(
              {Check::explanation_wrong, kPlaces, id, "stands there, but tile " + tile_ + " does not explain it"});
    for (const std::string& id : lines_)
      if (!indexed.count(id)) wrong(id, "is not in the index");
    for (const auto& [building, bodies] : bodies_)
      for (const ReadBody* body : bodies)
        if (const std::string part = owner(body->id); part != building && !indexed.count(part))
          wrong(part, "is not in the index");
  }

  std::size_t count() const { return lines_.size(); }

 private:
  void compare_place(const std::string& id, const Json& json) {
    const auto differs = [&](std::string what) {
      findings_.push_back({Check::explanation_wrong, kPlaces, id, std::move(what)});
    };
    const auto found = places_->find(id);
    if (found == places_->end()) return differs("is missing");
    const PlaceRow& row = found->second;
    const Json* place = member(json, "place");
    const double lon = number(member(place, "lon")).value_or(0), lat = number(member(place, "lat")).value_or(0);
    if (!(std::fabs(row.lon - lon) <= kPlaceStep) || !(std::fabs(row.lat - lat) <= kPlaceStep))
      differs(fmt::format("stands at {:.7f} {:.7f}, its explanation says {:.7f} {:.7f}", row.lon, row.lat, lon, lat));
    if (const double top = told_top(json); !(std::fabs(row.top - top) <= kTopStep))
      differs(fmt::format("is {:.1f} m high, its explanation says {:.2f}", row.top, top));
    if (const std::string told = told_addresses(json); row.addresses != told)
      differs(fmt::format("has the addresses \"{}\", its explanation says \"{}\"", row.addresses, told));
    if (const std::string told = on_one_line(text(member(json, "name"))); row.name != told)
      differs(fmt::format("has the name \"{}\", its explanation says \"{}\"", row.name, told));
  }

  void wrong(const std::string& object, std::string what) {
    findings_.push_back({Check::explanation_wrong, file_, object, std::move(what)});
  }

  void compare(const std::string& id, const Json& json) {
    const Json* said = member(json, "bodies");
    const std::size_t count = said && said->is_array() ? said->size() : 0;
    const auto model = bodies_.find(id);
    const std::size_t there = model == bodies_.end() ? 0 : model->second.size();
    if (count != there) return wrong(id, fmt::format("is said to have {} bodies, the model has {}", count, there));
    const std::string state = text(member(json, "state"));
    // Houses mapped twice, and outlines around mapped houses, are built as others.
    if (count == 0 && state != "reported" && state != "represented" && state != "duplicate")
      wrong(id, "has no body, but is not reported");
    std::unordered_map<std::string, const ReadBody*> bodies;
    if (model != bodies_.end())
      for (const ReadBody* body : model->second) bodies.emplace(body->id, body);
    for (std::size_t i = 0; i < count; ++i) {
      const Json& body = (*said)[i];
      std::string body_id = text(member(body, "id"));
      if (count > 1 && body_id == id) body_id += ".1";
      const auto found = bodies.find(body_id);
      if (found == bodies.end()) {
        wrong(id, "explains a body that does not exist: " + body_id);
        continue;
      }
      differs(*found->second, "lod", value_text(member(body, "lod")));
      differs(*found->second, "built_roof", text(member(body, "built_roof")));
      compare_detail(*found->second, member(body, "detail"));
      const Json* attributes = member(body, "attributes");
      if (!attributes && count == 1) attributes = member(json, "attributes");
      if (attributes && attributes->is_array()) compare_attributes(*found->second, *attributes);
    }
  }

  /// What is said of LoD3 against what stands there; of formats that tell no solids, nothing is known.
  void compare_detail(const ReadBody& body, const Json* said) {
    const auto solid =
        std::find_if(body.solids.begin(), body.solids.end(), [](const ReadSolid& s) { return s.lod == 3; });
    if (solid == body.solids.end()) return;
    if (!said || !said->is_object()) return wrong(body.id, "its facades are not explained");
    const auto polygons = [&](const char* kind) {
      return static_cast<std::uint64_t>(std::count_if(solid->polygons.begin(), solid->polygons.end(),
                                                      [&](const ReadPolygon& p) { return p.kind == kind; }));
    };
    const auto sum = [&](const char* name) {
      std::uint64_t n = 0;
      if (const Json* kinds = member(*said, name); kinds && kinds->is_object())
        for (const auto& [kind, count] : kinds->items()) n += whole(&count).value_or(0);
      return n;
    };
    const auto expect = [&](const char* what, std::uint64_t is, std::uint64_t told) {
      if (is != told) wrong(body.id, fmt::format("is said to have {} {}, the model has {}", told, what, is));
    };
    expect("windows", polygons("window"), whole(member(*said, "windows")).value_or(0));
    expect("doors", polygons("door"), whole(member(*said, "doors")).value_or(0));
    const std::size_t placed = body.detail.placements.size();
    if (!lean_ || placed > sum("elements")) expect("placed elements", placed, sum("elements"));
    expect("installations", body.detail.installations.size(), sum("installations"));
  }

  void compare_attributes(const ReadBody& body, const Json& attributes) {
    std::set<std::string> said;
    for (const Json& a : attributes) {
      const std::string name = text(member(a, "name"));
      said.insert(name);
      differs(body, name, value_text(member(a, "value")));
      differs(body, name + "_source", text(member(a, "source")));
      if (const auto confidence = number(member(a, "confidence")); !confidence || *confidence < 0 || *confidence > 1)
        wrong(body.id, name + " has no confidence in [0, 1]");
    }
    for (const std::string& name : attribute_names())
      if (body.attributes.count(name) && !said.count(name)) wrong(body.id, name + " is not explained");
  }

  void differs(const ReadBody& body, const std::string& name, const std::string& said) {
    const auto is = body.attributes.find(name);
    if (is == body.attributes.end()) return;  // the other format does not say
    // A property table for people rounds.
    const PeopleColumn* const column = body.attributes.contains("sources") ? people_column(name) : nullptr;
    const double step = column ? column->step : 0;
    if (step > 0 && std::fabs(to_number(is->second) - to_number(said)) <= step / 2 + 1e-9) return;
    if (is->second != said)
      wrong(body.id, fmt::format("{} is said to be \"{}\", the model has \"{}\"", name, said, is->second));
  }

  const std::string &file_, &tile_;
  bool lean_;
  const std::map<std::string, PlaceRow>* places_;
  const BuildRecord& record_;
  std::vector<Finding>& findings_;
  bool has_model_ = false;
  std::map<std::string, std::vector<const ReadBody*>> bodies_;  ///< by building
  std::set<std::string> lines_, gone_;
};

}  // namespace

ExplanationIndex read_explanation_index(std::string_view lines, FindingLog& log) {
  ExplanationIndex index;
  std::unordered_set<std::string> objects;
  std::size_t number = 0;
  while (!lines.empty()) {
    const std::size_t end = std::min(lines.find('\n'), lines.size());
    const std::string_view line = lines.substr(0, end);
    lines.remove_prefix(std::min(end + 1, lines.size()));
    ++number;
    const std::size_t first = line.find(' '), second = first == line.npos ? line.npos : line.find(' ', first + 1);
    const std::string object(line.substr(0, first));
    if (second == line.npos || !is_osm_id(object) || !is_osm_id(line.substr(second + 1))) {
      log.add(Check::explanation_wrong, "explain/index.txt", fmt::format("line {}", number),
              "is no entry of object, tile and building");
      continue;
    }
    if (!objects.insert(object).second) log.add(Check::explanation_wrong, "explain/index.txt", object, "stands twice");
    index[std::string(line.substr(first + 1, second - first - 1))].emplace_back(object, line.substr(second + 1));
  }
  return index;
}

ExplainedPlaces read_places(std::string_view lines, FindingLog& log) {
  constexpr std::size_t kFields = 7;
  ExplainedPlaces places;
  std::unordered_set<std::string> buildings;
  std::pair<int, long long> last{-1, 0};
  for (std::size_t number = 1; !lines.empty(); ++number) {
    const std::size_t end = std::min(lines.find('\n'), lines.size());
    std::string_view line = lines.substr(0, end);
    lines.remove_prefix(std::min(end + 1, lines.size()));
    std::vector<std::string> fields;
    for (std::size_t tab = 0; tab != line.npos;) {
      tab = line.find('\t');
      fields.emplace_back(line.substr(0, tab));
      line.remove_prefix(tab == line.npos ? line.size() : tab + 1);
    }
    PlaceRow row;
    if (fields.size() != kFields || !is_osm_id(fields[0]) || !is_decimal(fields[2], row.lon) ||
        !is_decimal(fields[3], row.lat) || !is_decimal(fields[4], row.top)) {
      log.add(Check::explanation_wrong, kPlaces, fmt::format("line {}", number),
              "is no line of id, tile, longitude, latitude, height, addresses and name");
      continue;
    }
    if (!buildings.insert(fields[0]).second) log.add(Check::explanation_wrong, kPlaces, fields[0], "stands twice");
    const std::pair key(fields[0][0] == 'n' ? 0 : fields[0][0] == 'w' ? 1 : 2, std::atoll(fields[0].c_str() + 1));
    if (key < last) log.add(Check::explanation_wrong, kPlaces, fields[0], "stands out of the order of ids");
    last = key;
    row.addresses = std::move(fields[5]);
    row.name = std::move(fields[6]);
    places[fields[1]].emplace(std::move(fields[0]), std::move(row));
  }
  return places;
}

std::size_t check_explanations(std::string_view lines, const std::string& file, const std::string& tile,
                               const Contents* model, bool lean,
                               const std::vector<std::pair<std::string, std::string>>& entries,
                               const std::map<std::string, PlaceRow>* places, const BuildRecord& record,
                               std::vector<Finding>& findings) {
  TileRecords records(file, tile, model, lean, places, record, findings);
  for (std::size_t number = 1; !lines.empty(); ++number) {
    const std::size_t end = std::min(lines.find('\n'), lines.size());
    records.read(lines.substr(0, end), number);
    lines.remove_prefix(std::min(end + 1, lines.size()));
  }
  records.finish(entries);
  return records.count();
}

}  // namespace blockrand::validate
