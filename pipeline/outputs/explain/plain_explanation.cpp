#include "pipeline/outputs/explain/plain_explanation.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "pipeline/model/osm_keys.h"
#include "pipeline/outputs/explain/place_words.h"
#include "pipeline/outputs/explain/places.h"
#include "pipeline/outputs/explain/plain_reasons.h"
#include "pipeline/outputs/explain/plain_values.h"
#include "pipeline/outputs/explain/plain_words.h"

namespace blockrand::outputs {
namespace {

using namespace plain;

constexpr std::size_t kMostReasons = 3, kMostNotes = 3, kMostStreets = 3;
/// m: smaller moves of corners are told in centimetres.
constexpr double kInCentimetres = 0.995;
/// m: corners that moved less are where they are mapped, for anybody who looks at the model.
constexpr double kAsMapped = 0.05;
/// Percent from which "no more than one storey off" is sure.
constexpr double kWithinOne = 85;
/// The fourth digit of an area says nothing.
constexpr double kThreeDigits = 1000;

class PlainText {
 public:
  PlainText(const Json& json, std::string asked)
      : j_(json), asked_(std::move(asked)), id_(j_.at("id")), v_(j_.at("attributes")) {}

  PlainExplanation text() {
    out_.title = title();
    asked_line();
    if (j_.at("bodies").empty()) {
      without_body();
    } else {
      out_.lines.push_back(what());
      out_.lines.push_back(storeys());
      out_.lines.push_back(height());
      const std::string model = j_.value("replaced_by", "");
      if (model.empty()) out_.lines.push_back(roof());
      add(style());
      add(stands());
      out_.lines.push_back(model.empty() ? facade()
                                         : "Model: somebody's own model stands for this building: " + model + ".");
      add(simplified());
      add(outline());
      to_change();
    }
    return std::move(out_);
  }

 private:
  void add(std::string line) {
    if (!line.empty()) out_.lines.push_back(std::move(line));
  }

  bool has_parts() const { return j_.at("bodies").size() > 1; }

  // ---- who it is

  std::string use() const {
    const std::string use = v_.text("use");
    return use_words(use.empty() ? "yes" : use);
  }

  /// Of its front, else of any wall that looks at a street; empty for none.
  std::string street() const {
    if (!j_.contains("edges")) return {};
    std::string any;
    for (const Json& e : j_.at("edges")) {
      const std::string name = e.value("street_name", "");
      if (name.empty()) continue;
      if (e.value("front", false)) return name;
      if (any.empty() && e.value("kind", "") == "street") any = name;
    }
    return any;
  }

  std::string title() const {
    const std::string name = j_.value("name", ""), address = addresses().first;
    if (!name.empty()) return address.empty() ? name : name + ", " + address;
    const std::string near = street();
    const bool town_alone = !address.empty() && own_street().empty() && tag(model::osm_key::kAddrHousenumber).empty() &&
                            tag(model::osm_key::kAddrHousename).empty() && address == j_.value("address", "");
    if (!address.empty() && !town_alone) {
      if (!own_street().empty() || j_.value("address", "").empty()) return address;
      const PlaceAddresses all = place_addresses(address + "; " + addresses().second);
      // A number without a street says too little: the street of its other doors, else that which it faces.
      const bool of_doors = !all.all.front().street.empty();
      const std::string from = of_doors ? all.all.front().shown_street : near;
      return from.empty() || address.starts_with(from) ? address : from + " " + address;
    }
    const std::string noun = use();
    return capitalised(noun.substr(0, noun.find(','))) + (near.empty() ? "" : ", " + near) +
           (town_alone ? ", " + address : "") +
           (near.empty() && !town_alone ? " without an address"
            : near.empty()              ? ""
                                        : " (no address mapped)");
  }

  std::string tag(std::string_view key) const {
    return j_.contains("tags") ? j_.at("tags").value(std::string(key), "") : std::string();
  }
  /// Of its address, as mapped.
  std::string own_street() const {
    const std::string street = tag(model::osm_key::kAddrStreet);
    return street.empty() ? tag(model::osm_key::kAddrPlace) : street;
  }

