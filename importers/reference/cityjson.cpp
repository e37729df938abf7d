#include "importers/reference/cityjson.h"

#include <algorithm>
#include <string_view>
#include <unordered_set>
#include <utility>
#include <vector>

#include "importers/reference/axes.h"
#include "importers/reference/cityjson_objects.h"
#include "importers/reference/coordinate_text.h"
#include "importers/reference/file_bytes.h"
#include "importers/reference/height_words.h"
#include "importers/reference/reference_crs.h"
#include "pipeline/base/error.h"
#include "pipeline/base/json_depth.h"

namespace blockrand::importers::reference {
namespace {

/// A JSON text with what nlohmann's objects forget: the order of the city objects.
struct Document {
  Json json;
  std::vector<std::string> ids;
  std::vector<std::string> repeated;  ///< ids that stand twice; the last one counts
  std::string error;                  ///< not empty: no JSON
  bool too_deep = false;              ///< no more text makes it better
};

Document parse(std::string_view text) {
  Document out;
  std::unordered_set<std::string> seen;
  bool in_objects = false;
  if (base::json_depth(text) > kDeepestJson) {
    out.too_deep = true;
    out.error = too_deep_text();
    return out;
  }
  const auto order = [&](int depth, Json::parse_event_t event, Json& parsed) {
    if (event != Json::parse_event_t::key) return true;
    if (depth == 1) in_objects = parsed.get_ref<const std::string&>() == "CityObjects";
    if (depth == 2 && in_objects) {
      const auto& id = parsed.get_ref<const std::string&>();
      (seen.insert(id).second ? out.ids : out.repeated).push_back(id);
    }
    return true;
  };
  try {
    out.json = Json::parse(text.begin(), text.end(), order);
  } catch (const Json::exception& error) {
    out.error = error.what();
    // "[json.exception.parse_error.101] parse error at line 1, column 5: …"
    if (const std::size_t end = out.error.find("] "); end != std::string::npos) out.error.erase(0, end + 2);
  }
  return out;
}

bool is_blank(std::string_view line) { return trimmed(line).empty(); }

class Reader {
 public:
  Reader(ReferenceModel& model, NoteLog& notes, const std::string& path)
      : model_(model), notes_(notes), path_(path), objects_(model, notes) {}

