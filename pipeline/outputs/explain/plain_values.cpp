#include "pipeline/outputs/explain/plain_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

namespace blockrand::outputs::plain {

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

std::string capitalised(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

std::string as_mapped(double value) {
  std::string text = fmt::format("{:.2f}", value);
  while (text.ends_with('0')) text.pop_back();
  if (text.ends_with('.')) text.pop_back();
  return text;
}

std::string whole(double value) { return fmt::format("{:.0f}", std::max(1.0, std::round(value))); }

const Json* attribute_of(const Json& attributes, std::string_view name) {
  for (const Json& a : attributes)
    if (a.value("name", "") == name) return &a;
  return nullptr;
}

double number_behind(std::string_view text, std::string_view before) {
  const std::size_t at = text.find(before);
  double value = -1;
  if (at != std::string_view::npos) std::from_chars(text.data() + at + before.size(), text.data() + text.size(), value);
  return value;
}

std::string three_digits(double value) {
  const double step = std::pow(10, std::floor(std::log10(value)) - 2);
  return fmt::format("{:.0f}", std::round(value / step) * step);
}

std::string storey_height(double value) { return as_mapped(std::round(10 * value) / 10); }

std::string link_of(const std::string& id) {
  if (id.size() < 2 || id[1] == '-') return {};
  const std::string_view kind = id[0] == 'n' ? "node" : id[0] == 'w' ? "way" : "relation";
  return fmt::format("https://www.openstreetmap.org/{}/{}", kind, id.substr(1));
}

std::string reported_words(const std::string& code, std::string meaning) {
  if (const std::string_view words = consequence_words(code); !words.empty()) return std::string(words);
  if (meaning.ends_with('.')) meaning.pop_back();
  return meaning;
}

std::string remedy_words(const std::string& state, const std::string& code) {
  if (state != "reported")
    return "To change it: if it is a house of its own, correct its outline in OpenStreetMap and build again.";
  if (code == "OUTLINE_INCOMPLETE")
    return "To change it: cut a larger piece out of the map, so that the whole house lies in it.";
  if (code == "NODE_ONLY") return "To change it: draw its outline in OpenStreetMap; a point has no shape.";
  if (code == "LIFECYCLE" || code == "UNDERGROUND")
    return "To change it: if that is no longer so, correct its tags in OpenStreetMap and build again.";
  return "To change it: correct it in OpenStreetMap and build again.";
}

std::string origin(const std::string& source) {
  if (source == "implied") return "follows from what else is mapped";
  if (source == "part") return "from its parts";
  if (source == "imagery") return "seen in the aerial image";
  if (source == "terrain") return "from the terrain model";
  if (source == "geometry") return "judged by its outline, its use and its surroundings";
  if (source == "neighbours") return "like houses near it";
  if (source == "block" || source == "cell" || source == "district" || source == "region")
    return "usual in this part of town";
  if (source == "preset") return "usual for such buildings";
  return "assumed, as nothing is known";
}

}  // namespace blockrand::outputs::plain
