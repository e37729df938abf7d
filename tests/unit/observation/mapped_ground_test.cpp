// What the map covers of a picture: buildings as far as they lean, streets, car parks; not what runs below.
#include "pipeline/observation/mapped_ground.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

#include "pipeline/georef/crs.h"

namespace blockrand::observation {
namespace {

using model::Point2;

georef::Projection berlin() {
  const georef::GeoBox box{13.3, 52.4, 13.5, 52.6};
  return {georef::open_crs("EPSG:25833", box), box};
}

/// A place of which the map has what a test draws, in metres from its middle.
struct Place {
  Place() : projection(berlin()), middle(projection.forward(13.4, 52.5)), store(1) {
    middle = {std::round(middle.x), std::round(middle.y)};
    footprints::StoredFootprint f;
    f.id = {model::OsmType::way, 1};
    model::Polygon p;
    p.outer.points = {
        {middle.x - 10, middle.y - 10}, {middle.x, middle.y - 10}, {middle.x, middle.y}, {middle.x - 10, middle.y}};
    p.outer.nodes.assign(4, 0);
    store.set(0, f, {&p, 1});
    index = footprints::index_of(store);
  }
  void draw(model::FeatureKind kind, bool area, const std::map<std::string, std::string>& tags,
            const std::vector<Point2>& line) {
    model::Feature f;
    f.kinds = static_cast<std::uint32_t>(kind), f.area = area;
    f.tags.first = static_cast<std::uint32_t>(extract.tags.size());
    for (const auto& [key, value] : tags)
      extract.tags.push_back({extract.strings.intern(key), extract.strings.intern(value)});
    f.tags.count = static_cast<std::uint32_t>(tags.size());
    f.rings = {static_cast<std::uint32_t>(extract.rings.size()), 1};
    model::MappedRing ring;
    ring.vertices = {static_cast<std::uint32_t>(extract.vertices.size()), static_cast<std::uint32_t>(line.size())};
    extract.rings.push_back(ring);
    for (const Point2 p : line) {
      const georef::LonLat at = projection.inverse({middle.x + p.x, middle.y + p.y});
      extract.vertices.push_back(
          {static_cast<std::int32_t>(std::lround(at.lon * 1e7)), static_cast<std::int32_t>(std::lround(at.lat * 1e7))});
    }
    extract.features.push_back(f);
  }
  /// What covers a place, in metres from the middle.
  Mapped at(Point2 p, Point2 lean = {}) const {
    const MappedGround ground(extract, store, index, projection, [&](std::uint32_t) { return lean; }, {});
    Patch patch;
    patch.size = 0.5, patch.width = patch.height = 160;
    patch.west = middle.x - 40, patch.north = middle.y + 40;
    patch.valid.assign(160 * 160, 1);
    const auto column = static_cast<std::size_t>((p.x + 40) / 0.5), row = static_cast<std::size_t>((40 - p.y) / 0.5);
    return ground.on(patch)[row * 160 + column];
  }
  georef::Projection projection;
  Point2 middle;
  model::Extract extract;
  footprints::FootprintStore store;
  footprints::BoxIndex index;
};

TEST(MappedGround, BuildingsAndALittleAboutThem) {
  const Place place;
  EXPECT_EQ(place.at({-5, -5}), Mapped::building);
  EXPECT_EQ(place.at({1, -5}), Mapped::building) << "maps are not exact";
  EXPECT_EQ(place.at({3, -5}), Mapped::nothing);
}

TEST(MappedGround, RoofsThatLeanAndTheWallsBelowThem) {
  const Place place;
  EXPECT_EQ(place.at({5, -5}, {6, 0}), Mapped::building) << "the roof";
  EXPECT_EQ(place.at({9, -5}, {6, 0}), Mapped::building) << "it may be higher than it was guessed";
  EXPECT_EQ(place.at({-9, -5}, {6, 0}), Mapped::building) << "the ground of the house";
  EXPECT_EQ(place.at({13, -5}, {6, 0}), Mapped::nothing);
}

TEST(MappedGround, StreetsByTheirKind) {
  Place place;
  place.draw(model::FeatureKind::street, false, {{"highway", "residential"}}, {{-30, 20}, {30, 20}});
  place.draw(model::FeatureKind::street, false, {{"highway", "footway"}}, {{-30, 30}, {30, 30}});
  EXPECT_EQ(place.at({0, 22}), Mapped::ground);
  EXPECT_EQ(place.at({0, 24}), Mapped::nothing);
  EXPECT_EQ(place.at({0, 30}), Mapped::nothing) << "houses stand at paths, and over them";
}

TEST(MappedGround, WhatRunsBelowCoversNothing) {
  Place place;
  place.draw(model::FeatureKind::railway, false, {{"railway", "rail"}, {"tunnel", "yes"}}, {{-30, 20}, {30, 20}});
  place.draw(model::FeatureKind::street, false, {{"highway", "primary"}, {"layer", "-1"}}, {{-30, 30}, {30, 30}});
  EXPECT_EQ(place.at({0, 20}), Mapped::nothing);
  EXPECT_EQ(place.at({0, 30}), Mapped::nothing);
}

TEST(MappedGround, AreasOnWhichNoHouseStands) {
  Place place;
  const auto square = [](double x) { return std::vector<Point2>{{x, 10}, {x + 8, 10}, {x + 8, 18}, {x, 18}}; };
  place.draw(model::FeatureKind::amenity, true, {{"amenity", "parking"}}, square(-30));
  place.draw(model::FeatureKind::amenity, true, {{"amenity", "school"}}, square(-10));
  place.draw(model::FeatureKind::water, true, {{"natural", "water"}}, square(10));
  EXPECT_EQ(place.at({-26, 14}), Mapped::ground);
  EXPECT_EQ(place.at({-6, 14}), Mapped::nothing) << "a school has houses";
  EXPECT_EQ(place.at({14, 14}), Mapped::ground);
}

TEST(MappedGround, ALineOfOnePointIsNoStreet) {
  Place place;
  place.draw(model::FeatureKind::street, false, {{"highway", "residential"}}, {{0, 20}});
  place.draw(model::FeatureKind::street, false, {{"highway", "residential"}}, {});
  EXPECT_EQ(place.at({0, 20}), Mapped::nothing);
}

}  // namespace
}  // namespace blockrand::observation