  void read() {
    ByteReader bytes(path_);
    std::string text;
    int line = 0;
    while (is_blank(text)) {
      auto next = bytes.line();
      if (!next) refuse("", "is no CityJSON: it is blank", "");
      text = std::move(*next);
      if (++line == 1 && text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
    }
    Document document = parse(text);
    refuse_depth(document, line);
    if (!document.error.empty()) {  // a document over several lines
      while (auto next = bytes.line()) {
        if (text.size() > kLongestText) refuse("", "is longer than 4 GB", "Make it a CityJSON text sequence (.jsonl)");
        text += '\n';
        text += *next;
      }
      document = parse(text);
      refuse_depth(document, 0);
      if (!document.error.empty()) {
        if (bytes.damaged()) refuse("", "the gzip archive is cut off or damaged", "");
        refuse("", "is no JSON that can be read: " + document.error, "The file is damaged or cut off");
      }
      take_header(document, line);
      add(document, 0);
      return;
    }
    take_header(document, line);
    bool sequence = false;
    std::vector<std::pair<Document, int>> first;
    first.emplace_back(std::move(document), line);
    while (auto next = bytes.line()) {
      ++line;
      if (is_blank(*next)) continue;
      if (!first.empty()) add(first[0].first, line - 1);
      first.clear();
      sequence = true;
      read_line(*next, line);
    }
    if (!first.empty()) add(first[0].first, 0);
    if (bytes.damaged()) notes_.add(NoteKind::malformed_json, line, "the gzip archive is cut off or damaged");
    if (sequence) model_.format = "CityJSON sequence " + model_.version;
  }

  const std::vector<std::string>& systems() const { return systems_; }
  const std::string& title() const { return title_; }

 private:
  [[noreturn]] void refuse(const std::string& place, const std::string& what, const std::string& remedy) const {
    throw base::InputError(path_, place, what, remedy);
  }

  void refuse_depth(const Document& document, int line) const {
    if (document.too_deep)
      refuse(line > 1 ? "line " + std::to_string(line) : "", document.error, "The file is damaged, or no model");
  }

  void read_line(const std::string& text, int line) {
    Document document = parse(text);
    refuse_depth(document, line);
    if (!document.error.empty()) {
      notes_.add(NoteKind::malformed_json, line, document.error);
      return;
    }
    const std::string type = reference::text(member(document.json, "type"));
    if (type == "CityJSON") {  // sequences that were put one behind the other
      take_header(document, line);
    } else if (type != "CityJSONFeature") {
      notes_.add(NoteKind::malformed_json, line, "is no CityJSONFeature");
      return;
    }
    add(document, line);
  }

  void add(Document& document, int line) {
    for (const std::string& id : document.repeated)
      notes_.add(NoteKind::duplicate_id, line, "\"" + id + "\": twice in CityObjects; the last one is read");
    const Json& objects = member(document.json, "CityObjects");
    if (!objects.is_object()) {
      notes_.add(NoteKind::malformed_json, line, "no CityObjects");
      return;
    }
    objects_.add(objects, document.ids, member(document.json, "vertices"), line);
  }

  void take_header(Document& document, int line) {
    const std::string place = line > 1 ? "line " + std::to_string(line) : "";
    const Json& json = document.json;
    const std::string type = text(member(json, "type"));
    if (type == "CityJSONFeature")
      refuse(place, "starts with a CityJSONFeature: the line before it with the CityJSON object is missing",
             "Put it back: it has the transform that all coordinates need");
    if (type != "CityJSON") refuse(place, "is no CityJSON: its type is \"" + type + "\"", "");
    const std::string version = text(member(json, "version"));
    if (!version.starts_with("1.") && !version.starts_with("2."))
      refuse(place, version.empty() ? "says no version of CityJSON" : "is CityJSON " + version,
             "Versions 1.0, 1.1 and 2.0 are read; cjio's upgrade makes one of it");
    model_.version = version;
    model_.format = "CityJSON " + version;
    take_transform(member(json, "transform"), place);
    take_metadata(json);
    if (const auto templates = document.json.find("geometry-templates"); templates != document.json.end())
      objects_.set_templates(std::move(*templates));
  }

  void take_transform(const Json& stated, const std::string& place) {
    CityJsonObjects::Transform transform;
    if (!stated.is_null()) {
      for (std::size_t i = 0; i < 3; ++i) {
        const auto scale = number(element(member(stated, "scale"), i));
        const auto translate = number(element(member(stated, "translate"), i));
        if (!scale || !translate || *scale == 0)
          refuse(place, "its transform is not three numbers to scale by, none of them 0, and three to move by",
                 "Without it no coordinate is known");
        transform.scale[i] = *scale;
        transform.translate[i] = *translate;
      }
    } else if (model_.version != "1.0") {  // where it was optional
      notes_.add(NoteKind::malformed_json, 0, "no transform: vertices are read as coordinates");
    }
    objects_.set_transform(transform);
  }

  void take_metadata(const Json& json) {
    const Json& metadata = member(json, "metadata");
    const auto take = [&](const std::string& system) {
      if (!system.empty() && std::find(systems_.begin(), systems_.end(), system) == systems_.end())
        systems_.push_back(system);
      return !system.empty();
    };
    const auto epsg = index(member(member(metadata, "crs"), "epsg"));
    if (!take(text(member(metadata, "referenceSystem"))) && !take(epsg ? "EPSG:" + std::to_string(*epsg) : "") &&
        !take(text(member(member(json, "+metadata"), "referenceSystem"))))
      take(text(member(member(json, "+metadata-extended"), "referenceSystem")));
    if (title_.empty()) title_ = text(member(metadata, "title"));
  }

  ReferenceModel& model_;
  NoteLog& notes_;
  const std::string& path_;
  CityJsonObjects objects_;
  std::vector<std::string> systems_;  ///< different ones
  std::string title_;
};

}  // namespace

ReferenceModel read_cityjson(const std::string& path, const ReadOptions& options) {
  check_readable(path);
  ReferenceModel model;
  model.path = path;
  model.bytes = size_on_disk(path);
  NoteLog notes;
  Reader reader(model, notes, path);
  reader.read();
  if (!model.buildings.empty() || !reader.systems().empty() || !options.reference_crs.empty())
    model.crs = decide_crs(path, reader.systems(), options, notes);
  decide_heights(model.crs, height_words_in(reader.title()));
  settle_axes(model, options, notes);
  model.notes = notes.take();
  return model;
}

}  // namespace blockrand::importers::reference