  /// Its own address, and those that doors and points in it add.
  std::pair<std::string, std::string> addresses() const {
    const std::string street = own_street(), own = j_.value("address", ""),
                      numbers = tag(model::osm_key::kAddrHousenumber);
    AddressList list(own, street, numbers);
    if (j_.contains("edges"))
      for (const Json& e : j_.at("edges"))
        if (e.contains("points"))
          for (const Json& p : e.at("points")) {
            const std::string number = p.value("house_number", ""), point_street = p.value("street", ""),
                              wall_street = e.value("street_name", "");
            list.add(number, point_street, wall_street);
          }
    std::string all = list.text();
    if (!own.empty()) {
      all.erase(0, std::min(all.size(), own.size()));
      if (all.starts_with("; ")) all.erase(0, 2);
      return {own, all};
    }
    const std::size_t first = all.find("; ");
    if (first == std::string::npos) return {all, {}};
    return {all.substr(0, first), all.substr(first + 2)};
  }

  void asked_line() {
    if (asked_.empty() || asked_ == id_) return;
    const Json* own = nullptr;
    for (const Json& body : j_.at("bodies"))
      if (("." + body.value("id", "") + ".").find("." + asked_ + ".") != std::string::npos) {
        own = &body;
        break;
      }
    if (!own) {
      out_.lines.push_back(
          "You asked for another drawing of the same house in the map. Only one was built, which is told here.");
      return;
    }
    std::string line = "You asked for a part of this building";
    if (own->contains("attributes")) {
      const Values values(own->at("attributes"));
      line += fmt::format(
          ": it has {}, is {} m high and has a {}", count_of(values.number("storeys"), "storey"),
          values.is_known("height") ? as_mapped(values.number("height")) : "about " + whole(values.number("height")),
          roof_words(own->value("built_roof", "")));
    }
    out_.lines.push_back(line + ". The rest is about the whole building.");
  }

  void without_body() {
    const std::string state = j_.value("state", ""), code = j_.value("code", "");
    if (state == "reported")
      out_.lines.push_back("Not in the model: " + reported_words(code, j_.value("meaning", "")) + ".");
    else if (state == "duplicate")
      out_.lines.push_back(
          "Not in the model: the same house is drawn twice in the map, and the other drawing was built" +
          other_drawing() + ".");
    else
      out_.lines.push_back(
          "Without a body of its own: other buildings of the map cover its outline, and they were built.");
    add("What it is: " + what_noun() + ".");
    std::vector<std::string> notes = note_texts({"notice", "fallback", "reported"});
    if (code == "OUTLINE_INCOMPLETE") std::erase(notes, std::string(consequence_words("MEMBERS_MISSING")));  // the same
    if (state == "reported" && !notes.empty())
      out_.lines.push_back(fmt::format("What happened: {}.", fmt::join(notes, "; ")));
    out_.lines.push_back(remedy_words(state, code));
    if (const std::string page = link_of(id_); !page.empty()) out_.lines.push_back("Its page: " + page);
  }

  /// " (w400555844)": of whom it is a duplicate, which the note alone says.
  std::string other_drawing() const {
    for (const Json& note : j_.at("notes")) {
      const std::string detail = note.value("detail", "");
      if (note.value("code", "") == "NEAR_DUPLICATE" && detail.starts_with("of "))
        return " (ask for " + detail.substr(3, detail.find(',') - 3) + ")";
    }
    return {};
  }

  std::string what_noun() const {
    const std::string use = v_.text("use");
    if (use.empty() || use == "yes") {
      const std::string rule = j_.contains("style") ? j_.at("style").value("rule", "") : "";
      // What stands in a key that no class of use is made of, such as a mosque's: the map says it all the same.
      std::vector<std::string> called;
      for (const std::string_view key : {model::osm_key::kAmenity, model::osm_key::kTourism, model::osm_key::kHistoric,
                                         model::osm_key::kShop, model::osm_key::kOffice})
        if (const std::string value = tag(key); !value.empty() && value != "yes") called.push_back(with_spaces(value));
      return std::string(rule.empty() ? "a building" : "a small structure") +
             (called.empty() ? "; the map does not say what it is used for"
                             : fmt::format("; the map calls it {}", and_list(called)));
    }
    return with_article(use_words(use)) + (v_.given("use").empty() ? "" : ", " + v_.given("use"));
  }

