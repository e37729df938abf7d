#include "pipeline/outputs/citygml/codes.h"

#include <algorithm>
#include <iterator>

namespace blockrand::outputs {
namespace {

struct UseClass {
  std::string_view use, code;
};

// Sorted by use for the binary search. Codes: 1000 habitation, 1010 sanitation, 1020 administration, 1030 business and
// trade, 1040 catering, 1050 recreation, 1060 sport, 1070 culture, 1080 church institution, 1090 agriculture and forestry, 1100 schools,
// education, research, 1110 maintenance and waste management, 1120 healthcare, 1140 security, 1150 storage,
// 1160 industry, 1170 traffic.
constexpr UseClass kUses[] = {
    {"allotment_house", "1050"},
    {"annexe", "1000"},
    {"apartments", "1000"},
    {"barn", "1090"},
    {"bungalow", "1000"},
    {"cabin", "1000"},
    {"carport", "1170"},
    {"cathedral", "1080"},
    {"chapel", "1080"},
    {"church", "1080"},
    {"civic", "1020"},
    {"college", "1100"},
    {"commercial", "1030"},
    {"cowshed", "1090"},
    {"detached", "1000"},
    {"dormitory", "1000"},
    {"farm", "1000"},
    {"farm_auxiliary", "1090"},
    {"fire_station", "1140"},
    {"garage", "1170"},
    {"garages", "1170"},
    {"government", "1020"},
    {"grandstand", "1060"},
    {"greenhouse", "1090"},
    {"hangar", "1170"},
    {"hospital", "1120"},
    {"hotel", "1040"},
    {"house", "1000"},
    {"industrial", "1160"},
    {"kindergarten", "1100"},
    {"kiosk", "1030"},
    {"manufacture", "1160"},
    {"monastery", "1080"},
    {"mosque", "1080"},
    {"museum", "1070"},
    {"office", "1030"},
    {"parking", "1170"},
    {"public", "1020"},
    {"religious", "1080"},
    {"residential", "1000"},
    {"retail", "1030"},
    {"school", "1100"},
    {"semidetached_house", "1000"},
    {"shrine", "1080"},
    {"sports_centre", "1060"},
    {"sports_hall", "1060"},
    {"stable", "1090"},
    {"stadium", "1060"},
    {"sty", "1090"},
    {"supermarket", "1030"},
    {"synagogue", "1080"},
    {"temple", "1080"},
    {"terrace", "1000"},
    {"theatre", "1070"},
    {"toilets", "1010"},
    {"townhall", "1020"},
    {"train_station", "1170"},
    {"transportation", "1170"},
    {"university", "1100"},
    {"warehouse", "1150"},
};

}  // namespace

std::string_view roof_type_code(model::RoofShape shape) {
  using enum model::RoofShape;
  switch (shape) {
    case flat:
      return "1000";
    case skillion:
      return "1010";
    case gabled_height_moved:
      return "1020";  // "dual pent roof"
    case gabled:
    case saltbox:
    case double_saltbox:
    case quadruple_saltbox:
    case berlin:
      return "1030";
    case hipped:
    case side_hipped:
      return "1040";
    case half_hipped:
    case side_half_hipped:
      return "1050";
    case mansard:
    case gambrel:
      return "1060";
    case pyramidal:
      return "1070";  // "pavilion roof"
    case cone:
      return "1080";
    case dome:
    case onion:
      return "1090";  // "copula roof"
    case sawtooth:
      return "1100";
    case round:
      return "1110";  // "arch roof"
    case spire:
      return "1120";  // "pyramidal broach roof"
    case hipped_and_gabled:
    case crosspitched:
    case helm:
    case butterfly:
    case lined:
    case many:
      return "1130";  // "combination of roof forms"
    case other:
      return {};
  }
  return {};
}

std::string_view class_code(std::string_view use) {
  const auto found = std::lower_bound(std::begin(kUses), std::end(kUses), use,
                                      [](const UseClass& entry, std::string_view text) { return entry.use < text; });
  return found != std::end(kUses) && found->use == use ? found->code : std::string_view{};
}

}  // namespace blockrand::outputs
