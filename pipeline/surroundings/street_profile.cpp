#include "pipeline/surroundings/street_profile.h"

#include <algorithm>
#include <charconv>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>

#include "pipeline/model/osm_keys.h"

namespace blockrand::surroundings {
namespace {

namespace osm_key = model::osm_key;
using model::GroundClass;
using model::SurroundingMaterial;

// m. Source: RASt 06 (Richtlinien für die Anlage von Stadtstraßen, FGSV 2006).
constexpr double kParallelParking = 2, kDiagonalParking = 4.5, kPerpendicularParking = 5;
constexpr double kAdvisoryBicycleLane = 1.5, kBicycleLane = 1.85;
constexpr double kBicycleTrack = 2, kTwoWayBicycleTrack = 2.5;
/// A car of 1.75 m and 0.25 m on either side of it: lanes are not narrower.
constexpr double kNarrowestLane = 2.25;
/// Of the width for two directions: 5.5 m become 3.6 m. RASt 06 has 3.0 to 3.5 m for streets with one direction.
constexpr double kOnewayShare = 0.65;
/// A lane between two kerbs is wider than one beside another.
constexpr double kSingleLane = 3.25;
/// Ways to houses and for fire engines. Source: DIN 14090 (2003).
constexpr double kDriveway = 3;
/// A pavement that a tag tells of where streets of the class have none as a rule.
constexpr double kPavement = 2;

constexpr double kMinWidth = 0.3, kMaxWidth = 60;
constexpr int kMaxLanes = 16;

enum class Side { left, right };
/// Whether vehicles go with the way, against it, or both.
enum class Traffic { both, forward, backward };

/// The keys of one thing beside a street. `all` has a value that names the side.
struct SideKeys {
  std::string_view left, right, both, all;
};
constexpr SideKeys kSidewalks{osm_key::kSidewalkLeft, osm_key::kSidewalkRight, osm_key::kSidewalkBoth,
                              osm_key::kSidewalk};
constexpr SideKeys kCycleways{osm_key::kCyclewayLeft, osm_key::kCyclewayRight, osm_key::kCyclewayBoth,
                              osm_key::kCycleway};
constexpr SideKeys kParkings{osm_key::kParkingLeft, osm_key::kParkingRight, osm_key::kParkingBoth, {}};

template <std::size_t N>
bool is_one_of(std::string_view text, const std::string_view (&words)[N]) {
  return std::find(std::begin(words), std::end(words), text) != std::end(words);
}

std::string_view without_blanks(std::string_view text) {
  while (text.starts_with(' ')) text.remove_prefix(1);
  while (text.ends_with(' ')) text.remove_suffix(1);
  return text;
}

/// Takes the text up to `mark` off the front, and the mark.
std::string_view take_until(std::string_view& list, char mark) {
  const std::size_t end = std::min(list.find(mark), list.size());
  const std::string_view value = list.substr(0, end);
  list.remove_prefix(std::min(end + 1, list.size()));
  return without_blanks(value);
}

std::string_view value_of_side(const TagOf& tag, const SideKeys& keys, Side side) {
  const std::string_view own = tag(side == Side::left ? keys.left : keys.right);
  return own.empty() ? tag(keys.both) : own;
}

/// What is told of the thing on a side: width, surface. That of the side comes before that of both.
std::string_view detail_of_side(const TagOf& tag, const SideKeys& keys, Side side, std::string_view detail) {
  for (const std::string_view key : {side == Side::left ? keys.left : keys.right, keys.both, keys.all})
    if (!key.empty())
      if (const std::string_view value = tag(std::string(key) + ":" + std::string(detail)); !value.empty())
        return value;
  return {};
}

std::optional<double> width_of(std::string_view text) {
  const std::optional<double> width = length_of(text);
  return width && *width >= kMinWidth && *width <= kMaxWidth ? width : std::nullopt;
}

/// The first of a list that the catalogue knows; `concrete:plates` is concrete where it does not know the plates.
std::optional<SurroundingMaterial> paving_of(std::string_view surfaces, const Catalogue& catalogue) {
  while (!surfaces.empty()) {
    const std::string_view value = take_until(surfaces, ';');
    if (const auto known = catalogue.surface(value)) return known;
    if (const auto known = catalogue.surface(value.substr(0, value.find(':')))) return known;
  }
  return std::nullopt;
}

/// Of the way itself: of a street its carriageway.
SurroundingMaterial material_of(const TagOf& tag, std::string_view highway, bool built_up, const Catalogue& catalogue) {
  if (const auto told = paving_of(tag(osm_key::kSurface), catalogue)) return *told;
  if (const auto graded = paving_of(tag(osm_key::kTracktype), catalogue)) return *graded;
  if (!built_up && highway == "path")
    if (const auto trodden = catalogue.surface("ground")) return *trodden;
  return catalogue.material(catalogue.street(highway).material);
}

SurroundingMaterial material_of_side(const TagOf& tag, const SideKeys& keys, Side side, SurroundingMaterial usual,
                                     const Catalogue& catalogue) {
  return paving_of(detail_of_side(tag, keys, side, osm_key::kSurface), catalogue).value_or(usual);
}

bool is_roundabout(const TagOf& tag) {
  const std::string_view junction = tag(osm_key::kJunction);
  return junction == "roundabout" || junction == "circular";
}

Traffic traffic_of(const TagOf& tag, std::string_view highway) {
  const std::string_view oneway = tag(osm_key::kOneway);
  if (oneway == "-1" || oneway == "reverse") return Traffic::backward;
  if (oneway == "yes" || oneway == "1" || oneway == "true") return Traffic::forward;
  const bool implied = highway == "motorway" || is_roundabout(tag);
  return oneway.empty() && implied ? Traffic::forward : Traffic::both;
}

// ---------------------------------------------------------------------------------------------- what is beside lanes

/// Whether a value of `sidewalk` or of sidewalk:left tells of a pavement on that side; nothing: the value tells neither.
/// Pavements that are ways of their own are none of this street.
std::optional<bool> has_pavement(std::string_view values, Side side) {
  constexpr std::string_view kNone[] = {"no", "none", "separate", "lane", "shoulder", "left", "right"};
  std::optional<bool> out;
  while (!values.empty()) {
    const std::string_view value = take_until(values, ';');
    if (value == "both" || value == "yes" || value == (side == Side::left ? "left" : "right")) return true;
    if (is_one_of(value, kNone)) out = false;
  }
  return out;
}

double pavement_of(const TagOf& tag, Side side, double usual, bool where_untold) {
  std::optional<bool> told = has_pavement(value_of_side(tag, kSidewalks, side), side);
  if (!told) told = has_pavement(tag(osm_key::kSidewalk), side);
  if (!told) told = has_pavement(tag(osm_key::kFootway), side);  // an older word for `sidewalk`
  if (!told.value_or(where_untold)) return 0;
  if (const auto width = width_of(detail_of_side(tag, kSidewalks, side, osm_key::kWidth))) return *width;
  return told && usual <= 0 ? kPavement : usual;
}

/// The value of the scheme for a side. `cycleway=lane` is on both sides of a street with two directions, and on the side to
/// which vehicles keep where there is one; `opposite_lane` is on the other.
std::string_view cycleway_of(const TagOf& tag, Side side, Traffic traffic, bool keeps_left) {
  constexpr std::string_view kOpposite = "opposite_";
  std::string_view value = value_of_side(tag, kCycleways, side);
  const bool sided = !value.empty();
  if (!sided) value = tag(osm_key::kCycleway);
  const bool opposite = value.starts_with(kOpposite);
  if (opposite) value.remove_prefix(kOpposite.size());
  if (sided || (traffic == Traffic::both && !opposite)) return value;
  const Side kept = (traffic == Traffic::backward) != keeps_left ? Side::left : Side::right;
  return (side == kept) != opposite ? value : std::string_view{};
}

/// What lies on one side of the lanes of a street, m; 0: nothing.
struct BesideLanes {
  double bicycle_lane = 0;    ///< in the carriageway
  double parking_lane = 0;    ///< between the lanes and the kerb
  bool perhaps_bays = false;  ///< cars stand across the street, and no tag tells where
  double parking_bay = 0;     ///< beyond the line of the kerb
  double bicycle_track = 0;
  double pavement = 0;

