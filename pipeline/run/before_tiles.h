// What a build does before its tiles, and a plan of one as well.
#pragma once

#include <string>

#include "pipeline/base/progress.h"
#include "pipeline/georef/lon_lat.h"
#include "pipeline/model/extract.h"
#include "pipeline/model/report.h"
#include "pipeline/run/build_inputs.h"
#include "pipeline/run/options.h"

namespace blockrand::run {

/// BuildOptions::output. \throws base::UsageError  an input lies in it, or the folder of kept work
const std::string& checked_output(const BuildOptions& options);

/// What is asked of the outputs and no output reads.
void warn_of_unread(const BuildOptions& options, base::Progress& progress);

/// \param centre  of the extract, degrees
void warn_of_heights(const BuildOptions& options, const BuildInputs& inputs, const georef::LonLat& centre,
                     base::Progress& progress);

/// \returns  rows about overrides that match nothing. A tile alone does not see what lies elsewhere: the build of the
///           whole tells that
model::Report override_extract(const BuildOptions& options, BuildInputs& inputs, model::Extract& extract,
                               base::Progress& progress);

}  // namespace blockrand::run
