// What an aerial image shows of a roof: weaker than tags, stronger than what is usual.
#include <gtest/gtest.h>

#include <string>

#include "pipeline/attributes/resolve.h"

namespace blockrand::attributes {
namespace {

using model::Attributes;
using model::Colour;
using model::RoofOrientation;
using model::RoofShape;
using model::Source;

constexpr Colour kSeen{150, 60, 40}, kTagged{10, 20, 30};

class SeenRoof : public testing::Test {
 protected:
  SeenRoof() : defaults_(read_defaults(std::string(BLOCKRAND_SOURCE_DIR) + "/configs")) {
    building_.osm = {model::OsmType::way, 1};
    model::Polygon plan;
    plan.outer.points = {{0, 0}, {14, 0}, {14, 9}, {0, 9}};
    plan.outer.nodes.assign(4, 0);
    building_.outline = {plan};
    building_.mapped.use = extract_.strings.intern("house");
  }
  template <class T>
  static model::InferredCandidate<T> seen(T value) {
    return {value, Source::imagery, 0.9f, "seen in ortho.tif"};
  }
  const Attributes& resolve() {
    model::BuildingPart part;
    part.osm = building_.osm;
    part.plan = building_.outline[0];
    part.mapped = building_.mapped;
    building_.parts = {part};
    region_.extract = &extract_;
    region_.buildings = {building_};
    const context::TaggedNeighbours nobody({}, 100);
    resolve_attributes(region_,
                       {defaults_, nobody, 1, [](const model::Building&) { return context::BuildingGround(); }}, {});
    return region_.buildings[0].parts[0].attributes;
  }
  std::string why(std::uint32_t evidence) const { return region_.evidence[evidence].text; }

  Defaults defaults_;
  model::Extract extract_;
  model::Building building_;
  model::Region region_;
};

TEST_F(SeenRoof, ItsColourIsTakenWhereNobodyTaggedOne) {
  building_.seen_roof.colour = seen(kSeen);
  const Attributes& a = resolve();
  EXPECT_EQ(a.roof_colour.value, kSeen);
  EXPECT_EQ(a.roof_colour.source, Source::imagery);
  EXPECT_FLOAT_EQ(a.roof_colour.confidence, 0.9f);
  EXPECT_EQ(why(a.roof_colour.evidence), "seen in ortho.tif");
  EXPECT_NE(a.wall_colour.source, Source::imagery);
}

TEST_F(SeenRoof, TagsAreStronger) {
  building_.seen_roof = {seen(kSeen), seen(true), seen(90.0), seen(9.0)};
  building_.mapped.roof_colour = kTagged;
  building_.mapped.roof_shape = RoofShape::hipped;
  building_.mapped.roof_orientation = RoofOrientation::across;
  const Attributes& a = resolve();
  EXPECT_EQ(a.roof_colour.value, kTagged);
  EXPECT_EQ(a.roof_shape.value, RoofShape::hipped);
  EXPECT_EQ(a.roof_orientation.value, RoofOrientation::across);
  ASSERT_FALSE(region_.evidence[a.roof_colour.evidence].other_candidates.empty());
  EXPECT_EQ(region_.evidence[a.roof_colour.evidence].other_candidates[0].source, Source::imagery)
      << "it is told as lost";
}

TEST_F(SeenRoof, FlatIsFlatAndSlopesAreTheUsualOnes) {
  const RoofShape usual = resolve().roof_shape.value;
  ASSERT_NE(usual, RoofShape::flat);
  building_.seen_roof.pitched = seen(false);
  EXPECT_EQ(resolve().roof_shape.value, RoofShape::flat);
  EXPECT_EQ(resolve().roof_shape.source, Source::imagery);
  building_.seen_roof.pitched = seen(true);
  EXPECT_EQ(resolve().roof_shape.value, usual);
  EXPECT_EQ(resolve().roof_shape.source, Source::imagery);
  building_.mapped.use = extract_.strings.intern("garage");  // usually flat
  EXPECT_EQ(resolve().roof_shape.value, RoofShape::gabled);
}

TEST_F(SeenRoof, TheRidgeRunsWhereItIsSeen) {
  building_.seen_roof.pitched = seen(true);
  for (const auto& [degrees, orientation] :
       {std::pair(90.0, RoofOrientation::along), std::pair(70.0, RoofOrientation::along),
        std::pair(0.0, RoofOrientation::across), std::pair(175.0, RoofOrientation::across)}) {
    building_.seen_roof.ridge = seen(degrees);
    EXPECT_EQ(resolve().roof_orientation.value, orientation) << degrees;
    EXPECT_EQ(resolve().roof_orientation.source, Source::imagery) << degrees;
  }
  building_.seen_roof.ridge = seen(45.0);
  EXPECT_NE(resolve().roof_orientation.source, Source::imagery) << "neither along nor across";
}

TEST_F(SeenRoof, AShadowTellsStoreysWhereNobodyCountedThem) {
  const double usual = resolve().storeys.value, storey = resolve().storey_height.value;
  for (const double storeys : {1.0, 2.0, 3.0, 5.0}) {
    building_.seen_roof.eaves = seen(storeys * storey + 0.4);
    const Attributes& a = resolve();
    EXPECT_DOUBLE_EQ(a.storeys.value, storeys);
    EXPECT_EQ(a.storeys.source, Source::imagery);
    EXPECT_NEAR(a.eaves_height.value, storeys * storey, 1) << "what stands on them follows";
  }
  building_.seen_roof.eaves = seen(0.3);
  EXPECT_DOUBLE_EQ(resolve().storeys.value, 1) << "no house has none";
  building_.seen_roof.eaves = seen(5 * storey);
  building_.mapped.storeys = 2.0F;
  EXPECT_EQ(resolve().storeys.source, Source::tag);
  EXPECT_DOUBLE_EQ(resolve().storeys.value, 2);
  building_.mapped.storeys.reset();
  building_.seen_roof = {};
  EXPECT_DOUBLE_EQ(resolve().storeys.value, usual);
}

TEST_F(SeenRoof, OfMappedPartsTheImageShowsNoForm) {
  building_.seen_roof = {seen(kSeen), seen(false), seen(0.0), seen(30.0)};
  building_.has_mapped_parts = true;
  const Attributes& a = resolve();
  EXPECT_NE(a.roof_shape.source, Source::imagery);
  EXPECT_NE(a.roof_orientation.source, Source::imagery);
  EXPECT_NE(a.storeys.source, Source::imagery);
}

}  // namespace
}  // namespace blockrand::attributes
