#include "pipeline/base/pack.h"

#include <gtest/gtest.h>

#include <limits>

#include "pipeline/base/fields.h"
#include "pipeline/base/memo.h"
#include "pipeline/layer_file/table.h"

namespace blockrand::base {
namespace {

enum class Kind : std::uint8_t { a, b };
struct Nested {
  double x = 1.5;
  std::array<float, 3> more{1, 2, 3};
  friend bool operator==(const Nested&, const Nested&) = default;
};
struct Everything {
  int number = 0;
  bool flag = false;
  Kind kind = Kind::a;
  std::string text;
  std::vector<Nested> list;
  std::vector<bool> bits;
  std::optional<Nested> perhaps;
  std::map<std::string, std::vector<int>> map;
  std::pair<int, std::string> pair;
  friend bool operator==(const Everything&, const Everything&) = default;
};

Everything example() {
  Everything e;
  e.number = -7, e.flag = true, e.kind = Kind::b, e.text = std::string("a\0b", 3);
  e.list = {{1.25, {4, 5, 6}}, {}};
  e.bits = {true, false, true};
  e.perhaps = Nested{-0.0, {0, 0, std::numeric_limits<float>::infinity()}};
  e.map = {{"x", {1, 2}}, {"", {}}};
  e.pair = {3, "three"};
  return e;
}

TEST(Fields, AreCountedOneByOne) {
  EXPECT_EQ(field_count<Nested>(), 2U);
  EXPECT_EQ(field_count<Everything>(), 9U);
  struct Empty {};
  EXPECT_EQ(field_count<Empty>(), 0U);
}

TEST(Pack, ComesBackAsItWas) {
  EXPECT_EQ(unpacked<Everything>(packed(example())), example());
  EXPECT_EQ(unpacked<Everything>(packed(Everything())), Everything());
}

TEST(Pack, EveryFieldCounts) {
  const std::string all = packed(example());
  const auto differs = [&](auto&& change) {
    Everything e = example();
    change(e);
    return packed(e) != all;
  };
  EXPECT_TRUE(differs([](Everything& e) { ++e.number; }));
  EXPECT_TRUE(differs([](Everything& e) { e.flag = false; }));
  EXPECT_TRUE(differs([](Everything& e) { e.kind = Kind::a; }));
  EXPECT_TRUE(differs([](Everything& e) { e.text.pop_back(); }));
  EXPECT_TRUE(differs([](Everything& e) { e.list[1].more[2] = 0; }));
  EXPECT_TRUE(differs([](Everything& e) { e.bits[1] = true; }));
  EXPECT_TRUE(differs([](Everything& e) { e.perhaps.reset(); }));
  EXPECT_TRUE(differs([](Everything& e) { e.perhaps->x = 0.0; })) << "-0 is another number than 0";
  EXPECT_TRUE(differs([](Everything& e) { e.map.erase(""); }));
  EXPECT_TRUE(differs([](Everything& e) { e.pair.second = "drei"; }));
}

TEST(Pack, WhatLiesBesideEachOtherIsToldApart) {
  EXPECT_NE(packed(std::vector<std::string>{"ab", "c"}), packed(std::vector<std::string>{"a", "bc"}));
  EXPECT_NE(packed(std::vector<std::string>{"ab"}), packed(std::vector<std::string>{"a", "b"}));
  EXPECT_NE(packed(std::pair<std::vector<int>, std::vector<int>>{{1}, {2, 3}}),
            packed(std::pair<std::vector<int>, std::vector<int>>{{1, 2}, {3}}));
}

TEST(Pack, DamageIsToldAndAsksForNoMemory) {
  const std::string bytes = packed(example());
  for (std::size_t n = 0; n < bytes.size(); ++n)
    EXPECT_THROW(unpacked<Everything>(bytes.substr(0, n)), UnpackError) << n;
  EXPECT_THROW(unpacked<Everything>(bytes + "x"), UnpackError);
  const std::string huge = packed(std::uint64_t{1} << 62);
  EXPECT_THROW(unpacked<std::string>(huge), UnpackError);
  EXPECT_THROW(unpacked<std::vector<double>>(huge), UnpackError);
  EXPECT_THROW(unpacked<std::vector<Nested>>(huge), UnpackError);
  EXPECT_THROW((unpacked<std::map<int, int>>(huge)), UnpackError);
  // A number that is no bool.
  EXPECT_THROW(unpacked<bool>(std::string("\2", 1)), UnpackError);
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    std::string other = bytes;
    other[at] = static_cast<char>(other[at] ^ 0x55);
    try {
      unpacked<Everything>(other);
    } catch (const UnpackError&) {
      // Told, or another value: who keeps bytes keeps their hash with them.
    }
  }
}

TEST(Pack, RowsOfTables) {
  layer_file::CellTable table;
  layer_file::RowWriter row(table, 4);
  row.text("one"), row.integer(-5), row.real(2.5), row.null();
  row.geometry() += "g";
  row.end_row();
  const auto back = unpacked<layer_file::CellTable>(packed(table));
  EXPECT_EQ(packed(back), packed(table));
  EXPECT_EQ(back.cells[1].integer, -5);
  EXPECT_EQ(back.cells[2].real, 2.5);
  EXPECT_EQ(back.geometry(0), "g");
}

TEST(Memo, WorksOnceForTheSameInputs) {
  std::map<std::string, std::string> kept;
  const Memo memo{.shared = "program",
                  .find = [&](std::string_view kind, const std::string& key) -> std::optional<std::string> {
                    const auto found = kept.find(std::string(kind) + key);
                    return found == kept.end() ? std::nullopt : std::optional(found->second);
                  },
                  .keep = [&](std::string_view kind, const std::string& key,
                              std::string_view bytes) { kept[std::string(kind) + key] = bytes; }};
  int worked = 0;
  const auto ask = [&](const Memo* m, int input) {
    return remembered<Everything>(
        m, "kind", [&](Packer& p) { p << input; },
        [&] {
          ++worked;
          Everything e = example();
          e.number = input;
          return e;
        });
  };
  EXPECT_EQ(ask(&memo, 1).number, 1);
  EXPECT_EQ(ask(&memo, 1), ask(&memo, 1));
  EXPECT_EQ(worked, 1);
  EXPECT_EQ(ask(&memo, 2).number, 2);
  EXPECT_EQ(worked, 2);
  ask(nullptr, 1);
  EXPECT_EQ(worked, 3) << "without a memo";
  Memo other = memo;
  other.shared = "another program";
  ask(&other, 1);
  EXPECT_EQ(worked, 4);
  for (auto& [key, bytes] : kept) bytes.resize(bytes.size() / 2);
  EXPECT_EQ(ask(&memo, 1).number, 1) << "what does not unpack is worked out anew";
  EXPECT_EQ(worked, 5);
}

}  // namespace
}  // namespace blockrand::base
