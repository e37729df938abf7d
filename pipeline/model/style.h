// What a building looks like it was built as: class of appearance, era, morphology of its quarter.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace blockrand::model {

/// Class of appearance. Which sub-style belongs to which class stands in configs/styles/catalogue.toml.
enum class StyleClass : std::uint8_t {
  gruenderzeit,  ///< street-side house of 1840 to 1918 with a composed front
  tenement,      ///< mass housing of that time without one: wings, rear buildings, workers' tenements
  modern,        ///< designed after 1918
  other,         ///< church, shed, garage, house from before 1840, ...
};
inline constexpr int kStyleClassCount = 4;
inline constexpr std::array<std::string_view, kStyleClassCount> kStyleClassNames = {"gruenderzeit", "tenement",
                                                                                    "modern", "other"};
constexpr std::string_view name(StyleClass c) { return kStyleClassNames[static_cast<std::size_t>(c)]; }

/// When it was built, in the four steps that change how houses look.
enum class Era : std::uint8_t { pre1840, from1840, from1919, post1945 };
inline constexpr int kEraCount = 4;
inline constexpr std::array<std::string_view, kEraCount> kEraNames = {"pre1840", "1840_1918", "1919_1945", "post1945"};
constexpr std::string_view name(Era era) { return kEraNames[static_cast<std::size_t>(era)]; }
constexpr Era era_of(int year) {
  return year < 1840 ? Era::pre1840 : year < 1919 ? Era::from1840 : year < 1946 ? Era::from1919 : Era::post1945;
}

/// How the houses of a quarter stand (docs/style_measures.md 3.3).
enum class Morphology : std::uint8_t {
  perimeter_block,  ///< deep houses wall to wall around courtyards
  old_town,         ///< narrow houses on small irregular blocks
  slab,             ///< free-standing long or high houses
  detached,         ///< small houses with land around them
  terrace,          ///< rows of narrow houses with gardens
};
inline constexpr int kMorphologyCount = 5;
inline constexpr std::array<std::string_view, kMorphologyCount> kMorphologyNames = {"perimeter_block", "old_town",
                                                                                    "slab", "detached", "terrace"};
constexpr std::string_view name(Morphology m) { return kMorphologyNames[static_cast<std::size_t>(m)]; }

/// Years, both ends included, in which a building was built.
struct YearRange {
  std::int16_t from = 0, to = 0;
  int middle() const { return (from + to) / 2; }
  friend bool operator==(const YearRange&, const YearRange&) = default;
};

/// What `start_date` says of a building.
struct ConstructionDate {
  YearRange years;
  float confidence = 0;  ///< in [0, 1]; halved where the object also carries a shop or amenity, whose date it may be
};

/// What classification says about one building: probabilities, each array sums to 1.
struct BuildingStyle {
  std::array<float, kStyleClassCount> style{};
  std::array<float, kEraCount> era{};
  std::array<float, kMorphologyCount> morphology{};
  std::uint8_t substyle = 0;       ///< index into the catalogue of styles
  float substyle_p = 0;            ///< its probability
  std::optional<YearRange> years;  ///< as tagged
  bool non_house = false;  ///< a stated rule says that nobody lives or works in it (monument, garage, tank, ...)

  template <class E, std::size_t N>
  static E likeliest(const std::array<float, N>& p) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < N; ++i)
      if (p[i] > p[best]) best = i;
    return static_cast<E>(best);
  }
  StyleClass style_class() const { return likeliest<StyleClass>(style); }
  Era built() const { return likeliest<Era>(era); }
  Morphology quarter() const { return likeliest<Morphology>(morphology); }
};

/// What one feature of a building says about its class of appearance.
struct StyleTerm {
  std::string_view feature, unit, meaning;  ///< of classify::kFeatures
  float value = 0;
  float low = 0, high = 0;  ///< the bin that the weights are for: low <= value < high; may be infinite
  std::array<float, kStyleClassCount> weights{};  ///< log-odds per class
};

/// Why a building has its class of appearance:
/// log-odds = prior + region + neighbours + sum of the terms' weights; where a rule decided, `rule` says so.
struct StyleExplanation {
  std::vector<StyleTerm> terms;                              ///< the weightiest first
  std::array<float, kStyleClassCount> prior{}, elsewhere{};  ///< elsewhere: the region's usual shares, row and block
  std::string rule;                       ///< of configs/styles/non_houses.toml, in words; empty for houses
  StyleClass second = StyleClass::other;  ///< the next likely class
  std::vector<StyleTerm> changes;         ///< each alone would make `second` the answer: the bin it would need
};

}  // namespace blockrand::model