  /// "with a shop on the ground floor"
  std::string ground_floor() const {
    const std::string use = v_.text("ground_floor_use");
    std::string what;
    if (use == "shop") what = "a shop";
    if (use == "gastronomy") what = "a restaurant or café";
    if (use == "office") what = "offices";
    if (use == "health") what = "a doctor or the like";
    if (use == "culture") what = "a place of culture";
    if (use == "education") what = "a nursery or school";
    if (use == "service") what = "a service, such as a hairdresser,";
    if (use == "lodging") what = "a hotel or the like";
    if (use == "craft") what = "a workshop";
    const std::string building = v_.text("use");
    const bool house = building == "yes" || building == "residential" || building == "apartments" ||
                       building == "house" || building == "commercial" || building == "office";
    if (what.empty() || !house) return {};
    const bool mapped = v_.is_known("ground_floor_use") || v_.source("ground_floor_use") == "geometry";
    return fmt::format("; {} on the ground floor ({})", what,
                       mapped ? "mapped there" : std::string(v_.sureness("ground_floor_use")));
  }

  /// The addresses of its doors that its own does not name: "Granseer Straße 7 and 9, Lange Straße 2".
  std::string other_doors() const {
    const auto [own, doors] = addresses();
    const PlaceAddresses named = place_addresses(own);
    std::vector<std::pair<std::string, std::vector<std::string>>> by_street;
    for (const PlaceAddress& door : place_addresses(own + "; " + doors).all) {
      const auto same = [&](const PlaceAddress& a) {
        return a.street == door.street && std::any_of(a.numbers.begin(), a.numbers.end(), [&](const std::string& n) {
                 return door.numbers.empty() || match_numbers(door.numbers[0], n) != NumberMatch::none;
               });
      };
      if (door.numbers.empty() || std::any_of(named.all.begin(), named.all.end(), same)) continue;
      if (by_street.empty() || by_street.back().first != door.shown_street)
        by_street.emplace_back(door.shown_street, std::vector<std::string>());
      by_street.back().second.push_back(door.numbers[0]);
    }
    std::vector<std::string> texts;
    for (const auto& [street, numbers] : by_street)
      texts.push_back((street.empty() ? "number" : street) + " " + and_list(numbers));
    return fmt::format("{}", fmt::join(texts, ", "));
  }

  std::string what() const {
    std::string line = "What it is: " + what_noun() + ground_floor();
    if (has_parts()) line += fmt::format("; modelled in {} parts", j_.at("bodies").size());
    if (const std::string others = other_doors(); !others.empty()) line += "; also " + others;
    return line + ".";
  }

  // ---- how large

  std::string storeys() const {
    const double n = v_.number("storeys");
    const std::string source = v_.source("storeys"), why = v_.why("storeys");
    std::string line = "Storeys: ";
    std::set<double> of_parts;
    for (const Json& body : j_.at("bodies"))
      if (body.contains("attributes")) of_parts.insert(Values(body.at("attributes")).number("storeys"));
    if (of_parts.size() > 1)
      line += fmt::format("{} to {} in its parts; the whole building: {}", as_mapped(*of_parts.begin()),
                          as_mapped(*of_parts.rbegin()), as_mapped(n));
    else
      line += as_mapped(n);
    if (const std::string given = v_.given("storeys"); !given.empty()) {
      line += ", " + given;
    } else {
      if (const double voices = number_behind(why, ""); source == "neighbours" && voices >= 1)
        line += fmt::format(", as {} near it with mapped storeys suggest{}", count_of(voices, "house"),
                            voices == 1 ? "s" : "");
      else if (source == "implied" && why.find("of wall at") != std::string::npos)
        line += ", which the mapped height gives at the usual height of a storey";
      else
        line += ", " + origin(source);
      line += fmt::format(" ({}", v_.sureness("storeys"));
      const bool within = number_behind(why, "within one storey ") >= kWithinOne;
      line += v_.confidence("storeys") < kSure && within ? ", but surely no more than one off)" : ")";
    }
    if (const double roof = v_.number("roof_storeys"); roof > 0)
      line += fmt::format("; {} more in the roof{}", as_mapped(roof), v_.is_known("roof_storeys") ? ", as mapped" : "");
    return line + ".";
  }