  void move_parking_beyond_the_kerb() { parking_bay += std::exchange(parking_lane, 0); }
};

void add_cycleway(const TagOf& tag, Side side, Traffic traffic, bool keeps_left, BesideLanes& beside) {
  constexpr std::string_view kLanes[] = {"lane", "soft_lane", "buffered_lane"};
  std::string_view values = cycleway_of(tag, side, traffic, keeps_left);
  const auto width = width_of(detail_of_side(tag, kCycleways, side, osm_key::kWidth));
  while (!values.empty()) {
    const std::string_view value = take_until(values, ';');
    const std::string_view form = detail_of_side(tag, kCycleways, side, "lane");
    if (is_one_of(value, kLanes) && form != "pictogram")
      beside.bicycle_lane =
          width.value_or(form == "advisory" || value == "soft_lane" ? kAdvisoryBicycleLane : kBicycleLane);
    if (value == "track") {
      const bool two_ways = detail_of_side(tag, kCycleways, side, osm_key::kOneway) == "no";
      beside.bicycle_track = width.value_or(two_ways ? kTwoWayBicycleTrack : kBicycleTrack);
    }
  }
}

double parking_width(std::string_view orientation) {
  if (orientation == "diagonal") return kDiagonalParking;
  if (orientation == "perpendicular" || orientation == "orthogonal") return kPerpendicularParking;
  return kParallelParking;
}

/// parking:right=lane with parking:right:orientation; in the older scheme parking:lane:right=parallel with
/// parking:lane:right:parallel=on_street. What stands on the kerb stands on the pavement.
void add_parking(const TagOf& tag, Side side, BesideLanes& beside) {
  constexpr std::string_view kOrientations[] = {"parallel", "inline",     "diagonal", "perpendicular",
                                                "marked",   "orthogonal", "yes"};
  constexpr std::string_view kOnKerb[] = {"on_kerb", "half_on_kerb"};
  constexpr std::string_view kBays[] = {"street_side", "lay_by", "shoulder"};
  constexpr std::string_view kInLane[] = {"lane", "on_street"};
  std::string_view place = value_of_side(tag, kParkings, side), orientation;
  std::optional<double> width;
  if (is_one_of(place, kOrientations) && place != "yes") {
    orientation = place;  // a word of the older scheme in a key of the newer one
  } else if (!place.empty()) {
    if (place != "yes" && !is_one_of(place, kInLane) && !is_one_of(place, kBays)) return;
    orientation = detail_of_side(tag, kParkings, side, "orientation");
    width = width_of(detail_of_side(tag, kParkings, side, osm_key::kWidth));
  } else {
    const std::string prefix(osm_key::kParkingLane);
    std::string key = prefix + (side == Side::left ? "left" : "right");
    if (tag(key).empty()) key = prefix + "both";
    orientation = tag(key);
    if (!is_one_of(orientation, kOrientations)) return;
    place = tag(key + ":" + std::string(orientation));
    if (is_one_of(place, kOnKerb)) return;
    width = width_of(tag(key + ":" + std::string(osm_key::kWidth)));
  }
  beside.perhaps_bays = parking_width(orientation) > kParallelParking && !is_one_of(place, kInLane);
  (is_one_of(place, kBays) ? beside.parking_bay : beside.parking_lane) = width.value_or(parking_width(orientation));
}

// -------------------------------------------------------------------------------------------------------- the lanes

/// Number of lanes as told; "1.5" is a lane and a half.
std::optional<double> lanes_told(const TagOf& tag) {
  const std::string_view text = without_blanks(tag(osm_key::kLanes));
  double lanes = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), lanes, std::chars_format::fixed);
  if (error != std::errc() || end != text.data() + text.size() || !(lanes >= 1 && lanes <= kMaxLanes))
    return std::nullopt;
  return lanes;
}

