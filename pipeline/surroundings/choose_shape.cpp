#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/base/portable_math.h"
#include "pipeline/model/osm_keys.h"
#include "pipeline/surroundings/catalogue.h"
#include "pipeline/surroundings/street_profile.h"

namespace blockrand::surroundings {
namespace {

namespace osm_key = model::osm_key;
using Random = std::function<double(std::string_view choice)>;

std::string lower_case(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
}

bool has(std::string_view text, std::string_view word) { return text.find(word) != std::string_view::npos; }

/// A length between two bounds, m; nothing for what cannot be read or is out of them.
std::optional<double> bounded_length(const TagOf& tag, std::string_view key, double least, double most) {
  const auto value = length_of(tag(key));
  if (!value || *value < least || *value > most) return std::nullopt;
  return value;
}

double ratio(double a, double b) { return a > b ? a / b : b / a; }

double height_of(const model::ObjectShape& shape) { return shape.max.z; }
double width_of(const model::ObjectShape& shape) {
  return std::max(shape.max.x - shape.min.x, shape.max.y - shape.min.y);
}

/// The shape whose height is nearest; of equally near ones the first.
std::uint16_t nearest_height(const Catalogue& catalogue, const std::vector<std::uint16_t>& shapes, double height) {
  const auto far = [&](std::uint16_t s) { return ratio(height_of(catalogue.shown().shapes[s]), height); };
  return *std::min_element(shapes.begin(), shapes.end(), [&](auto a, auto b) { return far(a) < far(b); });
}

// --- trees ---------------------------------------------------------------------------------------------------------

enum class Habit { broadleaved, conifer, columnar, cypress, palm };

/// By Habit: how the names of its shapes begin.
constexpr std::string_view kHabitShapes[] = {"tree_broadleaved", "tree_conifer", "tree_columnar", "tree_cypress",
                                             "tree_palm"};

/// Genera of conifers, and Ginkgo not among them: it has broad leaves for whoever looks at it. (Farjon: A Handbook of the World's
/// Conifers, 2010; those that are planted in Europe.)
constexpr std::string_view kConifers[] = {
    "abies",       "araucaria",    "calocedrus",      "cedrus",         "cephalotaxus",   "chamaecyparis",
    "cryptomeria", "cunninghamia", "cupressocyparis", "hesperocyparis", "juniperus",      "larix",
    "libocedrus",  "metasequoia",  "picea",           "pinus",          "platycladus",    "podocarpus",
    "pseudolarix", "pseudotsuga",  "sciadopitys",     "sequoia",        "sequoiadendron", "taxodium",
    "taxus",       "thuja",        "thujopsis",       "torreya",        "tsuga",          "xanthocyparis"};
/// Genera of palms (Dransfield et al.: Genera Palmarum, 2008; those that are planted in Europe).
constexpr std::string_view kPalms[] = {"arecaceae", "archontophoenix", "brahea",  "butia",        "chamaerops",
                                       "cocos",     "howea",           "jubaea",  "livistona",    "phoenix",
                                       "roystonea", "sabal",           "syagrus", "trachycarpus", "washingtonia"};

template <std::size_t N>
bool among(const std::string_view (&list)[N], std::string_view word) {
  return std::find(std::begin(list), std::end(list), word) != std::end(list);
}

/// By the Latin name; nothing where none is tagged, or none that is known.
std::optional<Habit> habit_of_name(const TagOf& tag) {
  for (const std::string_view key : {osm_key::kSpecies, osm_key::kTaxon, osm_key::kGenus}) {
    const std::string name = lower_case(tag(key));
    const std::string_view genus = std::string_view(name).substr(0, name.find_first_of(" ;,"));
    if (genus.empty()) continue;
    if (genus == "cupressus") return Habit::cypress;
    if (among(kConifers, genus)) return Habit::conifer;
    if (among(kPalms, genus)) return Habit::palm;
    if ((has(name, "nigra") && has(name, "italica")) || has(name, "fastigiata") || has(name, "pyramidalis") ||
        has(name, "columnaris"))
      return Habit::columnar;
    if (key == osm_key::kGenus) return Habit::broadleaved;
  }
  if (!tag(osm_key::kSpecies).empty() || !tag(osm_key::kTaxon).empty()) return Habit::broadleaved;
  return std::nullopt;
}

Habit habit_of(const TagOf& tag, const Random& random) {
  const auto named = habit_of_name(tag);
  const std::string_view leaves = tag(osm_key::kLeafType);
  // A name in another language is no Latin one: there leaf_type tells more than the list of genera.
  if (named && (*named != Habit::broadleaved || leaves.empty() || leaves == "broadleaved")) return *named;
  if (leaves == "needleleaved") return Habit::conifer;
  if (leaves == "palm") return Habit::palm;
  if (leaves == "broadleaved") return Habit::broadleaved;
  if (leaves.empty() && !named && tag(osm_key::kLeafCycle) == "evergreen") return Habit::conifer;
  // Half the woods of Germany are conifers: 54 % of their area (Dritte Bundeswaldinventur, BMEL 2012).
  const bool of_wood = tag(osm_key::kNatural) == "wood" || tag(osm_key::kLanduse) == "forest";
  if (leaves == "mixed" || (leaves.empty() && !named && of_wood))
    return random("leaf_type") < 0.5 ? Habit::conifer : Habit::broadleaved;
  return Habit::broadleaved;
}

std::vector<std::uint16_t> shapes_of_habit(const Catalogue& catalogue, Habit habit) {
  const std::vector<std::uint16_t>& all = catalogue.shapes_of("tree");
  std::vector<std::uint16_t> out;
  for (const std::uint16_t s : all)
    if (catalogue.shown().shapes[s].name.starts_with(kHabitShapes[static_cast<std::size_t>(habit)])) out.push_back(s);
  return out.empty() ? all : out;
}

/// m; of a tree whose trunk is `circumference` m around and whose crown is `crown_ratio` times as wide as it is high.
///
/// D = 0.557 (H * CD)^0.809 exp(0.056² / 2), D the trunk's diameter in cm, H the height and CD the crown's diameter in m, for
/// trees of all kinds (Jucker et al.: Allometric equations for integrating remote sensing imagery into forest monitoring
/// programmes, Global Change Biology 23, 2017), solved for H. A trunk of 1.25 m around, 40 cm across, makes 18 m where the
/// crown is 0.58 H.
double height_of_trunk(double circumference, double crown_ratio) {
  const double diameter = 100 * circumference / base::kPi;
  const double product = base::pow(diameter / (0.557 * base::exp(0.056 * 0.056 / 2)), 1 / 0.809);
  return std::sqrt(product / crown_ratio);
}

ChosenShape choose_tree(const Catalogue& catalogue, const TagOf& tag, const Random& random) {
  const std::vector<std::uint16_t> shapes = shapes_of_habit(catalogue, habit_of(tag, random));
  const auto& shown = catalogue.shown().shapes;
  const double usual_ratio = width_of(shown[shapes.front()]) / height_of(shown[shapes.front()]);
  const auto crown = bounded_length(tag, osm_key::kDiameterCrown, 0.3, 45);
  auto height = bounded_length(tag, osm_key::kHeight, 0.8, 75);
  if (!height) height = bounded_length(tag, osm_key::kEstHeight, 0.8, 75);
  if (!height)
    if (auto around = bounded_length(tag, osm_key::kCircumference, 0.05, 1200)) {
      if (*around > 12) *around /= 100;  // the thickest trunk of Europe measures 14 m: above it is in centimetres
      height = std::clamp(height_of_trunk(*around, usual_ratio), 3.0, 35.0);
    }
  if (!height && crown) height = std::clamp(*crown / usual_ratio, 2.0, 30.0);

  ChosenShape out;
  if (height) {
    out.shape = nearest_height(catalogue, shapes, *height);
    out.height = static_cast<float>(*height / height_of(shown[out.shape]));
  } else {
    const std::string_view use = tag(osm_key::kLanduse);
    const double wanted = use == "orchard" || use == "allotments" ? 7 : random("size") < 0.6 ? 12 : 20;
    out.shape = nearest_height(catalogue, shapes, wanted);
    out.height = static_cast<float>(0.8 + 0.4 * random("height"));
  }
  out.width = crown ? static_cast<float>(*crown / width_of(shown[out.shape]))
                    : out.height * static_cast<float>(0.9 + 0.2 * random("width"));
  return out;
}

// --- other things --------------------------------------------------------------------------------------------------

/// The shape that a tag means, else that of the nearest height, else the first.
std::uint16_t shape_of_thing(const Catalogue& catalogue, const std::vector<std::uint16_t>& shapes, const TagOf& tag,
                             std::optional<double> height) {
  std::vector<std::uint16_t> by_height;
  for (const std::uint16_t shape : shapes) {
    const ShapeTags& meant = catalogue.tags_of(shape);
    for (const auto& [key, values] : meant.tags)
      if (const std::string_view value = tag(key);
          !value.empty() && std::find(values.begin(), values.end(), value) != values.end())
        return shape;
    if (meant.by_height) by_height.push_back(shape);
  }
  return height && !by_height.empty() ? nearest_height(catalogue, by_height, *height) : shapes.front();
}

/// m; `height`, and of wind turbines the tip of the rotor where its parts are tagged.
std::optional<double> tagged_height(std::string_view kind, const TagOf& tag) {
  if (kind == "wind_turbine") {
    const auto hub = bounded_length(tag, "height:hub", 5, 250), rotor = bounded_length(tag, "rotor:diameter", 2, 300);
    if (hub && rotor) return *hub + *rotor / 2;
  }
  const auto height = bounded_length(tag, osm_key::kHeight, 0.1, 400);
  return height ? height : bounded_length(tag, osm_key::kEstHeight, 0.1, 400);
}

ChosenShape choose_thing(const Catalogue& catalogue, std::string_view kind, const TagOf& tag) {
  const std::vector<std::uint16_t>& shapes = catalogue.shapes_of(kind);
  ChosenShape out;
  if (shapes.empty()) return out;
  const auto height = tagged_height(kind, tag);
  out.shape = shape_of_thing(catalogue, shapes, tag, height);
  // A height that no thing of the kind has is one of something else: of the building it stands on, or in other units.
  constexpr double kMostDifferent = 4;
  const double usual = height_of(catalogue.shown().shapes[out.shape]);
  if (height && ratio(*height, usual) <= kMostDifferent) {
    out.height = static_cast<float>(*height / usual);
    constexpr double kTall = 12;  // m; what is lower is as wide as people and vehicles need it
    if (usual >= kTall) out.width = out.height;
  }
  return out;
}

// --- directions ----------------------------------------------------------------------------------------------------

/// Degrees clockwise from north; nothing for ranges, lists, `forward`, `clockwise`.
std::optional<double> compass_of(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  double degrees = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), degrees);
  if (error == std::errc()) {
    const std::string_view rest(end, static_cast<std::size_t>(text.data() + text.size() - end));
    if (!(rest.empty() || rest == "°" || rest == " °" || rest == "deg" || rest == " deg")) return std::nullopt;
    if (!(degrees >= -360 && degrees <= 360)) return std::nullopt;
    return degrees;
  }
  std::string word = lower_case(text);
  for (const std::string_view whole : {"north", "east", "south", "west"})
    for (std::size_t at; (at = word.find(whole)) != std::string::npos;)
      word.replace(at, whole.size(), whole.substr(0, 1));
  std::erase_if(word, [](char c) { return c == '-' || c == '_' || c == ' '; });
  constexpr std::string_view kRose[] = {"n", "nne", "ne", "ene", "e", "ese", "se", "sse",
                                        "s", "ssw", "sw", "wsw", "w", "wnw", "nw", "nnw"};
  const auto found = std::find(std::begin(kRose), std::end(kRose), word);
  if (found == std::end(kRose)) return std::nullopt;
  return 22.5 * static_cast<double>(found - std::begin(kRose));
}