  std::string height() const {
    const double top = v_.number("height"), eaves = v_.number("eaves_height");
    const std::string source = v_.source("height"), given = v_.given("height");
    std::string line = "Height: ";
    if (!given.empty()) {
      line += fmt::format("{} m to the top of the roof, {}", as_mapped(top), given);
    } else {
      line += fmt::format("about {} m to the top of the roof", whole(top));
      if (!has_parts() && eaves > 0 && std::round(eaves) < std::round(top))
        line += fmt::format(", {} m to the eaves", whole(eaves));
      if (source == "part")
        line += "; that of its highest part";
      else if (v_.is_known("storeys"))
        line += fmt::format(
            "; worked out from the {} storeys, at {} m each, {} ({})",
            v_.source("storeys") == "override" ? "ordered" : "mapped", storey_height(v_.number("storey_height")),
            v_.is_known("storey_height") ? "as mapped" : "as usual for such buildings", v_.sureness("height"));
      else if (source == "implied" || source == "neighbours" || source == "geometry" || source == "preset")
        line += fmt::format("; worked out from the storeys at about {} m each, so no surer than they are ({})",
                            storey_height(v_.number("storey_height")), v_.sureness("height"));
      else
        line += fmt::format("; {} ({})", origin(source), v_.sureness("height"));
    }
    if (const double under = v_.number("min_height"); under > 0)
      line +=
          fmt::format("; it starts {} m above the ground", v_.is_known("min_height") ? as_mapped(under) : whole(under));
    return line + ".";
  }

  /// Why this shape, of a roof that nobody mapped.
  std::string roof_why() const {
    const std::string source = v_.source("roof_shape"), why = v_.why("roof_shape");
    const auto says = [&](std::string_view text) { return why.find(text) != std::string::npos; };
    if (says("too many for rafters")) return "so high a house has no pitched roof as a rule";
    if (says("too wide for rafters")) return "so wide a building has no pitched roof as a rule";
    if (says("neighbours stand at all sides")) return "neighbours stand at all sides, so a slope has nowhere to fall";
    if (says("other roof tags speak of a slope"))
      return says("neighbours") ? "the map has storeys in the roof or the like, so it slopes, and roofs near it look so"
                                : "the map has storeys in the roof or the like, so it slopes";
    if (const double voices = number_behind(why, ""); source == "neighbours" && voices >= 1)
      return fmt::format("as {} near it with {} suggest{}", count_of(voices, "house"),
                         voices == 1 ? "a mapped roof" : "mapped roofs", voices == 1 ? "s" : "");
    return origin(source);
  }

  std::string roof() const {
    std::vector<std::string> shapes;
    bool adapted = false;
    std::string asked;
    for (const Json& body : j_.at("bodies")) {
      const std::string built = body.value("built_roof", "");
      if (const std::string words = roof_words(built); std::find(shapes.begin(), shapes.end(), words) == shapes.end())
        shapes.push_back(words);
      if (body.value("asked_roof", "") != built) adapted = true, asked = body.value("asked_roof", "");
    }
    constexpr std::size_t kMostShapes = 3;
    const std::size_t shown = std::min(shapes.size(), kMostShapes);
    std::string line =
        fmt::format("Roof: {}", fmt::join(shapes.begin(), shapes.begin() + static_cast<std::ptrdiff_t>(shown), ", "));
    if (shapes.size() > shown) line += " and others";
    if (const std::string given = v_.given("roof_shape"); !given.empty() && !adapted)
      line += ", " + given;
    else if (has_parts())
      line += "; each part has its own, mapped or like the building's";
    else if (adapted && asked == "many")
      line += "; the map only says that it has several shapes, which cannot be built";
    else if (adapted && asked != "other")
      line += fmt::format("; meant was a {}, {}", roof_words(asked), given.empty() ? roof_why() : given);
    else if (adapted)
      line += "; the map says that it is another shape than the usual ones";
    else
      line += fmt::format("; {} ({})", roof_why(), v_.sureness("roof_shape"));
    std::vector<std::string> mapped;
    if (v_.is_known("roof_material")) mapped.push_back("its material");
    if (v_.is_known("roof_colour")) mapped.push_back("its colour");
    line += mapped.empty() ? "" : fmt::format("; {} {} mapped", and_list(mapped), mapped.size() > 1 ? "are" : "is");
    return line + ".";
  }

