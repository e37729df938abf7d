// What spoke for a building's style, as sentences. Internal to this folder.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace blockrand::outputs {

/// "it stands within a row"; empty for a feature without a value.
/// \param feature, meaning, unit  as in the explanation; a feature without a sentence here is told by its meaning
std::string reason_sentence(std::string_view feature, std::string_view meaning, std::string_view unit, double value);

/// The strongest reasons for the class of a style against the next likely one, the strongest first.
/// \param style  the object "style" of an explanation
std::vector<std::string> strongest_reasons(const nlohmann::ordered_json& style, std::size_t most);

}  // namespace blockrand::outputs
