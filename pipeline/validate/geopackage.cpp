// Rows, tile by tile.
#include "pipeline/validate/geopackage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "pipeline/base/text.h"
#include "pipeline/model/building.h"
#include "pipeline/model/roof_shape.h"
#include "pipeline/validate/attribute_names.h"
#include "pipeline/validate/geopackage_state.h"
#include "pipeline/validate/ids.h"

namespace blockrand::validate {
namespace {

bool is_colour(std::string_view text) {
  return text.size() == 7 && text[0] == '#' && text.find_first_not_of("0123456789abcdef", 1) == std::string_view::npos;
}

/// Notices stand there as well, where a value that was tagged could not be built.
bool is_fallback_list(std::string_view codes) {
  while (!codes.empty()) {
    const std::size_t end = codes.find(' ');
    const std::string_view code = codes.substr(0, end);
    if (std::none_of(std::begin(model::kIssueInfo), std::end(model::kIssueInfo), [&](const model::IssueInfo& about) {
          return about.text == code && about.issue_class != model::IssueClass::reported && about.text != "NONE";
        }))
      return false;
    codes.remove_prefix(end == std::string_view::npos ? codes.size() : end + 1);
  }
  return true;
}

/// Reads one row of `buildings` or `parts` from a statement with the columns of row_query().
class RowReader {
 public:
  RowReader(const SqliteRow& row, const std::string& file, std::vector<Finding>& findings)
      : row_(row), file_(file), findings_(findings), id_(row.string(1)) {}

  const std::string& id() const { return id_; }
  std::map<std::string, std::string> attributes;
  std::vector<ReadPolygon> footprint;

  void rule(std::string detail) { findings_.push_back({Check::geopackage_rule, file_, id_, std::move(detail)}); }

  void read(const GeoPackageLayer& layer, std::int64_t srs_id) {
    const std::string_view letter = osm_letter(row_.text(2));
    const std::string object = std::string(letter) + std::to_string(row_.integer(3));
    const bool building = layer.type == WkbType::multi_polygon;
    if (letter.empty() || !row_.is_integer(3) || object != (building ? id_ : owner(id_)))
      rule(fmt::format("the id does not fit osm_type {} and osm_number {}", row_.text(2), row_.text(3)));
    if (!(building ? is_osm_id(id_) : is_body_id(id_))) rule("the id has no known form");
    const std::string_view roof = row_.text(5);
    if (!model::roof_shape(roof)) rule(fmt::format("built_roof \"{}\" is unknown", roof));
    attributes["built_roof"] = roof;
    if (!row_.is_integer(4) || row_.integer(4) < -1 || row_.integer(4) > 3)
      rule(fmt::format("lod \"{}\" is none of -1, 0, 1, 2, 3", row_.text(4)));
    attributes["lod"] = std::to_string(row_.integer(4));
    if (!is_fallback_list(row_.text(8))) rule(fmt::format("fallbacks \"{}\" are no codes", row_.text(8)));
    if (!row_.null(9) && !tags_are_sound(row_.text(9))) rule("tags are no JSON object of texts");
    if (!row_.is_real(7) || !(row_.real(7) >= 0)) rule("volume is no number from 0");
    read_geometry(layer, srs_id);
    int column = kFirstAttribute;
    for (const GeoPackageAttribute& a : geopackage_attributes()) {
      read_attribute(a, column);
      column += 3;
    }
  }

  static constexpr int kFirstAttribute = 10;
  static constexpr std::string_view kColumns =
      "geom, id, osm_type, osm_number, lod, built_roof, footprint_area, volume, fallbacks, tags";

 private:
  static bool tags_are_sound(std::string_view text) {
    const auto json = nlohmann::json::parse(text, nullptr, false);
    return json.is_object() && std::all_of(json.begin(), json.end(), [](const auto& v) { return v.is_string(); });
  }

  void read_geometry(const GeoPackageLayer& layer, std::int64_t srs_id) {
    GeoPackageGeometry g = read_geopackage_geometry(row_.text(0), layer.type, srs_id);
    for (const std::string& error : g.errors) rule("geometry: " + error);
    bool on_grid = true;
    for (const ReadPolygon& polygon : g.polygons)
      for (const auto& ring : polygon.rings)
        for (const model::Point3& p : ring) on_grid = on_grid && p == model::snap(p);
    if (!on_grid) findings_.push_back({Check::off_grid, file_, id_, "a point of the footprint is not on the grid"});
    footprint = std::move(g.polygons);
    const double found = area_of(footprint);
    if (!row_.is_real(6) || !(std::fabs(row_.real(6) - found) <= area_tolerance(found)))
      rule(fmt::format("footprint_area is {}, the footprint has {}", row_.text(6), base::shortest(found)));
  }

