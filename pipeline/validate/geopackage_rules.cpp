// Rules of the whole file.
#include <fmt/format.h>
#include <libxml/parser.h>
#include <libxml/tree.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <set>
#include <unordered_set>

#include "pipeline/base/text.h"
#include "pipeline/model/issue_codes.h"
#include "pipeline/validate/geopackage_state.h"
#include "pipeline/validate/ids.h"

namespace blockrand::validate {

std::vector<std::string> geopackage_columns(std::string_view table) {
  if (table == "reported")
    return {"id", "osm_type", "osm_number", "kind", "state", "code", "meaning", "detail", "related"};
  if (table == "surfaces") return {"id", "body", "building", "tile", "lod", "class", "colour", "faces"};
  if (table == "tiles") return {"id", "level", "x", "y", "uri", "buildings", "parts", "bytes"};
  if (table != "buildings" && table != "parts") return context_columns(table);
  std::vector<std::string> columns{"id",         "osm_type", "osm_number",     "tile",      "lod",
                                   "built_roof", "volume",   "footprint_area", "fallbacks", "tags"};
  for (const char* name : {"state", "parts"})
    if (table == "buildings") columns.emplace_back(name);
  if (table == "parts") columns.emplace_back("building");
  if (table == "buildings")
    for (std::string& name : context_columns(table)) columns.push_back(std::move(name));
  for (const GeoPackageAttribute& a : geopackage_attributes())
    for (const char* end : {"", "_source", "_confidence"}) columns.push_back(a.name + end);
  return columns;
}

namespace {

constexpr std::int64_t kApplicationId = 0x47504B47;  // "GPKG"
/// Boxes of the spatial index are single precision, rounded outward: two steps of a float at most.
double index_slack(double value) { return std::max(1e-3, std::fabs(value) * (2.0 / 8388608)); }
// Extents go through decimal text on their way into the file: the last bit may be lost.
constexpr double kExtentSlack = 1e-6;

class Rules {
 public:
  using State = GeoPackageReader::State;
  Rules(State& s, FindingLog& log) : s_(s), log_(log) {}

  bool run() {
    if (!readable()) return false;
    identification();
    if (!tables()) return false;
    for (const GeoPackageLayer& layer : kGeoPackageLayers) this->layer(layer);
    if (has_surroundings())
      for (const GeoPackageLayer& layer : kSurroundingLayers) this->layer(layer);
    descriptions();
    styles();
    ids();
    reported();
    tile_rows();
    surfaces();
    check_context(s_, log_);
    beside();
    return true;
  }

 private:
  void rule(std::string object, std::string detail) {
    log_.add(Check::geopackage_rule, s_.name, std::move(object), std::move(detail));
  }
  void unreadable(std::string what) { log_.add(Check::file_unreadable, s_.name, "", std::move(what)); }
  /// Runs a query that a sound file can answer.
  template <class F>
  void each(const std::string& sql, const F& f) {
    if (!s_.db.each(sql, f)) rule("", fmt::format("{} (in: {})", s_.db.error(), sql.substr(0, 120)));
  }

  bool readable() {
    if (!s_.db.open()) {
      unreadable("SQLite cannot open it: " + s_.db.error());
      return false;
    }
    // A truncated or damaged page shows here before anything is concluded from rows.
    bool sound = true;
    if (!s_.db.each("PRAGMA integrity_check(20)", [&](const SqliteRow& row) {
          if (row.text(0) == "ok") return;
          sound = false;
          unreadable("SQLite's integrity check: " + row.string(0));
        })) {
      unreadable("SQLite cannot read it: " + s_.db.error());
      return false;
    }
    return sound;
  }

  void identification() {
    if (const auto id = s_.db.integer("PRAGMA application_id"); id != kApplicationId)
      rule("", fmt::format("application_id is {}, that of a GeoPackage is {}", id, kApplicationId));
    if (const auto version = s_.db.integer("PRAGMA user_version"); version < 10200 || version > 10499)
      rule("", fmt::format("user_version {} is none of GeoPackage 1.2 to 1.4", version));
    each("PRAGMA foreign_key_check", [&](const SqliteRow& row) {
      rule(row.string(0), fmt::format("row {} refers to a row of {} that is not there", row.integer(1), row.text(2)));
    });
  }

  bool is_table(std::string_view name) {
    std::int64_t count = 0;
    s_.db.each("SELECT count(*) FROM sqlite_master WHERE type = 'table' AND name = ?",
               [&](const SqliteRow& row) { count = row.integer(0); }, {name});
    return count == 1;
  }

