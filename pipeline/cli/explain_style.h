// Why a building has its style, in words. Internal to this folder.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace blockrand::cli {

/// "before 1840", "1840 to 1918"; other texts as they are. \param era  a name of model::Era
std::string era_in_words(std::string_view era);

/// A measured value as people read it: three digits at most and its unit; shares in percent; where numbers stand for
/// things ("position" 3), the thing's name.
/// \param feature, unit, meaning  as in the explanation
std::string value_in_words(std::string_view feature, std::string_view unit, std::string_view meaning, double value);

/// The section "Its style, and why" of `blockrand explain`; empty where nothing was classified.
/// \param style  the object "style" of an explanation (pipeline/outputs/explain/explanation.h)
/// \param all    every term and every change; else the six weightiest
std::string style_text(const nlohmann::ordered_json& style, bool all);

}  // namespace blockrand::cli
