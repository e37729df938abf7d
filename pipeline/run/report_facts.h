// The report page's facts out of a build's records.
#pragma once

#include <vector>

#include "pipeline/outputs/report/report_facts.h"
#include "pipeline/outputs/report/report_page.h"
#include "pipeline/georef/lon_lat.h"
#include "pipeline/model/extract.h"
#include "pipeline/run/build.h"
#include "pipeline/run/documents.h"

namespace blockrand::run {

/// Everything but the pictures. Call when counts, statistics and files of `record` are complete but for report.html and
/// build.json itself.
/// \param rows    of all objects, sorted; outlive the facts
/// \param centre  of the build, for the link to the place
outputs::ReportFacts report_facts(const BuildOptions& options, const BuildRecord& record, const model::Extract& extract,
                                  const std::vector<model::ReportRow>& rows, const outputs::ReportBuilder& page,
                                  georef::LonLat centre);

}  // namespace blockrand::run
