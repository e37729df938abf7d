// What a build must not do to the place it goes to: replace files that it did not write, or a good build by an empty one.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "pipeline/base/publish.h"
#include "pipeline/run/build.h"
#include "pipeline/run/options.h"

namespace blockrand::run {

/// Files and links below `folder`, relative to it and sorted, that are not in the list of its build.json. Side files of
/// other programs (base::is_side_file) do not count.
/// A build.json that cannot be read lists nothing.
std::vector<std::string> foreign_files(const std::string& folder);

/// The same for a folder whose files have fixed names.
/// \param ours  names of what the program writes there, relative to the folder
std::vector<std::string> files_other_than(const std::set<std::string>& ours, const std::string& folder);

/// Models of the build that `folder` holds, by its build.json; nothing where there is none, or it cannot be read.
std::optional<std::uint64_t> earlier_models(const std::string& folder);

/// \param earlier  models of the build that is to be replaced
/// \throws base::InputError  the new build has no models, or fewer than BuildOptions::allow_shrink lets go
void refuse_shrunk(const BuildOptions& options, const BuildSummary& summary, std::optional<std::uint64_t> earlier);

/// \param free  bytes where the output lies
/// \throws base::OutputError  too little space for so much, with a reserve of a quarter
/// \param bytes  that the build takes, about
void check_free_space(const BuildOptions& options, std::uint64_t bytes, std::uint64_t free);

}  // namespace blockrand::run
