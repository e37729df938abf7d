// The kept objects of a file as they stand in it, before anything is assembled. Internal to this folder.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include "importers/osm/interest.h"
#include "importers/osm/osm_file.h"
#include "pipeline/base/string_pool.h"
#include "pipeline/model/extract.h"

namespace blockrand::importers::osm {

/// Not in the file, and in the file without a usable position.
inline constexpr model::Location kMissing{std::numeric_limits<std::int32_t>::max(),
                                          std::numeric_limits<std::int32_t>::max()};
inline constexpr model::Location kInvalid{std::numeric_limits<std::int32_t>::max(), 0};
inline bool is_known(model::Location l) { return l.lon != std::numeric_limits<std::int32_t>::max(); }

struct RawObject {
  std::int64_t id = 0;
  std::uint32_t version = 0;
  std::uint32_t timestamp = 0;  ///< seconds since 1970, 0 for none
  model::Range tags;            ///< into RawData::tags
  Interest interest;
};

struct RawNode : RawObject {
  model::Location location;
};

struct RawWay : RawObject {
  model::Range refs;  ///< into RawData::refs
};

enum class Role : std::uint8_t { none, outer, inner, outline, part, other };

struct RawMember {
  std::int64_t ref = 0;
  model::OsmType type = model::OsmType::node;
  Role role = Role::none;
};

enum class RelationType : std::uint8_t { none, multipolygon, boundary, building, other };

struct RawRelation : RawObject {
  RelationType type = RelationType::none;
  model::Range members;  ///< into RawData::members, in the file's order
};

/// Positions of the nodes that kept ways use.
class NodePositions {
 public:
  static constexpr std::size_t npos = static_cast<std::size_t>(-1);
  void build(std::vector<std::int64_t> ids);
  std::size_t slot(std::int64_t id) const;
  model::Location find(std::int64_t id) const {
    const std::size_t s = slot(id);
    return s == npos ? kMissing : locations_[s];
  }
  /// Keeps the position of the highest version.
  void set(std::size_t slot, model::Location location, std::uint32_t version);
  std::uint64_t count_missing() const;

 private:
  std::vector<std::int64_t> ids_;
  std::vector<std::uint32_t> bucket_;  ///< first id of each stretch of 2^shift_ numbers
  std::uint64_t base_ = 0;
  int shift_ = 0;
  std::vector<model::Location> locations_;
  std::vector<std::uint32_t> versions_;
};

struct RawData {
  base::StringPool strings;  ///< as in the file, perhaps dirty
  std::vector<model::Tag> tags;
  std::vector<std::int64_t> refs;
  std::vector<RawMember> members;
  std::vector<RawNode> nodes;          ///< with a tag of interest; these lists are sorted by id, one version each
  std::vector<RawWay> ways;            ///< of interest, or member of a kept relation
  std::vector<RawRelation> relations;  ///< of interest, and all multipolygons: old-style ones have no tags
  NodePositions positions;
  std::uint64_t node_count = 0, way_count = 0, relation_count = 0;  ///< in the file
  std::uint32_t newest = 0;                                         ///< timestamp

  std::span<const std::int64_t> refs_of(const RawWay& way) const {
    return std::span(refs).subspan(way.refs.first, way.refs.count);
  }
  std::span<const RawMember> members_of(const RawRelation& r) const {
    return std::span(members).subspan(r.members.first, r.members.count);
  }
  std::span<const model::Tag> tags_of(const RawObject& object) const {
    return std::span(tags).subspan(object.tags.first, object.tags.count);
  }
  std::string_view tag(const RawObject& object, std::string_view key) const;
  const RawWay* way(std::int64_t id) const;
  const RawRelation* relation(std::int64_t id) const;
};

/// Reads the file in three passes, relations first, so that each pass knows what the one before needs; a fourth to
/// sixth follow only where ids do not rise, to find out whether an object has a newer version elsewhere.
/// \param surroundings  as Interest has it
/// \throws base::InputError, NulInText
RawData read_raw(OsmFile& file, bool surroundings,
                 const std::function<void(std::string_view phase, double fraction)>& progress);

}  // namespace blockrand::importers::osm
