// The one list of coded reasons: the report, the documentation and the tests share it.
#pragma once

#include <cstdint>
#include <string_view>

namespace blockrand::model {

/// What kind of statement a code makes.
enum class IssueClass : std::uint8_t {
  reported,  ///< the object was not modelled, for this reason: its final state
  fallback,  ///< modelled, but simpler than asked
  notice,    ///< modelled as asked; something in the input was mended, ignored or unreadable
};

// X(code, text, class, what it means and what the mapper or user can do)
#define BLOCKRAND_ISSUE_CODES(X)                                                                                     \
  X(none, "NONE", notice, "No issue.")                                                                               \
  /* objects that end as a row in the report */                                                                      \
  X(node_only, "NODE_ONLY", reported, "A building mapped as a point has no outline to build from.")                  \
  X(open_way, "OPEN_WAY", reported, "The way is not closed; close it in an editor.")                                 \
  X(ring_broken, "RING_BROKEN", reported, "The relation's members do not form closed rings.")                        \
  X(outline_incomplete, "OUTLINE_INCOMPLETE", reported, "Ways or nodes of the outline are not in the extract.")      \
  X(too_few_points, "TOO_FEW_POINTS", reported, "The outline has fewer than three distinct points.")                 \
  X(zero_area, "ZERO_AREA", reported, "The outline encloses no area.")                                               \
  X(invalid_location, "INVALID_LOCATION", reported, "A node lies outside the range of longitude and latitude.")      \
  X(too_large, "TOO_LARGE", reported, "The outline is wider than 10 km; no building is. Correct it in an editor.")   \
  X(underground, "UNDERGROUND", reported, "The building lies below the ground (location or layer tags).")            \
  X(lifecycle, "LIFECYCLE", reported, "The building is planned, under construction, ruined or gone.")                \
  X(relation_type, "RELATION_TYPE", reported, "A relation of this type carries no outline of its own.")              \
  X(no_solid, "NO_SOLID", reported, "No valid solid could be made, not even a block.")                               \
  X(unaccounted, "UNACCOUNTED", reported, "No stage decided on the object. This is a bug: please report it.")        \
  /* simpler than asked */                                                                                           \
  X(roof_shape_adapted, "ROOF_SHAPE_ADAPTED", fallback, "The plan does not take this shape; a relative was built.")  \
  X(roof_shape_unknown, "ROOF_SHAPE_UNKNOWN", fallback, "The value of roof:shape is in no list; flat was built.")    \
  X(roof_failed, "ROOF_FAILED", fallback, "The roof's solid failed its check; a flat roof was built.")               \
  X(roof_lines_ignored, "ROOF_LINES_IGNORED", fallback,                                                              \
    "The mapped ridges and edges make no roof; its shape was built.")                                                \
  X(roof_simplified, "ROOF_SIMPLIFIED", fallback, "The roof stands on a simplified plan.")                           \
  X(side_pitch_unread, "SIDE_PITCH_UNREAD", fallback,                                                                \
    "A pitch ordered for a side of the roof found no such side, a roof that has none, or a height against it.")      \
  X(skeleton_fallback, "SKELETON_FALLBACK", fallback, "The weighted skeleton gave up; CGAL's hips were built.")      \
  X(roof_row_ignored, "ROOF_ROW_IGNORED", fallback, "No valid roof between the party walls; it falls to all sides.") \
  X(roof_height_clamped, "ROOF_HEIGHT_CLAMPED", fallback, "The roof was higher than the building allows.")           \
  X(lod1_only, "LOD1_ONLY", fallback, "No valid LoD2 solid; a block was built.")                                     \
  X(facade_failed, "FACADE_FAILED", fallback, "The solid with openings failed its check; the walls stay closed.")    \
  X(opening_left_out, "OPENING_LEFT_OUT", fallback,                                                                  \
    "Windows or doors did not fit their walls; the others were built.")                                              \
  X(roof_element_left_out, "ROOF_ELEMENT_LEFT_OUT", fallback,                                                        \
    "Chimneys, gables, dormers or roof windows did not fit; the others were built.")                                 \
  X(grammar_error, "GRAMMAR_ERROR", fallback,                                                                        \
    "A rule asked for what cannot be made; the rest of the facade was built.")                                       \
  X(leaf_dropped, "LEAF_DROPPED", fallback,                                                                          \
    "What a rule made has no place in the model; the rest of the facade was built.")                                 \
  X(model_not_closed, "MODEL_NOT_CLOSED", fallback,                                                                  \
    "The model that replaces the building bounds no volume; its surfaces stand as they are.")                        \
  X(plan_simplified, "PLAN_SIMPLIFIED", fallback, "The plan was simplified to get a valid solid.")                   \
  X(rest_failed, "REST_FAILED", fallback, "The part of the outline that its parts leave free could not be built.")   \
  /* mended, ignored, unreadable */                                                                                  \
  X(value_unreadable, "VALUE_UNREADABLE", notice, "A tag's value cannot be parsed; it is kept as text.")             \
  X(value_clamped, "VALUE_CLAMPED", notice, "A tag's value is out of range and was limited.")                        \
  X(duplicate_key, "DUPLICATE_KEY", notice, "A key stands twice on the object; the first value in order was kept.")  \
  X(values_conflict, "VALUES_CONFLICT", notice, "Two tags contradict each other; the stronger one was used.")        \
  X(members_missing, "MEMBERS_MISSING", notice, "Some members are not in the extract; the rest was built.")          \
  X(relation_repaired, "RELATION_REPAIRED", notice, "The relation's rings were assembled despite errors.")           \
  X(old_style_multipolygon, "OLD_STYLE_MULTIPOLYGON", notice, "The tags stand on the outer way, not the relation.")  \
  X(duplicate_points, "DUPLICATE_POINTS", notice, "Repeated points were removed.")                                   \
  X(spike_removed, "SPIKE_REMOVED", notice, "A spike was removed.")                                                  \
  X(ring_repaired, "RING_REPAIRED", notice, "A self-intersecting outline was made valid.")                           \
  X(split_outline, "SPLIT_OUTLINE", notice, "The valid outline consists of several pieces.")                         \
  X(touching_rings, "TOUCHING_RINGS", notice, "Rings that touched were moved apart by a few centimetres.")           \
  X(sliver_dropped, "SLIVER_DROPPED", notice, "A piece below the smallest area was dropped.")                        \
  X(collinear_points, "COLLINEAR_POINTS", notice, "Points on straight walls were removed.")                          \
  X(shared_wall_made, "SHARED_WALL_MADE", notice, "A wall was joined with that of a neighbour that almost met it.")  \
  X(shared_wall_conflict, "SHARED_WALL_CONFLICT", notice, "Joining walls would have broken the outline; they stay.") \
  X(squared, "SQUARED", notice, "Corners that were almost right were made right.")                                   \
  X(overlap_resolved, "OVERLAP_RESOLVED", notice, "An overlap with a neighbour was given to one of the two.")        \
  X(overlap_kept, "OVERLAP_KEPT", notice, "An overlap with a neighbour stays: without it, little would be left.")    \
  X(nested_building, "NESTED_BUILDING", notice, "A building lies within another one at the same level.")             \
  X(near_duplicate, "NEAR_DUPLICATE", notice, "The same house is mapped twice; one of the two outlines was built.")  \
  X(covered_outline, "COVERED_OUTLINE", notice, "Others cover most of the outline; what they leave free was built.") \
  X(repair_bounded, "REPAIR_BOUNDED", notice, "Repair would have changed too much; the outline stays as mapped.")    \
  X(parts_outside, "PARTS_OUTSIDE", notice, "A building part sticks out of its building's outline.")                 \
  X(parts_overlap, "PARTS_OVERLAP", notice, "Parts overlap at overlapping heights; one of them gave way.")           \
  X(outline_made, "OUTLINE_MADE", notice, "Touching parts without an outline became one building.")                  \
  X(part_without_outline, "PART_WITHOUT_OUTLINE", notice, "A building part lies in no building; it stands alone.")   \
  X(parts_incomplete, "PARTS_INCOMPLETE", notice, "The parts leave some of the outline free; the rest was built.")   \
  X(antimeridian, "ANTIMERIDIAN", notice, "The outline crosses longitude 180 degrees.")                              \
  X(reach_cut, "REACH_CUT", notice, "A row of buildings longer than 1 km was cut at the grid.")                      \
  X(terrain_missing, "TERRAIN_MISSING", notice, "The terrain has no value here; the ground height was used.")        \
  X(roof_with_bays, "ROOF_WITH_BAYS", notice,                                                                        \
    "A roof along whole facades does not fit the plan; every bay has its own slopes.")                               \
  X(override_unmatched, "OVERRIDE_UNMATCHED", notice,                                                                \
    "An entry of the overrides has nothing in the extract to act on.")                                               \
  X(building_replaced, "BUILDING_REPLACED", notice,                                                                  \
    "A model that the overrides name stands for the building; its source and licence are told with it.")             \
  X(parameter_unread, "PARAMETER_UNREAD", notice,                                                                    \
    "A parameter, tag or order that nothing reads: the rule file of the preset asks for no such name.")              \
  X(text_cleaned, "TEXT_CLEANED", notice, "Characters that no XML file may hold were replaced in a tag.")            \
  X(requirement_missed, "REQUIREMENT_MISSED", notice, "The house, as built, misses a measure that its preset states.")

enum class IssueCode : std::uint8_t {
#define X(code, text, klass, meaning) code,
  BLOCKRAND_ISSUE_CODES(X)
#undef X
};

struct IssueInfo {
  std::string_view text;  ///< as written in reports, upper case
  IssueClass issue_class;
  std::string_view meaning;  ///< one sentence for documentation and report
};

inline constexpr IssueInfo kIssueInfo[] = {
#define X(code, text, klass, meaning) {text, IssueClass::klass, meaning},
    BLOCKRAND_ISSUE_CODES(X)
#undef X
};
inline constexpr int kIssueCodeCount = sizeof(kIssueInfo) / sizeof(kIssueInfo[0]);

constexpr const IssueInfo& info(IssueCode code) { return kIssueInfo[static_cast<int>(code)]; }

}  // namespace blockrand::model
