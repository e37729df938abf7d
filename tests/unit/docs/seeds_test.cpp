// docs/internal/seeds.md is a ledger: every checklist id of the five theses' digests, what became of it, and the test
// that proves it. This test keeps the page complete and true.
//
// Compile definitions: BLOCKRAND_SOURCE_DIR (root of the repository) and BLOCKRAND_SHARED_DIR (the folder that holds
// references/), both string literals.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace {

namespace fs = std::filesystem;

const fs::path kSourceDir = BLOCKRAND_SOURCE_DIR;
const fs::path kReferencesDir = fs::path(BLOCKRAND_SHARED_DIR) / "references";

constexpr std::array<std::string_view, 6> kDigests = {"bilke",         "schrader",      "finkenzeller",
                                                      "seed003-part1", "seed003-part2", "holtmeier"};
constexpr std::array<std::string_view, 5> kStatuses = {"done", "tests only", "replaced", "planned", "declined"};

/// What is wrong with the page, one line each; empty when nothing is.
using Complaints = std::vector<std::string>;

struct Row {
  std::string digest;  ///< the level-two heading that the row stands under
  std::string id;
  std::string feature;
  std::string status;
  std::string reason;
};

struct Ledger {
  std::vector<Row> rows;
  std::map<std::string, std::vector<std::string>> totals;  ///< digest or "total" → the cells after it
  Complaints malformed;                                    ///< rows that could not be read
};

std::string read_text(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw std::runtime_error("cannot read " + path.string());
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::string trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return "";
  return std::string(text.substr(first, text.find_last_not_of(" \t\r") - first + 1));
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(trimmed(line));
  return lines;
}

/// The trimmed cells of a Markdown table row; empty for any other line.
std::vector<std::string> cells_of(const std::string& line) {
  if (line.size() < 2 || line.front() != '|' || line.back() != '|') return {};
  std::vector<std::string> cells;
  std::istringstream stream(line.substr(1, line.size() - 2));
  for (std::string cell; std::getline(stream, cell, '|');) cells.push_back(trimmed(cell));
  if (line[line.size() - 2] == '|') cells.emplace_back();  // getline drops an empty last cell
  return cells;
}

/// The text of a level-two heading; nothing for any other line.
std::optional<std::string> heading_of(const std::string& line) {
  if (!line.starts_with("## ")) return std::nullopt;
  return trimmed(line.substr(3));
}

bool is_checklist_id(const std::string& text) {
  static const std::regex pattern("[A-Z][A-Z0-9]*-?[0-9]+");
  return std::regex_match(text, pattern);
}

bool is_digest(const std::string& name) { return std::ranges::find(kDigests, name) != kDigests.end(); }

/// The ids in the section "Feature checklist" of a digest, in its order.
std::vector<std::string> checklist_ids(const std::string& digest_text) {
  std::vector<std::string> ids;
  bool inside = false;
  for (const std::string& line : lines_of(digest_text)) {
    if (const auto heading = heading_of(line)) inside = heading->find("Feature checklist") != std::string::npos;
    const auto cells = cells_of(line);
    if (inside && !cells.empty() && is_checklist_id(cells.front())) ids.push_back(cells.front());
  }
  return ids;
}

Ledger parse_ledger(const std::string& text) {
  Ledger ledger;
  std::string section;
  for (const std::string& line : lines_of(text)) {
    if (const auto heading = heading_of(line)) section = *heading;
    if (!line.starts_with('|')) continue;
    const auto cells = cells_of(line);
    if (is_digest(section)) {
      const bool is_table_head = !cells.empty() && (cells[0] == "id" || cells[0].starts_with("---"));
      if (is_table_head) continue;
      if (cells.size() != 4 || !is_checklist_id(cells[0])) {
        ledger.malformed.push_back("not a row of id, feature, status, reason: " + line);
        continue;
      }
      ledger.rows.push_back({section, cells[0], cells[1], cells[2], cells[3]});
    } else if (section == "Totals" && !cells.empty() && (is_digest(cells[0]) || cells[0] == "total")) {
      const bool is_new = ledger.totals.emplace(cells[0], std::vector(cells.begin() + 1, cells.end())).second;
      if (!is_new) ledger.malformed.push_back("two rows of totals for " + cells[0]);
    }
  }
  return ledger;
}

