// Sends a build to all places that the settings name.
#pragma once

#include <cstdint>
#include <exception>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/base/progress.h"
#include "pipeline/outward/options.h"

namespace blockrand::outward {

/// What is sent.
struct PublishSource {
  std::string build;          ///< folder, absolute
  std::string name;           ///< of the region, or of the build's folder
  std::optional<int> number;  ///< of the build in its region
  std::string notes;          ///< folder where it is noted what lies where: REGION/outward, BUILD.outward
};

/// \param place  a region, whose published build is meant, or a build
/// \throws base::UsageError  it is neither, or a region without a published build
PublishSource publish_source(const std::string& place);

/// How one place went.
struct PublishedPart {
  std::string what;                                            ///< command, web-root, archive, postgis
  std::string place;                                           ///< without passwords
  std::vector<std::pair<std::string, std::uint64_t>> figures;  ///< "files sent" → 12
  std::string failure;                                         ///< why it is to do; empty: it is done
};

struct PublishReport {
  std::vector<PublishedPart> parts;
  std::exception_ptr first_failure;  ///< none: all is done
};

/// One place after the other; one that fails keeps none of the others back, and is taken up by the next call. How they went is noted in
/// `notes`/last.json: of each place, by what it is and where; a damaged build is a failure of each.
/// \param all_places  there are no other places: what is noted of such is forgotten
/// \throws base::UsageError   another one works for this source
/// \throws base::OutputError  the notes cannot be written
PublishReport publish(const PublishOptions& options, const PublishSource& source, bool dry_run,
                      base::Progress& progress, bool all_places = false);

/// What `blockrand status` tells: a line for each place where the published build is not; empty where nothing is to do, or was
/// ever sent.
std::vector<std::string> outward_to_do(const std::string& region, std::optional<int> current);

}  // namespace blockrand::outward
