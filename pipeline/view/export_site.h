// A site as files for any web server.
#pragma once

#include <cstdint>
#include <string>

#include "pipeline/view/site.h"

namespace blockrand::view {

struct ExportFigures {
  std::uint64_t files = 0, bytes = 0;
};

/// Writes every path of the site below `folder`, in one step.
/// \param force  replace an earlier export
/// \throws base::UsageError, base::OutputError  as base::StagedFolder
/// \throws base::InputError  a file of the build is missing or damaged
ExportFigures export_site(const Site& site, const std::string& folder, bool force);

}  // namespace blockrand::view