/// The sum of "3.5|1.5"; nothing where one of them is missing.
std::optional<double> sum_of_lanes(std::string_view widths) {
  if (widths.empty()) return std::nullopt;
  double sum = 0;
  for (bool more = true; more;) {
    more = widths.find('|') != std::string_view::npos;
    const auto width = width_of(take_until(widths, '|'));
    if (!width) return std::nullopt;
    sum += *width;
  }
  return sum <= kMaxWidth ? std::optional(sum) : std::nullopt;
}

/// width:lanes, which has lanes for bicycles too.
std::optional<double> width_by_lanes(const TagOf& tag) {
  const std::string key = std::string(osm_key::kWidth) + ":" + std::string(osm_key::kLanes);
  if (const auto all = sum_of_lanes(tag(key))) return all;
  const auto forward = sum_of_lanes(tag(key + ":forward")), backward = sum_of_lanes(tag(key + ":backward"));
  return forward && backward && *forward + *backward <= kMaxWidth ? std::optional(*forward + *backward) : std::nullopt;
}

/// Of all lanes where no tag tells.
double usual_width(const TagOf& tag, std::string_view highway, Traffic traffic, const StreetDefaults& usual) {
  if (highway == "service") {
    constexpr std::string_view kNarrow[] = {"driveway", "drive-through", "alley", "emergency_access"};
    return is_one_of(tag(osm_key::kService), kNarrow) ? std::min(kDriveway, usual.width) : usual.width;
  }
  const bool of_one_direction = highway == "motorway" || highway.ends_with("_link");
  // A roundabout is as wide as a street with two directions: long vehicles turn in it.
  if (traffic == Traffic::both || is_roundabout(tag) || of_one_direction) return usual.width;
  return std::min(usual.width, std::max(usual.lane, kOnewayShare * usual.width));
}

