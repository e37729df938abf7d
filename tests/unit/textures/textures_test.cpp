#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <webp/decode.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/base/error.h"
#include "pipeline/base/sha256.h"
#include "pipeline/base/toml_file.h"
#include "pipeline/textures/texture.h"
#include "pipeline/textures/texture_catalogue.h"
#include "pipeline/textures/texture_files.h"

namespace blockrand::textures {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const std::string kConfigs = std::string(BLOCKRAND_SOURCE_DIR) + "/configs/";

const TextureCatalogue& shipped() {
  static const TextureCatalogue read = TextureCatalogue::read(kConfigs + "materials/textures.toml");
  return read;
}

const TextureRow& row_of(std::string_view name) {
  for (const TextureRow& row : shipped().rows())
    if (row.name == name) return row;
  throw std::logic_error("no such row: " + std::string(name));
}

/// Made once: it takes most of the time of these tests.
const TextureMaps& full(const TextureRow& row) {
  static std::map<std::string, TextureMaps> made;
  const auto found = made.find(row.name);
  return found != made.end() ? found->second : made.emplace(row.name, make_maps(row, TextureSize::full)).first->second;
}

double linear(std::uint8_t value) {
  const double e = value / 255.0;
  return e <= 0.04045 ? e / 12.92 : std::pow((e + 0.055) / 1.055, 2.4);
}

/// Mean linear light of green in each of cells x cells squares.
std::vector<double> cells_of(const TextureMaps& maps, int cells) {
  std::array<double, 256> table;
  for (int i = 0; i < 256; ++i) table[i] = linear(static_cast<std::uint8_t>(i));
  std::vector<double> out(static_cast<std::size_t>(cells) * cells);
  const int size = maps.pixels / cells;
  for (int y = 0; y < maps.pixels; ++y)
    for (int x = 0; x < maps.pixels; ++x)
      out[y / size * cells + x / size] += table[maps.base[(static_cast<std::size_t>(y) * maps.pixels + x) * 3 + 1]];
  for (double& cell : out) cell /= size * size;
  return out;
}

/// The largest share by which one of cells x cells squares differs from the mean.
double unevenness(const TextureMaps& maps, int cells) {
  double worst = 0;
  for (const double cell : cells_of(maps, cells)) worst = std::max(worst, std::abs(cell / maps.mean[1] - 1));
  return worst;
}

/// Mean difference between each row (or column) and the next; the last is that across the border.
std::vector<double> steps(const std::vector<std::uint8_t>& rgb, int n, bool columns) {
  std::vector<double> out(n);
  for (int line = 0; line < n; ++line)
    for (int i = 0; i < n; ++i)
      for (int c = 0; c < 3; ++c) {
        const auto at = [&](int l) {
          const int x = columns ? l : i, y = columns ? i : l;
          return static_cast<int>(rgb[(static_cast<std::size_t>(y) * n + x) * 3 + c]);
        };
        out[line] += std::abs(at(line) - at((line + 1) % n)) / (3.0 * n);
      }
  return out;
}

std::string hash_of(const TextureMaps& maps) {
  base::Sha256 sum;
  for (const auto* map : {&maps.base, &maps.normal, &maps.orm})
    sum.add({reinterpret_cast<const char*>(map->data()), map->size()});
  return sum.finish();
}

/// What is laid of pieces: neighbours may differ.
bool laid(Pattern p) {
  const std::set<Pattern> pieces{Pattern::bond,     Pattern::cross_bond,  Pattern::ashlar, Pattern::rubble,
                                 Pattern::setts,    Pattern::cyclopean,   Pattern::slates, Pattern::cobbles,
                                 Pattern::pantiles, Pattern::plain_tiles, Pattern::flags};
  return pieces.contains(p);
}
/// What lies in laps: it slopes against the roof.
bool lapped(Pattern p) { return p == Pattern::pantiles || p == Pattern::plain_tiles || p == Pattern::slates; }

TEST(Textures, ShippedFileNamesMaterialsOfTheCatalogues) {
  auto classes = base::TomlTable::read(kConfigs + "materials/materials.toml");
  auto grounds = base::TomlTable::read(kConfigs + "surroundings.toml");
  const std::vector<std::string> of_buildings = classes.table("class")->keys();
  const std::vector<std::string> of_grounds = grounds.table("material")->keys();
  for (const Surface surface : {Surface::wall, Surface::roof})
    for (const std::string& material : shipped().materials(surface))
      EXPECT_THAT(of_buildings, testing::Contains(material));
  for (const std::string& material : shipped().materials(Surface::ground))
    EXPECT_THAT(of_grounds, testing::Contains(material));
  for (const char* material : {"plaster", "brick", "stone", "concrete", "wood", "metal", "copper", "slate"})
    EXPECT_GE(shipped().find(Surface::wall, material), 0) << material;
  for (const char* material : {"roof_tiles", "slate", "bitumen", "metal", "copper", "stone", "gravel", "concrete"})
    EXPECT_GE(shipped().find(Surface::roof, material), 0) << material;
  for (const char* material : {"asphalt", "concrete", "paving_stones", "sett", "cobblestone", "gravel", "fine_gravel",
                               "grass", "meadow", "sand", "ground", "tartan", "artificial_turf", "rock", "field"})
    EXPECT_GE(shipped().find(Surface::ground, material), 0) << material;
  for (const char* material : {"glass", "plastic"}) EXPECT_EQ(shipped().find(Surface::wall, material), -1);
  for (const char* material : {"water", "leaves_dark", "lacquer_red"})
    EXPECT_EQ(shipped().find(Surface::ground, material), -1);
  EXPECT_EQ(shipped().rows()[shipped().find(Surface::wall, "brick")].name, "brick");
  EXPECT_EQ(shipped().rows()[shipped().find(Surface::ground, "sett")].name, "setts");
}

TEST(Textures, AreFineEnoughAndLargeEnough) {
  constexpr double kLeast = 2.5;  // m: a repeat is not seen from 30 m
  for (const TextureRow& row : shipped().rows()) {
    EXPECT_GE(std::min(row.width, row.height), kLeast) << row.name;
    const double pixel = std::max(row.width, row.height) / row.pixels;
    EXPECT_LE(pixel, 0.02) << row.name;
    if (row.pattern == Pattern::bond || row.pattern == Pattern::cross_bond) {
      // Joints take two pixels at least, each of 5 mm and the rest of a height of 32 courses.
      EXPECT_LE(pixel, 0.00525) << row.name;
      EXPECT_GE(row.joint / pixel, 1.9) << row.name;
    }
  }
}

TEST(Textures, MapsHaveTheirSizes) {
  for (const TextureRow& row : shipped().rows()) {
    const TextureMaps& maps = full(row);
    const std::size_t bytes = static_cast<std::size_t>(row.pixels) * row.pixels * 3;
    EXPECT_EQ(maps.pixels, row.pixels) << row.name;
    EXPECT_EQ(maps.base.size(), bytes) << row.name;
    EXPECT_EQ(maps.normal.size(), bytes) << row.name;
    EXPECT_EQ(maps.orm.size(), bytes) << row.name;
    double roughness = 0;
    for (std::size_t i = 0; i < bytes; i += 3) {
      ASSERT_EQ(maps.orm[i], 255) << row.name;
      ASSERT_NEAR(maps.orm[i + 2], row.metallic * 255, 1) << row.name;
      roughness += maps.orm[i + 1];
    }
    EXPECT_NEAR(roughness / (bytes / 3.0) / 255, row.roughness, 0.05) << row.name;
  }
}

TEST(Textures, MeanIsExactAndHigh) {
  for (const TextureRow& row : shipped().rows()) {
    const TextureMaps& maps = full(row);
    std::array<double, 3> sum{};
    int brightest = 0;
    for (std::size_t i = 0; i < maps.base.size(); ++i) {
      sum[i % 3] += linear(maps.base[i]);
      brightest = std::max<int>(brightest, maps.base[i]);
    }
    // So that colour / mean stays a colour for light plasters.
    const bool wall = row.pattern == Pattern::bond || row.pattern == Pattern::cross_bond ||
                      row.pattern == Pattern::ashlar || row.pattern == Pattern::rubble ||
                      row.pattern == Pattern::boards || row.pattern == Pattern::metal;
    const double least = row.pattern == Pattern::plaster || row.pattern == Pattern::concrete ? 0.93 : wall ? 0.8 : 0.75;
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(maps.mean[c], sum[c] / (maps.base.size() / 3.0), 1e-9) << row.name;
      EXPECT_GE(maps.mean[c], least) << row.name;
      EXPECT_NEAR(maps.mean[c], maps.mean[1], 0.03) << row.name << ": a grain has hardly a hue of its own";
    }
    EXPECT_GE(brightest, 245) << row.name;
  }
}

