#include "pipeline/validate/qgis_project.h"

#include <fmt/format.h>
#include <libxml/parser.h>
#include <libxml/tree.h>
#include <zlib.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace blockrand::validate {
namespace {

constexpr std::size_t kLargest = std::size_t{64} << 20;

// ---- the archive

/// Little-endian; 0 beyond the end.
std::uint32_t number_at(std::string_view bytes, std::size_t at, int size) {
  std::uint32_t value = 0;
  for (int i = 0; i < size; ++i)
    if (at + static_cast<std::size_t>(i) < bytes.size())
      value |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + static_cast<std::size_t>(i)]))
               << (8 * i);
  return value;
}

std::string_view part(std::string_view bytes, std::size_t at, std::size_t size) {
  return at <= bytes.size() && size <= bytes.size() - at ? bytes.substr(at, size) : std::string_view();
}

std::optional<std::string> inflated(std::string_view data, std::size_t size) {
  std::string out(size, '\0');
  z_stream z{};
  if (inflateInit2(&z, -MAX_WBITS) != Z_OK) return std::nullopt;
  z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(data.data()));
  z.avail_in = static_cast<uInt>(data.size());
  z.next_out = reinterpret_cast<Bytef*>(out.data());
  z.avail_out = static_cast<uInt>(out.size());
  const int status = inflate(&z, Z_FINISH);
  const bool whole = status == Z_STREAM_END && z.avail_out == 0;
  inflateEnd(&z);
  if (!whole) return std::nullopt;
  return out;
}

/// The file of a line of the archive's directory.
std::optional<std::string> unpacked(std::string_view zip, std::size_t line, std::string& why) {
  constexpr std::size_t kHeader = 30;
  constexpr std::uint32_t kStored = 0, kDeflated = 8;
  const std::uint32_t method = number_at(zip, line + 10, 2), sum = number_at(zip, line + 16, 4);
  const std::size_t packed = number_at(zip, line + 20, 4), size = number_at(zip, line + 24, 4),
                    header = number_at(zip, line + 42, 4);
  if (size > kLargest) {
    why = fmt::format("the project in it has {} bytes", size);
    return std::nullopt;
  }
  const std::size_t data = header + kHeader + number_at(zip, header + 26, 2) + number_at(zip, header + 28, 2);
  const std::string_view bytes = part(zip, data, packed);
  std::optional<std::string> out;
  if (part(zip, header, 4) == "PK\x03\x04" && bytes.size() == packed) {
    if (method == kStored && packed == size) out = std::string(bytes);
    if (method == kDeflated) out = inflated(bytes, size);
  }
  if (out && crc32(0, reinterpret_cast<const Bytef*>(out->data()), static_cast<uInt>(out->size())) != sum) out.reset();
  if (!out) why = "the compressed data are damaged";
  return out;
}

// ---- the project

std::string attribute(const xmlNode* node, const char* name) {
  xmlChar* const value = xmlGetProp(node, reinterpret_cast<const xmlChar*>(name));
  std::string out = value ? reinterpret_cast<const char*>(value) : "";
  xmlFree(value);
  return out;
}

std::string content(const xmlNode* node) {
  xmlChar* const value = node ? xmlNodeGetContent(node) : nullptr;
  std::string out = value ? reinterpret_cast<const char*>(value) : "";
  xmlFree(value);
  return out;
}

std::string_view name_of(const xmlNode* node) { return reinterpret_cast<const char*>(node->name); }

const xmlNode* child(const xmlNode* node, std::string_view name) {
  for (const xmlNode* c = node ? node->children : nullptr; c; c = c->next)
    if (c->type == XML_ELEMENT_NODE && name_of(c) == name) return c;
  return nullptr;
}

/// Calls `visit` for a node and all below it.
void each_element(const xmlNode* node, const std::function<void(const xmlNode*)>& visit) {
  std::vector<const xmlNode*> waiting = {node};
  while (!waiting.empty()) {
    const xmlNode* const here = waiting.back();
    waiting.pop_back();
    visit(here);
    for (const xmlNode* c = here->children; c; c = c->next)
      if (c->type == XML_ELEMENT_NODE) waiting.push_back(c);
  }
}

/// Columns of an expression of QGIS: what stands in double quotes.
std::vector<std::string> quoted(std::string_view expression) {
  std::vector<std::string> names;
  for (std::size_t open = expression.find('"'); open != std::string_view::npos; open = expression.find('"')) {
    const std::size_t close = expression.find('"', open + 1);
    if (close == std::string_view::npos) break;
    names.emplace_back(expression.substr(open + 1, close - open - 1));
    expression.remove_prefix(close + 1);
  }
  return names;
}

/// Columns that styles name: a column alone, or an expression.
std::vector<std::string> columns_of(const std::string& text) {
  if (text.find('"') != std::string::npos) return quoted(text);
  return {text};
}

class Project {
 public:
  Project(const std::string& name, const std::string& geopackage, const TableColumns& tables, const std::string& crs,
          FindingLog& log)
      : name_(name), geopackage_(geopackage), tables_(tables), crs_(crs), log_(log) {}

