#include "pipeline/outputs/explain/find_explanation.h"

#include <charconv>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

#include "pipeline/base/error.h"
#include "pipeline/outputs/area_folders.h"
#include "pipeline/outputs/gzip.h"

namespace blockrand::outputs {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::optional<std::int64_t> parse_number(std::string_view text) {
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || text.empty()) return std::nullopt;
  return number;
}

std::optional<model::OsmId> parse_short_id(std::string_view text) {
  if (text.size() < 2) return std::nullopt;
  const auto number = parse_number(text.substr(1));
  if (!number) return std::nullopt;
  switch (text[0]) {
    case 'N':
    case 'n':
      return model::OsmId{model::OsmType::node, *number};
    case 'W':
    case 'w':
      return model::OsmId{model::OsmType::way, *number};
    case 'R':
    case 'r':
      return model::OsmId{model::OsmType::relation, *number};
    default:
      return std::nullopt;
  }
}

struct IndexLine {
  model::OsmId object;
  std::string tile;
  model::OsmId building;
};

[[noreturn]] void damaged(const std::string& file, const std::string& what) {
  throw base::InputError(file, "", what, "Build again; 'blockrand validate' lists all damage");
}

IndexLine parse_index_line(const std::string& file, const std::string& line) {
  const std::size_t first = line.find(' '), second = line.find(' ', first + 1);
  if (first != std::string::npos && second != std::string::npos) {
    const auto object = parse_short_id(std::string_view(line).substr(0, first));
    const auto building = parse_short_id(std::string_view(line).substr(second + 1));
    if (object && building) return {*object, line.substr(first + 1, second - first - 1), *building};
  }
  damaged(file, "this line of the index cannot be read: " + line.substr(0, 80));
}

/// Bisection over a sorted text file: no more of it is read than some lines.
std::optional<IndexLine> look_up(const std::string& path, model::OsmId id) {
  std::ifstream file(path, std::ios::binary);
  if (!file) damaged(path, "cannot be opened");
  file.seekg(0, std::ios::end);
  std::int64_t low = 0, high = file.tellg();  // the wanted line starts in [low, high)
  std::string line;
  while (low < high) {
    const std::int64_t middle = low + (high - low) / 2;
    // The first line that starts at or behind `middle`.
    file.clear();
    file.seekg(middle == 0 ? 0 : middle - 1);
    if (middle > 0) std::getline(file, line);
    const std::int64_t start = middle == 0 ? 0 : static_cast<std::int64_t>(file.tellg());
    if (start < 0 || start >= high || !std::getline(file, line)) {
      high = middle;
      continue;
    }
    IndexLine entry = parse_index_line(path, line);
    if (entry.object == id) return entry;
    if (entry.object < id)
      low = start + static_cast<std::int64_t>(line.size()) + 1;
    else
      high = middle;
  }
  return std::nullopt;
}

std::string read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) damaged(path, "cannot be opened");
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string line_of(const std::string& path, model::OsmId building) {
  std::string text;
  try {
    text = outputs::gunzip(read_file(path));
  } catch (const std::runtime_error& error) {
    damaged(path, error.what());
  }
  const std::string start = "{\"id\":\"" + building.text() + "\"";
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    if (text.compare(at, start.size(), start) == 0) return text.substr(at, end - at);
    at = end + 1;
  }
  damaged(path, "has no line on " + building.text() + ", although the index says so");
}

std::optional<Json> reported_row(const std::string& folder, model::OsmId id) {
  const std::string path = folder + "/report.json";
  const Json report = Json::parse(read_file(path), nullptr, false);
  if (report.is_discarded() || !report.is_object() || !report.contains("objects"))
    damaged(path, "is no report of a build");
  for (const Json& row : report["objects"]) {
    if (!row.is_object() || !row.contains("id") || row["id"] != id.text()) continue;
    Json out = row;
    if (row.contains("code") && row["code"].is_string() && report.contains("codes") && report["codes"].is_object())
      out["meaning"] = report["codes"].value(row["code"].get<std::string>(), "");
    return out;
  }
  return std::nullopt;
}

}  // namespace