/// Ids without a row, rows without an id, ids with two rows, rows under another digest's heading.
Complaints check_ids(const Ledger& ledger, const std::map<std::string, std::vector<std::string>>& ids_by_digest) {
  Complaints complaints;
  std::map<std::string, std::string> digest_of;
  for (const auto& [digest, ids] : ids_by_digest) {
    for (const std::string& id : ids) {
      if (!digest_of.emplace(id, digest).second) complaints.push_back(id + " stands twice in the digests");
    }
  }
  std::map<std::string, int> count;
  for (const Row& row : ledger.rows) {
    ++count[row.id];
    const auto known = digest_of.find(row.id);
    if (known == digest_of.end()) {
      complaints.push_back(row.id + " is in no digest");
    } else if (known->second != row.digest) {
      complaints.push_back(row.id + " belongs under " + known->second + ", not " + row.digest);
    }
  }
  for (const auto& [id, digest] : digest_of) {
    if (count[id] != 1) complaints.push_back(id + " of " + digest + " has " + std::to_string(count[id]) + " rows");
  }
  return complaints;
}

/// "Suite.Name" of every TEST, TEST_F and TEST_P at the start of a line in the .cpp files under `folder`.
std::set<std::string> test_names_under(const fs::path& folder) {
  static const std::regex pattern(R"((?:^|\n)[ \t]*TEST(?:_F|_P)?\s*\(\s*(\w+)\s*,\s*(\w+)\s*\))");
  std::set<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file() || entry.path().extension() != ".cpp") continue;
    const std::string text = read_text(entry.path());
    for (std::sregex_iterator match(text.begin(), text.end(), pattern), end; match != end; ++match) {
      names.insert((*match)[1].str() + "." + (*match)[2].str());
    }
  }
  return names;
}

/// What stands between backticks and has the form of a gtest name or of a path below tests/.
std::vector<std::string> tests_named_in(const std::string& reason) {
  static const std::regex pattern(R"(`([A-Z]\w*\.[A-Z]\w*|tests/[^`\s]+)`)");
  std::vector<std::string> names;
  for (std::sregex_iterator match(reason.begin(), reason.end(), pattern), end; match != end; ++match) {
    names.push_back((*match)[1].str());
  }
  return names;
}

/// Whether rows of that status name the tests that prove them.
bool names_its_tests(const std::string& status) { return status == "done" || status == "tests only"; }

/// Valid status, a feature and a reason, and the form that the head of the page gives each status' last column.
Complaints check_form(const Ledger& ledger) {
  static const std::regex planned(R"((issues? [1-9]\d*\b|later, no issue yet\b).*)");
  static const std::regex replaced(R"(by \S+.*)");
  static const std::regex begins_like_a_plan(R"((issue \d|later\b|by \S+ ).*)");
  constexpr std::size_t kShortestReason = 15;  // shorter than this is a shrug, not a reason

  Complaints complaints = ledger.malformed;
  for (const Row& row : ledger.rows) {
    if (row.feature.empty()) complaints.push_back(row.id + ": no feature");
    if (row.reason.empty()) complaints.push_back(row.id + ": no reason");
    if (std::ranges::find(kStatuses, row.status) == kStatuses.end()) {
      complaints.push_back(row.id + ": unknown status '" + row.status + "'");
    } else if (names_its_tests(row.status) && tests_named_in(row.reason).empty()) {
      complaints.push_back(row.id + ": " + row.status + ", but names no test in backticks");
    } else if ((row.status == "planned" || row.status == "tests only") && !std::regex_match(row.reason, planned)) {
      complaints.push_back(row.id + ": " + row.status + ", but does not begin with 'issue N' or 'later, no issue yet'");
    } else if (row.status == "replaced" && !std::regex_match(row.reason, replaced)) {
      complaints.push_back(row.id + ": replaced, but does not begin with 'by'");
    } else if (row.status == "declined" &&
               (row.reason.size() < kShortestReason || std::regex_match(row.reason, begins_like_a_plan))) {
      complaints.push_back(row.id + ": declined, but gives no reason of its own");
    }
  }
  return complaints;
}

