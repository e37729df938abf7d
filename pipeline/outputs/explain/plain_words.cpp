#include "pipeline/outputs/explain/plain_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace blockrand::outputs {
namespace {

using Words = std::pair<std::string_view, std::string_view>;

template <std::size_t N>
std::string_view looked_up(const Words (&table)[N], std::string_view key) {
  for (const auto& [name, words] : table)
    if (name == key) return words;
  return {};
}

}  // namespace

std::string_view confidence_word(double confidence) {
  if (confidence >= kSure) return "sure";
  return confidence >= kLikely ? "likely" : "a guess";
}

std::string count_of(double n, std::string_view one, std::string_view many) {
  const std::string number = n == std::floor(n) ? fmt::format("{:.0f}", n) : fmt::format("{:.1f}", n);
  if (n == 1) return fmt::format("{} {}", number, one);
  return many.empty() ? fmt::format("{} {}s", number, one) : fmt::format("{} {}", number, many);
}

std::string with_article(std::string_view noun) {
  const bool vowel = !noun.empty() && std::string_view("aeiouAEIO").find(noun[0]) != std::string_view::npos;
  return fmt::format("{} {}", vowel && !noun.starts_with("uni") ? "an" : "a", noun);
}

std::string with_spaces(std::string_view name) {
  std::string out(name);
  std::replace(out.begin(), out.end(), '_', ' ');
  return out;
}

std::string use_words(std::string_view use) {
  constexpr Words kWords[] = {
      {"apartments", "block of flats"},
      {"residential", "residential building"},
      {"commercial", "commercial building"},
      {"industrial", "industrial building"},
      {"retail", "shop building"},
      {"public", "public building"},
      {"civic", "public building"},
      {"religious", "religious building"},
      {"office", "office building"},
      {"service", "small technical building"},
      {"detached", "detached house"},
      {"semidetached_house", "semi-detached house"},
      {"terrace", "row of terraced houses"},
      {"garages", "row of garages"},
      {"roof", "canopy, a roof without walls"},
      {"carport", "carport, a roof without walls"},
      {"toilets", "public toilet"},
      {"farm", "farmhouse"},
      {"farm_auxiliary", "farm building"},
      {"train_station", "railway station"},
      {"dormitory", "hall of residence"},
      {"university", "university building"},
      {"hospital", "hospital building"},
      {"construction", "building under construction"},
      {"outbuilding", "outbuilding"},
      {"transformer_tower", "transformer tower"},
      {"yes", "building"},
  };
  const std::string_view words = looked_up(kWords, use);
  return words.empty() ? with_spaces(use) : std::string(words);
}

std::string roof_words(std::string_view shape) {
  constexpr Words kWords[] = {
      {"flat", "flat roof"},
      {"gabled", "gabled roof"},
      {"gabled_height_moved", "gabled roof with its ridge off the middle"},
      {"skillion", "lean-to roof of one slope"},
      {"hipped", "hipped roof"},
      {"half-hipped", "half-hipped roof"},
      {"side_hipped", "roof with a hip at one end"},
      {"side_half-hipped", "roof with a half-hip at one end"},
      {"hipped-and-gabled", "hipped roof with small gables"},
      {"mansard", "mansard roof"},
      {"gambrel", "mansard roof with gables"},
      {"pyramidal", "pyramid roof"},
      {"crosspitched", "roof with a gable at each side"},
      {"sawtooth", "sawtooth roof"},
      {"butterfly", "butterfly roof, which falls to the middle"},
      {"cone", "cone roof"},
      {"dome", "dome"},
      {"onion", "onion dome"},
      {"round", "vaulted roof"},
      {"saltbox", "saltbox roof, one slope longer than the other"},
      {"double_saltbox", "roof of two slopes up to a flat deck"},
      {"quadruple_saltbox", "roof of four slopes up to a flat deck"},
      {"spire", "spire"},
      {"helm", "helm roof"},
      {"many", "roof of several shapes"},
      {"other", "roof of another shape"},
      {"lined", "roof along the ridges that are drawn in the map"},
      {"berlin", "Berlin roof (steep to the street, low to the yard)"},
  };
  const std::string_view words = looked_up(kWords, shape);
  return words.empty() ? with_spaces(shape) + " roof" : std::string(words);
}

