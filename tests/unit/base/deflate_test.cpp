#include "pipeline/base/deflate.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <random>

namespace blockrand::base {
namespace {

std::string inflated(const std::string& bytes, int window_bits, std::size_t size) {
  z_stream stream{};
  EXPECT_EQ(inflateInit2(&stream, window_bits), Z_OK);
  std::string out(size + 1, '\0');
  std::string in = bytes;
  stream.next_in = reinterpret_cast<Bytef*>(in.data());
  stream.avail_in = static_cast<uInt>(in.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  EXPECT_EQ(inflate(&stream, Z_FINISH), Z_STREAM_END);
  EXPECT_EQ(stream.avail_in, 0u);
  out.resize(out.size() - stream.avail_out);
  inflateEnd(&stream);
  return out;
}

TEST(Deflate, IsReadByZlib) {
  std::mt19937 random(7);
  std::string noise, text;
  for (int i = 0; i < 100'000; ++i) noise += static_cast<char>(random());
  while (text.size() < 300'000) text += "storeys " + std::to_string(text.size() % 97) + "; ";
  for (const std::string& bytes : {std::string(), std::string("a"), noise, text})
    for (const int level : {1, 4, 6, 9, 12}) {
      EXPECT_EQ(inflated(deflated(bytes, level, DeflateFormat::zlib), MAX_WBITS, bytes.size()), bytes) << level;
      const std::string raw = deflated(bytes, level, DeflateFormat::raw);
      EXPECT_EQ(inflated(raw, -MAX_WBITS, bytes.size()), bytes) << level;
      EXPECT_EQ(raw, deflated(bytes, level, DeflateFormat::raw));
    }
  EXPECT_LT(deflated(text, 6, DeflateFormat::raw).size(), text.size() / 20);
}

TEST(Deflate, ChecksumsGoOn) {
  EXPECT_EQ(crc32_of("123456789"), 0xCBF43926u);  // the check value of CRC-32
  EXPECT_EQ(crc32_of("6789", crc32_of("12345")), 0xCBF43926u);
}

}  // namespace
}  // namespace blockrand::base