  // ---- what style

  /// "front house of the Berlin Mietskaserne": the note of the catalogue, which the reason for the sub-style ends with.
  std::string substyle() const {
    const std::string why = v_.why("substyle");
    constexpr std::string_view kBefore = "fit best: ";
    const std::size_t at = why.find(kBefore);
    if (at == std::string::npos) return {};
    std::string note = why.substr(at + kBefore.size());
    note = note.substr(0, note.find(';'));
    // Ids of other styles, notes on sources.
    for (std::size_t open = note.find(" ("); open != std::string::npos; open = note.find(" (", open + 1)) {
      const std::size_t close = note.find(')', open);
      if (close == std::string::npos) break;
      if (note.substr(open, close - open).find('_') != std::string::npos) note.erase(open, close + 1 - open);
    }
    return note;
  }

  /// ", built 1840 to 1918 (likely)", ", built 1905, as mapped"; of two answers that contradict each other neither.
  std::string built_when(const std::string& style_class) const {
    const std::string date = v_.text("construction_date");
    if (v_.is_known("construction_date") && !date.empty()) {
      const std::size_t dots = date.find("..");
      const std::string years =
          dots == std::string::npos ? date : date.substr(0, dots) + " to " + date.substr(dots + 2);
      return ", built " + years + ", " + v_.given("construction_date");
    }
    if (const std::size_t dots = date.find("..");
        v_.source("construction_date") == "neighbours" && dots != std::string::npos)
      if (const double voices = number_behind(v_.why("construction_date"), ""); voices >= 1)
        return fmt::format(", built about {} to {}, as {} near it with mapped dates suggest{} ({})",
                           date.substr(0, dots), date.substr(dots + 2), count_of(voices, "house"),
                           voices == 1 ? "s" : "", v_.sureness("construction_date"));
    const std::string era = v_.text("era");
    const bool old_class = style_class == "gruenderzeit" || style_class == "tenement";
    const bool old_era = era == "pre1840" || era == "1840_1918";
    if (era_words(era).empty()) return {};
    if ((old_class && era != "1840_1918") || (style_class == "modern" && old_era))
      return "; when it was built is not clear";
    return fmt::format(", built {} ({})", era_words(era), v_.sureness("era"));
  }

  std::string style() const {
    if (!j_.contains("style")) return {};
    const Json& style = j_.at("style");
    const std::string kind = substyle();
    if (const std::string rule = style.value("rule", ""); !rule.empty()) return no_house(rule);
    const std::string own = style.value("class", ""),
                      p = std::string(confidence_word(style.at("probabilities").value(own, 0.0)));
    const bool other = own == "other";
    std::string line = "Style: ";
    if (other)
      line += kind.empty() ? fmt::format("none of the usual houses ({})", p) : fmt::format("{} ({})", kind, p);
    else
      line += fmt::format("{} ({})", class_words(own), p);
    line += built_when(own);
    if (!other && !kind.empty()) line += fmt::format("; drawn as: {} ({})", kind, v_.sureness("substyle"));
    line += ".";
    const std::vector<std::string> reasons = strongest_reasons(style, kMostReasons);
    if (!reasons.empty())
      line += fmt::format(" Why {}, and not {}: {}.", other ? "this" : class_words(own),
                          class_words(style.value("second", "")), and_list(reasons));
    return line;
  }

  /// Of what a rule takes out: "building=toilets: a public toilet", "12.2 m² without an address: an outbuilding".
  static std::string no_house(const std::string& rule) {
    const std::size_t colon = rule.find(": ");
    const std::string what = colon == std::string::npos ? rule : rule.substr(colon + 2);
    const std::string because =
        colon == std::string::npos || rule.find('=') < colon ? "" : " (" + rule.substr(0, colon) + ")";
    const bool thing = what.starts_with("a ") || what.starts_with("an ");
    return fmt::format("Style: none of a house, as it is {}{}{}.", thing ? "taken for " : "", what, because);
  }