  void read_attribute(const GeoPackageAttribute& a, int column) {
    const auto source_wrong = [&](std::string detail) {
      findings_.push_back({Check::source_wrong, file_, id_, a.name + ": " + std::move(detail)});
    };
    if (row_.null(column) && (a.name == "roof_direction" || a.name == "ridge_direction")) {
      if (!row_.null(column + 1) || !row_.null(column + 2)) source_wrong("a source or confidence without a value");
      return;
    }
    if (a.number) {
      if (row_.is_real(column) && std::isfinite(row_.real(column)))
        attributes[a.name] = base::shortest(row_.real(column));
      else
        rule(fmt::format("{} is no number but \"{}\"", a.name, row_.text(column)));
    } else {
      const std::string_view value = row_.text(column);
      const bool sound = a.name == "roof_shape"         ? model::roof_shape(value).has_value()
                         : a.name == "roof_orientation" ? value == "along" || value == "across"
                         : a.name.ends_with("_colour")  ? is_colour(value)
                                                        : row_.is_text(column) && !value.empty();
      const bool no_rule_chose = a.name == "preset" && row_.null(column);
      if (sound)
        attributes[a.name] = value;
      else if (!no_rule_chose)
        rule(fmt::format("{} cannot be \"{}\"", a.name, value));
    }
    const std::string_view source = row_.text(column + 1);
    if (is_source(source))
      attributes[a.name + "_source"] = source;
    else
      source_wrong(fmt::format("source \"{}\" is unknown", source));
    const double confidence = row_.real(column + 2);
    if (row_.is_real(column + 2) && confidence >= 0 && confidence <= 1)
      attributes[a.name + "_confidence"] = base::shortest(confidence);
    else
      source_wrong(fmt::format("confidence \"{}\" is not between 0 and 1", row_.text(column + 2)));
  }

