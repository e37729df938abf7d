// overrides.toml: typed, checked, acting as tags do, marked as overrides; what matches nothing is told.
#include "pipeline/attributes/overrides.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "pipeline/attributes/resolve.h"
#include "pipeline/base/error.h"
#include "tests/unit/base/text_file.h"

namespace blockrand::attributes {
namespace {

using model::OsmId;
using model::OsmType;
using model::RoofShape;
using model::Source;
using testing::AllOf;
using testing::HasSubstr;

const Defaults& defaults() {
  static const Defaults read = read_defaults(std::string(BLOCKRAND_SOURCE_DIR) + "/configs");
  return read;
}

Overrides parse(const std::string& text) {
  const base::test::TextFile file("overrides.toml", text);
  return read_overrides(file.path(), defaults(), {{"gz_plain", "postwar"}, {"gz_high"}});
}

std::string error_of(const std::string& text) {
  try {
    parse(text);
  } catch (const base::InputError& error) {
    return error.what();
  }
  return "no error";
}

/// One house of 10 by 10 m, way 1, with tags and orders.
class House {
 public:
  explicit House(const std::string& applicable) : overrides(parse(applicable)) {
    model::MappedBuilding b;
    b.id = {OsmType::way, 1};
    b.attributes.use = extract.strings.intern("apartments");
    extract.buildings.push_back(b);
  }
  model::MappedAttributes& tags() { return extract.buildings[0].attributes; }
  /// A part of way 1, the western half.
  void add_part(std::int64_t id) {
    model::MappedBuilding b;
    b.id = {OsmType::way, id};
    b.kind = model::ObjectKind::building_part;
    extract.buildings.push_back(b);
  }
  const model::Attributes& resolve() {
    apply_overrides(overrides, extract, report);
    model::Building building;
    building.osm = {OsmType::way, 1};
    model::Polygon plan;
    plan.outer.points = {{0, 0}, {10, 0}, {10, 10}, {0, 10}};
    plan.outer.nodes.assign(4, 0);
    building.outline = {plan};
    building.mapped = tags();
    model::BuildingPart part;
    part.osm = building.osm;
    part.id = "w1";
    part.plan = plan;
    part.mapped = building.mapped;
    if (extract.buildings.size() == 1) building.parts.push_back(part);
    for (std::size_t i = 1; i < extract.buildings.size(); ++i) {
      building.has_mapped_parts = true;
      part.osm = extract.buildings[i].id;
      part.id = part.osm.text();
      part.plan.outer.points = {{0, 0}, {5, 0}, {5, 10}, {0, 10}};
      part.mapped = extract.buildings[i].attributes;
      building.parts.push_back(part);
    }
    model::WallSegment edge;
    edge.from_node = 11, edge.to_node = 12;
    building.edges.push_back(edge);
    region.extract = &extract;
    region.buildings = {building};
    const context::TaggedNeighbours none({}, 100);
    const auto ground = [](const model::Building&) {
      context::BuildingGround g;
      g.lowest = {0, Source::default_, 0, 0};
      return g;
    };
    resolve_attributes(region, {defaults(), none, 1, ground, &overrides}, {});
    mark_overrides(region, overrides, catalogue);
    return region.buildings[0].attributes;
  }
  const model::Evidence& why(const model::EvidenceId id) const { return region.evidence[id]; }
  const model::Attributes& part(std::size_t i) const { return region.buildings[0].parts.at(i).attributes; }
  std::string told(model::IssueCode code) const {
    std::string text;
    for (const model::ReportRow& row : region.report.rows)
      if (row.code == code) text += row.object.text() + " " + row.detail + "\n";
    return text;
  }