  // ---- where it stands

  std::string stands() const {
    if (!j_.contains("situation")) return {};
    const Json& s = j_.at("situation");
    std::string line = "Where it stands: " + std::string(position_words(s.value("position", "")));
    std::vector<std::string> fronts;
    std::set<std::string> neighbours;
    bool court = false;
    if (j_.contains("edges"))
      for (const Json& e : j_.at("edges")) {
        if (e.contains("neighbour")) neighbours.insert(e.value("neighbour", ""));
        court = court || e.value("kind", "") == "courtyard";
        if (!e.value("front", false)) continue;
        const std::string_view looks = direction_words(e.value("looks", ""));
        const std::string name = e.value("street_name", "");
        std::string front =
            (name.empty() ? "a street without a name" : name) + (looks.empty() ? "" : fmt::format(" ({})", looks));
        if (std::none_of(fronts.begin(), fronts.end(),
                         [&](const std::string& f) { return !name.empty() && f.starts_with(name + " ("); }))
          fronts.push_back(std::move(front));
      }
    if (fronts.size() > kMostStreets) fronts.resize(kMostStreets);
    if (!fronts.empty()) line += "; its front faces " + and_list(fronts);
    const bool alone = s.value("position", "") == "free_standing";
    line += neighbours.empty() ? (alone ? "" : "; it shares no wall with a neighbour")
                               : fmt::format("; it shares walls with {}",
                                             count_of(static_cast<double>(neighbours.size()), "neighbour"));
    if (const std::string yard = courtyard(); !yard.empty())
      line += "; " + yard;
    else if (court)
      line += "; there is a courtyard at its back";
    if (s.contains("setback") && s.value("setback", 0.0) >= 1)
      line += fmt::format("; it stands about {} m back from the line of the street's fronts",
                          whole(s.value("setback", 0.0)));
    return line + ".";
  }

  /// "it stands at a closed courtyard of 1650 m²", of what context says; the sizes stand nowhere else.
  std::string courtyard() const {
    for (const Json& stage : j_.at("stages")) {
      if (stage.value("stage", "") != "context") continue;
      const std::string text = stage.value("text", "");
      constexpr std::string_view kBefore = "stands at ";
      const std::size_t at = text.find(kBefore);
      if (at == std::string::npos) return {};
      std::string yards = text.substr(at, text.find(';', at) - at);
      if (yards.find("courtyard of") == std::string::npos || yards.find(".y") != std::string::npos) return {};
      for (std::size_t m = yards.find(" m2"); m != std::string::npos; m = yards.find(" m2", m + 1)) {
        yards.replace(m, 3, " m²");
        const std::size_t number = yards.rfind(' ', m - 1) + 1;
        const double area = number_behind(yards.substr(number, m - number), "");
        if (area >= kThreeDigits) yards.replace(number, m - number, three_digits(area));
      }
      return "it " + yards;
    }
    return {};
  }

  // ---- what it looks like

  bool has_stage(std::string_view name, std::string_view text = {}) const {
    for (const Json& stage : j_.at("stages"))
      if (stage.value("stage", "") == name) return stage.value("text", "").find(text) != std::string::npos;
    return false;
  }

