// The buildings of a tile, shared among threads.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "pipeline/base/parallel.h"
#include "pipeline/model/region.h"

namespace blockrand::facades {

/// Works on each building that the tile owns. The report is the one that a single thread would write.
///
/// \param make  returns a worker of its own for each thread
/// \param work  called as work(worker, building, its index, report); must change nothing but that building
template <class Make, class Work>
void for_each_owned_building(model::Region& region, const Make& make, const Work& work) {
  const std::vector<std::size_t> begins = base::stretches_to_share(region.buildings.size());
  std::vector<model::Report> reports(begins.size() - 1);
  base::share(reports.size(), [&](std::size_t i) {
    auto worker = make();
    for (std::size_t b = begins[i]; b < begins[i + 1]; ++b)
      if (region.buildings[b].owned) work(worker, region.buildings[b], static_cast<std::uint32_t>(b), reports[i]);
  });
  for (model::Report& report : reports) region.report.append(std::move(report));
}

}  // namespace blockrand::facades