TEST(Textures, Wrap) {
  // The border is one of many lines: it may differ from its neighbour as the most different of them, and a third more,
  // for joints begin right at the border and elsewhere within a pixel.
  constexpr double kMore = 1.3, kLevels = 0.5;
  for (const TextureRow& row : shipped().rows()) {
    const TextureMaps& maps = full(row);
    for (const auto* map : {&maps.base, &maps.normal, &maps.orm})
      for (const bool columns : {false, true}) {
        std::vector<double> all = steps(*map, maps.pixels, columns);
        const double border = all.back();
        all.pop_back();
        EXPECT_LE(border, *std::max_element(all.begin(), all.end()) * kMore + kLevels)
            << row.name << (columns ? " left and right" : " top and bottom");
        // Where nothing but grains lies on the border, it differs as any line does.
        if (laid(row.pattern) || row.stone_width > 1 || row.pattern == Pattern::boards ||
            row.pattern == Pattern::metal || row.pattern == Pattern::felt)
          continue;
        std::sort(all.begin(), all.end());
        EXPECT_LE(border, all[all.size() / 2] * 1.25 + kLevels) << row.name;
      }
  }
}

TEST(Textures, BricksThatCrossTheBorderAreWhole) {
  const TextureRow& row = row_of("brick_stretchers");
  const TextureMaps& maps = full(row);
  const auto light_of = [&](int course, int first) {  // 12 columns, of the middle of a course
    constexpr int kColumns = 12;
    double sum = 0;
    int count = 0;
    for (double y = 0.03; y < 0.06; y += 0.004)
      for (int x = first; x < first + kColumns; ++x, ++count) {
        const int line = maps.pixels - 1 - static_cast<int>((course * row.stone_height + y) / row.height * maps.pixels);
        sum += linear(maps.base[(static_cast<std::size_t>(line) * maps.pixels + x) * 3 + 1]);
      }
    return sum / count;
  };
  // Each second course has a brick across the border. Its halves differ by their mottle alone; two bricks by more.
  double whole = 0, two = 0;
  for (int course = 1; course < 30; course += 2) {
    whole += std::abs(light_of(course, 2) - light_of(course, maps.pixels - 14)) / 15;
    two += std::abs(light_of(course, 2) - light_of(course, 40)) / 15;
  }
  EXPECT_LT(whole, 0.02);
  EXPECT_GT(two, 2 * whole);
}

