// The shipped configuration with weights of a few features, for tests: what they say is easily said in a sentence.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

namespace blockrand::classify::test {

/// Houses from before 1919 and wall to wall are gruenderzeit, rear buildings tenements, free-standing ones modern.
inline constexpr const char* kStyleWeights = R"(answers = ["gruenderzeit", "tenement", "modern", "other"]
[prior]
other = -1.0
[feature.party_share]
edges = [0.05]
gruenderzeit = [-1.0, 1.0]
modern = [1.5, 0.0]
[feature.position]
edges = [4.5]
gruenderzeit = [0.0, -2.0]
tenement = [-1.0, 2.0]
[feature.tag_year]
edges = [1840.0, 1919.0]
gruenderzeit = [0.0, 3.0, -3.0]
modern = [-3.0, -3.0, 3.0]
)";
inline constexpr const char* kEraWeights = R"(answers = ["pre1840", "1840_1918", "1919_1945", "post1945"]
[prior]
pre1840 = -2.0
[feature.party_share]
edges = [0.05]
1840_1918 = [-0.5, 1.0]
post1945 = [1.0, 0.0]
)";
inline constexpr const char* kMorphologyWeights =
    R"(answers = ["perimeter_block", "old_town", "slab", "detached", "terrace"]
[feature.party_share]
edges = [0.05]
perimeter_block = [0.0, 2.0]
detached = [2.0, 0.0]
)";
inline constexpr const char* kStoreysWeights = R"(answers = ["1", "2", "3", "4", "5", "6", "8"]
[feature.area]
edges = [60.0]
1 = [2.0, 0.0]
4 = [0.0, 2.0]
[feature.tag_storeys]
edges = [4.5]
8 = [-15.0, 15.0]
)";
inline constexpr const char* kRoofWeights = R"(answers = ["flat", "gabled", "hipped", "mansard", "other"]
[prior]
gabled = 1.0
)";

/// A folder with a copy of configs/styles and configs/materials and the weights above; gone with the object.
class SmallWeights {
 public:
  explicit SmallWeights(const std::string& name)
      : path_(std::filesystem::path(testing::TempDir()) / ("blockrand_weights_" + name)) {
    namespace fs = std::filesystem;
    const fs::path configs = fs::path(BLOCKRAND_SOURCE_DIR) / "configs";
    fs::remove_all(path_);
    for (const char* folder : {"styles", "materials"}) {
      fs::create_directories(path_ / folder);
      fs::copy(configs / folder, path_ / folder, fs::copy_options::recursive | fs::copy_options::overwrite_existing);
    }
    fs::create_directories(path_ / "styles/weights");
    write("weights/style.toml", kStyleWeights);
    write("weights/era.toml", kEraWeights);
    write("weights/morphology.toml", kMorphologyWeights);
    write("weights/storeys.toml", kStoreysWeights);
    write("weights/roof.toml", kRoofWeights);
  }
  ~SmallWeights() { std::filesystem::remove_all(path_); }
  SmallWeights(const SmallWeights&) = delete;
  SmallWeights& operator=(const SmallWeights&) = delete;

  std::string path() const { return path_.string(); }
  /// \param file  below configs/styles
  void write(const std::string& file, const std::string& text) const { std::ofstream(path_ / "styles" / file) << text; }

 private:
  std::filesystem::path path_;
};

}  // namespace blockrand::classify::test
