// The model inside of the report: a page that is opened from the disk may fetch nothing, so the files lie in it.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "pipeline/base/publish.h"
#include "pipeline/outputs/view_record.h"

namespace blockrand::outputs {

/// Bytes of the page, for all files of a model together.
inline constexpr std::uint64_t kMostEmbedded = 20'000'000;

/// {"files":{"view.json":"…","model/tileset.json":"…", …}}: each file compressed (gzip) and in base64, as viewer/ reads them; neither < nor & in it.
/// \param files   of the build, by path
/// \param read    the content of one of them
/// \param view    its name and the like; paths and the extent are filled here
/// \returns nothing where there are no tiles, or they are more than `most` bytes
std::optional<std::string> embedded_view(std::span<const base::PublishedFile> files,
                                         const std::function<std::string(const std::string& path)>& read,
                                         ViewRecord view, std::uint64_t most = kMostEmbedded);

/// The page's own files, packed alike: {"viewer.js":"…","viewer.css":"…"}.
std::string embedded_viewer();

}  // namespace blockrand::outputs