  std::set<std::string> columns_of(std::string_view table) {
    std::set<std::string> names;
    s_.db.each("SELECT name FROM pragma_table_info(?)", [&](const SqliteRow& row) { names.insert(row.string(0)); },
               {table});
    return names;
  }

  bool tables() {
    bool all = true;
    for (const std::string_view table :
         {"gpkg_spatial_ref_sys", "gpkg_contents", "gpkg_geometry_columns", "gpkg_extensions", "buildings", "parts",
          "reported", "tiles", "facade_edges", "blocks", "courtyards", "cells", "surfaces", "layer_styles"}) {
      if (is_table(table)) continue;
      rule(std::string(table), "the table is missing");
      all = false;
    }
    for (const GeoPackageLayer& layer : kGeoPackageLayers) {
      const std::set<std::string> there = columns_of(layer.table);
      std::vector<std::string> wanted = geopackage_columns(layer.table);
      wanted.insert(wanted.end(), {"fid", "geom"});
      for (const std::string& column : wanted) {
        if (there.empty() || there.contains(column)) continue;
        rule(std::string(layer.table), "the column " + column + " is missing");
        all = false;
      }
    }
    return all;
  }

  /// Whether the layers of surroundings are there; tells of those that are there without the others.
  bool has_surroundings() {
    std::size_t there = 0;
    for (const GeoPackageLayer& layer : kSurroundingLayers)
      there += columns_of(layer.table).contains(std::string(layer.id));
    if (there != 0 && there != std::size(kSurroundingLayers)) rule("ground", "layers of surroundings are missing");
    return there == std::size(kSurroundingLayers);
  }

  /// What the standard's tables say of a layer, then its geometries and their index, row by row.
  void layer(const GeoPackageLayer& l) {
    const std::string table(l.table);
    std::int64_t srs_id = 0;
    int rows = 0;
    each(fmt::format(
             "SELECT geometry_type_name, srs_id, z, m, column_name FROM gpkg_geometry_columns WHERE table_name = '{}'",
             table),
         [&](const SqliteRow& row) {
           ++rows;
           srs_id = row.integer(1);
           if (row.text(0) != l.geometry_type || row.text(4) != "geom" ||
               row.integer(2) != (l.type == WkbType::multi_polygon_z ? 1 : 0) || row.integer(3) != 0)
             rule(table, fmt::format("gpkg_geometry_columns registers {} {} with z {} and m {}, it holds geom {}",
                                     row.text(4), row.text(0), row.integer(2), row.integer(3), l.geometry_type));
         });
    if (rows != 1) rule(table, fmt::format("{} rows of gpkg_geometry_columns register it", rows));
    if (s_.db.integer(
            fmt::format("SELECT count(*) FROM gpkg_spatial_ref_sys WHERE srs_id = {} AND upper(organization) = 'EPSG' "
                        "AND organization_coordsys_id = srs_id AND length(definition) > 50",
                        srs_id)) != 1)
      rule(table, fmt::format("its reference system {} is not one of EPSG's with a definition", srs_id));
    if (srs_id != s_.srs_id()) rule(table, "its reference system is another than that of the buildings");
    if (s_.db.integer(
            fmt::format("SELECT count(*) FROM gpkg_extensions WHERE table_name = '{}' AND column_name = 'geom' AND "
                        "extension_name = 'gpkg_rtree_index'",
                        table)) != 1)
      rule(table, "gpkg_extensions does not register its spatial index");

    const Box box = geometries(l, srs_id);
    rows = 0;
    each(fmt::format("SELECT data_type, srs_id, min_x, min_y, max_x, max_y, last_change FROM gpkg_contents WHERE "
                     "table_name = '{}'",
                     table),
         [&](const SqliteRow& row) {
           ++rows;
           if (row.text(0) != "features") rule(table, fmt::format("gpkg_contents calls it {}", row.text(0)));
           if (row.integer(1) != srs_id)
             rule(table, "gpkg_contents and gpkg_geometry_columns name different reference systems");
           const double slack = kExtentSlack;
           if (!box.empty() && (row.null(2) || row.real(2) > box.min_x + slack || row.real(3) > box.min_y + slack ||
                                row.real(4) < box.max_x - slack || row.real(5) < box.max_y - slack))
             rule(table, "the extent in gpkg_contents does not hold the layer");
           if (!is_time(row.text(6))) rule(table, fmt::format("last_change \"{}\" is no time", row.text(6)));
         });
    if (rows != 1) rule(table, fmt::format("{} rows of gpkg_contents register it", rows));
    if (is_table("gpkg_ogr_contents")) {
      const auto count = s_.db.integer(fmt::format("SELECT count(*) FROM \"{}\"", table));
      const auto said = s_.db.integer(
          fmt::format("SELECT feature_count FROM gpkg_ogr_contents WHERE table_name = '{}'", table), count);
      if (said != count) rule(table, fmt::format("gpkg_ogr_contents says {} rows, it has {}", said, count));
    }
  }

