// A value that knows where it came from (ARCHITECTURE.md, law 2).
#pragma once

#include <cstdint>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

namespace blockrand::model {

/// Strongest first. The order is the precedence between sources that speak about the same value.
enum class Source : std::uint8_t {
  override_,   ///< a user's correction
  tag,         ///< a tag of the object itself
  implied,     ///< follows from another tag
  part,        ///< taken from the building's parts
  imagery,     ///< an aerial image
  terrain,     ///< an elevation model
  geometry,    ///< the footprint's shape
  neighbours,  ///< buildings within the stated reach
  block,
  cell,
  district,
  region,
  preset,    ///< a style preset or the defaults table for the building's use
  default_,  ///< nothing known
};
inline constexpr int kSourceCount = 14;

constexpr std::string_view name(Source source) {
  constexpr std::string_view names[kSourceCount] = {"override", "tag",      "implied",    "part",   "imagery",
                                                    "terrain",  "geometry", "neighbours", "block",  "cell",
                                                    "district", "region",   "preset",     "default"};
  return names[static_cast<int>(source)];
}

/// Index into EvidenceTable; 0 is "no evidence noted".
using EvidenceId = std::uint32_t;

template <class T>
struct Sourced {
  T value{};
  Source source = Source::default_;
  float confidence = 0;  ///< in [0, 1]
  EvidenceId evidence = 0;
};

/// A value that was considered and lost against the one chosen.
struct Candidate {
  Source source = Source::default_;
  float confidence = 0;
  std::string value;
  std::string text;  ///< why it was considered, as Evidence::text
};

/// Why a value was chosen: a sentence a layman can read ("median of 7 neighbours within 100 m"), and what lost.
struct Evidence {
  std::string text;
  std::vector<Candidate> other_candidates;
};

/// One tile's evidence, addressed by EvidenceId.
class EvidenceTable {
 public:
  EvidenceTable() : entries_(1) {}
  EvidenceId add(Evidence evidence) {
    entries_.push_back(std::move(evidence));
    return static_cast<EvidenceId>(entries_.size() - 1);
  }
  const Evidence& operator[](EvidenceId id) const { return entries_[id]; }
  /// Takes over another table's entries. \returns what their ids (but 0) grow by
  EvidenceId append(EvidenceTable&& other) {
    const auto offset = static_cast<EvidenceId>(entries_.size() - 1);
    entries_.insert(entries_.end(), std::make_move_iterator(other.entries_.begin() + 1),
                    std::make_move_iterator(other.entries_.end()));
    return offset;
  }

 private:
  std::vector<Evidence> entries_;
};

}  // namespace blockrand::model