std::optional<double> turn_of(std::string_view kind, const TagOf& tag) {
  const std::string_view own = kind == "street_lamp"    ? "light:direction"
                               : kind == "surveillance" ? "camera:direction"
                                                        : "";
  auto compass = own.empty() ? std::nullopt : compass_of(tag(own));
  if (!compass) compass = compass_of(tag(osm_key::kDirection));
  if (!compass) return std::nullopt;
  double degrees = 90 - *compass;
  while (degrees < 0) degrees += 360;
  while (degrees >= 360) degrees -= 360;
  return degrees * base::kRadiansPerDegree;
}

}  // namespace

ChosenShape choose_shape(const Catalogue& catalogue, std::string_view kind, const TagOf& tag, const Random& random) {
  if (catalogue.shapes_of(kind).empty()) return {};
  if (kind == "tree") return choose_tree(catalogue, tag, random);
  ChosenShape out = choose_thing(catalogue, kind, tag);
  if ((kind == "shrub" || kind == "boulder") && out.height == 1) {
    out.height = static_cast<float>(0.7 + 0.6 * random("height"));
    out.width = out.height * static_cast<float>(0.85 + 0.3 * random("width"));
  }
  out.turn = turn_of(kind, tag);
  return out;
}

}  // namespace blockrand::surroundings