/// Tests that a row is proved by and that do not exist.
Complaints check_proofs(const Ledger& ledger, const std::set<std::string>& test_names, const fs::path& root) {
  Complaints complaints;
  for (const Row& row : ledger.rows) {
    if (!names_its_tests(row.status)) continue;
    for (const std::string& name : tests_named_in(row.reason)) {
      const bool exists = name.starts_with("tests/") ? fs::exists(root / name) : test_names.contains(name);
      if (!exists) complaints.push_back(row.id + ": " + row.status + ", but there is no test " + name);
    }
  }
  return complaints;
}

/// The table of totals against the rows: per digest and overall, each status and the sum.
Complaints check_totals(const Ledger& ledger) {
  std::map<std::string, std::map<std::string, int>> count;
  for (const Row& row : ledger.rows) {
    for (const std::string& line : {row.digest, std::string("total")}) {
      ++count[line][row.status];
      ++count[line]["all"];
    }
  }
  std::vector<std::string> lines(kDigests.begin(), kDigests.end());
  lines.emplace_back("total");
  Complaints complaints;
  for (const std::string& line : lines) {
    std::vector<std::string> expected;
    for (const std::string_view status : kStatuses)
      expected.push_back(std::to_string(count[line][std::string(status)]));
    expected.push_back(std::to_string(count[line]["all"]));
    const auto found = ledger.totals.find(line);
    if (found != ledger.totals.end() && found->second == expected) continue;
    std::string wanted = "totals should read: | " + line + " |";
    for (const std::string& number : expected) wanted += " " + number + " |";
    complaints.push_back(wanted);
  }
  return complaints;
}

std::string joined(const Complaints& complaints) {
  std::string text;
  for (const std::string& complaint : complaints) text += "\n  " + complaint;
  return text;
}

std::string page_text() { return read_text(kSourceDir / "docs" / "internal" / "seeds.md"); }

// ---- the page itself
// -------------------------------------------------------------------------------------------------

TEST(Seeds, EveryChecklistIdHasExactlyOneRow) {
  if (!fs::is_directory(kReferencesDir)) GTEST_SKIP() << "no digests at " << kReferencesDir;
  std::map<std::string, std::vector<std::string>> ids_by_digest;
  for (const std::string_view name : kDigests) {
    const std::string digest(name);
    ids_by_digest[digest] = checklist_ids(read_text(kReferencesDir / (digest + ".md")));
    // An empty list would mean that the heading or the table changed its form and everything passes unseen.
    ASSERT_GE(ids_by_digest[digest].size(), 20u) << "checklist of " << digest << " not found";
  }
  const Complaints complaints = check_ids(parse_ledger(page_text()), ids_by_digest);
  EXPECT_TRUE(complaints.empty()) << joined(complaints);
}

TEST(Seeds, EveryRowHasTheFormOfItsStatus) {
  const Ledger ledger = parse_ledger(page_text());
  ASSERT_FALSE(ledger.rows.empty());
  const Complaints complaints = check_form(ledger);
  EXPECT_TRUE(complaints.empty()) << joined(complaints);
}

TEST(Seeds, EveryTestThatARowIsProvedByExists) {
  const std::set<std::string> test_names = test_names_under(kSourceDir / "tests");
  ASSERT_TRUE(test_names.contains("Seeds.EveryTestThatARowIsProvedByExists")) << "the search for tests finds nothing";
  const Complaints complaints = check_proofs(parse_ledger(page_text()), test_names, kSourceDir);
  EXPECT_TRUE(complaints.empty()) << joined(complaints);
}

TEST(Seeds, TotalsAgreeWithTheRows) {
  const Complaints complaints = check_totals(parse_ledger(page_text()));
  EXPECT_TRUE(complaints.empty()) << joined(complaints);
}

// ---- the checks find what they are for
// -------------------------------------------------------------------------------

/// A ledger with one row under bilke.
Ledger ledger_of(const std::string& row) { return parse_ledger("## bilke\n" + row + "\n"); }