TEST(Textures, NormalsAreUnitVectorsAroundTheSurface) {
  for (const TextureRow& row : shipped().rows()) {
    const TextureMaps& maps = full(row);
    std::array<double, 3> sum{};
    double shortest = 2, longest = 0;
    for (std::size_t i = 0; i < maps.normal.size(); i += 3) {
      std::array<double, 3> n;
      for (int c = 0; c < 3; ++c) sum[c] += n[c] = maps.normal[i + c] / 127.5 - 1;
      const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
      shortest = std::min(shortest, length);
      longest = std::max(longest, length);
      ASSERT_GT(n[2], 0) << row.name;
    }
    // Half a level of 127.5 in each of three directions.
    EXPECT_GT(shortest, 0.99) << row.name;
    EXPECT_LT(longest, 1.01) << row.name;
    const double count = maps.normal.size() / 3.0;
    EXPECT_NEAR(sum[0] / count, 0, 0.03) << row.name;
    // Laps slope one way over their length; steep edges count little, for their normals are short in that direction.
    EXPECT_NEAR(sum[1] / count, 0, lapped(row.pattern) ? 0.09 : 0.03) << row.name;
    EXPECT_GT(sum[2] / count, 0.8) << row.name;
  }
}

TEST(Textures, FlatHeightsHaveFlatNormals) {
  for (TextureRow row : shipped().rows()) {
    row.depth = 0;
    const TextureMaps maps = make_maps(row, TextureSize::small);
    for (std::size_t i = 0; i < maps.normal.size(); i += 3) {
      ASSERT_EQ(maps.normal[i], 128) << row.name;
      ASSERT_EQ(maps.normal[i + 1], 128) << row.name;
      ASSERT_EQ(maps.normal[i + 2], 255) << row.name;
    }
  }
}

