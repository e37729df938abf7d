// One building's explanation in about ten plain lines, for readers who know the town and no code.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace blockrand::outputs {

struct PlainExplanation {
  std::string title;  ///< "Zionskirche, Zionskirchplatz 1", "Arkonaplatz 5, 10435 Berlin", "Garage in Veteranenstraße"
  std::vector<std::string> lines;  ///< at most 12, each a subject and what is to be said: "Storeys: 6, as mapped."
};

/// Numbers are rounded to what is known: mapped ones as mapped, others to whole metres. A confidence is a word
/// (plain_words.h): "sure" from 0.85, "likely" from 0.6, else "a guess".
/// \param json   a line as pipeline/outputs/explain/explanation.h describes, or a row of report.json as find_explanation
///               returns it for what is not in the model
/// \param asked  id that was asked for; other than the line's own: a part of this building or its duplicate. May be empty
/// \throws std::exception  `json` is no such line
PlainExplanation plain_explanation(std::string_view json, std::string_view asked = {});

}  // namespace blockrand::outputs
