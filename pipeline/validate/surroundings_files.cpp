#include "pipeline/validate/surroundings_files.h"

#include <fmt/format.h>
#include <libxml/xmlreader.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <memory>
#include <unordered_set>
#include <utility>

#include "pipeline/base/json_depth.h"
#include "pipeline/base/parallel.h"
#include "pipeline/validate/bytes_of_file.h"
#include "pipeline/validate/checked_json.h"
#include "pipeline/validate/glb_container.h"

namespace blockrand::validate {
namespace {

constexpr std::size_t kMostFindings = 100;  // of one file
constexpr std::size_t kDeepest = 256;       // levels of arrays and objects, as in cityjson_reader.cpp

/// City objects that surroundings are made of.
constexpr std::string_view kElements[] = {"Road",       "Square",        "Railway",          "TransportationComplex",
                                          "WaterBody",  "LandUse",       "Bridge",           "SolitaryVegetationObject",
                                          "PlantCover", "CityFurniture", "GenericCityObject"};
constexpr std::string_view kTypes[] = {"Road",       "TransportSquare", "Railway",           "WaterBody",
                                       "LandUse",    "Bridge",          "OtherConstruction", "SolitaryVegetationObject",
                                       "PlantCover", "CityFurniture"};

template <std::size_t N>
bool is_one_of(const std::string_view (&names)[N], std::string_view name) {
  return std::find(std::begin(names), std::end(names), name) != std::end(names);
}

class Checker {
 public:
  Checker(Format format, const std::string& name, SurroundingsFile& out)
      : rule_(format == Format::citygml    ? Check::citygml_rule
              : format == Format::cityjson ? Check::cityjson_rule
                                           : Check::glb_rule),
        name_(name),
        out_(out) {}

  void rule(std::string object, std::string what) { add(rule_, std::move(object), std::move(what)); }
  void bounds(std::string what) { add(Check::tile_bounds, {}, std::move(what)); }
  void unreadable(std::string what) { add(Check::file_unreadable, {}, std::move(what)); }

 private:
  void add(Check check, std::string object, std::string what) {
    if (out_.findings.size() < kMostFindings)
      out_.findings.push_back({check, name_, std::move(object), std::move(what)});
  }

  Check rule_;
  const std::string& name_;
  SurroundingsFile& out_;
};

// ---- CityGML

std::string_view view(const xmlChar* text) { return text ? reinterpret_cast<const char*>(text) : std::string_view(); }

void read_gml(std::string_view xml, Checker& check, SurroundingsFile& out) {
  constexpr int kOptions = XML_PARSE_NONET | XML_PARSE_NOERROR | XML_PARSE_NOWARNING | XML_PARSE_HUGE;
  const std::unique_ptr<xmlTextReader, void (*)(xmlTextReaderPtr)> reader(
      xml.size() > 0x7fffffff
          ? nullptr
          : xmlReaderForMemory(xml.data(), static_cast<int>(xml.size()), "file.gml", nullptr, kOptions),
      xmlFreeTextReader);
  if (!reader) return check.unreadable("larger than can be read");
  std::unordered_set<std::string> ids;
  std::vector<std::string> named;
  std::string parent, element;
  bool in_target = false;
  int status = 0;
  while ((status = xmlTextReaderRead(reader.get())) == 1) {
    const int type = xmlTextReaderNodeType(reader.get());
    if (type == XML_READER_TYPE_DOCUMENT_TYPE) check.rule({}, "a document type definition");
    if (type == XML_READER_TYPE_TEXT && in_target) named.emplace_back(view(xmlTextReaderConstValue(reader.get())));
    if (type != XML_READER_TYPE_ELEMENT) continue;
    const int depth = xmlTextReaderDepth(reader.get());
    element = view(xmlTextReaderConstLocalName(reader.get()));
    in_target = element == "target";
    if (depth == 0 && element != "CityModel") check.rule({}, "the root is no CityModel");
    std::string id;
    while (xmlTextReaderMoveToNextAttribute(reader.get()) == 1) {
      const std::string_view attribute = view(xmlTextReaderConstLocalName(reader.get())),
                             value = view(xmlTextReaderConstValue(reader.get()));
      if (attribute == "id") id = value;
      if (attribute == "href") named.emplace_back(value);
    }
    if (!id.empty() && !ids.insert(id).second) check.rule(id, "gml:id twice: " + id);
    if (depth == 2 && parent == "cityObjectMember") {
      if (!is_one_of(kElements, element)) check.rule(id, "unexpected city object " + element);
      if (id.empty()) check.rule({}, "a " + element + " without gml:id");
      out.ids.push_back(id);
    }
    if (depth == 1) parent = element;
  }
  if (status != 0) return check.unreadable("not well-formed");
  for (const std::string& name : named)
    if (!name.starts_with('#') || !ids.contains(name.substr(1))) check.rule(name, "names what is not in the file");
}

// ---- CityJSON

/// Every number of nested arrays lies below `count`.
bool all_below(const Json& list, std::uint64_t count) {
  if (!list.is_array()) {
    const auto n = whole(&list);
    return n && *n < count;
  }
  return std::all_of(list.begin(), list.end(), [&](const Json& item) { return all_below(item, count); });
}

std::uint64_t length(const Json* list) { return list && list->is_array() ? list->size() : 0; }

class SequenceReader {
 public:
  SequenceReader(Checker& check, SurroundingsFile& out) : check_(check), out_(out) {}