  const SqliteRow& row_;
  const std::string& file_;
  std::vector<Finding>& findings_;
  std::string id_;
};

std::string row_query(const GeoPackageLayer& layer, std::string_view more, std::int64_t first, std::int64_t last) {
  std::string sql = "SELECT " + std::string(RowReader::kColumns);
  for (const GeoPackageAttribute& a : geopackage_attributes())
    sql += fmt::format(", \"{0}\", \"{0}_source\", \"{0}_confidence\"", a.name);
  return sql + fmt::format(", {} FROM \"{}\" WHERE fid BETWEEN {} AND {} AND tile = ? ORDER BY fid", more, layer.table,
                           first, last);
}

}  // namespace

double area_tolerance(double area) { return 0.001 + 1e-12 * std::fabs(area); }

double area_of(const std::vector<ReadPolygon>& polygons) {
  double sum = 0;
  for (const ReadPolygon& polygon : polygons)
    for (const auto& ring : polygon.rings)
      for (std::size_t i = 1; i + 1 < ring.size(); ++i)
        sum += ((ring[i].x - ring[0].x) * (ring[i + 1].y - ring[0].y) -
                (ring[i + 1].x - ring[0].x) * (ring[i].y - ring[0].y)) /
               2;
  return sum;
}

const std::vector<GeoPackageAttribute>& geopackage_attributes() {
  static const std::vector<GeoPackageAttribute> attributes = [] {
    std::vector<GeoPackageAttribute> out;
    model::Attributes all;
    all.roof_direction.emplace();
    all.ridge_direction.emplace();
    model::for_each_attribute(
        all,
        [&](std::string_view name, std::string_view, const auto& sourced) {
          out.push_back({std::string(name), std::is_same_v<std::decay_t<decltype(sourced.value)>, double>});
        },
        [](std::string_view, std::string_view) {});
    return out;
  }();
  return attributes;
}

std::string_view osm_letter(std::string_view type) {
  return type == "node" ? "n" : type == "way" ? "w" : type == "relation" ? "r" : "";
}

std::int64_t GeoPackageReader::State::srs_id() {
  return db.integer("SELECT srs_id FROM gpkg_geometry_columns WHERE table_name = 'buildings'");
}

const std::vector<GeoPackageReader::State::TileSpans>& GeoPackageReader::State::spans() {
  if (have_spans) return tile_spans;
  have_spans = true;
  std::map<std::string, std::size_t> index;
  for (const GeoPackageLayer& layer : kGeoPackageLayers) {
    if (layer.table != "buildings" && layer.table != "parts") continue;
    db.each(fmt::format("SELECT tile, min(fid), max(fid) FROM \"{}\" GROUP BY tile ORDER BY 2", layer.table),
            [&](const SqliteRow& row) {
              const std::string tile = row.string(0);
              const auto [at, is_new] = index.emplace(tile, tile_spans.size());
              if (is_new) tile_spans.push_back({tile, {}});
              tile_spans[at->second].layers.emplace(layer.table, Span{row.integer(1), row.integer(2)});
            });
  }
  return tile_spans;
}

GeoPackageReader::GeoPackageReader(const std::string& path, std::string name)
    : state_(std::make_unique<State>(path, std::move(name))) {}
GeoPackageReader::~GeoPackageReader() = default;

std::int64_t GeoPackageReader::srs_id() {
  const std::lock_guard lock(state_->reading);
  return state_->srs_id();
}

std::vector<std::string> GeoPackageReader::tiles() {
  const std::lock_guard lock(state_->reading);
  std::vector<std::string> out;
  for (const State::TileSpans& s : state_->spans()) out.push_back(s.tile);
  return out;
}

GeoPackageTileRows GeoPackageReader::rows(const std::string& tile) {
  const std::lock_guard lock(state_->reading);
  State& s = *state_;
  GeoPackageTileRows out;
  std::vector<Finding>& findings = out.contents.findings;
  const auto& spans = s.spans();
  const auto found = std::find_if(spans.begin(), spans.end(), [&](const auto& t) { return t.tile == tile; });
  if (found == spans.end()) return out;
  const std::int64_t srs_id = s.srs_id();
  constexpr int kMore = RowReader::kFirstAttribute;
  const int more = kMore + 3 * static_cast<int>(geopackage_attributes().size());
  std::map<std::string, std::int64_t> bodies;  // of each building
  const auto read = [&](const GeoPackageLayer& layer, std::string_view columns, const auto& take) {
    const auto span = found->layers.find(layer.table);
    if (span == found->layers.end()) return;
    const bool whole = s.db.each(row_query(layer, columns, span->second.first, span->second.last), take, {tile});
    if (!whole)
      findings.push_back(
          {Check::file_unreadable, s.name, tile, fmt::format("layer {}: {}", layer.table, s.db.error())});
  };
  read(kGeoPackageLayers[1], "building", [&](const SqliteRow& row) {
    RowReader r(row, s.name, findings);
    r.read(kGeoPackageLayers[1], srs_id);
    ReadBody body{r.id(), row.string(more), std::move(r.attributes), std::move(r.footprint), {}, {}};
    if (body.building != building_of(body.id))
      r.rule("the id does not begin with that of its building " + body.building);
    ++bodies[body.building];
    out.contents.bodies.push_back(std::move(body));
  });
  read(kGeoPackageLayers[0], "state, parts", [&](const SqliteRow& row) {
    RowReader r(row, s.name, findings);
    r.read(kGeoPackageLayers[0], srs_id);
    GeoPackageBuilding b{r.id(),
                         row.string(more),
                         static_cast<int>(row.integer(4)),
                         row.integer(more + 1),
                         std::move(r.attributes),
                         std::move(r.footprint)};
    if (b.state != "modelled" && b.state != "represented" && b.state != "reported")
      r.rule(fmt::format("state \"{}\" is unknown", b.state));
    const auto own = bodies.find(b.id);
    const std::int64_t count = own == bodies.end() ? 0 : own->second;
    if (own != bodies.end()) bodies.erase(own);
    if (b.parts != count || count == 0)
      r.rule(fmt::format("says {} parts, its tile holds {} rows of it in the layer parts", b.parts, count));
    out.contents.buildings.push_back(b.id);
    out.buildings.push_back(std::move(b));
  });
  for (const auto& [building, count] : bodies)
    findings.push_back(
        {Check::geopackage_rule, s.name, building,
         fmt::format("{} rows of the layer parts belong to it, and the layer buildings has it not", count)});
  return out;
}

std::vector<GeoPackageReportedRow> GeoPackageReader::reported() {
  const std::lock_guard lock(state_->reading);
  std::vector<GeoPackageReportedRow> out;
  const std::int64_t srs_id = state_->srs_id();
  state_->db.each("SELECT id, kind, state, code, detail, related, geom FROM reported ORDER BY fid",
                  [&](const SqliteRow& row) {
                    GeoPackageReportedRow r{.id = row.string(0),
                                            .kind = row.string(1),
                                            .state = row.string(2),
                                            .code = row.string(3),
                                            .detail = row.string(4),
                                            .related = row.string(5)};
                    if (!row.null(6)) {
                      const GeoPackageGeometry g = read_geopackage_geometry(row.text(6), WkbType::point, srs_id);
                      if (g.errors.empty()) r.place = g.point;
                    }
                    out.push_back(std::move(r));
                  });
  return out;
}

std::vector<GeoPackageTileRow> GeoPackageReader::tile_rows() {
  const std::lock_guard lock(state_->reading);
  std::vector<GeoPackageTileRow> out;
  state_->db.each("SELECT id, uri, buildings, parts, bytes FROM tiles ORDER BY fid", [&](const SqliteRow& row) {
    out.push_back({row.string(0), row.string(1), row.integer(2), row.integer(3), row.integer(4)});
  });
  return out;
}

std::map<std::string, std::set<std::string>, std::less<>> GeoPackageReader::columns() {
  const std::lock_guard lock(state_->reading);
  std::map<std::string, std::set<std::string>, std::less<>> out;
  for (const GeoPackageLayer& layer : kGeoPackageLayers)
    state_->db.each("SELECT name FROM pragma_table_info(?)",
                    [&](const SqliteRow& row) { out[std::string(layer.table)].insert(row.string(0)); }, {layer.table});
  return out;
}

RepairsSaid GeoPackageReader::repairs() {
  const std::lock_guard lock(state_->reading);
  RepairsSaid said;
  state_->db.each("SELECT id, max_shift, overlaps_resolved FROM buildings WHERE max_shift >= 0",
                  [&](const SqliteRow& row) {
                    said[row.string(0)] = {row.real(1), row.integer(2) > 0};
                  });
  return said;
}

}  // namespace blockrand::validate
