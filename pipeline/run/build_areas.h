// A region of any size in bounded memory: the extract goes to disk, cut into areas of the quadtree, and each is built as a build of
// its own, in a process of its own, from what lies in it and 3 km around.
//
//   OUT/areas/11/1093/805/   a build as any other: tiles, tileset, GeoPackage, report, explanations, build.json
//   OUT/tileset.json         leads to their tilesets
//   OUT/build.json           what is true of all, and the hash of each area's build.json
//   OUT/report.html, .json   sums, and where to go on
//
// Nothing of it grows with the region but one line per area.
#pragma once

#include <stdexcept>
#include <string>

#include "importers/osm/extract_store.h"
#include "pipeline/base/progress.h"
#include "pipeline/run/area_record.h"
#include "pipeline/run/build.h"
#include "pipeline/run/tile_choice.h"

namespace blockrand::run {

/// An area in work.
struct AreaPart {
  const importers::osm::ExtractStore& store;
  TileChoice choice;
  std::string record_key = {};  ///< under which the records of its tiles are kept; empty: they are not
  std::string before_key = {};  ///< with TileChoice::only: under which those of the other tiles lie
  bool roomy = false;           ///< its work needs so little memory that speed counts more
};

/// What lies around the tiles that are looked into does not suffice, or work on the others is not kept any more: the area is to be
/// looked into as a whole.
struct WindowTooSmall : std::runtime_error {
  using std::runtime_error::runtime_error;
};

class SharedAreas;

/// What is wrong with settings and inputs of a build in areas is told before long data are read. \throws as build
void check_inputs_of_areas(const BuildOptions& options, base::Progress& progress);

/// \throws base::UsageError  --areas or --area with what they cannot be used with
void refuse_contradictions_of_areas(const BuildOptions& options);

/// BuildOptions::areas. \throws as build
BuildSummary build_in_areas(const BuildOptions& options, base::Progress& progress);

/// The last step of a build whose areas other processes built: documents, publishing. Areas that the plan did not name and the earlier
/// build has no more are built here. \throws as build
BuildSummary finish_areas(const BuildOptions& options, const SharedAreas& shared, base::Progress& progress);

/// BuildOptions::area: one of them, from the extract, as a build of its own. \throws as build
BuildSummary build_one_area(const BuildOptions& options, base::Progress& progress);

}  // namespace blockrand::run