  void line(std::string_view text, std::size_t number) {
    const std::string where = fmt::format("line {}", number);
    const auto json = base::json_depth(text) > kDeepest ? std::nullopt : parse_json(text);
    if (!json) return check_.unreadable(where + " is no JSON");
    if (number == 1)
      head(*json);
    else
      feature(*json, where);
  }

 private:
  void head(const Json& json) {
    if (text(member(json, "type")) != "CityJSON" || text(member(json, "version")) != "2.0")
      check_.rule({}, "the first line is no CityJSON of version 2.0");
    if (!numbers(member(member(json, "transform"), "scale"), 3) ||
        !numbers(member(member(json, "transform"), "translate"), 3))
      check_.rule({}, "the first line has no transform");
    const Json* templates = member(json, "geometry-templates");
    templates_ = length(member(templates, "templates"));
    for (std::uint64_t i = 0; i < templates_; ++i)
      geometry(*element(member(templates, "templates"), i), length(member(templates, "vertices-templates")),
               length(member(member(json, "appearance"), "materials")), fmt::format("template {}", i));
  }

  void feature(const Json& json, const std::string& where) {
    const std::string id = text(member(json, "id"));
    const Json* objects = member(json, "CityObjects");
    if (text(member(json, "type")) != "CityJSONFeature" || !objects || !objects->is_object() || !objects->contains(id))
      return check_.rule(id, where + " is no CityJSONFeature with its object");
    for (const auto& [name, object] : objects->items()) {
      out_.ids.push_back(name);
      if (!ids_.insert(name).second) check_.rule(name, "stands twice");
      if (const std::string type = text(member(object, "type")); !is_one_of(kTypes, type))
        check_.rule(name, "unexpected type " + type);
      const Json* geometries = member(object, "geometry");
      for (std::uint64_t g = 0; g < length(geometries); ++g)
        geometry(*element(geometries, g), length(member(json, "vertices")),
                 length(member(member(json, "appearance"), "materials")), name);
    }
  }

