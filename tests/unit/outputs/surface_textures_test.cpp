// Textures on walls, roofs and ground: level courses that turn corners, rows up the slope, colours that stay what they are.
#include "pipeline/outputs/gltf/surface_textures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "pipeline/outputs/gltf/linear_light.h"

namespace blockrand::outputs {
namespace {

using model::Point2;
using model::Point3;
using textures::TextureCatalogue;

TextureCatalogue catalogue() {
  return TextureCatalogue::read(std::string(BLOCKRAND_SOURCE_DIR) + "/configs/materials/textures.toml");
}

/// A house of 10.1 m by 7.3 m with its ground at 2 m: the faces of its walls, two roof sides and a flat terrace.
class House : public ::testing::Test {
 protected:
  House() {
    outlines_.push_back({{{0, 0}, {10.1, 0}, {10.1, 7.3}, {0, 7.3}}, {0, 10.1, 17.4, 27.5, 34.8}, 2});
    mesh_.primitives.resize(1);
    quad({0, 0, 2}, {10.1, 0, 2}, {10.1, 0, 9}, {0, 0, 9}, {0, -127, 0}, brick_);
    quad({10.1, 0, 2}, {10.1, 7.3, 2}, {10.1, 7.3, 9}, {10.1, 0, 9}, {127, 0, 0}, brick_);
    quad({10.1, 7.3, 2}, {0, 7.3, 2}, {0, 7.3, 9}, {10.1, 7.3, 9}, {0, 127, 0}, brick_);
    quad({0, 7.3, 2}, {0, 0, 2}, {0, 0, 9}, {0, 7.3, 9}, {-127, 0, 0}, brick_);
    quad({0, 0, 9}, {10.1, 0, 9}, {10.1, 3.65, 12.65}, {0, 3.65, 12.65}, {0, -90, 90}, tiles_);
    quad({0, 7.3, 1}, {0, 0, 1}, {10.1, 0, 1}, {10.1, 7.3, 1}, {0, 0, -127}, brick_);  // an underside
    mesh_.solid_positions = mesh_.positions.size();
  }

  void quad(const Point3& a, const Point3& b, const Point3& c, const Point3& d, std::array<std::int8_t, 3> normal,
            const model::PartMaterial& look) {
    MeshPrimitive& p = mesh_.primitives[0];
    const auto first = static_cast<std::uint16_t>(p.vertices.size());
    for (const Point3& at : {a, b, c, d}) {
      MeshVertex v;
      v.position = static_cast<std::uint32_t>(mesh_.positions.size());
      v.normal = normal, v.look = look;
      mesh_.positions.push_back(at);
      p.vertices.push_back(v);
    }
    for (const int i : {0, 1, 2, 0, 2, 3}) p.indices.push_back(static_cast<std::uint16_t>(first + i));
  }

  std::vector<MeshPrimitive> split() {
    textures_.emplace(set_, SurfaceTextures::Of::buildings, classes_, outlines_, "textures/");
    return textures_->split(mesh_.primitives[0], mesh_);
  }

  const MeshPrimitive& of(const std::vector<MeshPrimitive>& all, std::string_view material) {
    for (const MeshPrimitive& p : all)
      if (p.texture >= 0 && classes_[p.look.material].name == material) return p;
    throw std::runtime_error("no such primitive");
  }

