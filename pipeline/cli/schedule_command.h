// blockrand schedule: the files of systemd, cron, Slurm and Kubernetes that update a region every night.
#pragma once

#include <string>
#include <vector>

#include "pipeline/settings/command_text.h"

namespace blockrand::cli {

/// \param arguments  after the command's name
/// \returns the exit code; errors are thrown
int run_schedule(const std::vector<std::string>& arguments);

settings::CommandText schedule_text();

}  // namespace blockrand::cli