TEST(Textures, SlopesAreMetric) {
  TextureRow row = row_of("plaster_rough");
  const auto slope = [](const TextureMaps& maps, int axis) {
    double sum = 0;
    for (std::size_t i = 0; i < maps.normal.size(); i += 3) {
      const double s = (maps.normal[i + axis] / 127.5 - 1) / (maps.normal[i + 2] / 127.5 - 1);
      sum += s * s;
    }
    return std::sqrt(sum / (maps.normal.size() / 3.0));
  };
  const TextureMaps once = full(row);
  row.depth *= 2;
  EXPECT_NEAR(slope(make_maps(row, TextureSize::full), 0) / slope(once, 0), 2, 0.05);
  // The same picture, twice as large in every measure but the depth, is half as steep.
  row = row_of("plaster_rough");
  for (double* length : {&row.width, &row.height, &row.stone_width, &row.stone_height}) *length *= 2;
  EXPECT_NEAR(slope(make_maps(row, TextureSize::full), 0) / slope(once, 0), 0.5, 0.03);
  EXPECT_NEAR(slope(once, 1) / slope(once, 0), 1, 0.1);
}

TEST(Textures, EavesAreAtTheBottom) {
  // The steepest faces are the lower edges of tiles: they look down, and green is up.
  for (const char* name : {"pantiles", "plain_tiles", "slates"}) {
    const TextureMaps& maps = full(row_of(name));
    int down = 0, up = 0;
    for (std::size_t i = 0; i < maps.normal.size(); i += 3) {
      if (maps.normal[i + 1] < 64) ++down;
      if (maps.normal[i + 1] > 192) ++up;
    }
    EXPECT_GT(down, maps.pixels) << name;
    EXPECT_GT(down, 10 * up) << name;
  }
}

TEST(Textures, JointsLieAtTheCourses) {
  for (const char* name : {"brick", "brick_stretchers", "clinker"}) {
    const TextureRow& row = row_of(name);
    const TextureMaps& maps = full(row);
    std::vector<double> light(maps.pixels), down(maps.pixels);
    for (int y = 0; y < maps.pixels; ++y)
      for (int x = 0; x < maps.pixels; ++x)
        light[y] += linear(maps.base[(static_cast<std::size_t>(y) * maps.pixels + x) * 3 + 1]) / maps.pixels;
    const double pixel = row.height / maps.pixels;
    const int courses = static_cast<int>(std::lround(row.height / row.stone_height));
    ASSERT_EQ(courses % 2, 0);
    for (int course = 0; course < courses; ++course) {
      const auto at = [&](double up) {  // m above the joint's lower edge
        return light[maps.pixels - 1 - static_cast<int>((course * row.stone_height + up) / pixel)];
      };
      const double joint = at(row.joint / 2);
      for (const double share : {0.3, 0.45, 0.6, 0.75, 0.9})
        EXPECT_GT(joint, at(row.joint + share * (row.stone_height - row.joint)) + 0.05) << name << " " << course;
    }
    // The ground's joint is not cut in two: the lowest rows are joint, the highest row is brick.
    EXPECT_GT(light[maps.pixels - 2], light[0] + 0.05) << name;
    EXPECT_GT(light[maps.pixels - 1], light[0]) << name;
  }
}

TEST(Textures, BricksDifferModerately) {
  // Means of the middles of stretchers, of one course in two.
  const TextureRow& row = row_of("brick_stretchers");
  const TextureMaps& maps = full(row);
  std::vector<double> bricks;
  for (int course = 0; course < 30; ++course)
    for (int k = 0; k < 10; ++k) {
      double sum = 0;
      int count = 0;
      const double x0 = (k + (course % 2) * 0.5 + 0.25) * 0.25, y0 = course * row.stone_height + 0.04;
      for (double x = x0; x < x0 + 0.12; x += 0.005)
        for (double y = y0; y < y0 + 0.03; y += 0.005, ++count) {
          const int column = static_cast<int>(x / row.width * maps.pixels) % maps.pixels;
          const int line = maps.pixels - 1 - static_cast<int>(y / row.height * maps.pixels);
          sum += linear(maps.base[(static_cast<std::size_t>(line) * maps.pixels + column) * 3 + 1]);
        }
      bricks.push_back(sum / count);
    }
  double mean = 0, variance = 0;
  for (const double b : bricks) mean += b / static_cast<double>(bricks.size());
  for (const double b : bricks) variance += (b - mean) * (b - mean) / static_cast<double>(bricks.size());
  EXPECT_GT(std::sqrt(variance) / mean, 0.02);
  EXPECT_LT(std::sqrt(variance) / mean, 0.12);
  EXPECT_GT(*std::min_element(bricks.begin(), bricks.end()) / mean, 0.75);  // no hole in the wall
}