  void geometry(const Json& json, std::uint64_t vertices, std::uint64_t materials, const std::string& object) {
    const Json* boundaries = member(json, "boundaries");
    if (!boundaries || !boundaries->is_array() || !all_below(*boundaries, vertices))
      check_.rule(object, "a geometry counts vertices that are not there");
    if (text(member(json, "type")) == "GeometryInstance") {
      const auto number = whole(member(json, "template"));
      if (!number || *number >= templates_) check_.rule(object, "its template is not there");
      if (!numbers(member(json, "transformationMatrix"), 16)) check_.rule(object, "its matrix is none");
      return;
    }
    const Json* themes = member(json, "material");
    if (!themes || !themes->is_object()) return;
    for (const auto& [theme, look] : themes->items())
      for (const char* kind : {"value", "values"})
        if (const Json* numbers = member(look, kind); numbers && !all_below(*numbers, materials))
          check_.rule(object, "a face has a material that is not there");
  }

  Checker& check_;
  SurroundingsFile& out_;
  std::unordered_set<std::string> ids_;
  std::uint64_t templates_ = 0;
};

void read_sequence(std::string_view text, Checker& check, SurroundingsFile& out) {
  if (text.empty() || text.back() != '\n') check.rule({}, "the last line has no end");
  SequenceReader reader(check, out);
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = text.find('\n');
    reader.line(text.substr(0, end), number);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
}

// ---- GLB

class GlbReader {
 public:
  GlbReader(std::string_view bytes, const std::string& name, Checker& check, SurroundingsFile& out)
      : glb_(bytes, name, out.findings), check_(check), out_(out), ground_(is_ground(name)) {}

  void read(const TilesetEntry* entry) {
    if (!glb_.readable()) return;
    if (ground_) {
      read_pictures();
    } else {
      const Json* metadata = member(member(&glb_.json(), "extensions"), "EXT_structural_metadata");
      const Json* table = element(member(metadata, "propertyTables"), 0);
      if (!table || text(member(table, "class")) != "surrounding")
        return check_.rule({}, "it has no table of surroundings");
      rows_ = out_.objects = whole(member(table, "count")).value_or(0);
    }
    if (!member(member(member(&glb_.json(), "asset"), "extras"), "georeference"))
      check_.rule({}, "it does not say where it lies");
    const Json* nodes = member(&glb_.json(), "nodes");
    for (std::uint64_t n = 0; n < length(nodes); ++n) node(*element(nodes, n));
    if (!entry) return;
    const Overhang over = overhang(*entry, points_);
    if (over.own > kVolumeTolerance || over.ancestor > kVolumeTolerance)
      check_.bounds(fmt::format("{:.3f} m outside of its tile", std::max(over.own, over.ancestor)));
  }

 private:
  void read_pictures() {
    out_.objects = 1;
    if (text(member(member(&glb_.json(), "asset"), "copyright")).empty())
      check_.rule({}, "it does not say whose images it shows");
    const Json* images = member(&glb_.json(), "images");
    for (std::uint64_t i = 0; i < length(images); ++i) {
      const std::string uri = text(member(element(images, i), "uri"));
      if (uri.empty() || uri.find('/') != std::string::npos)
        check_.rule({}, "a picture of the ground is no file beside it");
      else
        out_.pictures.push_back(uri);
    }
  }

  void node(const Json& node) {
    const Json* instances = member(member(&node, "extensions"), "EXT_mesh_gpu_instancing");
    if (instances) {
      const Json* attributes = member(instances, "attributes");
      features(member(attributes, "_FEATURE_ID_0"));
      points(member(attributes, "TRANSLATION"));
      return;
    }
    const Json* meshes = member(&glb_.json(), "meshes");
    const auto number = whole(member(&node, "mesh"));
    if (!number) return;
    const Json* primitives = member(element(meshes, *number), "primitives");
    for (std::uint64_t p = 0; p < length(primitives); ++p) {
      const Json* attributes = member(element(primitives, p), "attributes");
      if (!ground_) features(member(attributes, "_FEATURE_ID_0"));
      points(member(attributes, "POSITION"));
    }
  }
  void features(const Json* index) {
    const GlbContainer::Accessor* ids = glb_.accessor(index);
    if (!ids) return check_.rule({}, "features have no rows");
    for (std::size_t i = 0; i < ids->count; ++i)
      if (const double row = glb_.value(*ids, i); !(row >= 0 && row < static_cast<double>(rows_)))
        return check_.rule({}, "a feature names a row that is not there");
  }
  void points(const Json* index) {
    const GlbContainer::Accessor* places = glb_.accessor(index);
    if (!places || places->width != 3) return check_.rule({}, "a mesh has no positions");
    for (std::size_t i = 0; i < places->count; ++i)
      points_.push_back({glb_.value(*places, i, 0), -glb_.value(*places, i, 2), glb_.value(*places, i, 1)});
  }