std::optional<model::OsmId> parse_object_id(std::string_view text) {
  while (text.starts_with(' ')) text.remove_prefix(1);
  while (text.ends_with(' ')) text.remove_suffix(1);
  if (const std::size_t host = text.find("openstreetmap.org/"); host != std::string_view::npos) {
    text.remove_prefix(host + std::string_view("openstreetmap.org/").size());
    text = text.substr(0, text.find_first_of("?#"));
    // Pages below an object's own, such as its history.
    if (const std::size_t second = text.find('/', text.find('/') + 1); second != std::string_view::npos)
      text = text.substr(0, second);
  }
  while (text.ends_with('/')) text.remove_suffix(1);
  for (const auto& [word, type] : {std::pair{std::string_view("node"), model::OsmType::node},
                                   std::pair{std::string_view("way"), model::OsmType::way},
                                   std::pair{std::string_view("relation"), model::OsmType::relation}}) {
    if (!text.starts_with(word) || text.size() <= word.size() + 1) continue;
    if (text[word.size()] != '/' && text[word.size()] != ' ') continue;
    if (const auto number = parse_number(text.substr(word.size() + 1))) return model::OsmId{type, *number};
    return std::nullopt;
  }
  return parse_short_id(text.substr(0, text.find('.')));
}

namespace {

/// In a build in areas an object is modelled in one of them; a row that says why it is not may stand in several.
std::optional<FoundExplanation> find_in_areas(const std::string& folder, const std::vector<std::string>& areas,
                                              model::OsmId id) {
  std::optional<FoundExplanation> told;
  for (const std::string& area : areas) {
    std::optional<FoundExplanation> found = find_explanation(folder + "/" + area, id);
    if (found && found->in_model) return found;
    if (found && !told) told = std::move(found);
  }
  return told;
}

}  // namespace

void check_explained(const std::string& folder) {
  std::error_code error;
  if (!fs::exists(fs::path(folder) / "build.json", error))
    throw base::UsageError(folder +
                           " is no build (it has no build.json). Name the output folder of 'blockrand build'.");
  if (!area_folders(folder).empty()) return;
  const std::string index = folder + "/explain/index.txt";
  if (!fs::exists(index, error)) {
    const Json build = Json::parse(read_file(folder + "/build.json"), nullptr, false);
    if (build.is_object() && build.contains("configuration") && build["configuration"].is_object() &&
        build["configuration"].contains("explain") && build["configuration"]["explain"] == false)
      throw base::UsageError(folder + " was built with --no-explain. Build again without it to get explanations.");
    damaged(index, "is missing");
  }
}

std::optional<FoundExplanation> find_explanation(const std::string& folder, model::OsmId id) {
  check_explained(folder);
  if (const std::vector<std::string> areas = area_folders(folder); !areas.empty())
    return find_in_areas(folder, areas, id);
  const std::string index = folder + "/explain/index.txt";
  if (const auto entry = look_up(index, id))
    return FoundExplanation{line_of(folder + "/explain/" + entry->tile + ".jsonl.gz", entry->building), true, id,
                            entry->building};
  const auto row = reported_row(folder, id);
  if (!row) return std::nullopt;
  if (row->contains("state") && (*row)["state"] == "duplicate" && row->contains("related") &&
      (*row)["related"].is_string())
    if (const auto other = parse_short_id((*row)["related"].get<std::string>()))
      if (const auto entry = look_up(index, *other))
        return FoundExplanation{line_of(folder + "/explain/" + entry->tile + ".jsonl.gz", entry->building), true, id,
                                entry->building};
  return FoundExplanation{row->dump(), false, id, id};
}

}  // namespace blockrand::outputs
