// Reads an OpenStreetMap extract into the compact object store of a build.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "pipeline/base/error.h"
#include "pipeline/model/extract.h"

namespace blockrand::importers::osm {

struct ReadOptions {
  /// Called from the reading thread with the name of the phase and how much of it is done, in [0, 1].
  std::function<void(std::string_view phase, double fraction)> progress;

  /// Longitude and latitude in degrees: minimum, minimum, maximum, maximum. A building is kept when the centre of its
  /// raw bounding box lies inside (a duplicate or represented object also with the one that stands for it; one without
  /// any known position is dropped), a feature when its bounding box touches. Counts of buildings are those kept.
  std::optional<std::array<double, 4>> bbox;
  /// Boxes within `bbox`: what is in none of them is not kept; empty: all of it.
  std::vector<std::array<double, 4>> parts;
  bool surroundings = false;  ///< features of FeatureKind::surrounding are kept as well
  bool placeless = false;     ///< with `bbox`: buildings without any known position are kept all the same
  /// With `bbox`: a building is kept when its bounding box touches, as a feature is. For windows around what is built: a building
  /// is a neighbour wherever it stands, however far off its middle.
  bool touching = false;
};

/// Reads `.osm`, `.osm.gz`, `.osm.bz2`, `.osm.pbf` and `.pbf`, with the objects in any order and any versions.
///
/// Objects marked as deleted (`visible="false"`, JOSM's `action="delete"`) are skipped; of several versions the highest
/// counts. The result depends on the data alone: the same for every format and order of the same objects. Everything
/// in the result is sorted by OSM id, tags by key; strings are interned in that order.
///
/// Every object with `building` or `building:part` (not `no`) is counted before assembly and has one entry in
/// `Extract::buildings`, which is either pending with rings, duplicate, represented, or reported with a code; a
/// reported one has exactly one row with that code in `Extract::report`, which tells the members or values concerned.
///
/// Memory: what is kept, about 12 bytes per node that a kept object uses, and libosmium's buffers; the nodes of the
/// file are never held as a whole.
///
/// \throws base::InputError when the file is missing, a directory, empty, truncated, damaged, or not what its name says
model::Extract read_extract(const std::string& path, const ReadOptions& options = {});

}  // namespace blockrand::importers::osm
