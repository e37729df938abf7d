// The table of the built-in kinds and their parameters: docs/elements.md shows it.
#include "styles/elements/kinds.h"

#include <algorithm>

namespace blockrand::elements {
namespace {

using Type = ParameterInfo::Type;
using Parameters = std::vector<ParameterInfo>;

ParameterInfo number(std::string name, std::string unit, double initial, double least, double most,
                     std::string meaning) {
  return {.name = std::move(name),
          .unit = std::move(unit),
          .type = Type::number,
          .initial = initial,
          .least = least,
          .most = most,
          .meaning = std::move(meaning)};
}
ParameterInfo whole(std::string name, double initial, double least, double most, std::string meaning) {
  return {.name = std::move(name),
          .type = Type::whole,
          .initial = initial,
          .least = least,
          .most = most,
          .meaning = std::move(meaning)};
}
ParameterInfo word(std::string name, std::vector<std::string> words, std::string_view initial, std::string meaning) {
  const auto at = std::find(words.begin(), words.end(), initial) - words.begin();
  return {.name = std::move(name),
          .type = Type::word,
          .initial = static_cast<double>(at),
          .words = std::move(words),
          .meaning = std::move(meaning)};
}
ParameterInfo profile(std::string name, std::string preset, std::string meaning) {
  return {.name = std::move(name), .type = Type::profile, .words = {std::move(preset)}, .meaning = std::move(meaning)};
}

void add(Parameters& to, Parameters more) {
  to.insert(to.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

Parameters opening(double reveal, double least_reveal, const char* head) {
  return {
      number("reveal", "m", reveal, least_reveal, 0.40, "depth of the opening: wall's plane to the front of the frame"),
      word("head", {"straight", "segmental", "round", "gabled", "pointed", "basket"}, head, "shape of the upper edge"),
      number("rise", "of the width", 0.12, 0.04, 0.50, "height of segmental and gabled heads")};
}

Parameters surround(const char* initial, double width) {
  return {
      word("surround", {"none", "plain", "moulded", "double_cornice", "brick"}, initial,
           "band round the opening; double_cornice: a straight cornice on it and a second one along a gable or arch"),
      number("surround_width", "m", width, 0.06, 0.60, "width of the band"),
      number("surround_projection", "m", 0.04, 0.02, 0.15, "how far it stands out of the wall"),
      profile("surround_profile", "casing", "section of moulded bands, from the opening outwards"),
      number("stone_length", "m", 0.25, 0.06, 0.80, "brick: length of a stone along the edge, joint included"),
      number("stone_gap", "m", 0.012, 0.005, 0.03, "brick: joint"),
      word("keystone", {"no", "yes"}, "no", "a wedge in the middle of the head")};
}

Parameters sill(const char* initial) {
  return {word("sill", {"none", "plain", "moulded"}, initial,
               "slab under the opening; without one the surround goes round"),
          number("sill_height", "m", 0.10, 0.05, 0.30, "height of the slab's front"),
          number("sill_projection", "m", 0.08, 0.03, 0.30, "how far it stands out of the wall"),
          number("sill_overhang", "m", 0.05, 0, 0.30, "at each end beyond the opening and its surround"),
          profile("sill_profile", "sill", "section of moulded sills")};
}

Parameters pediment(const char* initial) {
  return {
      word("pediment", {"none", "straight", "triangular", "segmental"}, initial, "roof over the opening (Verdachung)"),
      number("pediment_height", "m", 0.18, 0.08, 0.60, "height of its cornice"),
      number("pediment_projection", "m", 0.18, 0.05, 0.50, "how far it stands out of the wall"),
      number("pediment_rise", "of its span", 0.22, 0.08, 0.35,
             "triangular and segmental: height of the gable over the cornice"),
      number("pediment_overhang", "m", 0.05, 0, 0.50, "at each end beyond the surround"),
      number("pediment_frieze", "m", 0.04, 0, 1.0, "wall between surround and cornice"),
      profile("pediment_profile", "hood", "section of its cornice"),
      word("pediment_consoles", {"no", "yes"}, "no", "a bracket under each end")};
}

ParameterInfo detail() {
  return whole("detail", 1, 0, 2, "0: flat, for far away; 1: usual; 2: all sides, strips and curves");
}

Parameters leaves(int count, double transom, int bars) {
  return {number("frame", "m", 0.07, 0.03, 0.15, "width of the fixed frame and of the transom"),
          number("leaf", "m", 0.05, 0.02, 0.12, "width of a leaf's stiles and rails"),
          whole("leaves", count, 1, 3, "leaves side by side"),
          number("transom", "of the height", transom, 0, 0.85, "height of the transom's middle; 0: none"),
          whole("upper_leaves", 0, 0, 3, "lights above the transom; 0: as many as leaves"),
          whole("bars", bars, 0, 6, "level glazing bars in each leaf"),
          whole("upright_bars", 0, 0, 4, "upright glazing bars in each leaf"),
          whole("upper_bars", 0, 0, 4, "level bars in each light above the transom"),
          whole("upper_upright_bars", 0, 0, 4, "upright bars in each light above the transom"),
          number("bar", "m", 0.03, 0.015, 0.06, "width of glazing bars")};
}

ElementKind casement() {
  ElementKind k{.name = "casement_window",
                .semantic = ElementClass::window,
                .meaning = "window of one to three leaves in one frame",
                .width = {.measures = "opening", .least = 0.40, .usual = 1.10, .most = 3.50},
                .height = {.measures = "opening", .least = 0.40, .usual = 1.60, .most = 4.50}};
  add(k.parameters, opening(0.12, 0, "straight"));
  add(k.parameters, leaves(2, 0, 0));
  add(k.parameters, surround("none", 0.14));
  add(k.parameters, sill("plain"));
  add(k.parameters, pediment("none"));
  k.parameters.push_back(detail());
  return k;
}

ElementKind double_casement() {
  ElementKind k{.name = "double_casement",
                .semantic = ElementClass::window,
                .meaning = "box window: outer and inner leaves with an air gap (Kastenfenster)",
                .width = {.measures = "opening", .least = 0.50, .usual = 1.10, .most = 3.50},
                .height = {.measures = "opening", .least = 0.60, .usual = 2.20, .most = 4.50}};
  add(k.parameters, opening(0.14, 0, "straight"));
  k.parameters.push_back(number("gap", "m", 0.12, 0.04, 0.20, "air between outer and inner leaves"));
  add(k.parameters, leaves(2, 0.66, 1));
  add(k.parameters, surround("moulded", 0.16));
  add(k.parameters, sill("moulded"));
  add(k.parameters, pediment("none"));
  k.parameters.push_back(detail());
  return k;
}

ElementKind shop_window() {
  ElementKind k{.name = "shop_window",
                .semantic = ElementClass::window,
                .meaning = "shop front: glass between mullions on a base, lights above, a sign over it",
                .width = {.measures = "opening", .least = 1.00, .usual = 3.20, .most = 9.00},
                .height = {.measures = "opening", .least = 1.80, .usual = 2.80, .most = 5.00}};
  k.parameters = {number("reveal", "m", 0.10, 0, 0.40, "depth of the opening: wall's plane to the front of the frame"),
                  number("frame", "m", 0.07, 0.04, 0.15, "width of frame, mullions and transom"),
                  whole("mullions", 1, 0, 8, "uprights between the panes, besides the door's"),
                  number("base", "m", 0.45, 0, 1.20, "height of the panels under the glass; 0: glass to the floor"),
                  number("transom", "of the height", 0.78, 0, 0.90, "height of the transom's middle; 0: none"),
                  word("door", {"none", "left", "middle", "right"}, "none", "where a glazed door stands"),
                  number("door_width", "m", 1.00, 0.80, 1.60, "width of the door's leaf with its half of the frame"),
                  number("sign", "m", 0.45, 0, 1.20, "height of the sign on the wall over the opening; 0: none"),
                  number("sign_projection", "m", 0.10, 0.03, 0.40, "how far the sign stands out of the wall"),
                  number("sign_overhang", "m", 0.10, 0, 1.0, "of the sign at each end beyond the opening")};
  add(k.parameters, surround("none", 0.20));
  k.parameters.push_back(detail());
  return k;
}

ElementKind shaped_window() {
  ElementKind k{.name = "shaped_window",
                .semantic = ElementClass::window,
                .meaning =
                    "window of one pane whose four edges are drawn one by one (docs/sources.md, Finkenzeller 3.11.2): "
                    "ogees, ellipses, cut corners",
                .width = {.measures = "opening", .least = 0.30, .usual = 1.00, .most = 6.00},
                .height = {.measures = "opening", .least = 0.30, .usual = 2.00, .most = 8.00}};
  k.parameters = {
      number("reveal", "m", 0.14, 0, 0.40, "depth of the opening: wall's plane to the front of the frame"),
      word("outline", {"edges", "circular"}, "edges", "edges: as the four say; circular: an ellipse, all round"),
      word("dominant", {"head_and_sill", "jambs"}, "head_and_sill",
           "which edges span the opening; the others end at them")};
  for (const char* edge : {"bottom", "right", "top", "left"}) {
    const std::string name = edge;
    const bool level = name == "bottom" || name == "top";
    const std::string across = level ? "of the height" : "of the width",
                      along = level ? "of the width" : "of the height";
    k.parameters.push_back(
        {.name = name,
         .type = Type::edge,
         .words = {"straight"},
         .meaning = "shape of that edge: straight, round, basket, pointed, ogee, gabled or a program"});
    k.parameters.push_back(number(name + "_size", across, 0, 0, 1, "depth of the strip that the shape runs in"));
    k.parameters.push_back(number(name + "_inward", across, 0, 0, 1, "how far that edge moves in"));
    k.parameters.push_back(
        number(name + (level ? "_left" : "_below"), along, 0, 0, 1, "what it is shortened by there"));
    k.parameters.push_back(number(name + (level ? "_right" : "_above"), along, 0, 0, 1, "the same at its other end"));
  }
  add(k.parameters,
      {number("frame", "m", 0.06, 0.03, 0.15, "width of the frame"), whole("bars", 0, 0, 8, "level glazing bars"),
       whole("upright_bars", 0, 0, 8, "upright ones"), number("bar", "m", 0.03, 0.015, 0.10, "width of glazing bars")});
  add(k.parameters, surround("none", 0.14));
  add(k.parameters, sill("none"));
  k.parameters.push_back(detail());
  return k;
}

ElementKind cellar_window() {
  ElementKind k{.name = "cellar_window",
                .semantic = ElementClass::window,
                .meaning = "small window in the plinth, often with iron bars",
                .width = {.measures = "opening", .least = 0.30, .usual = 0.80, .most = 1.60},
                .height = {.measures = "opening", .least = 0.25, .usual = 0.45, .most = 1.40}};
  add(k.parameters, opening(0.12, 0.05, "straight"));
  add(k.parameters,
      {number("frame", "m", 0.05, 0.03, 0.10, "width of the frame"), whole("leaves", 1, 1, 3, "leaves side by side"),
       whole("grille", 3, 0, 10, "upright iron bars in front; 0: none")});
  add(k.parameters, surround("none", 0.10));
  add(k.parameters, sill("none"));
  k.parameters.push_back(detail());
  return k;
}

ElementKind house_door() {
  ElementKind k{.name = "house_door",
                .semantic = ElementClass::door,
                .meaning = "door of one or two panelled leaves with a top light",
                .width = {.measures = "opening", .least = 0.75, .usual = 1.50, .most = 3.00},
                .height = {.measures = "opening", .least = 1.80, .usual = 3.00, .most = 5.00}};
  add(k.parameters, opening(0.20, 0, "straight"));
  add(k.parameters,
      {number("frame", "m", 0.08, 0.04, 0.20, "width of the frame and of the transom"),
       whole("leaves", 2, 1, 2, "leaves side by side"),
       number("rail", "m", 0.11, 0.05, 0.20, "width of a leaf's stiles and rails"),
       whole("panels", 3, 1, 5, "panels of each leaf, one over the other; the middle ones are the highest"),
       word("glazing", {"none", "upper", "all"}, "none", "which panels are glass: none, the uppermost, all"),
       number("top_light", "m", 0.55, 0, 2.00, "height of the light over the leaves, head included; 0: none"),
       whole("upright_bars", 1, 0, 6, "upright bars in the top light"),
       number("bar", "m", 0.03, 0.015, 0.06, "width of glazing bars")});
  add(k.parameters, surround("plain", 0.18));
  add(k.parameters, pediment("none"));
  k.parameters.push_back(detail());
  return k;
}

ElementKind carriage_gateway() {
  ElementKind k{
      .name = "carriage_gateway",
      .semantic = ElementClass::door,
      .meaning =
          "gate of a passage for carts (Durchfahrt): jambs, arch and leaves; the passage is made by the building",
      .width = {.measures = "opening", .least = 1.80, .usual = 2.80, .most = 5.00},
      .height = {.measures = "opening", .least = 2.20, .usual = 3.40, .most = 6.00}};
  add(k.parameters, opening(0.30, 0.05, "segmental"));
  add(k.parameters, {word("leaves", {"closed", "open", "absent"}, "closed",
                          "how the two leaves stand; open ones lie along the passage"),
                     number("frame", "m", 0.08, 0.04, 0.20, "width of the frame and of the transom"),
                     number("rail", "m", 0.14, 0.06, 0.25, "width of a leaf's stiles and rails"),
                     whole("panels", 3, 1, 5, "panels of each leaf, one over the other"),
                     word("fanlight", {"no", "yes"}, "yes", "glass in an arched head over the leaves"),
                     whole("upright_bars", 3, 0, 8, "upright bars in the fanlight"),
                     number("bar", "m", 0.035, 0.015, 0.06, "width of glazing bars"),
                     word("guards", {"no", "yes"}, "no", "stones that keep wheels off the jambs (Radabweiser)")});
  add(k.parameters, surround("plain", 0.30));
  add(k.parameters, pediment("none"));
  k.parameters.push_back(detail());
  return k;
}

ElementKind reveal() {
  ElementKind k{.name = "reveal",
                .semantic = ElementClass::window,
                .meaning = "opening without a window: blind, with wall at its end, or bare",
                .width = {.measures = "opening", .least = 0.20, .usual = 1.00, .most = 6.00},
                .height = {.measures = "opening", .least = 0.30, .usual = 2.00, .most = 6.00}};
  add(k.parameters, opening(0.10, 0.01, "straight"));
  k.parameters.push_back(word("filling", {"blind", "none"}, "blind", "what closes the opening"));
  add(k.parameters, surround("none", 0.14));
  add(k.parameters, sill("none"));
  add(k.parameters, pediment("none"));
  k.parameters.push_back(detail());
  return k;
}

ElementKind sill_kind() {
  ElementKind k{.name = "sill",
                .semantic = ElementClass::installation,
                .meaning = "sill on its own (Sohlbank); its upper edge at the wall is 0.012 m above y = height",
                .width = {.measures = "opening above it", .least = 0.30, .usual = 1.10, .most = 12.0},
                .height = {.measures = "front", .least = 0.05, .usual = 0.10, .most = 0.30}};
  k.parameters = {word("sill", {"plain", "moulded"}, "moulded", "section: a slab, or a moulding"),
                  number("reveal", "m", 0, 0, 0.40, "how deep it reaches into the opening"),
                  number("sill_projection", "m", 0.08, 0.03, 0.30, "how far it stands out of the wall"),
                  number("sill_overhang", "m", 0.05, 0, 0.60, "at each end beyond the opening"),
                  profile("sill_profile", "sill", "section of moulded sills"),
                  detail()};
  return k;
}

ElementKind surround_kind() {
  ElementKind k{.name = "surround",
                .semantic = ElementClass::installation,
                .meaning = "band round an opening on its own, with keystone; lower edge open",
                .width = {.measures = "opening", .least = 0.40, .usual = 1.10, .most = 6.00},
                .height = {.measures = "opening", .least = 0.40, .usual = 2.20, .most = 6.00}};
  k.parameters = {word("head", {"straight", "segmental", "round", "gabled", "pointed", "basket"}, "straight",
                       "shape of the opening's upper edge"),
                  number("rise", "of the width", 0.12, 0.04, 0.50, "height of segmental and gabled heads"),
                  word("foot", {"open", "closed"}, "open", "closed: the band runs along the lower edge too")};
  Parameters band = surround("moulded", 0.16);
  band[0].words = {"plain", "moulded", "double_cornice", "brick"};
  band[0].initial = 1;
  add(k.parameters, band);
  k.parameters.push_back(detail());
  return k;
}

ElementKind pediment_kind() {
  ElementKind k{.name = "pediment",
                .semantic = ElementClass::installation,
                .meaning = "straight, triangular or segmental hood (Verdachung) on its own",
                .width = {.measures = "span of its cornice", .least = 0.40, .usual = 1.60, .most = 8.00},
                .height = {.measures = "cornice without the gable", .least = 0.08, .usual = 0.18, .most = 0.60}};
  k.parameters = {word("pediment", {"straight", "triangular", "segmental"}, "triangular", "shape"),
                  number("pediment_projection", "m", 0.18, 0.05, 0.50, "how far it stands out of the wall"),
                  number("pediment_rise", "of its span", 0.22, 0.08, 0.35,
                         "triangular and segmental: height of the gable over the cornice"),
                  profile("pediment_profile", "hood", "section of its cornice"),
                  word("pediment_consoles", {"no", "yes"}, "no", "a bracket under each end"),
                  detail()};
  return k;
}

Parameters course(const char* preset, double projection) {
  return {profile("profile", preset, "section"),
          number("projection", "m", projection, 0.02, 1.50,
                 "at most this far out of the wall; higher profiles are squeezed"),
          word("ends", {"cut", "returned", "left_returned", "right_returned"}, "cut",
               "cut: at right angles; returned: it turns round the end and dies into the wall, at both or one of them"),
          number("left_turn", "degrees", 0, -170, 170,
                 "the wall turns there, positive at corners that stand out: the end lies on the bisector, for the same "
                 "course on the next wall; 0: as ends says"),
          number("right_turn", "degrees", 0, -170, 170, "the same of the right end")};
}

ElementKind string_course() {
  ElementKind k{.name = "string_course",
                .semantic = ElementClass::installation,
                .meaning = "band or moulding along the wall between storeys or through the sills (Gurtgesims)",
                .width = {.measures = "run", .least = 0.20, .usual = 4.00, .most = 100},
                .height = {.measures = "profile", .least = 0.05, .usual = 0.26, .most = 1.00}};
  add(k.parameters, course("string_course", 0.12));
  k.parameters.push_back(detail());
  return k;
}

ElementKind main_cornice() {
  ElementKind k{.name = "main_cornice",
                .semantic = ElementClass::installation,
                .meaning = "crowning cornice under the roof, with or without brackets (Hauptgesims)",
                .width = {.measures = "run", .least = 0.20, .usual = 4.00, .most = 100},
                .height = {.measures = "profile", .least = 0.15, .usual = 0.85, .most = 2.00}};
  add(k.parameters, course("main_cornice_brackets", 0.60));
  add(k.parameters,
      {number("bracket_spacing", "m", 0.60, 0, 5, "from bracket to bracket; 0: none"),
       number("bracket_width", "m", 0.16, 0.05, 0.60, "along the wall"),
       number("bracket_foot", "of the height", 0.20, 0, 0.60, "lower end of the brackets"),
       number("bracket_head", "of the height", 0.57, 0.30, 0.95, "upper end of the brackets"),
       number("bracket_projection", "of the cornice's", 0.70, 0.20, 0.95, "how far brackets stand out"), detail()});
  return k;
}

ElementKind plinth() {
  ElementKind k{.name = "plinth",
                .semantic = ElementClass::installation,
                .meaning = "foot of the wall, proud of it, with a bevel or moulding on top (Sockel)",
                .width = {.measures = "run", .least = 0.20, .usual = 4.00, .most = 100},
                .height = {.measures = "plinth", .least = 0.10, .usual = 0.80, .most = 3.00}};
  add(k.parameters, course("plinth", 0.06));
  k.parameters.push_back(detail());
  return k;
}

ElementKind console_kind() {
  ElementKind k{.name = "console",
                .semantic = ElementClass::installation,
                .meaning = "bracket under cornices, pediments and balconies (Konsole)",
                .width = {.measures = "bracket", .least = 0.05, .usual = 0.16, .most = 1.00},
                .height = {.measures = "bracket", .least = 0.08, .usual = 0.30, .most = 1.50}};
  k.parameters = {number("projection", "m", 0.25, 0.05, 2.00, "how far it stands out of the wall"), detail()};
  return k;
}

// Sizes and ranges of the following four: docs/style_measures.md 2.6 (balconies, bays), 2.5 (quoins, pilasters).
ElementKind balcony() {
  ElementKind k{.name = "balcony",
                .semantic = ElementClass::installation,
                .meaning = "balcony: slab on brackets with a railing; y = 0 is the slab's upper side",
                .width = {.measures = "slab", .least = 1.00, .usual = 2.60, .most = 8.00},
                .height = {.measures = "railing", .least = 0.80, .usual = 0.95, .most = 1.30}};
  k.parameters = {number("depth", "m", 1.00, 0.40, 1.80, "how far the slab stands out of the wall"),
                  number("slab", "m", 0.18, 0.10, 0.35, "thickness of the slab"),
                  whole("consoles", 2, 0, 5, "brackets under the slab"),
                  number("console_width", "m", 0.24, 0.10, 0.45, "width of a bracket"),
                  number("console_height", "m", 0.50, 0.15, 0.90, "height of a bracket"),
                  word("railing", {"bars", "panels", "stone", "glass"}, "bars", "iron bars, boards, balusters, panes"),
                  number("bar_spacing", "m", 0.14, 0.09, 0.30, "bars: from bar to bar; stone: half of it"),
                  detail()};
  return k;
}

ElementKind bay() {
  ElementKind k{
      .name = "bay",
      .semantic = ElementClass::installation,
      .meaning =
          "bay (Erker) over one or more storeys with windows of its own; y = 0 is its underside, without the base",
      .width = {.measures = "bay at the wall", .least = 1.20, .usual = 2.80, .most = 5.00},
      .height = {.measures = "bay without base and roof", .least = 2.20, .usual = 7.00, .most = 24.0}};
  k.parameters = {word("plan", {"rectangular", "polygonal"}, "rectangular", "plan; polygonal: slanting cheeks"),
                  number("depth", "m", 0.90, 0.30, 1.50, "how far it stands out of the wall"),
                  whole("storeys", 2, 1, 6, "storeys, all as high"),
                  whole("windows", 2, 1, 4, "windows side by side at the front"),
                  number("window_share", "of the width", 0.66, 0.30, 0.85, "glass share of front and cheeks"),
                  number("sill", "of the storey", 0.24, 0.02, 0.32, "underside of the windows"),
                  number("window_height", "of the storey", 0.55, 0.30, 0.62, "height of the windows"),
                  word("cheek_windows", {"no", "yes"}, "yes", "windows in the cheeks, where 0.3 m are left for them"),
                  word("base", {"corbel", "consoles", "none"}, "corbel", "what carries it"),
                  number("base_height", "m", 0.60, 0.20, 1.20, "height of the base below the bay"),
                  word("bands", {"no", "yes"}, "yes", "string courses at its floors"),
                  word("roof", {"hipped", "flat"}, "hipped", "its own roof"),
                  number("roof_height", "m", 0.60, 0.15, 2.00, "hipped: height of the roof"),
                  detail()};
  return k;
}

ElementKind quoin() {
  ElementKind k{.name = "quoin",
                .semantic = ElementClass::installation,
                .meaning = "corner stones (Eckquaderung), long and short ones in turn",
                .width = {.measures = "long stones", .least = 0.30, .usual = 0.60, .most = 1.20},
                .height = {.measures = "stack", .least = 0.30, .usual = 3.00, .most = 320}};
  k.parameters = {
      word("corner", {"left", "right", "middle"}, "left", "the straight side; middle: toothed on both sides"),
      number("short", "of the width", 0.66, 0.40, 0.95, "width of the short stones"),
      number("stone_height", "m", 0.36, 0.20, 0.80, "height of a stone, joint included"),
      number("joint", "m", 0.02, 0.01, 0.05, "height of the joints"),
      number("projection", "m", 0.04, 0.02, 0.12, "how far the stones stand out of the wall"),
      detail()};
  return k;
}

ElementKind pilaster() {
  ElementKind k{.name = "pilaster",
                .semantic = ElementClass::installation,
                .meaning = "flat upright strip: a lesene, or a pilaster with base and capital",
                .width = {.measures = "shaft", .least = 0.12, .usual = 0.50, .most = 1.20},
                .height = {.measures = "whole", .least = 0.80, .usual = 3.60, .most = 320}};
  k.parameters = {word("order", {"tuscan", "lesene"}, "tuscan", "with base and capital, or without"),
                  number("projection", "m", 0.10, 0.03, 0.30, "how far the shaft stands out of the wall"),
                  number("base_height", "m", 0.30, 0.10, 0.80, "height of the base"),
                  number("capital_height", "m", 0.35, 0.10, 0.90, "height of the capital"), detail()};
  return k;
}

struct Table {
  std::vector<ElementKind> kinds;
  std::vector<Generator> generators;
  void add(ElementKind kind, Generator generator) {
    kinds.push_back(std::move(kind));
    generators.push_back(generator);
  }
};

const Table& table() {
  static const Table all = [] {
    Table t;
    t.add(casement(), make_casement_window);
    t.add(double_casement(), make_double_casement);
    t.add(shop_window(), make_shop_window);
    t.add(cellar_window(), make_cellar_window);
    t.add(shaped_window(), make_shaped_window);
    t.add(house_door(), make_house_door);
    t.add(carriage_gateway(), make_carriage_gateway);
    t.add(reveal(), make_reveal);
    t.add(sill_kind(), make_sill);
    t.add(surround_kind(), make_surround);
    t.add(pediment_kind(), make_pediment);
    t.add(string_course(), make_string_course);
    t.add(main_cornice(), make_main_cornice);
    t.add(plinth(), make_plinth);
    t.add(console_kind(), make_console);
    t.add(balcony(), make_balcony);
    t.add(bay(), make_bay);
    t.add(quoin(), make_quoin);
    t.add(pilaster(), make_pilaster);
    return t;
  }();
  return all;
}

}  // namespace

std::span<const ElementKind> built_in_kinds() { return table().kinds; }
std::span<const Generator> generators() { return table().generators; }

}  // namespace blockrand::elements