  model::Extract extract;
  model::Report report;
  model::Region region;
  Overrides overrides;
  const classify::Catalogue* catalogue = nullptr;
};

const classify::Catalogue& catalogue() {
  static const classify::Catalogue read = classify::read_catalogue(std::string(BLOCKRAND_SOURCE_DIR) + "/configs");
  return read;
}

TEST(Overrides, EveryAttributeCanBeOrdered) {
  // Each alone, with a value of its kind.
  model::Attributes a;
  a.roof_direction.emplace();
  a.ridge_direction.emplace();
  model::for_each_attribute(
      a,
      [](std::string_view name, std::string_view, const auto& sourced) {
        using T = std::decay_t<decltype(sourced.value)>;
        std::string value = "\"shop\"";
        if constexpr (std::is_same_v<T, double>) value = "5";
        if constexpr (std::is_same_v<T, RoofShape>) value = "\"mansard\"";
        if constexpr (std::is_same_v<T, model::RoofOrientation>) value = "\"across\"";
        if constexpr (std::is_same_v<T, model::Colour>) value = "\"#aabbcc\"";
        if (name.ends_with("material")) value = "\"brick\"";
        if (name == "construction_date") value = "\"1895..1902\"";
        if (name == "era") value = "\"1840_1918\"";
        if (name == "style") value = "\"tenement\"";
        if (name == "substyle") value = "\"gz_high\"";
        if (name == "preset") value = "\"postwar\"";
        std::string text = "[w1]\n" + std::string(name) + " = " + value + "\n";
        if (name == "eaves_height") text += "roof_height = 2\n";
        const Overrides o = parse(text);
        ASSERT_EQ(o.entries.size(), 1u) << name;
        EXPECT_TRUE(o.entries[0].values.contains(std::string(name))) << name;
        House house(text);
        house.resolve();
        model::for_each_attribute(
            house.region.buildings[0].attributes,
            [&](std::string_view n, std::string_view, const auto& s) {
              if (n != name) return;
              EXPECT_EQ(s.source, Source::override_) << name;
              EXPECT_EQ(s.confidence, 1) << name;
              EXPECT_THAT(house.why(s.evidence).text, HasSubstr("overrides.toml:2")) << name;
            },
            [&](std::string_view n, std::string_view) { EXPECT_NE(n, name); });
      },
      [](std::string_view, std::string_view) {});
}

TEST(Overrides, HeightsStayConsistentAndTheTagIsAmongWhatLost) {
  House house("[w1]\nstoreys = 5\nroof_shape = \"flat\"\n");
  house.tags().storeys = 3;
  house.tags().height = 20;
  const model::Attributes& a = house.resolve();
  EXPECT_EQ(a.storeys.value, 5);
  EXPECT_EQ(a.storeys.source, Source::override_);
  EXPECT_NEAR(a.storey_height.value, 4, 0.01) << "the tagged height stays";
  ASSERT_FALSE(house.why(a.storeys.evidence).other_candidates.empty());
  EXPECT_EQ(house.why(a.storeys.evidence).other_candidates[0].value, "3");
  EXPECT_EQ(house.why(a.storeys.evidence).other_candidates[0].source, Source::tag);
  EXPECT_EQ(house.region.buildings[0].parts[0].attributes.storeys.source, Source::override_);
}

TEST(Overrides, AStoreyHeightIsStrongerThanATaggedHeight) {
  House house("[w1]\nstorey_height = 4.5\nroof_shape = \"flat\"\n");
  house.tags().storeys = 4;
  house.tags().height = 12;
  const model::Attributes& a = house.resolve();
  EXPECT_NEAR(a.height.value, 18, 0.01);
  EXPECT_NEAR(a.storey_height.value, 4.5, 1e-9);
  EXPECT_EQ(a.storey_height.source, Source::override_);
}

TEST(Overrides, EavesAndRoofMakeTheHeight) {
  House house("[w1]\neaves_height = 12\nroof_height = 4\nroof_shape = \"gabled\"\n");
  const model::Attributes& a = house.resolve();
  EXPECT_NEAR(a.height.value, 16, 0.01);
  EXPECT_NEAR(a.roof_height.value, 4, 0.01);
  EXPECT_EQ(a.eaves_height.value, 12);
}

TEST(Overrides, ASlopeBeatsATaggedFlatRoof) {
  House house("[w1]\nroof_pitch = 40\n");
  house.tags().roof_shape = RoofShape::flat;
  house.tags().storeys = 3;
  const model::Attributes& a = house.resolve();
  EXPECT_NE(a.roof_shape.value, RoofShape::flat);
  EXPECT_GT(a.roof_height.value, 2);
}

TEST(Overrides, PitchesOfSidesMakeTheRoof) {
  House house("[w1]\nroof_pitches = \"street 60, yard 30\"\n");
  house.tags().roof_shape = RoofShape::flat;
  house.tags().storeys = 3;
  const model::Attributes& a = house.resolve();
  EXPECT_NE(a.roof_shape.value, RoofShape::flat);
  EXPECT_GT(a.roof_height.value, 1);
  EXPECT_EQ(model::text(house.region.buildings[0].parts[0].side_pitches), "street 60, yard 30");
  EXPECT_THAT(house.why(a.roof_height.evidence).text, HasSubstr("street 60, yard 30"));
}

TEST(Overrides, WhatIsNotThereIsTold) {
  House house("[w1]\nstoreys = 3\n[w2]\nstoreys = 4\n[w1.w7]\nstoreys = 2\n");
  house.resolve();
  ASSERT_EQ(house.report.rows.size(), 2u);
  for (const model::ReportRow& row : house.report.rows) EXPECT_EQ(row.code, model::IssueCode::override_unmatched);
  EXPECT_THAT(house.report.rows[0].detail, HasSubstr("overrides.toml:3"));
  House detailed(
      "[w1]\nstoreys = 3\n[w1.storey.2]\nheight = 4\n[w1.storey.7]\nheight = 4\n[w1.edge.e11_12]\nkind = \"street\"\n"
      "[w1.edge.e1_2]\nkind = \"street\"\n[w1.bay.3]\nparameters = { window = \"triple\" }\n");
  detailed.resolve();
  EXPECT_EQ(detailed.region.buildings[0].detail_overrides.size(), 5u);
  std::string told;
  for (const model::ReportRow& row : detailed.region.report.rows)
    if (row.code == model::IssueCode::override_unmatched) told += row.detail + "\n";
  EXPECT_THAT(told, AllOf(HasSubstr("no storey 7"), HasSubstr("no edge e1_2")));
  EXPECT_EQ(std::count(told.begin(), told.end(), '\n'), 2);
}

TEST(Overrides, EveryMistakeIsToldAtItsPlace) {
  const std::vector<std::pair<const char*, std::vector<const char*>>> all = {
      {"[x1]\nstoreys = 3\n", {":1", "is no id"}},
      {"[w1]\nstoreis = 3\n", {":2", "unknown key", "storeys"}},
      {"[w1]\nstoreys = 500\n", {":2", "out of range"}},
      {"[w1]\nstoreys = \"3\"\n", {":2", "must be a number"}},
      {"[w1]\nroof_shape = \"gable\"\n", {":2", "Did you mean gabled"}},
      {"[w1]\nwall_colour = \"red\"\n", {":2", "#rrggbb"}},
      {"[w1]\nwall_material = \"brik\"\n", {":2", "Did you mean brick"}},
      {"[w1]\npreset = \"postwr\"\n", {":2", "Did you mean postwar"}},
      {"[w1]\nera = \"1900\"\n", {":2", "unknown"}},
      {"[w1]\nconstruction_date = \"old\"\n", {":2", "no year"}},
      {"[w1]\nheight = 12\nstorey_height = 3\n", {":3", "contradicts height"}},
      {"[w1]\nroof_pitches = \"front 30\"\n", {":2", "begins with no side"}},
      {"[w1]\nroof_shape = \"flat\"\nroof_pitches = \"street 30\"\n", {":3", "contradicts roof_shape"}},
      {"[w1]\nroof_height = 3\nroof_pitch = 30\n", {":3", "contradicts roof_height"}},
      {"[w1]\neaves_height = 12\n", {":2", "needs either"}},
      {"[w1]\nheight = 10\neaves_height = 12\n", {":3", "above the height"}},
      {"[w1]\nheight = 10\nroof_height = 12\n", {":3", "above the height"}},
      {"[w1]\nroof_shape = \"flat\"\nroof_height = 2\n", {":3", "flat roof has none"}},
      {"[w1]\nheight = 10\neaves_height = 8\nroof_shape = \"flat\"\n", {":3", "flat roof lie at the height"}},
      {"[w1]\neaves_height = 8\nroof_height = 2\nmin_height = 9\n", {":4", "above the eaves"}},
      {"[w1]\nheight = 10\nmin_height = 6\nroof_height = 5\n", {":4", "less min_height"}},
      {"[w1]\nheight = 10\nstoreys = 9\n", {":3", "contradicts height", "1.11 m"}},
      {"[w1]\nheight = 60\nstoreys = 2\nroof_shape = \"flat\"\n", {":3", "contradicts height", "30.00 m"}},
      {"[w1]\neaves_height = 10\nroof_height = 3\nstoreys = 8\n", {":4", "contradicts eaves_height"}},
      {"[w777]\n", {":1", "[w777] orders nothing"}},
      {"[w1]\nstoreys = 3\n[w1.w2]\n", {":3", "[w1.w2] orders nothing"}},
      {"[w1.storey]\n", {":1", "orders nothing"}},
      {"[w1.storey.ground]\nheight = 4\n", {":1", "no number"}},
      {"[w1.edge.7]\nkind = \"street\"\n", {":1", "no id of an edge"}},
      {"[w1.edge.e1_2]\nkind = \"road\"\n", {":2", "unknown"}},
      {"[w1.storey.1]\nheight = 40\n", {":2", "out of range"}},
      {"[w1.w2]\nstoreys = 1\n[w2]\nstoreys = 2\n", {"w2 stands twice"}},
  };
  for (const auto& [text, words] : all) {
    const std::string error = error_of(text);
    EXPECT_THAT(error, HasSubstr("overrides.toml")) << text;
    for (const char* word : words) EXPECT_THAT(error, HasSubstr(word)) << text;
  }
}

TEST(Parts, AnOrderHoldsWhereverItStandsAndIsToldWhereThatIsWrong) {
  for (const char* head : {"[w51]", "[w999.w51]"}) {
    House house(std::string(head) + "\nheight = 20\npreset = \"postwar\"\n[w1.w52]\nstoreys = 2\n");
    house.add_part(51);
    house.add_part(52);
    house.resolve();
    EXPECT_NEAR(house.part(0).height.value, 20, 1e-6);
    EXPECT_EQ(house.part(0).height.source, Source::override_) << head;
    EXPECT_EQ(house.part(0).preset.value, "postwar");
    EXPECT_EQ(house.part(1).storeys.source, Source::override_);
    const std::string told = house.told(model::IssueCode::override_unmatched);
    EXPECT_THAT(told, HasSubstr("w51 overrides.toml:1: it is a part of w1: write [w1.w51]")) << head;
    EXPECT_EQ(std::count(told.begin(), told.end(), '\n'), 1);
  }
  House alone("[w999.w1]\nheight = 20\nroof_shape = \"flat\"\n");
  alone.extract.buildings[0].kind = model::ObjectKind::building_part;
  EXPECT_EQ(alone.resolve().height.source, Source::override_);
  EXPECT_THAT(alone.told(model::IssueCode::override_unmatched), HasSubstr("no part of w999: write [w1]"));
}

TEST(Parts, WhatIsOrderedForTheHouseHoldsForThemUnlessTheyHaveOrders) {
  House house("[w1]\npreset = \"postwar\"\nstyle = \"modern\"\nera = \"" + std::string(model::kEraNames[3]) +
              "\"\nstoreys = 9\n[w1.w52]\npreset = \"gz_plain\"\nstyle = \"tenement\"\n");
  house.add_part(51);
  house.add_part(52);
  house.resolve();
  EXPECT_EQ(house.part(0).preset.value, "postwar");
  EXPECT_EQ(house.part(0).preset.source, Source::override_);
  EXPECT_EQ(house.part(0).style.value, "modern");
  EXPECT_NE(house.part(0).storeys.source, Source::override_) << "a part has heights of its own";
  EXPECT_EQ(house.part(1).preset.value, "gz_plain");
  EXPECT_EQ(house.part(1).style.value, "tenement");
  EXPECT_NE(house.part(1).era.source, Source::override_) << "the era belongs to the house's style";
}

TEST(Conflicts, TagsThatOrdersContradictGiveWayAndAreTold) {
  House squeezed("[w1]\nstoreys = 9\nroof_shape = \"flat\"\n");
  squeezed.tags().height = 10;
  const model::Attributes& a = squeezed.resolve();
  EXPECT_EQ(a.storeys.value, 9);
  EXPECT_EQ(a.storeys.source, Source::override_);
  EXPECT_GT(a.height.value, 20);
  EXPECT_NE(a.height.source, Source::tag);
  EXPECT_THAT(squeezed.told(model::IssueCode::values_conflict), HasSubstr("overrides.toml:1: height=10 is left aside"));

  House low("[w1]\nheight = 4\n");
  low.tags().roof_height = 5;
  low.tags().roof_shape = RoofShape::gabled;
  low.tags().storeys = 4;
  const model::Attributes& b = low.resolve();
  EXPECT_NEAR(b.height.value, 4, 1e-6);
  EXPECT_LT(b.roof_height.value, 4);
  EXPECT_GE(b.storey_height.value, 1.5);
  EXPECT_THAT(low.told(model::IssueCode::values_conflict),
              AllOf(HasSubstr("roof:height=5"), HasSubstr("building:levels=4")));

  House raised("[w1]\nmin_height = 12\n");
  raised.tags().height = 10;
  const model::Attributes& c = raised.resolve();
  EXPECT_EQ(c.min_height.value, 12);
  EXPECT_THAT(raised.told(model::IssueCode::values_conflict), HasSubstr("height=10"));
}

TEST(Conflicts, OnlyWhatIsOrderedHasTheSourceOverrideAndOnlyWhatIsTaggedTheSourceTag) {
  House skipped("[w1]\nstoreys = 2\n");
  skipped.tags().min_storey = 3;
  const model::Attributes& a = skipped.resolve();
  if (a.storeys.value != 2) {
    EXPECT_NE(a.storeys.source, Source::override_);
    EXPECT_THAT(skipped.told(model::IssueCode::values_conflict), HasSubstr("storeys = 2 cannot be met"));
  } else {
    EXPECT_EQ(a.storeys.source, Source::override_);
  }
  House pitched("[w1]\nroof_height = 4\nroof_shape = \"gabled\"\n");
  pitched.tags().storeys = 3;
  pitched.tags().roof_angle = 20;
  const model::Attributes& b = pitched.resolve();
  EXPECT_EQ(b.roof_height.source, Source::override_);
  EXPECT_NE(b.roof_pitch.source, Source::tag);
  EXPECT_NE(b.eaves_height.source, Source::tag);
  EXPECT_EQ(b.storeys.source, Source::tag);
  House plinth("[w1]\nplinth_height = 1.2\n");
  EXPECT_NEAR(plinth.resolve().plinth_height.value, 1.2, 1e-6);
}

TEST(Style, AnOrderedSubStyleBringsClassAndEra) {
  const classify::Style* wanted = catalogue().find("gz_high");
  if (!wanted)
    for (const classify::Style& s : catalogue().styles())
      if (s.style_class == model::StyleClass::gruenderzeit && !wanted) wanted = &s;
  ASSERT_TRUE(wanted);
  House house("[w1]\nroof_shape = \"flat\"\n");
  OverrideValue order{wanted->id, 2};
  house.overrides.entries[0].values.emplace("substyle", order);
  house.catalogue = &catalogue();
  const model::Attributes& a = house.resolve();
  EXPECT_EQ(a.substyle.source, Source::override_);
  EXPECT_EQ(a.style.value, "gruenderzeit");
  EXPECT_EQ(a.style.source, Source::implied);
  EXPECT_THAT(house.why(a.style.evidence).text, HasSubstr("overrides.toml:2: of the ordered sub-style"));
  EXPECT_EQ(a.era.value, model::name(model::era_of((wanted->years.from + wanted->years.to) / 2)));
}

TEST(Style, AnOrderedClassLeavesNoSubStyleOfAnother) {
  House house("[w1]\nstyle = \"modern\"\nera = \"" + std::string(model::kEraNames[3]) + "\"\n");
  house.catalogue = &catalogue();
  const model::Attributes& a = house.resolve();
  EXPECT_EQ(a.style.source, Source::override_);
  const classify::Style* s = catalogue().find(a.substyle.value);
  ASSERT_TRUE(s);
  EXPECT_EQ(s->style_class, model::StyleClass::modern);
  EXPECT_GE(model::era_of(s->years.to), model::Era{3});
  EXPECT_THAT(house.why(a.substyle.evidence).text, HasSubstr("the first of the ordered class modern"));
}

}  // namespace
}  // namespace blockrand::attributes