  GlbContainer glb_;
  Checker& check_;
  SurroundingsFile& out_;
  bool ground_;
  std::uint64_t rows_ = 0;
  std::vector<model::Point3> points_;  ///< east, north, up
};

SurroundingsFile checked_file(const std::string& folder, const std::string& path, Format format,
                              const CityGmlSchema* schema, const Tileset* tileset) {
  SurroundingsFile out;
  const std::string full = (std::filesystem::path(folder) / path).string();
  if (!std::filesystem::exists(full)) return out;
  std::string why;
  const auto bytes = content_of(full, why);
  if (!bytes) {
    out.findings.push_back({Check::file_unreadable, path, "", why});
    return out;
  }
  const TilesetEntry* entry = nullptr;
  if (format == Format::gltf && tileset && tileset->readable) {
    const auto known = tileset->entries.find(path);
    if (known == tileset->entries.end()) {
      out.findings.push_back({Check::tile_missing, path, "", "the tileset does not name it"});
      return out;
    }
    entry = &known->second;
  }
  out = read_surroundings(format, *bytes, path, entry);
  for (const std::string& picture : out.pictures)
    if (!std::filesystem::exists(std::filesystem::path(full).parent_path() / picture))
      out.findings.push_back({Check::file_unreadable, path, "", "its picture " + picture + " is not there"});
  if (schema && format == Format::citygml)
    for (Finding& finding : schema->validate(*bytes, path)) out.findings.push_back(std::move(finding));
  return out;
}

}  // namespace

SurroundingsFile read_surroundings(Format format, std::string_view bytes, const std::string& name,
                                   const TilesetEntry* entry) {
  SurroundingsFile out;
  Checker check(format, name, out);
  if (format == Format::citygml)
    read_gml(bytes, check, out);
  else if (format == Format::gltf)
    GlbReader(bytes, name, check, out).read(entry);
  else
    read_sequence(bytes, check, out);
  return out;
}

SurroundingsTotals check_surroundings(const std::string& folder, const BuildRecord& record, int sample,
                                      const CityGmlSchema* schema, const Tileset* tileset, int workers,
                                      base::Progress& progress, FindingLog& log) {
  std::vector<std::pair<std::string, Format>> files;
  std::size_t number = 0;
  for (const auto& [path, file] : record.files)
    if (const auto t = surroundings_path(path))
      if (number++ % static_cast<std::size_t>(std::max(sample, 1)) == 0) files.emplace_back(path, t->format);
  SurroundingsTotals totals;
  if (files.empty()) return totals;
  progress.begin("surroundings", files.size(), "files");
  std::vector<SurroundingsFile> results(files.size());
  std::unordered_set<std::string> ids[kTileFormats];
  base::ordered_parallel(
      files.size(), workers, static_cast<std::size_t>(workers + 1),
      [&](std::size_t i) { results[i] = checked_file(folder, files[i].first, files[i].second, schema, tileset); },
      [&](std::size_t i) {
        ++totals.files;
        totals.objects += results[i].ids.size() + results[i].objects;
        log.add(std::move(results[i].findings));
        for (const std::string& id : results[i].ids)
          if (!ids[static_cast<std::size_t>(files[i].second)].insert(id).second)
            log.add(Check::object_doubled, files[i].first, id, "stands twice, in one file or in several");
        results[i] = {};
        progress.advance_to(i + 1);
      });
  return totals;
}

}  // namespace blockrand::validate