  std::string facade() const {
    std::string line = "Facade: ";
    double windows = 0, doors = 0;
    std::map<std::string, double> things;
    for (const Json& body : j_.at("bodies")) {
      if (!body.contains("detail")) continue;
      const Json& detail = body.at("detail");
      windows += detail.value("windows", 0.0);
      doors += detail.value("doors", 0.0);
      for (const char* group : {"elements", "roof_elements", "installations"})
        if (detail.contains(group))
          for (const auto& [kind, count] : detail.at(group).items())
            if (!element_words(kind).one.empty()) things[kind] += count.get<double>();
    }
    if (!has_stage("facades")) {
      line += "plain walls; this build has no windows (--lod 3 draws them)";
    } else if (windows + doors == 0) {
      line += has_stage("facades", "no rule") ? "plain walls; there are no rules for the windows of such buildings"
                                              : "walls without windows or doors";
    } else {
      line += (windows == 0 ? "no windows" : count_of(windows, "window")) + " and " +
              (doors == 0 ? "no door" : count_of(doors, "door"));
      std::vector<std::string> more;
      for (const auto& [kind, count] : things)
        more.push_back(count_of(count, element_words(kind).one, element_words(kind).many));
      if (!more.empty()) line += ", besides " + and_list(more);
      line += "; drawn by rules for such houses, not counted in the street";
    }
    if (const std::string material = v_.text("wall_material"); !material.empty())
      line += fmt::format(
          "; walls of {}, {}", with_spaces(material),
          v_.given("wall_material").empty() ? origin(v_.source("wall_material")) : v_.given("wall_material"));
    if (v_.is_known("wall_colour")) line += "; the walls' colour is " + v_.given("wall_colour").substr(3);
    return line + ".";
  }

  // ---- what went otherwise

  /// What happened to it, each once, with what it means.
  std::vector<std::string> note_texts(std::initializer_list<std::string_view> classes) const {
    std::vector<std::string> out;
    for (const Json& note : j_.at("notes")) {
      if (std::find(classes.begin(), classes.end(), note.value("class", "")) == classes.end()) continue;
      std::string text(consequence_words(note.value("code", "")));
      if (text.empty()) {  // of a newer build
        text = note.value("meaning", "");
        if (text.ends_with('.')) text.pop_back();
        if (text.size() > 1 && is_letter(text[1]))
          text[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(text[0])));
      }
      if (text != " " && std::find(out.begin(), out.end(), text) == out.end()) out.push_back(std::move(text));
    }
    if (out.size() > kMostNotes) {
      out.resize(kMostNotes);
      out.push_back("more (--all tells)");
    }
    return out;
  }

  std::vector<std::string> simplifications() const {
    std::vector<std::string> texts = note_texts({"fallback"});
    bool closed = false;
    for (const Json& body : j_.at("bodies"))
      if (body.contains("fallbacks"))
        for (const Json& code : body.at("fallbacks")) {
          const std::string text(consequence_words(code.get<std::string>()));
          closed = closed || code == "FACADE_FAILED";
          if (!text.empty() && text != " " && std::find(texts.begin(), texts.end(), text) == texts.end() &&
              texts.size() < kMostNotes)
            texts.push_back(text);
        }
    // Walls that stay closed have no windows to miss.
    if (closed) std::erase(texts, std::string(consequence_words("OPENING_LEFT_OUT")));
    return texts;
  }

  std::string simplified() const {
    const std::vector<std::string> texts = simplifications();
    return texts.empty() ? "" : fmt::format("Simplified: {}.", fmt::join(texts, "; "));
  }

  /// "its walls meet those of its neighbours and its corners are square"
  static std::string why_moved(const Json& repair) {
    std::vector<std::string> why;
    if (repair.value("shared_walls", 0.0) > 0) why.push_back("its walls meet those of its neighbours");
    if (repair.contains("direction")) why.push_back("its corners are square");
    if (repair.value("overlaps_resolved", 0.0) > 0) why.push_back("it overlaps nobody");
    return why.empty() ? "" : ", so that " + and_list(why);
  }

  std::string outline() const {
    std::vector<std::string> pieces;
    if (j_.contains("imagery"))
      for (const Json& stage : j_.at("stages"))
        if (stage.value("stage", "") == "image") pieces.push_back("in the aerial image: " + stage.value("text", ""));
    if (j_.contains("repair")) {
      const Json& r = j_.at("repair");
      const double moved = r.value("moved", 0.0), all = r.value("vertices", 0.0), most = r.value("max_shift", 0.0);
      if (moved > 0 && most < kAsMapped)
        pieces.push_back(fmt::format("as mapped, within {:.0f} cm", std::max(1.0, std::ceil(100 * most))));
      else if (moved > 0)
        pieces.push_back(
            fmt::format("{} were moved by {} at most{}",
                        moved == all ? fmt::format("all its {:.0f} corners", all)
                                     : fmt::format("{:.0f} of its {:.0f} corners", moved, all),
                        most < kInCentimetres ? fmt::format("{:.0f} cm", 100 * most) : fmt::format("{:.1f} m", most),
                        why_moved(r)));
    }
    const std::vector<std::string> told = simplifications();
    for (std::string& text : note_texts({"notice"}))
      if (std::find(told.begin(), told.end(), text) == told.end()) pieces.push_back(std::move(text));
    if (pieces.empty()) return "Outline: as mapped; nothing had to be mended.";
    return fmt::format("Outline: {}.", fmt::join(pieces, "; "));
  }

