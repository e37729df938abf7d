// What build.json says of the options of a build, and whether another build had them too.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "pipeline/run/options.h"

namespace blockrand::run {

/// Every option that shapes the results: those of the main section, then an object for each other section.
nlohmann::ordered_json configuration(const BuildOptions& options);

/// The first option with which a tile must agree with the build that it belongs to, and does not ("repair.max_shift");
/// empty for none. An option that the record lacks had its default: the version that wrote it did not know it.
/// \param record  the configuration in the build.json of that build
/// \throws std::exception  it is no such record
std::string first_difference(const nlohmann::json& record, const BuildOptions& options);

}  // namespace blockrand::run
