// What differs between two builds of a region, building by building, and whether that is too much to publish.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "pipeline/base/memo.h"
#include "pipeline/run/region_options.h"

namespace blockrand::run {

/// An attribute of a building that both builds have.
struct AttributeChange {
  std::string id, name;
  std::string from, to;                ///< values as text; empty: has none
  std::string from_source, to_source;  ///< model::name(Source)
  std::string why;                     ///< of the new value
};

/// A building that both builds have, whose footprint differs.
struct OutlineChange {
  std::string id;
  double area_before = 0, area_after = 0;  ///< m2
};

struct BuildChanges {
  std::vector<std::string> added, removed;  ///< ids of buildings with a model
  std::vector<AttributeChange> attributes;  ///< by id, then in the order of the new build's attributes
  std::vector<OutlineChange> outlines;
  /// Of the buildings above the footprint as mapped, that of the new build where it has one: as explanations have it (JSON). Empty
  /// where all is new.
  std::map<std::string, std::string> footprints;
  std::vector<std::string> files_changed,
      files_removed;  ///< of the build, new ones among the former: for caches of servers
  std::vector<std::string> settings_before, settings_after;  ///< lines of region.toml that the other has not
  std::uint64_t before = 0, after = 0;                       ///< buildings with a model
  std::uint64_t all_before = 0, all_after = 0;               ///< mapped buildings
  std::uint64_t simpler_before = 0, simpler_after = 0;       ///< of those: simpler than asked, or without a model
  double height_before = 0, height_after = 0;                ///< m, mean of those that both have
  std::uint64_t both = 0;                                    ///< that both have, with a height
};

/// Compares the explanations of two builds. \param before  folder of a build, or empty: all is new
/// \param memo  where sums of tiles are found again, so that those that both builds have alike need not be read; null: none
/// \throws base::InputError  a build has no explanations, or damaged ones
BuildChanges compare_builds(const std::string& before, const std::string& after, const base::Memo* memo = nullptr);

/// A limit, and what it was held against.
struct Gate {
  std::string key, words;  ///< "max_lost", "buildings that are gone"
  double value = 0, limit = 0;
  bool exceeded() const { return value > limit; }
};

/// What region.toml's limits say of a change; percent. A build without buildings never passes.
std::vector<Gate> gates_of(const BuildChanges& changes, const RegionOptions& options, bool first);

/// The same against RegionOptions::baseline. \param changes  from there
std::vector<Gate> drift_gates(const BuildChanges& changes, const RegionOptions& options);

/// The change report. \param title  of the page, for people
std::string changes_json(const BuildChanges& changes, const std::vector<Gate>& gates);
std::string changes_page(const std::string& title, const BuildChanges& changes, const std::vector<Gate>& gates);

}  // namespace blockrand::run
