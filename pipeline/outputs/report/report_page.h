// report.html: one page that tells a planner what was built, from what, and where to look twice.
#pragma once

#include <cstddef>
#include <string>

#include "pipeline/outputs/report/report_facts.h"
#include "pipeline/outputs/report/report_tile.h"

namespace blockrand::outputs {

struct ReportOptions {
  std::size_t listed_objects = 300;       ///< of each code; the page says where the others are
  std::size_t map_bytes = 8'000'000;      ///< of the map's path data, beyond which details and then footprints go
  std::size_t single_footprints = 8'000;  ///< up to here every footprint has a title of its own
  std::size_t listed_blocks = 300;        ///< by floor area; their outlines are on the map
};

/// Collects tiles and writes the page. Memory: about 120 bytes a building and 8 a corner; while writing, the page besides.
class ReportBuilder {
 public:
  /// Takes a tile; call in tile order, since the page keeps it.
  void add(ReportTile&& tile);

  std::uint64_t buildings_built() const;  ///< of the tiles so far: with at least one body
  std::uint64_t bodies() const { return footprints_.bodies; }

  /// The page: HTML that is well-formed XML too, with nothing to load from elsewhere. The same tiles and facts give the
  /// same bytes.
  std::string html(const ReportFacts& facts, const ReportOptions& options = {}) const;

 private:
  MapFootprints footprints_;
  StyleCounts styles_;
};

}  // namespace blockrand::outputs