/// Width of the lanes for vehicles alone. A told width has parking lanes and lanes for bicycles in it, as far as there is
/// room for them. Where there is none, parking lies beyond it, and lanes for bicycles are not marked off.
double settle_lanes(const TagOf& tag, std::string_view highway, Traffic traffic, const StreetDefaults& usual,
                    BesideLanes& left, BesideLanes& right) {
  auto told = width_of(tag(std::string(osm_key::kWidth) + ":carriageway"));
  if (!told) told = width_of(tag(osm_key::kWidth));
  double parking = 0;
  for (BesideLanes* beside : {&left, &right}) {
    if (!told && beside->perhaps_bays) beside->move_parking_beyond_the_kerb();
    if (told) parking += beside->parking_lane;
  }
  if (!told) told = width_by_lanes(tag);
  if (!told) {
    const double width = usual_width(tag, highway, traffic, usual);
    const auto lanes = lanes_told(tag);
    if (!lanes) return width;
    const double least = *lanes >= 2 ? 0 : is_roundabout(tag) ? width : std::min(kSingleLane, usual.width);
    return std::max(*lanes * usual.lane, least);
  }
  double free = *told - parking;
  if (parking > 0 && free < kNarrowestLane) {
    free = *told;
    for (BesideLanes* beside : {&left, &right}) beside->move_parking_beyond_the_kerb();
  }
  const double bicycles = left.bicycle_lane + right.bicycle_lane;
  if (free - bicycles >= kNarrowestLane) return free - bicycles;
  left.bicycle_lane = right.bicycle_lane = 0;
  return free;
}

// -------------------------------------------------------------------------------------------------- the whole profile

/// Puts strips side by side from left to right.
class Row {
 public:
  Row(double from, StreetProfile& out) : at_(from), out_(out) {}
  void add(GroundClass ground, double width, SurroundingMaterial material) {
    if (width <= 0) return;
    out_.strips.push_back({ground, at_, at_ + width, material});
    at_ += width;
  }
  double at() const { return at_; }

 private:
  double at_;
  StreetProfile& out_;
};