  struct Box {
    double min_x = 1, min_y = 1, max_x = 0, max_y = 0;
    bool empty() const { return min_x > max_x; }
    void add(const GeoPackageGeometry& g) {
      if (empty()) {
        *this = {g.min_x, g.min_y, g.max_x, g.max_y};
        return;
      }
      min_x = std::min(min_x, g.min_x);
      min_y = std::min(min_y, g.min_y);
      max_x = std::max(max_x, g.max_x);
      max_y = std::max(max_y, g.max_y);
    }
  };

  Box geometries(const GeoPackageLayer& l, std::int64_t srs_id) {
    const std::string table(l.table), index = "rtree_" + table + "_geom";
    const bool indexed = is_table(index);
    if (!indexed) rule(table, "the spatial index " + index + " is missing");
    Box box;
    std::int64_t count = 0, unlike = 0;
    std::string first_unlike;
    // Buildings and parts are read again, with their rows, by rows(); their errors are told there.
    const bool tell = l.table != "buildings" && l.table != "parts";
    each(fmt::format("SELECT l.fid, l.{3}, l.geom{1} FROM \"{0}\" l{2}", table,
                     indexed ? ", r.minx, r.miny, r.maxx, r.maxy" : "",
                     indexed ? fmt::format(" LEFT JOIN \"{}\" r ON r.id = l.fid", index) : "", l.id),
         [&](const SqliteRow& row) {
           if (row.null(2)) {
             if (l.needs_geometry) rule(row.string(1), fmt::format("no geometry in the layer {}", table));
             return;
           }
           ++count;
           const GeoPackageGeometry g = read_geopackage_geometry(row.text(2), l.type, srs_id);
           if (tell)
             for (const std::string& error : g.errors)
               rule(row.string(1), fmt::format("layer {}, geometry: {}", table, error));
           if (!g.errors.empty()) return;
           box.add(g);
           if (!indexed) return;
           const bool like =
               !row.null(3) && row.real(3) <= g.min_x && row.real(4) <= g.min_y && row.real(5) >= g.max_x &&
               row.real(6) >= g.max_y && row.real(3) >= g.min_x - index_slack(g.min_x) &&
               row.real(4) >= g.min_y - index_slack(g.min_y) && row.real(5) <= g.max_x + index_slack(g.max_x) &&
               row.real(6) <= g.max_y + index_slack(g.max_y);
           if (like) return;
           if (unlike++ == 0) first_unlike = row.string(1);
         });
    if (unlike > 0)
      rule(first_unlike,
           fmt::format("layer {}: the spatial index has no or a wrong box, for it and {} others", table, unlike - 1));
    if (indexed) {
      if (const auto entries = s_.db.integer(fmt::format("SELECT count(*) FROM \"{}\"", index)); entries != count)
        rule(table, fmt::format("the spatial index has {} entries for {} geometries", entries, count));
      if (const std::string said = s_.db.text(fmt::format("SELECT rtreecheck('{}')", index));
          !said.empty() && said != "ok")
        rule(table, "the spatial index is damaged: " + said.substr(0, said.find('\n')));
    }
    return box;
  }

  static bool is_time(std::string_view text) {
    constexpr std::string_view form = "dddd-dd-ddTdd:dd:dd.dddZ";
    if (text.size() != form.size()) return false;
    for (std::size_t i = 0; i < form.size(); ++i)
      if (form[i] == 'd' ? text[i] < '0' || text[i] > '9' : text[i] != form[i]) return false;
    return true;
  }

  void descriptions() {
    if (!is_table("gpkg_data_columns")) return;  // an extension that a file may do without
    std::map<std::string, std::set<std::string>> columns;
    each("SELECT table_name, column_name FROM gpkg_data_columns", [&](const SqliteRow& row) {
      const auto [at, is_new] = columns.try_emplace(row.string(0));
      if (is_new) at->second = columns_of(row.text(0));
      if (!at->second.contains(row.string(1)))
        rule(row.string(0), fmt::format("gpkg_data_columns describes {}, which it does not have", row.text(1)));
    });
  }

