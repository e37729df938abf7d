#include "pipeline/base/folded_text.h"

#include <cstdint>

namespace blockrand::base {
namespace {

/// U+00C0 to U+00FF; letters that people write as two are capitals here (kPairs), '.' is no letter.
constexpr std::string_view kLatin1 = "aaaaAaAceeeeiiiidnooooO.OuuuUyTSaaaaAaAceeeeiiiidnooooO.OuuuUyTy";
/// U+0100 to U+017F.
constexpr std::string_view kLatinA =
    "aaaaaaccccccccddddeeeeeeeeeegggggggghhhhiiiiiiiiiiIIjjkkkllllllllllnnnnnnnnnooooooOOrrrrrrsssssssstttttt"
    "uuuuuuuuuuuuwwyyyzzzzzzs";
/// U+1E00 to U+1E95: letters with the number of code points they take.
struct Run {
  char letter;
  int length;
};
constexpr Run kLatinAdditional[] = {{'a', 2},  {'b', 6}, {'c', 2},  {'d', 10}, {'e', 10}, {'f', 2}, {'g', 2}, {'h', 10},
                                    {'i', 4},  {'k', 6}, {'l', 8},  {'m', 6},  {'n', 8},  {'o', 8}, {'p', 4}, {'r', 8},
                                    {'s', 10}, {'t', 8}, {'u', 10}, {'v', 4},  {'w', 10}, {'x', 4}, {'y', 2}, {'z', 6}};
/// U+1EA0 to U+1EF9, Vietnamese.
constexpr Run kVietnamese[] = {{'a', 24}, {'e', 16}, {'i', 4}, {'o', 24}, {'u', 14}, {'y', 8}};
static_assert(kLatin1.size() == 64 && kLatinA.size() == 128);

struct Pair {
  char capital;
  std::string_view letters;
};
constexpr Pair kPairs[] = {{'A', "ae"}, {'O', "oe"}, {'U', "ue"}, {'S', "ss"}, {'T', "th"}, {'I', "ij"}};

/// Pairs that stand for one letter, as its first: whoever writes ä as a finds what is written with ae.
constexpr std::string_view kWrittenAsTwo[] = {"ae", "oe", "ue", "ss", "aa"};

/// 0: none left. Moves `at` behind what was read; U+FFFD for what is no UTF-8.
std::uint32_t next_code_point(std::string_view text, std::size_t& at) {
  const auto byte = [&](std::size_t i) -> std::uint32_t {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0;
  };
  const std::uint32_t c = byte(at++);
  const int more = c < 0x80 ? 0 : c >= 0xF0 && c < 0xF5 ? 3 : c >= 0xE0 ? 2 : c >= 0xC2 ? 1 : -1;
  if (more < 0 || c >= 0xF5) return 0xFFFD;
  std::uint32_t point = more == 0 ? c : c & (0x3Fu >> more);
  for (int i = 0; i < more; ++i) {
    if ((byte(at) & 0xC0u) != 0x80) return 0xFFFD;
    point = point << 6 | (byte(at++) & 0x3Fu);
  }
  return point;
}

template <std::size_t N>
char letter_of(const Run (&runs)[N], std::uint32_t index) {
  for (const Run& run : runs) {
    if (index < static_cast<std::uint32_t>(run.length)) return run.letter;
    index -= static_cast<std::uint32_t>(run.length);
  }
  return '.';
}

/// The Latin letter of a code point, a capital of kPairs, or '.' for others.
char latin_letter(std::uint32_t c) {
  if (c >= 0xC0 && c <= 0xFF) return kLatin1[c - 0xC0];
  if (c >= 0x100 && c <= 0x17F) return kLatinA[c - 0x100];
  if (c == 0x1E9E) return 'S';
  if (c >= 0x1E00 && c <= 0x1E95) return letter_of(kLatinAdditional, c - 0x1E00);
  if (c >= 0x1EA0 && c <= 0x1EF9) return letter_of(kVietnamese, c - 0x1EA0);
  switch (c) {
    case 0x01A0:
    case 0x01A1:
      return 'o';
    case 0x01AF:
    case 0x01B0:
      return 'u';
    case 0x0218:
    case 0x0219:
      return 's';
    case 0x021A:
    case 0x021B:
      return 't';
    case 0x0259:
    case 0x018F:
      return 'a';
    default:
      return '.';
  }
}

/// Lower case without accents, of other alphabets.
std::uint32_t other_letter(std::uint32_t c) {
  if (c >= 0x400 && c <= 0x40F) c += 0x50;  // Cyrillic
  if (c >= 0x410 && c <= 0x42F) c += 0x20;
  if (((c >= 0x460 && c <= 0x481) || (c >= 0x48A && c <= 0x4BF) || (c >= 0x4D0 && c <= 0x52F)) && c % 2 == 0) ++c;
  if (c >= 0x391 && c <= 0x3A9) c += 0x20;  // Greek
  if (c >= 0x531 && c <= 0x556) c += 0x30;  // Armenian
  switch (c) {
    case 0x450:
    case 0x451:
      return 0x435;  // ё
    case 0x439:
      return 0x438;  // й, which decomposed is и
    case 0x457:
      return 0x456;
    case 0x45E:
      return 0x443;
    case 0x453:
    case 0x491:
      return 0x433;
    case 0x45C:
      return 0x43A;
    case 0x386:
    case 0x3AC:
      return 0x3B1;
    case 0x388:
    case 0x3AD:
      return 0x3B5;
    case 0x389:
    case 0x3AE:
      return 0x3B7;
    case 0x38A:
    case 0x390:
    case 0x3AF:
    case 0x3CA:
      return 0x3B9;
    case 0x38C:
    case 0x3CC:
      return 0x3BF;
    case 0x38E:
    case 0x3B0:
    case 0x3CB:
    case 0x3CD:
      return 0x3C5;
    case 0x38F:
    case 0x3CE:
      return 0x3C9;
    case 0x3C2:
      return 0x3C3;
    default:
      return c;
  }
}

void append_utf8(std::string& out, std::uint32_t c) {
  const auto add = [&](std::uint32_t byte) { out += static_cast<char>(byte); };
  if (c < 0x80) {
    add(c);
  } else if (c < 0x800) {
    add(0xC0 | c >> 6), add(0x80 | (c & 0x3F));
  } else if (c < 0x10000) {
    add(0xE0 | c >> 12), add(0x80 | (c >> 6 & 0x3F)), add(0x80 | (c & 0x3F));
  } else {
    add(0xF0 | c >> 18), add(0x80 | (c >> 12 & 0x3F)), add(0x80 | (c >> 6 & 0x3F)), add(0x80 | (c & 0x3F));
  }
}

bool is_apostrophe(std::uint32_t c) {
  return c == '\'' || c == '`' || c == 0xB4 || c == 0x2BC || c == 0x2018 || c == 0x2019;
}
bool is_dash(std::uint32_t c) { return c == '-' || (c >= 0x2010 && c <= 0x2015) || c == 0x2212; }
bool is_punctuation(std::uint32_t c) {
  return c < 0xC0 || c == 0xD7 || c == 0xF7 || (c >= 0x2000 && c <= 0x206F) || (c >= 0x3000 && c <= 0x303F) ||
         c == 0x2116 || c >= 0xFFF0;
}

void append_folded(std::string& out, std::uint32_t c) {
  if (c >= 'A' && c <= 'Z') c += 'a' - 'A';
  if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '/') {
    out += static_cast<char>(c);
  } else if (is_dash(c)) {
    out += '-';
  } else if (is_apostrophe(c) || (c >= 0x300 && c <= 0x36F)) {
    return;
  } else if (is_punctuation(c)) {
    out += ' ';
  } else if (const char letter = latin_letter(c); letter == '.') {
    append_utf8(out, other_letter(c));
  } else {
    std::string_view letters(&letter, 1);
    for (const Pair& pair : kPairs)
      if (pair.capital == letter) letters = pair.letters;
    out += letters;
  }
}

}  // namespace

std::string folded(std::string_view text) {
  std::string letters;
  letters.reserve(text.size());
  for (std::size_t at = 0; at < text.size();) append_folded(letters, next_code_point(text, at));
  std::string out;
  out.reserve(letters.size());
  for (std::size_t i = 0; i < letters.size(); ++i) {
    out += letters[i];
    for (const std::string_view pair : kWrittenAsTwo)
      if (letters.compare(i, 2, pair) == 0) {
        ++i;
        break;
      }
  }
  return out;
}

}  // namespace blockrand::base