  std::size_t check(const xmlNode* root) {
    if (!root || name_of(root) != "qgis") {
      wrong("", "is no QGIS project");
      return 0;
    }
    check_crs(child(root, "projectCrs"), "");
    std::set<std::string> ids;
    for (const xmlNode* c = child(root, "projectlayers") ? child(root, "projectlayers")->children : nullptr; c;
         c = c->next)
      if (c->type == XML_ELEMENT_NODE && name_of(c) == "maplayer") {
        const std::string id = content(child(c, "id"));
        if (!ids.insert(id).second) wrong(id, "two layers have this id");
        check_layer(c, id);
      }
    if (ids.empty()) wrong("", "has no layers");
    check_panel(root, ids);
    return ids.size();
  }

 private:
  void wrong(const std::string& layer, const std::string& what) { log_.add(Check::qgis_project, name_, layer, what); }

  void check_crs(const xmlNode* holder, const std::string& layer) {
    const std::string said = content(child(child(holder, "spatialrefsys"), "authid"));
    if (said != crs_) wrong(layer, fmt::format("its reference system is \"{}\", build.json says {}", said, crs_));
  }

  void check_layer(const xmlNode* layer, const std::string& id) {
    check_crs(child(layer, "srs"), id);
    const std::string source = content(child(layer, "datasource")), start = "./" + geopackage_ + "|layername=";
    if (!source.starts_with(start)) return wrong(id, fmt::format("reads {}, not {}…", source, start));
    const std::string table = source.substr(start.size());
    const auto columns = tables_.find(table);
    if (columns == tables_.end()) return wrong(id, fmt::format("{} has no layer {}", geopackage_, table));
    const auto need = [&](const std::vector<std::string>& names) {
      for (const std::string& column : names)
        if (!columns->second.contains(column))
          wrong(id, fmt::format("the layer {} has no column \"{}\"", table, column));
    };
    if (!child(layer, "renderer-v2")) wrong(id, "has no style");
    each_element(layer, [&](const xmlNode* e) {
      if (name_of(e) == "renderer-v2" && !attribute(e, "attr").empty()) need(columns_of(attribute(e, "attr")));
      if (name_of(e) == "text-style") need(columns_of(attribute(e, "fieldName")));
      if (name_of(e) == "previewExpression") need(quoted(content(e)));
      if (name_of(e) == "mapTip") need(quoted(content(e)));
    });
  }

  /// Every line of the panel is a layer, and every layer is in the panel.
  void check_panel(const xmlNode* root, const std::set<std::string>& ids) {
    std::set<std::string> shown;
    if (const xmlNode* tree = child(root, "layer-tree-group"))
      each_element(tree, [&](const xmlNode* e) {
        if (name_of(e) != "layer-tree-layer") return;
        const std::string id = attribute(e, "id");
        shown.insert(id);
        if (!ids.contains(id)) wrong(id, "the panel names a layer that does not exist");
      });
    for (const std::string& id : ids)
      if (!shown.contains(id)) wrong(id, "the panel does not have the layer");
  }

  const std::string& name_;
  const std::string& geopackage_;
  const TableColumns& tables_;
  const std::string& crs_;
  FindingLog& log_;
};

}  // namespace

std::optional<std::string> qgs_of(std::string_view qgz, std::string& why) {
  constexpr std::size_t kEnd = 22, kLine = 46;
  const std::size_t end = qgz.rfind("PK\x05\x06");
  if (end == std::string_view::npos || end + kEnd > qgz.size()) {
    why = "is no ZIP archive";
    return std::nullopt;
  }
  std::size_t line = number_at(qgz, end + 16, 4);
  const std::uint32_t files = number_at(qgz, end + 10, 2);
  for (std::uint32_t i = 0; i < files; ++i) {
    if (part(qgz, line, 4) != "PK\x01\x02") break;
    const std::size_t length = number_at(qgz, line + 28, 2);
    if (part(qgz, line + kLine, length).ends_with(".qgs")) return unpacked(qgz, line, why);
    line += kLine + length + number_at(qgz, line + 30, 2) + number_at(qgz, line + 32, 2);
  }
  why = "holds no project";
  return std::nullopt;
}

std::size_t check_qgis_project(std::string_view qgs, const std::string& name, const std::string& geopackage,
                               const TableColumns& tables, const std::string& crs, FindingLog& log) {
  const std::unique_ptr<xmlDoc, void (*)(xmlDoc*)> document(
      xmlReadMemory(qgs.data(), static_cast<int>(qgs.size()), "project.qgs", nullptr,
                    XML_PARSE_NONET | XML_PARSE_NOERROR | XML_PARSE_NOWARNING),
      xmlFreeDoc);
  if (!document) {
    log.add(Check::file_unreadable, name, "", "the project is no well-formed XML");
    return 0;
  }
  // Entities of entities would be texts without end.
  if (document->intSubset && document->intSubset->entities) {
    log.add(Check::file_unreadable, name, "", "the project declares entities");
    return 0;
  }
  return Project(name, geopackage, tables, crs, log).check(xmlDocGetRootElement(document.get()));
}

}  // namespace blockrand::validate