StreetProfile street(const TagOf& tag, std::string_view highway, bool built_up, const Catalogue& catalogue,
                     bool keeps_left) {
  const StreetDefaults& usual = catalogue.street(highway);
  const Traffic traffic = traffic_of(tag, highway);
  BesideLanes left, right;
  for (const Side side : {Side::left, Side::right}) {
    BesideLanes& beside = side == Side::left ? left : right;
    add_cycleway(tag, side, traffic, keeps_left, beside);
    add_parking(tag, side, beside);
    beside.pavement = pavement_of(tag, side, usual.pavement, built_up || !usual.built_up_only);
  }
  const double lanes = settle_lanes(tag, highway, traffic, usual, left, right);
  const double carriageway = left.bicycle_lane + lanes + right.bicycle_lane;
  const double between_kerbs = left.parking_lane + carriageway + right.parking_lane;

  const SurroundingMaterial paving = material_of(tag, highway, built_up, catalogue);
  const SurroundingMaterial of_pavements = catalogue.material(catalogue.street("footway").material);
  const SurroundingMaterial of_tracks = catalogue.material(catalogue.street("cycleway").material);
  StreetProfile out;
  Row row(-between_kerbs / 2 - left.parking_bay - left.bicycle_track - left.pavement, out);
  row.add(GroundClass::pavement, left.pavement, material_of_side(tag, kSidewalks, Side::left, of_pavements, catalogue));
  row.add(GroundClass::cycle_way, left.bicycle_track,
          material_of_side(tag, kCycleways, Side::left, of_tracks, catalogue));
  row.add(GroundClass::parking_lane, left.parking_bay + left.parking_lane,
          material_of_side(tag, kParkings, Side::left, paving, catalogue));
  out.carriageway_left = row.at() + left.bicycle_lane;
  row.add(GroundClass::carriageway, carriageway, paving);
  out.carriageway_right = row.at() - right.bicycle_lane;
  row.add(GroundClass::parking_lane, right.parking_bay + right.parking_lane,
          material_of_side(tag, kParkings, Side::right, paving, catalogue));
  row.add(GroundClass::cycle_way, right.bicycle_track,
          material_of_side(tag, kCycleways, Side::right, of_tracks, catalogue));
  row.add(GroundClass::pavement, right.pavement,
          material_of_side(tag, kSidewalks, Side::right, of_pavements, catalogue));

  out.kerbed = usual.kerbed;
  if (const auto told = lanes_told(tag); told && *told == static_cast<int>(*told)) out.lanes = static_cast<int>(*told);
  return out;
}

/// A way that has no lanes: one strip, and beside cycle ways the pavements that tags tell of.
StreetProfile way_without_lanes(const TagOf& tag, std::string_view highway, GroundClass ground, bool built_up,
                                const Catalogue& catalogue) {
  const double width = width_of(tag(osm_key::kWidth)).value_or(catalogue.street(highway).width);
  const bool beside = ground == GroundClass::cycle_way;
  const double left = beside ? pavement_of(tag, Side::left, 0, false) : 0;
  const double right = beside ? pavement_of(tag, Side::right, 0, false) : 0;
  const SurroundingMaterial of_pavements = catalogue.material(catalogue.street("footway").material);
  StreetProfile out;
  Row row(-width / 2 - left, out);
  row.add(GroundClass::pavement, left, material_of_side(tag, kSidewalks, Side::left, of_pavements, catalogue));
  row.add(ground, width, material_of(tag, highway, built_up, catalogue));
  row.add(GroundClass::pavement, right, material_of_side(tag, kSidewalks, Side::right, of_pavements, catalogue));
  return out;
}

/// Values of `highway` that are no ground: what is not there yet or no more, what is indoors or a climb, and what belongs to
/// points.
bool is_no_ground(std::string_view highway) {
  // clang-format off
  constexpr std::string_view kNot[] = {
      "", "no", "construction", "proposed", "planned", "razed", "abandoned", "disused", "demolished", "dismantled", "removed",
      "historic", "corridor", "elevator", "via_ferrata", "ladder", "rest_area", "services", "bus_stop", "crossing", "stop",
      "give_way", "traffic_signals", "traffic_mirror", "traffic_island", "speed_camera", "street_lamp", "milestone",
      "mini_roundabout", "motorway_junction", "passing_place", "toll_gantry", "trailhead", "turning_circle", "turning_loop",
      "emergency_access_point"};
  // clang-format on
  return is_one_of(highway, kNot);
}