TEST(Textures, RepeatIsNotSeenFromAfar) {
  for (const TextureRow& row : shipped().rows()) {
    const TextureMaps& maps = full(row);
    // A sixteenth of a patch is a decimetre and a half: one of the larger stones. Of those the mean of four counts.
    const bool large = laid(row.pattern) || row.pattern == Pattern::boards || row.pattern == Pattern::metal;
    EXPECT_LE(unevenness(maps, 16), large ? 0.2 : 0.06) << row.name;
    EXPECT_LE(unevenness(maps, 4), 0.04) << row.name;
  }
}

TEST(Textures, AreTheSameOnEveryRun) {
  for (const char* name : {"plaster_smooth", "brick", "cyclopean", "pantiles", "gravel", "meadow", "sand"}) {
    const TextureRow& row = row_of(name);
    EXPECT_EQ(hash_of(make_maps(row, TextureSize::full)), hash_of(full(row))) << name;
  }
  TextureRow other = row_of("brick");
  other.name = "other";
  EXPECT_NE(hash_of(make_maps(other, TextureSize::full)), hash_of(full(row_of("brick"))));
}

TEST(Textures, SmallOnesAreTheFullOnesFromAfar) {
  for (const TextureRow& row : shipped().rows()) {
    const TextureMaps small = make_maps(row, TextureSize::small);
    const TextureMaps& large = full(row);
    ASSERT_EQ(small.pixels, row.pixels / 2) << row.name;
    EXPECT_EQ(small.base.size(), static_cast<std::size_t>(small.pixels) * small.pixels * 3) << row.name;
    EXPECT_EQ(small.normal.size(), small.base.size()) << row.name;
    EXPECT_EQ(small.orm.size(), small.base.size()) << row.name;
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(small.mean[c], large.mean[c], 0.01) << row.name;
    const std::vector<double> a = cells_of(small, 16), b = cells_of(large, 16);
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 0.01) << row.name;
  }
}

TEST(Textures, SmallOnesAreAsSteep) {
  const auto tilt = [](const TextureMaps& maps) {
    double sum = 0;
    for (std::size_t i = 0; i < maps.normal.size(); i += 3) sum += std::abs(maps.normal[i] / 127.5 - 1);
    return sum / (maps.normal.size() / 3.0);
  };
  // The wave of pantiles is wide against a pixel.
  const TextureRow& row = row_of("pantiles");
  EXPECT_NEAR(tilt(make_maps(row, TextureSize::small)) / tilt(full(row)), 1, 0.15);
}

std::string error_of(const std::string& text) {
  try {
    TextureCatalogue::parse(text, "textures.toml");
  } catch (const base::InputError& error) {
    return error.what();
  }
  return "";
}