  void styles() {
    std::map<std::string, int> defaults;
    each("SELECT f_table_name, f_geometry_column, styleName, styleQML, useAsDefault, f_table_schema FROM layer_styles",
         [&](const SqliteRow& row) {
           const std::string style = fmt::format("style \"{}\" of {}", row.text(2), row.text(0));
           if (row.integer(4) != 0) ++defaults[row.string(0)];
           if (row.text(1) != "geom" || row.null(5) || !row.text(5).empty() || columns_of(row.text(0)).empty())
             rule(row.string(0), style + ": QGIS does not find the layer that it is for");
           const std::string_view qml = row.text(3);
           xmlDoc* const doc = xmlReadMemory(qml.data(), static_cast<int>(qml.size()), "style.qml", nullptr,
                                             XML_PARSE_NONET | XML_PARSE_NOERROR | XML_PARSE_NOWARNING);
           const xmlNode* const root = doc != nullptr ? xmlDocGetRootElement(doc) : nullptr;
           if (root == nullptr)
             rule(row.string(0), style + " is no well-formed XML");
           else if (xmlStrcmp(root->name, reinterpret_cast<const xmlChar*>("qgis")) != 0)
             rule(row.string(0), style + " is no QGIS style");
           xmlFreeDoc(doc);
         });
    for (const GeoPackageLayer& l : kGeoPackageLayers)
      if (const int count = defaults[std::string(l.table)]; count != 1)
        rule(std::string(l.table), fmt::format("{} styles are its default", count));
  }

  void ids() {
    for (const GeoPackageLayer& l : kGeoPackageLayers) {
      if (l.type == WkbType::line_string) continue;  // millions: told building by building
      std::unordered_set<std::string> seen;
      each(fmt::format("SELECT id FROM \"{}\"", l.table), [&](const SqliteRow& row) {
        if (!seen.insert(row.string(0)).second)
          log_.add(Check::object_doubled, s_.name, row.string(0), fmt::format("stands twice in the layer {}", l.table));
      });
    }
  }

  void reported() {
    each("SELECT id, osm_type, osm_number, kind, state, code, meaning, related FROM reported",
         [&](const SqliteRow& row) {
           const std::string id = row.string(0);
           if (!is_osm_id(id) || id != std::string(osm_letter(row.text(1))) + std::to_string(row.integer(2)))
             rule(id, fmt::format("the id does not fit osm_type {} and osm_number {}", row.text(1), row.text(2)));
           if (row.text(3) != "building" && row.text(3) != "building_part")
             rule(id, fmt::format("kind \"{}\" is unknown", row.text(3)));
           const std::string_view state = row.text(4), code = row.text(5);
           if (state == "reported") {
             const auto about = std::find_if(std::begin(model::kIssueInfo), std::end(model::kIssueInfo),
                                             [&](const model::IssueInfo& i) { return i.text == code; });
             if (about == std::end(model::kIssueInfo) || about->text == "NONE")
               rule(id, fmt::format("code \"{}\" is unknown", code));
             else if (about->meaning != row.text(6))
               rule(id, fmt::format("the meaning is not that of {}", code));
           } else if (state == "duplicate" || state == "represented") {
             if (!is_osm_id(row.text(7)))
               rule(id, fmt::format("state {} without the object that stands for it", state));
           } else {
             rule(id, fmt::format("state \"{}\" is unknown", state));
           }
         });
  }

  /// Counts of `tiles` are those of the rows, and every tile that has rows is there.
  void tile_rows() {
    std::map<std::string, std::pair<std::int64_t, std::int64_t>> counted;
    each("SELECT tile, count(*) FROM buildings GROUP BY tile",
         [&](const SqliteRow& row) { counted[row.string(0)].first = row.integer(1); });
    each("SELECT tile, count(*) FROM parts GROUP BY tile",
         [&](const SqliteRow& row) { counted[row.string(0)].second = row.integer(1); });
    each("SELECT id, level, x, y, uri, buildings, parts, bytes FROM tiles", [&](const SqliteRow& row) {
      const std::string id = row.string(0);
      if (id != fmt::format("{}/{}/{}", row.integer(1), row.integer(2), row.integer(3)))
        rule(id,
             fmt::format("the id does not fit level {}, x {}, y {}", row.integer(1), row.integer(2), row.integer(3)));
      if (row.null(4) ? row.integer(7) != 0 : row.text(4).empty() || row.integer(7) <= 0)
        rule(id, fmt::format("{} bytes of the file \"{}\"", row.integer(7), row.text(4)));
      const auto& [buildings, parts] = counted[id];
      if (row.integer(5) != buildings || row.integer(6) != parts)
        log_.add(Check::counts_differ, s_.name, id,
                 fmt::format("the layer tiles says {} buildings and {} parts, the layers hold {} and {}",
                             row.integer(5), row.integer(6), buildings, parts));
      counted.erase(id);
    });
    for (const auto& [tile, count] : counted)
      if (count.first > 0 || count.second > 0)
        log_.add(Check::counts_differ, s_.name, tile,
                 fmt::format("the layer tiles lacks it, and {} buildings are of it", count.first));
  }

