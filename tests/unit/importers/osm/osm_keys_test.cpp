// docs/osm_keys.md says of the OSM keys what the code says; the code spells no key that the table has.
//   OSM_KEYS_PAGE=1 build/release/tests/test_osm_keys --gtest_filter='OsmKeys.*'   writes the page.
#include "pipeline/model/osm_keys.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "importers/osm/interest.h"
#include "importers/osm/interest_rules.h"

namespace blockrand::importers::osm {
namespace {

namespace fs = std::filesystem;

const std::string kRoot = BLOCKRAND_SOURCE_DIR;
const std::string kPage = kRoot + "/docs/osm_keys.md";

std::string text_of(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Product sources by their path below the root.
const std::map<std::string, std::string>& sources() {
  static const auto found = [] {
    std::map<std::string, std::string> out;
    for (const char* top : {"importers", "pipeline", "styles"})
      for (const fs::directory_entry& entry : fs::recursive_directory_iterator(kRoot + "/" + top))
        if (const fs::path& path = entry.path(); path.extension() == ".cpp" || path.extension() == ".h")
          if (path.filename() != "osm_keys.h") out.emplace(fs::relative(path, kRoot).generic_string(), text_of(path));
    return out;
  }();
  return found;
}

bool names(const std::string& text, std::string_view word) {
  const auto letter = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1))
    if ((at == 0 || !letter(text[at - 1])) && (at + word.size() == text.size() || !letter(text[at + word.size()])))
      return true;
  return false;
}

/// "importers/osm, pipeline/context": the folders whose sources name the constant.
std::string readers(std::string_view constant) {
  std::set<std::string> folders;
  for (const auto& [path, text] : sources())
    if (text.find("osm_key::") != std::string::npos || text.find("namespace model::osm_key") != std::string::npos)
      if (names(text, constant)) folders.insert(path.substr(0, path.find('/', path.find('/') + 1)));
  std::string out;
  for (const std::string& folder : folders) out += (out.empty() ? "" : ", ") + folder;
  return out;
}

constexpr std::pair<model::FeatureKind, const char*> kKinds[] = {
    {model::FeatureKind::street, "street"},       {model::FeatureKind::land_use, "land use"},
    {model::FeatureKind::water, "water"},         {model::FeatureKind::railway, "railway"},
    {model::FeatureKind::barrier, "barrier"},     {model::FeatureKind::tree, "tree"},
    {model::FeatureKind::entrance, "entrance"},   {model::FeatureKind::address, "address"},
    {model::FeatureKind::shop, "shop"},           {model::FeatureKind::amenity, "amenity"},
    {model::FeatureKind::passage, "passage"},     {model::FeatureKind::roof_line, "roof line"},
    {model::FeatureKind::roof_apex, "roof apex"}, {model::FeatureKind::place, "place"},
    {model::FeatureKind::boundary, "boundary"},   {model::FeatureKind::surrounding, "surroundings, where asked for"}};

std::string kept_as(const InterestRule& rule) {
  std::string out = rule.mark == ObjectMark::building        ? "building"
                    : rule.mark == ObjectMark::building_part ? "part of a building"
                    : rule.mark == ObjectMark::covered_way   ? "passage, of a street or railway"
                                                             : "";
  for (const auto& [kind, name] : kKinds)
    if (rule.kinds & static_cast<std::uint32_t>(kind)) out += (out.empty() ? "" : ", ") + std::string(name);
  return out;
}

std::string page() {
  std::string out =
      "# OSM keys that are read\n\n"
      "Made from `pipeline/model/osm_keys.h` and `importers/osm/interest_rules.h` by "
      "`tests/unit/importers/osm/osm_keys_test.cpp`.\n"
      "Rules in `configs/` and rules of users name further keys: every tag of an object that is kept can be asked.\n\n"
      "| key | what its value is used for | read in |\n|---|---|---|\n";
  for (const model::OsmKeyInfo& key : model::kOsmKeys)
    out += "| `" + std::string(key.key) + "` | " + std::string(key.use) + " | " + readers(key.constant) + " |\n";
  out +=
      "\n## Which objects are kept\n\n"
      "An object is kept for one of these tags, or as a member of a kept relation. The value `no` never counts. Of the "
      "rows of\n"
      "one key the first counts whose values fit. A closed way is an area or a line as its tags say, a line where they "
      "differ;\n"
      "`area=yes` and `area=no` outrank them.\n\n"
      "| key | values | kept as | a closed way is | on nodes |\n|---|---|---|---|---|\n";
  for (const InterestRule& rule : kInterestRules) {
    std::string values;
    for (const std::string_view value : rule.values)
      if (!value.empty()) values += (values.empty() ? "`" : ", `") + std::string(value) + "`";
    out += "| `" + std::string(rule.key) + (rule.key.ends_with(':') ? "*" : "") + "` | " +
           (values.empty() ? "any" : values) + " | " + kept_as(rule) + " | " +
           (rule.closed == ClosedWay::area   ? "an area"
            : rule.closed == ClosedWay::line ? "a line"
                                             : "") +
           " | " +
           (!rule.ways   ? "alone"
            : rule.nodes ? "yes"
                         : "no") +
           " |\n";
  }
  return out;
}

TEST(OsmKeys, PageSaysWhatTheCodeSays) {
  if (std::getenv("OSM_KEYS_PAGE")) std::ofstream(kPage) << page();
  EXPECT_EQ(text_of(kPage), page()) << "run: OSM_KEYS_PAGE=1 test_osm_keys";
}

TEST(OsmKeys, EveryKeyIsReadSomewhereAndStandsOnce) {
  std::set<std::string_view> seen;
  for (const model::OsmKeyInfo& key : model::kOsmKeys) {
    EXPECT_TRUE(seen.insert(key.key).second) << key.key << " stands twice";
    EXPECT_NE(readers(key.constant), "") << key.key << " is read nowhere";
  }
}

/// A call that asks an object for a tag names the key by its constant.
TEST(OsmKeys, NoSourceSpellsAKeyThatItAsksFor) {
  const std::regex asked("\\b(?:tag|told|read\\.[a-z_]+)\\((?:[^()\"]*, )?\\{?\"([a-z_:]+)\"");
  for (const auto& [path, text] : sources())
    for (std::sregex_iterator at(text.begin(), text.end(), asked), end; at != end; ++at)
      ADD_FAILURE() << path << " asks for " << (*at)[1] << ": add it to pipeline/model/osm_keys.h";
}

/// What the importer reads is used by a stage or an output; else a tag would be dropped in silence. By word: a field named as others are
/// (`height`) passes unseen.
TEST(OsmKeys, EveryMappedAttributeIsUsed) {
  // Read and checked, but no stage builds below the ground yet.
  const std::set<std::string> waiting = {"storeys_underground"};
  const std::string header = text_of(kRoot + "/pipeline/model/extract.h");
  const std::size_t from = header.find("struct MappedAttributes {"), to = header.find("\n};", from);
  ASSERT_NE(from, std::string::npos);
  const std::regex declaration("\n  [\\w:<>]+ ([^;]+);"), field("(\\w+)(?: = \\w+)?(?:, |$)");
  const std::string fields = header.substr(from, to - from);
  int count = 0;
  for (std::sregex_iterator line(fields.begin(), fields.end(), declaration), end; line != end; ++line) {
    const std::string list = (*line)[1];
    for (std::sregex_iterator at(list.begin(), list.end(), field); at != end; ++at, ++count) {
      const std::string name = (*at)[1];
      const bool used = std::any_of(sources().begin(), sources().end(), [&](const auto& source) {
        return !source.first.starts_with("importers/") && source.first != "pipeline/model/extract.h" &&
               names(source.second, name);
      });
      EXPECT_EQ(used, !waiting.contains(name)) << name << (used ? " is used now" : " is read, and nothing uses it");
    }
  }
  EXPECT_GE(count, 18) << "fields of MappedAttributes";
}

TEST(OsmKeys, RulesOfInterestNameKeysOfTheTable) {
  for (const InterestRule& rule : kInterestRules)
    EXPECT_TRUE(rule.key.ends_with(':') || std::any_of(std::begin(model::kOsmKeys), std::end(model::kOsmKeys),
                                                       [&](const auto& known) { return known.key == rule.key; }))
        << rule.key;
}

Interest look_at(model::OsmType type, std::string_view key, std::string_view value) {
  Interest out;
  out.add(type, key, value);
  out.finish(type);
  return out;
}

TEST(OsmKeys, FirstFittingRuleOfAKeyCounts) {
  using enum model::FeatureKind;
  using interest_rules::bit;
  using model::OsmType;
  EXPECT_EQ(look_at(OsmType::way, "landuse", "basin").kinds, bit(land_use) | bit(water));
  EXPECT_EQ(look_at(OsmType::way, "landuse", "forest").kinds, bit(land_use));
  EXPECT_TRUE(look_at(OsmType::way, "natural", "water").area());
  EXPECT_FALSE(look_at(OsmType::way, "natural", "coastline").area());
  EXPECT_EQ(look_at(OsmType::way, "natural", "").kinds, bit(land_use));  // no value is none of the rows' values
  EXPECT_EQ(look_at(OsmType::way, "barrier", "gate").kinds, 0u);
}

TEST(OsmKeys, NodesAndPrefixesAndNo) {
  using enum model::FeatureKind;
  using interest_rules::bit;
  using model::OsmType;
  EXPECT_EQ(look_at(OsmType::node, "highway", "crossing").kinds, 0u);
  EXPECT_EQ(look_at(OsmType::node, "natural", "tree").kinds, bit(tree));
  EXPECT_EQ(look_at(OsmType::way, "addr:street", "x").kinds, bit(address));
  EXPECT_TRUE(look_at(OsmType::way, "addr:street", "x").area_by_tag);
  EXPECT_TRUE(look_at(OsmType::way, "addr:interpolation", "odd").line_by_tag);
  EXPECT_FALSE(look_at(OsmType::way, "building", "no").is_building());
  EXPECT_TRUE(look_at(OsmType::way, "area", "no").area_no);
}

}  // namespace
}  // namespace blockrand::importers::osm
