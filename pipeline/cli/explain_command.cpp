#include "pipeline/cli/explain_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string_view>

#include "pipeline/base/error.h"
#include "pipeline/cli/exit_codes.h"
#include "pipeline/cli/explain_chip.h"
#include "pipeline/cli/explain_style.h"
#include "pipeline/cli/path_kinds.h"
#include "pipeline/cli/terminal_text.h"
#include "pipeline/outputs/explain/find_places.h"
#include "pipeline/outputs/explain/plain_explanation.h"
#include "pipeline/settings/command_line.h"

namespace blockrand::cli {
namespace {

using Json = nlohmann::ordered_json;

/// A source (pipeline/model/sourced.h) as people say it.
std::string in_words(const std::string& source) {
  static const std::map<std::string_view, std::string_view> words = {
      {"override", "as you ordered"},
      {"tag", "tagged"},
      {"implied", "follows from what is known"},
      {"part", "from its parts"},
      {"imagery", "seen in the aerial image"},
      {"terrain", "from the terrain model"},
      {"geometry", "from the shape of the plan"},
      {"neighbours", "from the neighbours"},
      {"block", "from the block"},
      {"cell", "from the cell"},
      {"district", "from the district"},
      {"region", "from the region"},
      {"preset", "usual for such buildings"},
      {"default", "assumed, nothing is known"},
  };
  const auto found = words.find(source);
  return found == words.end() ? "from the " + source : std::string(found->second);  // of a newer build
}

std::string spaced(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

/// A value as people read it: centimetres for lengths, no more digits than that.
std::string value_text(const Json& attribute) {
  const Json& value = attribute.at("value");
  const std::string unit = attribute.value("unit", "");
  std::string text;
  if (value.is_number()) {
    const double number = value.get<double>();
    text = number == std::floor(number) ? fmt::format("{:.0f}", number) : fmt::format("{:.2f}", number);
  } else {
    const std::string name = attribute.value("name", "");
    if (name == "era" && value.is_string()) return era_in_words(value.get<std::string>());
    // Ids stay as they stand in the configuration.
    if ((name == "substyle" || name == "preset") && value.is_string()) return value.get<std::string>();
    text = value.is_string() ? spaced(value.get<std::string>()) : value.dump();
  }
  if (unit == "degree") return text + "°";
  return unit.empty() ? text : text + " " + unit;
}

std::string percent(const Json& of) { return fmt::format("{:.0f}%", 100 * of.value("confidence", 0.0)); }

std::string attribute_rows(const Json& attributes) {
  constexpr std::size_t kValueColumn = 20, kReasonColumn = 34;
  std::string text;
  for (const Json& a : attributes) {
    if (a.at("value").is_string() && a.at("value").get_ref<const std::string&>().empty()) continue;  // nothing is known
    std::string line = "  " + spaced(a.value("name", ""));
    line.resize(std::max(line.size() + 1, kValueColumn), ' ');
    line += value_text(a);
    // Degree signs and other multi-byte characters take one column.
    const std::size_t extra =
        static_cast<std::size_t>(std::count_if(line.begin(), line.end(), [](char c) { return (c & 0xC0) == 0x80; }));
    line.resize(std::max(line.size() + 1, kReasonColumn + extra), ' ');
    const std::string source = a.value("source", ""), why = a.value("why", "");
    // "usual for houses" and "tagged brick" say by themselves where they come from.
    const bool speaks = source == "preset" || why.starts_with(in_words(source));
    std::string reason = fmt::format("{} ({})", speaks && !why.empty() ? why : in_words(source), percent(a));
    if (!why.empty() && !speaks) reason += ": " + why;
    text += line + wrapped(reason, kReasonColumn) + "\n";
    if (a.contains("lost"))
      for (const Json& lost : a["lost"]) {
        std::string value = spaced(lost.value("value", ""));
        Json shown = a;
        double number = 0;
        if (a.at("value").is_number() && std::sscanf(value.c_str(), "%lf", &number) == 1) {
          shown["value"] = number;
          value = value_text(shown);
        }
        const std::string lost_why = lost.value("why", "");
        // Two opinions for the same value are no contradiction.
        text += std::string(kReasonColumn, ' ') +
                wrapped(fmt::format("{} {}: {} ({})", value == value_text(a) ? "also" : "not", value,
                                    lost_why.empty() ? in_words(lost.value("source", "")) : lost_why, percent(lost)),
                        kReasonColumn + 2) +
                "\n";
      }
  }
  return text;
}

const Json* attribute(const Json& attributes, const char* name) {
  for (const Json& a : attributes)
    if (a.value("name", "") == name) return &a;
  return nullptr;
}

std::string storeys_text(const Json& attributes) {
  const Json* storeys = attribute(attributes, "storeys");
  if (!storeys) return {};
  const std::string value = value_text(*storeys);
  return value + (value == "1" ? " storey" : " storeys");
}

/// "5 storeys, 18.02 m high, gabled roof"
std::string looks(const Json& attributes, const std::string& built_roof) {
  std::string text = storeys_text(attributes);
  if (const Json* height = attribute(attributes, "height"))
    text += (text.empty() ? "" : ", ") + value_text(*height) + " high";
  if (!built_roof.empty()) text += ", " + spaced(built_roof) + " roof";
  return text;
}

/// Texts of the map cannot steer the terminal or start a line of their own.
std::string printable(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    const bool second_control = c == 0xC2 && i + 1 < text.size() && static_cast<unsigned char>(text[i + 1]) < 0xA0;
    // Marks that turn the direction of what follows, and separators of lines: a line could be shown reversed.
    if (const std::string_view three = std::string_view(text).substr(i, 3);
        (three >= "\xE2\x80\x8E" && three <= "\xE2\x80\x8F") || (three >= "\xE2\x80\xA8" && three <= "\xE2\x80\xAE") ||
        (three >= "\xE2\x81\xA6" && three <= "\xE2\x81\xA9")) {
      out += "\xEF\xBF\xBD";
      i += 2;
      continue;
    }
    if (c < 0x20 || c == 0x7F || second_control) {
      out += "\xEF\xBF\xBD";
      i += second_control;
    } else {
      out += text[i];
    }
  }
  return out;
}

void make_printable(Json& j) {
  if (j.is_string()) {
    j = printable(j.get<std::string>());
  } else if (j.is_array()) {
    for (Json& element : j) make_printable(element);
  } else if (j.is_object()) {
    Json clean = Json::object();
    for (auto& [key, value] : j.items()) {
      make_printable(value);
      clean[printable(key)] = std::move(value);
    }
    j = std::move(clean);
  }
}

/// Whether `part` is one of the ids that a body's id is made of.
bool has_component(const std::string& body, const std::string& part) {
  return ("." + body + ".").find("." + part + ".") != std::string::npos;
}

std::string link(const std::string& id) {
  if (id.size() > 1 && id[1] == '-') return "an editor's new object, without a page at openstreetmap.org";
  const std::string kind = id[0] == 'n' ? "node" : id[0] == 'w' ? "way" : "relation";
  return "https://www.openstreetmap.org/" + kind + "/" + id.substr(1);
}

std::string tag_rows(const Json& tags) {
  std::string text;
  for (const auto& [key, value] : tags.items())
    text += row(key, std::max<std::size_t>(24, key.size() + 4),
                value.is_string() ? value.get<std::string>() : value.dump());
  return text.empty() ? "  no tags\n" : text;
}

std::string not_modelled(const Json& j, const outputs::FoundExplanation& found) {
  const std::string id = found.asked.text();
  std::string text =
      fmt::format("{}: a {}\n  {}\n\n", id, j.value("kind", "") == "building" ? "building" : "building part", link(id));
  const std::string state = j.value("state", "");
  const std::string related = j.value("related", "");
  if (state == "duplicate")
    text += "  " + wrapped("It is not in the model: it duplicates " + related + ".", 2) + "\n";
  else if (state == "represented")
    text += "  " + wrapped("It has no body of its own in the model: " + related + " stands for it.", 2) + "\n";
  else
    text += "  " +
            wrapped(fmt::format("It is not in the model. {}: {}{}", j.value("code", ""), j.value("meaning", ""),
                                j.value("detail", "").empty() ? "" : " (" + j.value("detail", "") + ")"),
                    2) +
            "\n";
  return text;
}

std::string body_rows(const Json& j, const std::string& asked, const std::string& asked_body) {
  std::string text;
  const Json& bodies = j.at("bodies");
  if (bodies.size() < 2 && !(bodies.size() == 1 && bodies[0].contains("attributes"))) return text;
  text += fmt::format("\nIts {} bodies\n", bodies.size());
  for (const Json& body : bodies) {
    const std::string id = body.value("id", "");
    std::string what = body.contains("attributes") ? looks(body["attributes"], body.value("built_roof", ""))
                                                   : body.value("built_roof", "") + " roof";
    if (body.contains("fallbacks"))
      for (const Json& code : body["fallbacks"]) what += " (" + code.get<std::string>() + ")";
    text += row(id, 28, what);
  }
  for (const Json& body : bodies) {
    const std::string id = body.value("id", "");
    const bool is_asked =
        asked_body.empty() ? asked != j.value("id", "") && has_component(id, asked) : id == asked_body;
    if (!is_asked || !body.contains("attributes")) continue;
    text += fmt::format("\nThe values of {}\n", id);
    if (body.contains("tags")) text += tag_rows(body["tags"]);
    text += attribute_rows(body["attributes"]);
  }
  return text;
}

/// The house numbers of a wall segment, each once: "7, 7a".
std::string house_numbers(const Json& edge) {
  std::vector<std::string> numbers;
  if (edge.contains("points"))
    for (const Json& point : edge["points"])
      if (std::string number = point.value("house_number", "");
          !number.empty() && std::find(numbers.begin(), numbers.end(), number) == numbers.end())
        numbers.push_back(std::move(number));
  return fmt::format("{}", fmt::join(numbers, ", "));
}

/// What the wall segment of an outline looks out on: "Kastanienallee, 11.5 m away".
std::string faces(const Json& e) {
  const std::string kind = e.value("kind", "");
  std::string text;
  if (e.contains("neighbour")) text = e.value("neighbour", "");
  if (e.contains("covered_height")) text += fmt::format(", covered to {:.1f} m", e.value("covered_height", 0.0));
  if (e.contains("street")) {
    text = e.value("street_name", e.value("street", ""));
    text += fmt::format(", {:.1f} m away", e.value("street_distance", 0.0));
  }
  const auto also = [&](const std::string& what) { text += (text.empty() ? "" : "; ") + what; };
  if (e.value("front", false)) also("main front");
  if (e.value("corner_start", false) || e.value("corner_end", false)) also("street corner");
  if (e.value("chamfer", false)) also("cuts off the corner");
  if (e.contains("radius")) also(fmt::format("curve of radius {:.1f} m", e.value("radius", 0.0)));
  if (const int n = e.value("entrances", 0); n > 0) also(fmt::format("{} entrance{}", n, n == 1 ? "" : "s"));
  if (const std::string numbers = house_numbers(e); !numbers.empty()) also("house number " + numbers);
  return text;
}

std::string edge_rows(const Json& j) {
  if (!j.contains("edges")) return "\nIts walls\n  " + wrapped("This build does not know what they face.", 2) + "\n";
  std::string text = "\nIts walls\n";
  for (const Json& e : j["edges"]) {
    std::string id = e.value("id", "");
    if (const std::string prefix = j.value("id", "") + ".e"; id.starts_with(prefix)) id = id.substr(prefix.size());
    text += row(id, 28,
                fmt::format("{:<11} {:>6.1f} m  {:<2}  {:>3.0f}%  {}", spaced(e.value("kind", "")),
                            e.value("length", 0.0), e.value("looks", ""), 100 * e.value("confidence", 0.0), faces(e)));
  }
  return text;
}

}  // namespace

namespace {

std::string text_of(const Json& j, const outputs::FoundExplanation& found, const std::string& asked_body, bool edges,
                    bool style) {
  if (!found.in_model) return not_modelled(j, found);

  const std::string id = j.at("id"), asked = found.asked.text();
  const Json& attributes = j.at("attributes");
  const Json& bodies = j.at("bodies");
  const Json* use = attribute(attributes, "use");
  const std::string kind = use && use->at("value") != "yes" ? spaced(use->at("value").get<std::string>()) : "building";
  std::string text;
  if (asked != id) {
    const bool is_part = std::any_of(bodies.begin(), bodies.end(),
                                     [&](const Json& b) { return has_component(b.value("id", ""), asked); });
    text += fmt::format("{} {} {}.\n\n", asked, is_part ? "is a part of" : "duplicates", id);
  }
  const std::string roof = bodies.size() == 1 ? bodies[0].value("built_roof", "") : "";
  const std::string summary = bodies.empty() ? "not in the model" : looks(attributes, roof);
  text += wrapped(fmt::format("{}: {}, {}", id, kind, summary), 0) + "\n";
  for (const char* name : {"name", "address"})
    if (j.contains(name)) text += "  " + j[name].get<std::string>() + "\n";
  text += "  " + link(id);
  if (j.contains("place"))
    text += fmt::format("   {:.5f}, {:.5f} (latitude, longitude)", j["place"].value("lat", 0.0),
                        j["place"].value("lon", 0.0));
  text += "\n";
  if (j.value("state", "") == "reported")
    text += "\n  " +
            wrapped(fmt::format("It is not in the model. {}: {}", j.value("code", ""), j.value("meaning", "")), 2) +
            "\n";

  if (j.contains("style")) text += style_text(j.at("style"), style);
  text += "\nWhat the map says\n" + tag_rows(j.at("tags"));
  if (!bodies.empty())
    text += "\nEvery value, where it comes from, how sure that is, and what else was considered\n" +
            attribute_rows(attributes);
  text += body_rows(j, asked, asked_body);
  text += "\nWhat each stage did\n";
  for (const Json& stage : j.at("stages")) text += row(stage.value("stage", ""), 12, stage.value("text", ""));
  if (edges) text += edge_rows(j);
  if (!j.at("notes").empty()) {
    text += "\nNotes\n";
    for (const Json& note : j["notes"]) {
      std::string what = note.value("meaning", "");
      if (const std::string detail = note.value("detail", ""); !detail.empty()) what += " (" + detail + ")";
      if (const std::string object = note.value("object", ""); !object.empty()) what = object + ": " + what;
      text += row(note.value("code", ""), 28, what);
    }
  }
  if (j.contains("files") && !j["files"].empty()) {
    text += "\nIt stands in\n";
    for (const Json& file : j["files"]) text += "  " + file.get<std::string>() + "\n";
  }
  if (!bodies.empty())
    text += "\n" +
            wrapped(
                "To change a value, tag the building in OpenStreetMap, or order it in a file for --overrides: an order "
                "(override) beats "
                "what is tagged, and what is tagged beats every other source.",
                0) +
            "\n";
  return text;
}

}  // namespace

namespace {

[[noreturn]] void damaged_explanation(const outputs::FoundExplanation& found, const std::exception& error) {
  throw base::InputError("explain/", found.explained.text(), std::string("the explanation is damaged: ") + error.what(),
                         "Build again; 'blockrand validate' lists all damage");
}

}  // namespace

std::string explanation_text(const outputs::FoundExplanation& found, const std::string& body, bool edges, bool style) {
  try {
    Json j = Json::parse(found.json);
    make_printable(j);
    return text_of(j, found, body, edges, style);
  } catch (const Json::exception& error) {
    damaged_explanation(found, error);
  }
}

std::string plain_text(const outputs::FoundExplanation& found) {
  outputs::PlainExplanation plain;
  try {
    plain = outputs::plain_explanation(found.json, found.asked.text());
  } catch (const std::exception& error) {
    damaged_explanation(found, error);
  }
  std::string text = wrapped(printable(plain.title), 0) + "\n\n";
  for (const std::string& line : plain.lines) text += "  " + wrapped(printable(line), 4) + "\n";
  return text;
}

settings::CommandText explain_text() {
  return {.name = "explain",
          .summary = "why one building looks as it does",
          .usage = "FOLDER ID|ADDRESS [options]",
          .description =
              "Tells in about ten plain lines why a building looks as it does: storeys, height, roof and style with "
              "where they come from and how sure they are (sure, likely, a guess), where it stands, what was "
              "simplified or mended, and how to change it. The building is named by its id, its address or its name; "
              "case, accents, postcode and town may be left out. --all tells everything that the build knows of it: "
              "each value with its source, its confidence and what else was considered, what each stage did with it, "
              "what fell back and why, and the files it stands in. An object that is not in the model is explained, "
              "too.",
          .options = settings::kExplain,
          .examples = {{"blockrand explain out/leipzig w123", ""},
                       {"blockrand explain out/leipzig \"Karl-Liebknecht-Str. 5\"", ""},
                       {"blockrand explain out/leipzig Thomaskirche", ""},
                       {"blockrand explain out/leipzig w123 --all", ""},
                       {"blockrand explain out/leipzig https://www.openstreetmap.org/way/123", ""},
                       {"blockrand explain out/leipzig w123 --edges", ""},
                       {"blockrand explain out/leipzig w123 --style", ""},
                       {"blockrand explain out/leipzig r45 --json | jq .attributes", ""}},
          .exit_codes = {{"0", "all well"},
                         {"1", "wrong usage"},
                         {"2", "unreadable or invalid input"},
                         {"4", "output could not be written or internal error"}}};
}

namespace {

std::string overlay_text(const std::string& folder, const outputs::FoundExplanation& found) {
  const std::string path = overlay_path(folder, found);
  return path.empty() ? "" : "\nThe aerial image with its outline: " + path + " (--chip FILE.png: this piece of it)\n";
}

/// "Arkonaplatz 5, 10435 Berlin", "Zionskirche, Zionskirchplatz"
std::string place_title(const outputs::Place& place) {
  if (place.name.empty()) return place.addresses;
  return place.addresses.empty() ? place.name : place.name + ", " + place.addresses;
}

/// The building at an address or with a name. Empty where that is not one building: what to do then is told.
std::optional<model::OsmId> id_by_address(const std::string& folder, const std::string& text) {
  constexpr std::size_t kMostListed = 10;
  const outputs::FoundPlaces found = outputs::find_places(folder, text);
  const auto tell = [](const std::string& line) { std::fputs((printable(line) + "\n").c_str(), stderr); };
  if (found.places.size() == 1) {
    if (!found.exact) tell(fmt::format("blockrand: no building has just '{}'; this one is beside it.", text));
    return outputs::parse_object_id(found.places[0].id);
  }
  if (found.places.empty()) {
    std::string line = fmt::format("blockrand: {}: no building is mapped with the address or name '{}'.", folder, text);
    if (!found.nearest.empty()) line += fmt::format(" Did you mean '{}'?", fmt::join(found.nearest, "' or '"));
    tell(line);
    tell("Ask for a house number that is mapped, for the name of a building, or by id, for example w123.");
    return std::nullopt;
  }
  tell(fmt::format(
      "blockrand: {} buildings answer to '{}'. Ask for one of them by its id, or add what tells them apart:",
      found.places.size(), text));
  for (std::size_t i = 0; i < std::min(found.places.size(), kMostListed); ++i)
    tell(fmt::format("  {:<14} {}", found.places[i].id, place_title(found.places[i])));
  if (found.places.size() > kMostListed) tell(fmt::format("  and {} more", found.places.size() - kMostListed));
  return std::nullopt;
}

}  // namespace

int run_explain(const std::vector<std::string>& arguments) {
  const settings::CommandLine line = settings::read_command_line(settings::kExplain, arguments);
  if (line.help) {
    std::fputs(settings::command_help(explain_text()).c_str(), stdout);
    return kSuccess;
  }
  const settings::Settings& s = line.settings;
  if (s.id.find_first_not_of("0123456789") == std::string::npos)
    throw base::UsageError(fmt::format("{} is no id of an OpenStreetMap object. Write {} for a way, {} for a relation.",
                                       s.id, s.id.empty() ? "w123" : "w" + s.id, s.id.empty() ? "r45" : "r" + s.id));
  auto id = outputs::parse_object_id(s.id);
  // "St. Nikolai" has a point as well.
  const bool is_body = id && s.id.find('.') != std::string::npos && s.id.find('/') == std::string::npos;
  if (!id) {
    id = id_by_address(s.folder, s.id);
    if (!id) return kInvalidInput;
  }
  expect_build(s.folder);
  const auto found = outputs::find_explanation(s.folder, *id);
  if (!found)
    throw base::InputError(s.folder, "", "knows no building or building part " + id->text(),
                           "It is tagged otherwise, or lies outside of the extract or the --bbox");
  if (!s.chip.empty()) write_chip(s.folder, *found, s.chip);
  if (s.json)
    std::printf("%s\n", found->json.c_str());
  else if (s.all || s.edges || s.style)
    std::fputs(
        (explanation_text(*found, is_body ? s.id : "", s.edges, s.style) + overlay_text(s.folder, *found)).c_str(),
        stdout);
  else
    std::fputs((plain_text(*found) + overlay_text(s.folder, *found) +
                fmt::format("\nEverything that is known of it: blockrand explain {} {} --all\n", s.folder, id->text()))
                   .c_str(),
               stdout);
  return kSuccess;
}

}  // namespace blockrand::cli
