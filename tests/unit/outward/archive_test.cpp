// The archive of a build: its index, its bytes, and what ZIP64 needs.
#include "pipeline/outward/archive.h"

#include <gtest/gtest.h>

#include <cstring>

namespace blockrand::outward {
namespace {

std::uint64_t number_at(std::string_view bytes, std::size_t at, int size) {
  std::uint64_t value = 0;
  for (int i = size - 1; i >= 0; --i)
    value = value << 8 | static_cast<unsigned char>(bytes[at + static_cast<std::size_t>(i)]);
  return value;
}

std::string hex(const std::array<std::uint8_t, 16>& bytes) {
  std::string out;
  for (const std::uint8_t b : bytes) out += "0123456789abcdef"[b >> 4], out += "0123456789abcdef"[b & 15];
  return out;
}

TEST(Archive, HashesPathsWithoutLeadingSlashes) {
  // echo -n tileset.json | md5sum
  EXPECT_EQ(hex(archive_hash("tileset.json")), "c09bdea7e745894f499a7517db9a7709");
  EXPECT_EQ(archive_hash("/tileset.json"), archive_hash("tileset.json"));
  EXPECT_NE(archive_hash("tiles/tileset.json"), archive_hash("tileset.json"));
}

TEST(Archive, IndexIsSortedByTwoLittleEndianNumbers) {
  const auto entry = [](std::uint8_t first, std::uint8_t eighth, std::uint8_t ninth, std::uint64_t offset) {
    ArchiveEntry e;
    e.md5[0] = first, e.md5[7] = eighth, e.md5[8] = ninth, e.offset = offset;
    return e;
  };
  // The eighth byte is the highest of the first number, so that the first byte counts less; the ninth is of the second number.
  const std::string index =
      archive_index({entry(255, 1, 0, 1), entry(0, 2, 0, 2), entry(1, 0, 9, 3), entry(1, 0, 8, 4)});
  ASSERT_EQ(index.size(), 4U * 24);
  std::vector<std::uint64_t> offsets;
  for (std::size_t i = 0; i < 4; ++i) offsets.push_back(number_at(index, 24 * i + 16, 8));
  EXPECT_EQ(offsets, (std::vector<std::uint64_t>{4, 3, 1, 2}));
}

TEST(ZipWriter, StoresAndDeflatesAndSaysWhereEntriesBegin) {
  std::string out;
  ZipWriter zip([&out](std::string_view bytes) { out += bytes; });
  const std::string text(1000, 'a');
  EXPECT_EQ(zip.add("a.json", text, true), 0U);
  const std::uint64_t second = zip.add("b.glb", "xyz", false);
  zip.close();
  EXPECT_EQ(number_at(out, 8, 2), 8U) << "deflated";
  EXPECT_EQ(number_at(out, second, 4), 0x04034b50U);
  EXPECT_EQ(number_at(out, second + 8, 2), 0U) << "stored";
  EXPECT_EQ(number_at(out, second + 18, 4), 3U) << "the header has the size, as the format asks";
  EXPECT_EQ(out.substr(second + 30, 8), "b.glbxyz");
  EXPECT_EQ(number_at(out, out.size() - 22, 4), 0x06054b50U) << "no ZIP64 where none is needed";
  EXPECT_EQ(number_at(out, out.size() - 22 + 10, 2), 2U);
  EXPECT_EQ(number_at(out, out.size() - 22 - 20, 4) == 0x07064b50U, false);
}

TEST(ZipWriter, TextThatDoesNotShrinkIsStored) {
  std::string out;
  ZipWriter zip([&out](std::string_view bytes) { out += bytes; });
  zip.add("a", "x", true);
  EXPECT_EQ(number_at(out, 8, 2), 0U);
}

TEST(ZipWriter, FarEntriesHaveZip64Records) {
  std::string out;
  ZipWriter zip([&out](std::string_view bytes) { out += bytes; });
  constexpr std::uint64_t kFar = 5'000'000'000;
  zip.pretend_size(kFar);
  EXPECT_EQ(zip.add("tileset.json", "{}", false), kFar);
  const std::size_t directory = out.size();
  zip.close();
  EXPECT_EQ(number_at(out, directory, 4), 0x02014b50U);
  EXPECT_EQ(number_at(out, directory + 42, 4), 0xffffffffU);
  const std::size_t extra = directory + 46 + std::strlen("tileset.json");
  EXPECT_EQ(number_at(out, extra, 2), 1U);
  EXPECT_EQ(number_at(out, extra + 2, 2), 8U);
  EXPECT_EQ(number_at(out, extra + 4, 8), kFar);
  const std::size_t record = extra + 12;
  EXPECT_EQ(number_at(out, record, 4), 0x06064b50U);
  EXPECT_EQ(number_at(out, record + 48, 8), kFar + directory) << "where the directory begins";
  EXPECT_EQ(number_at(out, record + 56, 4), 0x07064b50U);
  EXPECT_EQ(number_at(out, record + 56 + 8, 8), kFar + record);
  EXPECT_EQ(number_at(out, out.size() - 22 + 16, 4), 0xffffffffU);
}

}  // namespace
}  // namespace blockrand::outward
