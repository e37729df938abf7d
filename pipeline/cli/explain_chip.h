// The piece of the aerial image that shows one building, cut out of its tile's picture: `blockrand explain --chip`.
#pragma once

#include <string>

#include "pipeline/outputs/explain/find_explanation.h"

namespace blockrand::cli {

/// The picture of its tile's aerial image with the outlines on it; empty for a build without images or pictures.
std::string overlay_path(const std::string& folder, const outputs::FoundExplanation& found);

/// Writes the building and some of its surroundings as a PNG. \param folder  of the build
/// \throws base::InputError   the build has no image of it, or what it has is damaged
/// \throws base::UsageError   the file is there already
/// \throws base::OutputError  the file cannot be written; none is left half written
void write_chip(const std::string& folder, const outputs::FoundExplanation& found, const std::string& file);

}  // namespace blockrand::cli
