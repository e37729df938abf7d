// What a stage has to say about single objects.
#pragma once

#include <compare>
#include <string>
#include <vector>

#include "pipeline/model/issue_codes.h"
#include "pipeline/model/osm_id.h"

namespace blockrand::model {

/// One row of report.json. `detail` holds the tag, value, member or measure concerned.
struct ReportRow {
  OsmId object;
  IssueCode code = IssueCode::none;
  std::string detail;
  friend auto operator<=>(const ReportRow&, const ReportRow&) = default;
};

/// Rows in the order they were found; sorted by object before they are written.
struct Report {
  std::vector<ReportRow> rows;
  void add(OsmId object, IssueCode code, std::string detail = {}) { rows.push_back({object, code, std::move(detail)}); }
  void append(Report&& other) {
    rows.insert(rows.end(), std::make_move_iterator(other.rows.begin()), std::make_move_iterator(other.rows.end()));
  }
};

}  // namespace blockrand::model