  /// The faces of each body in space are closed: each edge is run in both directions equally often. All bodies with a
  /// solid are there, and no others.
  void surfaces() {
    struct Body {
      std::map<std::pair<std::array<double, 3>, std::array<double, 3>>, int> edges;
    };
    Body body;
    std::string id;
    const auto end = [&] {
      if (std::any_of(body.edges.begin(), body.edges.end(), [](const auto& e) { return e.second != 0; }))
        rule(id, "layer surfaces: its faces are not closed");
      body = {};
    };
    const std::int64_t srs_id = s_.srs_id();
    each(
        "SELECT s.id, s.body, s.building, s.tile, s.lod, s.class, s.colour, s.faces, s.geom, p.building, p.tile, "
        "p.lod, "
        "p.fallbacks FROM surfaces s LEFT JOIN parts p ON p.id = s.body ORDER BY s.fid",
        [&](const SqliteRow& row) {
          const std::string name = row.string(0);
          if (row.string(1) != id) {
            end();
            id = row.string(1);
          }
          if (row.null(9)) return rule(name, "layer surfaces: no body of the layer parts");
          if (row.text(2) != row.text(9) || row.text(3) != row.text(10))
            rule(name, "layer surfaces: its building or tile is not that of its body");
          if (row.integer(4) < 1 || row.integer(4) != std::min<std::int64_t>(2, row.integer(11)))
            rule(name, fmt::format("layer surfaces: lod {} of a body of lod {}", row.text(4), row.text(11)));
          constexpr std::string_view kClasses[] = {"ground", "wall", "roof", "outer_ceiling", "outer_floor", "closure"};
          if (std::find(std::begin(kClasses), std::end(kClasses), row.text(5)) == std::end(kClasses))
            rule(name, fmt::format("layer surfaces: class \"{}\" is unknown", row.text(5)));
          const std::string_view colour = row.text(6);
          if (colour.size() != 7 || colour[0] != '#' ||
              colour.find_first_not_of("0123456789abcdef", 1) != std::string_view::npos)
            rule(name, fmt::format("layer surfaces: colour \"{}\" is none", colour));
          const GeoPackageGeometry g = read_geopackage_geometry(row.text(8), WkbType::multi_polygon_z, srs_id);
          if (static_cast<std::int64_t>(g.polygons.size()) != row.integer(7))
            rule(name, fmt::format("layer surfaces: says {} faces, has {}", row.text(7), g.polygons.size()));
          bool on_grid = true;
          const bool bounds =
              row.string(12).find(model::info(model::IssueCode::model_not_closed).text) == std::string::npos;
          for (const ReadPolygon& polygon : g.polygons)
            for (const auto& ring : polygon.rings)
              for (std::size_t i = 0; i < ring.size(); ++i) {
                const model::Point3 &a = ring[i], &b = ring[(i + 1) % ring.size()];
                on_grid = on_grid && a == model::snap(a);
                if (!bounds) continue;
                const std::array<double, 3> p{a.x, a.y, a.z}, q{b.x, b.y, b.z};
                if (p < q)
                  ++body.edges[{p, q}];
                else
                  --body.edges[{q, p}];
              }
          if (!on_grid) log_.add(Check::off_grid, s_.name, name, "layer surfaces: a point is not on the grid");
        });
    end();
    each("SELECT id FROM parts WHERE lod >= 1 AND id NOT IN (SELECT body FROM surfaces)",
         [&](const SqliteRow& row) { rule(row.string(0), "the layer surfaces does not have it"); });
  }

  /// A journal with something in it means that the file was not closed: readers would play it back. An empty one is what
  /// a program leaves that only looks.
  void beside() {
    std::error_code ignored;
    for (const char* end : {"-journal", "-wal"})
      if (const auto size = std::filesystem::file_size(s_.path + end, ignored); !ignored && size > 0)
        rule("",
             std::string("a ") + (end + 1) + " file lies beside it that was not played back: close what has it open");
  }

  State& s_;
  FindingLog& log_;
};

}  // namespace

bool GeoPackageReader::check(FindingLog& log) {
  const std::lock_guard lock(state_->reading);
  return Rules(*state_, log).run();
}

}  // namespace blockrand::validate