std::string_view position_words(std::string_view position) {
  constexpr Words kWords[] = {
      {"free_standing", "on its own"},
      {"end_of_row", "at the end of a row"},
      {"mid_row", "within a row of houses"},
      {"corner_house", "at a street corner"},
      {"rear_building", "in the back, behind other houses"},
      {"side_wing", "as a side wing at the back of other houses"},
  };
  return looked_up(kWords, position);
}

std::string_view direction_words(std::string_view compass) {
  constexpr Words kWords[] = {{"N", "north"}, {"NE", "north-east"}, {"E", "east"}, {"SE", "south-east"},
                              {"S", "south"}, {"SW", "south-west"}, {"W", "west"}, {"NW", "north-west"}};
  return looked_up(kWords, compass);
}

std::string_view class_words(std::string_view style_class) {
  constexpr Words kWords[] = {
      {"gruenderzeit", "a Gründerzeit house"},
      {"tenement", "a plain tenement of the Gründerzeit"},
      {"modern", "a building from after 1918"},
      {"other", "an outbuilding, a church or a house from before 1840"},
  };
  return looked_up(kWords, style_class);
}

std::string_view era_words(std::string_view era) {
  constexpr Words kWords[] = {{"pre1840", "before 1840"},
                              {"1840_1918", "1840 to 1918"},
                              {"1919_1945", "1919 to 1945"},
                              {"post1945", "after 1945"}};
  return looked_up(kWords, era);
}

ElementWords element_words(std::string_view kind) {
  constexpr std::pair<std::string_view, ElementWords> kWords[] = {
      {"balcony", {"balcony", "balconies"}},
      {"loggia", {"loggia", "loggias"}},
      {"bay", {"bay", "bays"}},
      {"shop_window", {"shop window", "shop windows"}},
      {"carriage_gateway", {"gateway", "gateways"}},
      {"chimney", {"chimney", "chimneys"}},
      {"roof_window", {"roof window", "roof windows"}},
      {"dormer", {"dormer", "dormers"}},
      {"cross_gable", {"cross gable", "cross gables"}},
  };
  for (const auto& [name, words] : kWords)
    if (name == kind) return words;
  return {};
}