TEST(TextureCatalogue, TellsErrorsWithTheirPlace) {
  const std::string brick =
      "[texture.brick]\npattern = \"bond\"\nwidth = 2.5\nheight = 2.5\nstone_width = 0.25\nstone_height = 0.083333\n"
      "walls = [\"brick\"]\n";
  EXPECT_EQ(error_of(brick), "");
  EXPECT_THAT(error_of("[texture.a]\npattern = \"plastr\"\n"),
              AllOf(HasSubstr("textures.toml:2:"), HasSubstr("plaster")));
  EXPECT_THAT(error_of("[texture.a]\npattern = \"xyz\"\n"), AllOf(HasSubstr("textures.toml:2:"), HasSubstr("xyz")));
  EXPECT_THAT(error_of("[texture.a]\nwidth = 2.5\n"), AllOf(HasSubstr("textures.toml:1:"), HasSubstr("pattern")));
  EXPECT_THAT(error_of(brick + "dept = 0.1\n"), AllOf(HasSubstr("textures.toml:8:"), HasSubstr("depth")));
  EXPECT_THAT(error_of(brick + "[texture.b]\npattern = \"plaster\"\nwalls = [\"stone\", \"brick\"]\n"),
              AllOf(HasSubstr("textures.toml:10:"), HasSubstr("`brick`, which `brick` has")));
  EXPECT_EQ(error_of(brick + "[texture.b]\npattern = \"plaster\"\ngrounds = [\"brick\"]\n"), "");
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = brick;
    return text.replace(text.find(from), from.size(), to);
  };
  EXPECT_THAT(error_of(with("width = 2.5", "width = 2.6")),
              AllOf(HasSubstr("textures.toml:3:"), HasSubstr("stone_width")));
  EXPECT_THAT(error_of(with("height = 2.5", "height = 2.54")),
              AllOf(HasSubstr("textures.toml:4:"), HasSubstr("stone_height")));
  EXPECT_THAT(error_of(with("height = 2.5", "height = 2.583323")),
              AllOf(HasSubstr("textures.toml:4:"), HasSubstr("31 courses")));
  EXPECT_THAT(error_of(with("bond", "cross_bond")), AllOf(HasSubstr("textures.toml:4:"), HasSubstr("30 courses")));
  EXPECT_THAT(error_of(with("stone_width = 0.25\n", "")), HasSubstr("stone_width"));
  EXPECT_THAT(error_of(brick + "pixels = 500\n"), AllOf(HasSubstr("textures.toml:8:"), HasSubstr("power of two")));
  EXPECT_THAT(error_of(brick + "joint = 0.1\n"), AllOf(HasSubstr("textures.toml:8:"), HasSubstr("joint")));
  EXPECT_THAT(error_of(brick + "roughness = 1.5\n"), HasSubstr("textures.toml:8:"));
  EXPECT_THAT(error_of("[texture.Brick]\npattern = \"plaster\"\n"), HasSubstr("textures.toml:1:"));
  EXPECT_THAT(error_of("[textur.a]\n"), HasSubstr("texture"));
  EXPECT_THAT(error_of(brick + "[other]\n"), HasSubstr("other"));
  EXPECT_THROW(TextureCatalogue::read("/nowhere/textures.toml"), base::InputError);
}

std::vector<std::uint8_t> decoded(const std::string& file, int pixels) {
  int width = 0, height = 0;
  std::uint8_t* rgb = WebPDecodeRGB(reinterpret_cast<const std::uint8_t*>(file.data()), file.size(), &width, &height);
  EXPECT_EQ(width, pixels);
  EXPECT_EQ(height, pixels);
  std::vector<std::uint8_t> out;
  if (rgb != nullptr) out.assign(rgb, rgb + static_cast<std::size_t>(width) * height * 3);
  WebPFree(rgb);
  return out;
}

TEST(TextureFiles, DecodeToTheirPixels) {
  for (const char* name : {"plaster_smooth", "brick", "slates", "asphalt", "sand"}) {
    const TextureMaps& maps = full(row_of(name));
    for (const auto* map : {&maps.base, &maps.normal, &maps.orm}) {
      EXPECT_EQ(decoded(webp(*map, maps.pixels, 101), maps.pixels), *map) << name;
      const std::string lossy = webp(*map, maps.pixels, 85);
      const std::vector<std::uint8_t> back = decoded(lossy, maps.pixels);
      ASSERT_EQ(back.size(), map->size()) << name;
      double error = 0;
      for (std::size_t i = 0; i < back.size(); ++i) error += std::abs(int{back[i]} - int{(*map)[i]});
      // Of colours WebP keeps each second row and column: the two slopes of a normal map lose more than light does.
      EXPECT_LT(error / static_cast<double>(back.size()), map == &maps.normal ? 5.5 : 3) << name;
      EXPECT_EQ(webp(*map, maps.pixels, 85), lossy) << name;
      EXPECT_LT(webp(*map, maps.pixels, 40).size(), lossy.size() + 1) << name;
    }
  }
}

}  // namespace
}  // namespace blockrand::textures