GroundClass ground_of_way(const TagOf& tag, std::string_view highway) {
  if (highway == "footway" || highway == "path")
    return tag(osm_key::kFootway) == "sidewalk" ? GroundClass::pavement : GroundClass::footway;
  constexpr std::pair<std::string_view, GroundClass> kGrounds[] = {{"bridleway", GroundClass::footway},
                                                                   {"cycleway", GroundClass::cycle_way},
                                                                   {"steps", GroundClass::steps},
                                                                   {"pedestrian", GroundClass::square},
                                                                   {"platform", GroundClass::platform}};
  for (const auto& [value, ground] : kGrounds)
    if (highway == value) return ground;
  return GroundClass::carriageway;
}

// ----------------------------------------------------------------------------------------------------------- lengths

/// Takes `word` off the front, in either case.
bool take_word(std::string_view& text, std::string_view word) {
  if (text.size() < word.size()) return false;
  for (std::size_t i = 0; i < word.size(); ++i)
    if ((text[i] >= 'A' && text[i] <= 'Z' ? text[i] - 'A' + 'a' : text[i]) != word[i]) return false;
  text = without_blanks(text.substr(word.size()));
  return true;
}

/// Takes digits with a point or a comma off the front, and blanks after them; no sign, no exponent.
std::optional<double> take_decimal(std::string_view& text) {
  const auto is_digit = [&](std::size_t i) { return i < text.size() && text[i] >= '0' && text[i] <= '9'; };
  std::string digits;
  std::size_t n = 0;
  for (bool point = false;
       is_digit(n) || (!point && n > 0 && n < text.size() && (text[n] == '.' || text[n] == ',') && is_digit(n + 1));
       ++n) {
    point = point || !is_digit(n);
    digits += is_digit(n) ? text[n] : '.';
  }
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (digits.empty() || error != std::errc() || end != digits.data() + digits.size()) return std::nullopt;
  text = without_blanks(text.substr(n));
  return value;
}

template <std::size_t N>
bool take_any(std::string_view& text, const std::string_view (&words)[N]) {
  return std::any_of(std::begin(words), std::end(words), [&](std::string_view word) { return take_word(text, word); });
}

}  // namespace

std::optional<double> length_of(std::string_view text) {
  constexpr double kFoot = 0.3048, kInch = 0.0254;
  constexpr std::string_view kMetres[] = {"metres", "meters", "metre", "meter", "m"};
  constexpr std::string_view kCentimetres[] = {"cm"};
  constexpr std::string_view kInches[] = {"inches", "inch", "in", "\"", "″", "”", "''"};
  constexpr std::string_view kFeet[] = {"feet", "foot", "ft", "'", "′", "’"};
  text = without_blanks(text);
  const std::optional<double> number = take_decimal(text);
  if (!number) return std::nullopt;
  double unit = 1, inches = 0;
  if (take_any(text, kCentimetres)) {
    unit = 0.01;
  } else if (take_any(text, kInches)) {
    unit = kInch;
  } else if (take_any(text, kFeet)) {
    unit = kFoot;
    if (const auto rest = take_decimal(text)) {
      inches = *rest;
      take_any(text, kInches);
    }
  } else {
    take_any(text, kMetres);
  }
  if (!text.empty() || inches >= 12) return std::nullopt;
  return *number * unit + inches * kInch;
}

std::optional<StreetProfile> street_profile(const TagOf& tag, bool built_up, const Catalogue& catalogue,
                                            bool keeps_left) {
  std::string_view highway = tag(osm_key::kHighway);
  if (highway == "trail") highway = "path";  // an older word
  if (is_no_ground(highway)) return std::nullopt;
  const GroundClass ground = ground_of_way(tag, highway);
  return ground == GroundClass::carriageway ? street(tag, highway, built_up, catalogue, keeps_left)
                                            : way_without_lanes(tag, highway, ground, built_up, catalogue);
}

}  // namespace blockrand::surroundings