TEST(SeedsChecks, FindMissingDoubledUnknownAndMisplacedIds) {
  const std::string digest =
      "## 10. Feature checklist\n| id | f |\n|---|---|\n| B01 | a |\n| B02 | b |\n## 11. Else\n| B03 | |";
  EXPECT_EQ(checklist_ids(digest), (std::vector<std::string>{"B01", "B02"}));

  const std::string one = "| B01 | a | declined | nobody needs such a thing |\n";
  const std::string two = "| B02 | b | declined | nobody needs such a thing |\n";
  const auto complaints_about = [](const std::string& page) {
    return check_ids(parse_ledger(page), {{"bilke", {"B01", "B02"}}, {"schrader", {}}});
  };
  EXPECT_EQ(complaints_about("## bilke\n" + one + two), Complaints{});
  EXPECT_EQ(complaints_about("## bilke\n" + one), Complaints{"B02 of bilke has 0 rows"});
  EXPECT_EQ(complaints_about("## bilke\n" + one + two + one), Complaints{"B01 of bilke has 2 rows"});
  EXPECT_EQ(complaints_about("## bilke\n" + one + two + "| B99 | c | planned | issue 2 |\n"),
            Complaints{"B99 is in no digest"});
  EXPECT_EQ(complaints_about("## bilke\n" + one + "## schrader\n" + two),
            Complaints{"B02 belongs under bilke, not schrader"});
}

TEST(SeedsChecks, AcceptOneGoodRowOfEachStatus) {
  for (const std::string row :
       {"| B01 | a | done | `Suite.Name` |", "| B01 | a | done | `tests/end_to_end/x.sh` shows it |",
        "| B01 | a | tests only | issue 25: `Suite.Name` |", "| B01 | a | planned | issue 2 |",
        "| B01 | a | planned | later, no issue yet: infill |", "| B01 | a | replaced | by the map |",
        "| B01 | a | declined | outside the styles in view |"}) {
    EXPECT_EQ(check_form(ledger_of(row)), Complaints{}) << row;
  }
}

TEST(SeedsChecks, FindRowsOfBadForm) {
  for (const std::string row :
       {"| B01 | a | finished | `Suite.Name` |", "| B01 | | planned | issue 2 |", "| B01 | a | planned | |",
        "| B01 | a | planned |", "| B01 | a | planned | issue 2 | more |", "| B01 | a | done | surely |",
        "| B01 | a | done | Suite.Name |", "| B01 | a | tests only | `Suite.Name` |",
        "| B01 | a | tests only | issue 25 |", "| B01 | a | planned | soon |", "| B01 | a | planned | issue |",
        "| B01 | a | replaced | something else |", "| B01 | a | declined | no |",
        "| B01 | a | declined | issue 4: later |", "| first | a | declined | outside the styles in view |"}) {
    EXPECT_FALSE(check_form(ledger_of(row)).empty()) << row;
  }
}

TEST(SeedsChecks, FindProofsThatDoNotExist) {
  const auto complaints_about = [](const std::string& reason) {
    return check_proofs(ledger_of("| B01 | a | done | " + reason + " |"), {"Suite.Name"}, kSourceDir);
  };
  EXPECT_EQ(complaints_about("`Suite.Name`, `tests/unit/docs/seeds_test.cpp`"), Complaints{});
  EXPECT_EQ(complaints_about("`Suite.Name`, `Suite.Gone`"), Complaints{"B01: done, but there is no test Suite.Gone"});
  EXPECT_EQ(complaints_about("`tests/unit/gone.sh`"), Complaints{"B01: done, but there is no test tests/unit/gone.sh"});
  EXPECT_EQ(check_proofs(ledger_of("| B01 | a | tests only | issue 25: `Suite.Gone` |"), {"Suite.Name"}, kSourceDir),
            Complaints{"B01: tests only, but there is no test Suite.Gone"});
}

TEST(SeedsChecks, FindWrongAndMissingTotals) {
  std::string totals = "## Totals\n| bilke | 0 | 0 | 0 | 1 | 0 | 1 |\n";
  for (const std::string_view digest : kDigests) {
    if (digest != "bilke") totals += "| " + std::string(digest) + " | 0 | 0 | 0 | 0 | 0 | 0 |\n";
  }
  totals += "| total | 0 | 0 | 0 | 1 | 0 | 1 |\n";
  const std::string row = "## bilke\n| B01 | a | planned | issue 2 |\n";
  EXPECT_EQ(check_totals(parse_ledger(totals + row)), Complaints{});
  EXPECT_EQ(check_totals(parse_ledger(totals + row + "| B02 | b | replaced | by the map |\n")).size(), 2u);
  EXPECT_EQ(check_totals(parse_ledger(row)).size(), kDigests.size() + 1);
}

}  // namespace
