// Numbers, values and remedies of a plain explanation (plain_explanation.h) as texts. Internal to this folder.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "pipeline/outputs/explain/plain_words.h"

namespace blockrand::outputs::plain {

using Json = nlohmann::ordered_json;

bool is_letter(char c);
std::string capitalised(std::string text);
/// "24.6" of 24.60, "6" of 6.0: as a mapper writes it.
std::string as_mapped(double value);
std::string whole(double value);
const Json* attribute_of(const Json& attributes, std::string_view name);
/// The number behind `before` in a text: 92 of "within one storey 92 %" behind "within one storey ".
double number_behind(std::string_view text, std::string_view before);
/// 13334 → "13300".
std::string three_digits(double value);
/// m, of one storey: "2.8", "7".
std::string storey_height(double value);
std::string link_of(const std::string& id);
/// What a reason means of an object that is not in the model, without a full stop.
std::string reported_words(const std::string& code, std::string meaning);
/// What to do about an object that is not in the model.
std::string remedy_words(const std::string& state, const std::string& code);
/// Where a value comes from that nobody gave, without how sure it is.
std::string origin(const std::string& source);

/// The attributes of one building or body, asked for by name.
class Values {
 public:
  explicit Values(const Json& attributes) : attributes_(attributes) {}

  const Json* find(std::string_view name) const { return attribute_of(attributes_, name); }
  double number(std::string_view name, double otherwise = 0) const {
    const Json* a = find(name);
    return a && a->at("value").is_number() ? a->at("value").get<double>() : otherwise;
  }
  std::string text(const char* name) const {
    const Json* a = find(name);
    return a && a->at("value").is_string() ? a->at("value").get<std::string>() : std::string();
  }
  std::string source(std::string_view name) const {
    const Json* a = find(name);
    return a ? a->value("source", "") : std::string();
  }
  std::string why(std::string_view name) const {
    const Json* a = find(name);
    return a ? a->value("why", "") : std::string();
  }
  double confidence(std::string_view name) const {
    const Json* a = find(name);
    return a ? a->value("confidence", 0.0) : 0.0;
  }
  std::string_view sureness(std::string_view name) const { return confidence_word(confidence(name)); }
  bool is_known(std::string_view name) const {
    const std::string s = source(name);
    return s == "tag" || s == "override";
  }
  /// "as mapped", "as you ordered"; else empty.
  std::string given(std::string_view name) const {
    const std::string s = source(name);
    return s == "tag" ? "as mapped" : s == "override" ? "as you ordered" : "";
  }

 private:
  const Json& attributes_;
};

}  // namespace blockrand::outputs::plain