  TextureCatalogue catalogue_ = catalogue();
  TextureSet set_{catalogue_, textures::TextureSize::small};
  std::vector<model::MaterialClass> classes_ = {{"brick"}, {"roof_tiles"}, {"glass"}};
  model::PartMaterial brick_{0, {0x8f, 0x5a, 0x48}}, tiles_{1, {0x8f, 0x4a, 0x36}};
  std::vector<CourseOutline> outlines_;
  std::optional<SurfaceTextures> textures_;
  Mesh mesh_;
};

double fraction(double v) { return v - std::floor(v); }

TEST_F(House, EveryTriangleIsThereOnce) {
  const auto parts = split();
  std::size_t indices = 0;
  for (const MeshPrimitive& p : parts) {
    indices += p.indices.size();
    EXPECT_EQ(p.repeats.size(), p.texture >= 0 ? p.vertices.size() : 0u);
    for (const auto i : p.indices) ASSERT_LT(i, p.vertices.size());
  }
  EXPECT_EQ(indices, mesh_.primitives[0].indices.size());
  EXPECT_EQ(parts[0].indices.size(), 6u) << "the underside is plain";
  EXPECT_THAT(textures_->used(), ::testing::SizeIs(2));
}

TEST_F(House, CoursesStartAtTheGroundAndAreLevel) {
  const auto parts = split();
  const MeshPrimitive& walls = of(parts, "brick");
  const double height = set_.row(walls.texture).height;
  for (std::size_t i = 0; i < walls.vertices.size(); ++i) {
    const double z = mesh_.positions[walls.vertices[i].position].z;
    EXPECT_NEAR(fraction(-static_cast<double>(walls.repeats[i][1]) + 0.5), fraction((z - 2) / height + 0.5), 1e-5);
  }
}

TEST_F(House, CoursesTurnCornersInWholeStones) {
  const auto parts = split();
  const MeshPrimitive& walls = of(parts, "brick");
  // Walls meet in corners: the end of one and the start of the next are the same place of the picture, up to whole stones.
  const double stones = set_.row(walls.texture).width / set_.row(walls.texture).stone_width;
  std::size_t met = 0;
  for (std::size_t i = 0; i < walls.vertices.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) {
      const Point3 &a = mesh_.positions[walls.vertices[i].position], &b = mesh_.positions[walls.vertices[k].position];
      if (!(a == b)) continue;
      ++met;
      const double apart =
          (static_cast<double>(walls.repeats[i][0]) - static_cast<double>(walls.repeats[k][0])) * stones;
      EXPECT_NEAR(apart, std::nearbyint(apart), 1e-3);
    }
  EXPECT_EQ(met, 8u);
}

TEST_F(House, AStretchOfWallsIsSmall) {
  const auto parts = split();
  const MeshPrimitive& walls = of(parts, "brick");
  const double metres = static_cast<double>(walls.repeats[1][0] - walls.repeats[0][0]) * set_.row(walls.texture).width;
  EXPECT_NEAR(metres, 10.1, 10.1 * 0.125 / 34.8 + 1e-4)
      << "to the right as seen from outside, half a stone around the house";
}

TEST_F(House, RowsOfTilesFollowTheSlopeFromTheEaves) {
  const auto parts = split();
  const MeshPrimitive& roof = of(parts, "roof_tiles");
  const textures::TextureRow& row = set_.row(roof.texture);
  ASSERT_EQ(roof.vertices.size(), 4u);
  const double up = static_cast<double>(roof.repeats[0][1] - roof.repeats[3][1]) * row.height;
  EXPECT_NEAR(up, std::hypot(3.65, 3.65), 1e-4) << "measured on the slope";
  EXPECT_NEAR(fraction(static_cast<double>(roof.repeats[0][1]) + 0.5), 0.5, 1e-4) << "rows begin at the eaves";
}

TEST_F(House, TooLightColoursStayPlainAndAreCounted) {
  for (MeshVertex& v : mesh_.primitives[0].vertices)
    if (v.look == brick_) v.look.colour = {255, 255, 255};
  const auto parts = split();
  EXPECT_EQ(textures_->too_light(), 8u);
  EXPECT_EQ(parts[0].indices.size(), 30u);
}

TEST_F(House, ElementsAreNotTextured) {
  mesh_.solid_positions = 16;
  const auto parts = split();
  EXPECT_EQ(parts[0].indices.size(), 12u) << "the roof and the underside";
}

TEST_F(House, WhatIsTooLongForTheReachIsFarOrPlain) {
  for (Point3& p : mesh_.positions) p.x *= 40;
  const auto parts = split();
  EXPECT_GT(of(parts, "brick").reach, 64.f) << "404 m of wall";
  for (Point3& p : mesh_.positions) p.x *= 10;
  for (const MeshPrimitive& p : split())
    for (const auto& at : p.repeats) EXPECT_LE(at[0], p.reach);
}

TEST(SurfaceTextures, GroundGoesThroughTilesAlike) {
  const TextureCatalogue file = catalogue();
  const TextureSet set(file, textures::TextureSize::small);
  const std::vector<model::MaterialClass> classes = {{"asphalt"}};
  // One corner of the CRS in two meshes with other origins.
  const auto repeats = [&](double east, double north) {
    Mesh mesh;
    mesh.primitives.resize(1);
    for (const Point2 p :
         {Point2{4500000.25, 5800000.5}, Point2{4500000.25 + east, 5800000.5}, Point2{4500000.25, 5800000.5 + north}}) {
      MeshVertex v;
      v.position = static_cast<std::uint32_t>(mesh.positions.size());
      v.normal = {0, 0, 127}, v.look.colour = {0x6b, 0x6b, 0x6c};
      mesh.positions.push_back({p.x - 4500000, p.y - 5800000, 0});
      mesh.plan.push_back(p);
      mesh.primitives[0].vertices.push_back(v);
    }
    if (east * north < 0) std::swap(mesh.primitives[0].vertices[1], mesh.primitives[0].vertices[2]);
    mesh.primitives[0].indices = {0, 1, 2};
    mesh.solid_positions = 3;
    SurfaceTextures textures(set, SurfaceTextures::Of::ground, classes, {}, "textures/");
    const auto parts = textures.split(mesh.primitives[0], mesh);
    EXPECT_EQ(parts.size(), 2u);
    return parts.at(1).repeats.at(0);
  };
  const auto a = repeats(40, 30), b = repeats(-100, -20);
  for (std::size_t k = 0; k < 2; ++k)
    EXPECT_NEAR(fraction(static_cast<double>(a[k]) + 0.5), fraction(static_cast<double>(b[k]) + 0.5), 1e-4);
}

}  // namespace
}  // namespace blockrand::outputs
