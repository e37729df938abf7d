// What data a build was made of: the same for a file, the same file in another format, and a file with changes applied.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "pipeline/model/extract.h"

namespace blockrand::run {

/// SHA-256 over the objects of an extract as the stages read them, in id order: tags, members, positions, when they were
/// last edited, and what the importer reported. Neither the file's name and format nor the order of its objects count, nor
/// objects that nothing reads. Before overrides and images change the extract.
std::string data_sha256(const model::Extract& extract);

/// The same over some of the mapped objects and nothing else. \param buildings  into Extract::buildings
std::string data_sha256(const model::Extract& extract, std::span<const std::uint32_t> buildings);

}  // namespace blockrand::run