std::string_view consequence_words(std::string_view code) {
  constexpr Words kWords[] = {
      {"NODE_ONLY", "it is mapped as a point, which has no outline to build from"},
      {"OPEN_WAY", "its outline is not closed in the map"},
      {"RING_BROKEN", "the pieces of its outline do not close in the map"},
      {"OUTLINE_INCOMPLETE", "a piece of its outline lies outside of the map extract"},
      {"TOO_FEW_POINTS", "its outline has fewer than three corners in the map"},
      {"ZERO_AREA", "its outline encloses nothing in the map"},
      {"INVALID_LOCATION", "a corner of it lies nowhere on Earth"},
      {"TOO_LARGE", "its outline is wider than 10 km, as no building is"},
      {"UNDERGROUND", "it lies below the ground, as mapped"},
      {"LIFECYCLE", "it is planned, under construction, a ruin or gone, as mapped"},
      {"RELATION_TYPE", "it is mapped as a collection of others and has no outline of its own"},
      {"NO_SOLID", "no sound body could be made of its outline, not even a block"},
      {"UNACCOUNTED", "the program lost it, which is a mistake of the program: please report it"},
      {"ROOF_SHAPE_ADAPTED", "its outline does not take the roof that was meant, so a similar one was built"},
      {"ROOF_SHAPE_UNKNOWN", "the roof shape that is mapped is none that the program knows, so the roof is flat"},
      {"ROOF_FAILED", "no sound roof could be built, so it is flat"},
      {"ROOF_LINES_IGNORED", "the ridges that are drawn in the map make no roof, so they were left aside"},
      {"ROOF_SIMPLIFIED", "the roof follows the outline only roughly"},
      {"SIDE_PITCH_UNREAD",
       "a pitch ordered for one side of its roof found no such side, a roof that has none, or a height against it"},
      {"SKELETON_FALLBACK", "the roof's slopes were laid out in a simpler way"},
      {"ROOF_ROW_IGNORED", "the roof could not end at the neighbours' walls, so it falls to all sides"},
      {"ROOF_HEIGHT_CLAMPED", "the roof would have been higher than the building, so it was lowered"},
      {"LOD1_ONLY", "no sound roof could be built, so it is a plain block"},
      {"FACADE_FAILED", "its windows could not be cut into the walls, so the walls are closed"},
      {"OPENING_LEFT_OUT", "some windows or doors did not fit and are missing"},
      {"ROOF_ELEMENT_LEFT_OUT", "some chimneys, gables, dormers or roof windows did not fit and are missing"},
      {"GRAMMAR_ERROR", "a rule for its front failed, so something of the front is missing"},
      {"MODEL_NOT_CLOSED", "the model that replaces the building bounds no volume; its surfaces stand as they are"},
      {"BUILDING_REPLACED", "a model named by the overrides stands for the building"},
      {"LEAF_DROPPED", "something that the rules of its front made has no place in the model and is missing"},
      {"PLAN_SIMPLIFIED", "its outline was simplified, or no sound body could have been built"},
      {"REST_FAILED", "what its mapped parts leave free could not be built, so a piece may be missing"},
      {"ROOF_WITH_BAYS", "one roof over everything does not fit, so every bay has slopes of its own"},
      {"REQUIREMENT_MISSED", "it misses a measure that houses of its kind shall keep"},
      {"VALUE_UNREADABLE", "a tag cannot be read and was left aside"},
      {"VALUE_CLAMPED", "a tag has an impossible value, which was limited"},
      {"DUPLICATE_KEY", "a tag stands twice in the map, and the first one counts"},
      {"VALUES_CONFLICT", "two tags contradict each other, and the stronger one counts"},
      {"MEMBERS_MISSING", "pieces of its outline lie outside of the map extract"},
      {"RELATION_REPAIRED", "its outline had errors in the map and was pieced together"},
      {"DUPLICATE_POINTS", "double points were removed"},
      {"SPIKE_REMOVED", "a spike was removed"},
      {"RING_REPAIRED", "the outline crossed itself and was mended"},
      {"SPLIT_OUTLINE", "it consists of several pieces"},
      {"TOUCHING_RINGS", "courtyards that touched were moved apart by a few centimetres"},
      {"SLIVER_DROPPED", "a tiny piece was dropped"},
      {"SHARED_WALL_CONFLICT", "some walls could not be joined with the neighbours' and stay as mapped"},
      {"OVERLAP_RESOLVED", "it overlapped a neighbour, and one of the two gave way"},
      {"OVERLAP_KEPT", "it overlaps a neighbour, as mapped"},
      {"NESTED_BUILDING", "it lies within another building of the map"},
      {"NEAR_DUPLICATE", "the same house is drawn twice in the map, and one of the two was built"},
      {"COVERED_OUTLINE", "other buildings cover most of its outline, and only what they leave was built"},
      {"REPAIR_BOUNDED", "mending it would have changed too much, so it stays as mapped"},
      {"PARTS_OUTSIDE", "a part of it sticks out of its outline"},
      {"PARTS_OVERLAP", "parts of it overlapped, and one gave way"},
      {"OUTLINE_MADE", "its parts touch and have no outline in the map, so they became one building"},
      {"PART_WITHOUT_OUTLINE", "it is mapped as a part of a building that is not there"},
      {"PARTS_INCOMPLETE", "its mapped parts leave some of the outline free, and that was built, too"},
      {"TERRAIN_MISSING", "the terrain has a hole here"},
      {"OVERRIDE_UNMATCHED", "an order of yours found nothing to act on"},
      {"PARAMETER_UNREAD", "a parameter, tag or order for it is one that nothing reads"},
      // Of no interest to who looks at the model, or told by the corners that moved.
      {"SQUARED", " "},
      {"SHARED_WALL_MADE", " "},
      {"COLLINEAR_POINTS", " "},
      {"OLD_STYLE_MULTIPOLYGON", " "},
      {"ANTIMERIDIAN", " "},
      {"REACH_CUT", " "},
      {"TEXT_CLEANED", " "},
  };
  return looked_up(kWords, code);
}

}  // namespace blockrand::outputs