  // ---- what to do

  struct Changeable {
    const char *attribute, *tag, *words;
  };

  void to_change() {
    if (has_parts()) {  // orders for the whole reach no part that says otherwise
      const std::string page = link_of(id_);
      out_.lines.push_back(fmt::format(
          "To change it: it is modelled in parts; correct their tags {} and build again, or order their values "
          "(build --overrides) by their ids, which --all lists.",
          page.empty() ? "in OpenStreetMap" : "at " + page));
      return;
    }
    constexpr Changeable kAll[] = {{"storeys", "building:levels", "number of storeys"},
                                   {"roof_shape", "roof:shape", "shape of its roof"},
                                   {"height", "height", "height"}};
    const Changeable* least = nullptr;
    for (const Changeable& c : kAll)
      if (v_.find(c.attribute) && !v_.is_known(c.attribute) &&
          (!least || v_.confidence(c.attribute) < v_.confidence(least->attribute)))
        least = &c;
    const std::string page = link_of(id_);
    const std::string where = page.empty() ? "in OpenStreetMap" : "at " + page;
    if (!least) {
      out_.lines.push_back(fmt::format(
          "To change it: storeys, height and roof are mapped; if one is wrong, correct its tag {} and build again.",
          where));
      return;
    }
    const std::string_view attribute = least->attribute;
    const std::string value = attribute == "roof_shape" ? fmt::format("\"{}\"", v_.text("roof_shape"))
                              : attribute == "height"   ? whole(v_.number("height"))
                                                        : as_mapped(v_.number("storeys"));
    out_.lines.push_back(fmt::format("To change it: least is known of the {}. Add the tag {} {} and build again;",
                                     least->words, least->tag, where));
    out_.lines.push_back(
        fmt::format("or write {}.{} = {} with the true value into a file and give it to build --overrides.", id_,
                    attribute, value));
  }

  const Json& j_;
  std::string asked_, id_;
  Values v_;
  PlainExplanation out_;
};

/// Of a row of report.json.
PlainExplanation row_text(const Json& row) {
  PlainExplanation out;
  const std::string id = row.at("id"), state = row.at("state"), code = row.value("code", ""),
                    related = row.value("related", "");
  const std::string what = row.value("kind", "") == "building" ? "A building" : "A part of a building";
  const std::string ask = related.empty() ? "" : " (ask for " + related + ")";
  out.title = what + (state == "represented" ? " without a body of its own" : " that is not in the model");
  if (state == "duplicate")
    out.lines.push_back("Why: it is drawn twice in the map, and the other drawing counts" + ask + ".");
  else if (state == "represented")
    out.lines.push_back("Why: others of the map stand for it" + ask + ".");
  else
    out.lines.push_back("Why: " + reported_words(code, row.value("meaning", "")) + ".");
  out.lines.push_back(remedy_words(state, code));
  if (const std::string page = link_of(id); !page.empty()) out.lines.push_back("Its page: " + page);
  return out;
}

/// Texts of the map stay on their line.
std::string one_line(std::string text) {
  for (char& c : text)
    if (const auto byte = static_cast<unsigned char>(c); byte < 0x20 || byte == 0x7F) c = ' ';
  return text;
}

}  // namespace

PlainExplanation plain_explanation(std::string_view json, std::string_view asked) {
  const Json j = Json::parse(json);
  PlainExplanation out = j.contains("bodies") ? PlainText(j, std::string(asked)).text() : row_text(j);
  out.title = one_line(std::move(out.title));
  for (std::string& line : out.lines) line = one_line(std::move(line));
  return out;
}

}  // namespace blockrand::outputs
