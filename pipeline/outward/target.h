// A place that files of a build are sent to: a web root that this program writes, or whatever a command reaches.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "pipeline/outward/build_files.h"

namespace blockrand::outward {

/// A few files of one step.
struct Batch {
  Step step = Step::contents;
  int number = 0, of = 0;  ///< of the batches of the whole publishing, from 1
  std::vector<BuildFile> files;
};

/// The compressed bytes of a file, or nothing where it has no smaller variant. Called from one thread.
using MakeVariant = std::function<std::string(const BuildFile& file)>;

struct Target {
  /// Puts files there, with their variants. \returns  the variants that lie there now, by path
  std::function<std::vector<std::string>(const Batch& batch, const MakeVariant& variant)> put;
  /// Removes files; one that is not there is no error.
  std::function<void(std::span<const std::string> paths, int number, int of)> remove;
  /// Whether a file lies there with these bytes: asked where a run was broken off. Empty: nobody can tell.
  std::function<bool(const BuildFile& file)> has;
};

/// A folder, made where it is missing. Each file is written beside its place and renamed, so that readers find the old one or the
/// new one, whole; its bytes are compared with its hash while they are copied.
/// \param build  folder of the build
/// \throws base::UsageError   the folder is a build, a region, or within one
/// \throws base::OutputError  it cannot be written
/// \throws base::InputError   (of put) a file of the build is missing or is not the one that its record names
Target folder_target(const std::string& build, const std::string& folder);

/// A command that is run by /bin/sh for each batch, as docs/publishing.md tells.
/// \param work  folder for lists of files, and for links to files where there are variants; made, and removed at the end
/// \throws base::OutputError  (of put and remove) it ended with another exit code than 0
Target command_target(const std::string& build, const std::string& command, const std::string& name,
                      const std::string& work);

/// \throws base::InputError  a file of a build is missing, or has another size than its record says
void check_there(const std::string& build, const BuildFile& file);

}  // namespace blockrand::outward
