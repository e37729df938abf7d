#include "pipeline/base/markup.h"

#include <array>

namespace blockrand::base {
namespace {

/// Length of the valid UTF-8 sequence at `p` that XML 1.0 allows, or 0.
std::size_t allowed_sequence(const unsigned char* p, const unsigned char* end) {
  const auto continuation = [&](int i) { return p + i < end && (p[i] & 0xC0) == 0x80; };
  const unsigned char c = *p;
  if (c < 0x80) return c >= 0x20 || c == '\t' || c == '\n' || c == '\r' ? 1 : 0;
  if (c >= 0xC2 && c <= 0xDF) return continuation(1) ? 2 : 0;
  if (c >= 0xE0 && c <= 0xEF) {
    if (!continuation(1) || !continuation(2)) return 0;
    const unsigned code = (c & 0x0Fu) << 12 | (p[1] & 0x3Fu) << 6 | (p[2] & 0x3Fu);
    return code >= 0x800 && !(code >= 0xD800 && code <= 0xDFFF) && code < 0xFFFE ? 3 : 0;
  }
  if (c >= 0xF0 && c <= 0xF4) {
    if (!continuation(1) || !continuation(2) || !continuation(3)) return 0;
    const unsigned code = (c & 0x07u) << 18 | (p[1] & 0x3Fu) << 12 | (p[2] & 0x3Fu) << 6 | (p[3] & 0x3Fu);
    return code >= 0x10000 && code <= 0x10FFFF ? 4 : 0;
  }
  return 0;
}

/// By character: ASCII that is written as it is.
template <class Escape>
constexpr std::array<bool, 256> is_plain = [] {
  std::array<bool, 256> out{};
  for (std::size_t c = 0x20; c < 0x80; ++c) out[c] = !Escape::needs(static_cast<unsigned char>(c));
  return out;
}();

/// Appends cleaned text; `escape` says which ASCII characters it writes in another way. Runs of the others are copied
/// in one go.
template <class Escape>
void append_escaped(std::string& out, std::string_view text, const Escape& escape) {
  const auto* p = reinterpret_cast<const unsigned char*>(text.data());
  const auto* const end = p + text.size();
  const auto* plain = p;  // start of what can be copied as it is
  const auto flush = [&] { out.append(reinterpret_cast<const char*>(plain), static_cast<std::size_t>(p - plain)); };
  while (p < end) {
    while (p < end && is_plain<Escape>[*p]) ++p;
    if (p == end) break;
    const std::size_t length = allowed_sequence(p, end);
    if (length == 0) {
      flush();
      out += "\xEF\xBF\xBD";
      plain = ++p;
    } else if (length == 1) {
      if (escape.needs(*p)) {
        flush();
        escape.write(out, *p);
        plain = p + 1;
      }
      ++p;
    } else {
      p += length;
    }
  }
  flush();
}

struct NoEscape {
  static constexpr bool needs(unsigned char) { return false; }
  static void write(std::string&, unsigned char) {}
};

struct XmlEscape {
  static constexpr bool needs(unsigned char c) { return c < 0x20 || c == '&' || c == '<' || c == '>' || c == '"'; }
  static void write(std::string& out, unsigned char c) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\t':
        out += "&#9;";
        break;
      case '\n':
        out += "&#10;";
        break;
      default:
        out += "&#13;";
        break;
    }
  }
};

struct JsonEscape {
  static constexpr bool needs(unsigned char c) { return c < 0x20 || c == '"' || c == '\\'; }
  static void write(std::string& out, unsigned char c) {
    switch (c) {
      case '"':
        out += "\\\"";
        break;
      case '\\':
        out += "\\\\";
        break;
      case '\t':
        out += "\\t";
        break;
      case '\n':
        out += "\\n";
        break;
      default:
        out += "\\r";
        break;
    }
  }
};

}  // namespace

void append_clean(std::string& out, std::string_view text) { append_escaped(out, text, NoEscape{}); }
void append_xml(std::string& out, std::string_view text) { append_escaped(out, text, XmlEscape{}); }
void append_json(std::string& out, std::string_view text) {
  out += '"';
  append_escaped(out, text, JsonEscape{});
  out += '"';
}

std::string escaped(std::string_view text) {
  std::string out;
  append_xml(out, text);
  return out;
}

void append_base64(std::string& out, std::string_view bytes) {
  static constexpr char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const std::size_t before = out.size(), whole = bytes.size() / 3;
  out.resize(before + (bytes.size() + 2) / 3 * 4);
  char* to = out.data() + before;
  const auto* from = reinterpret_cast<const unsigned char*>(bytes.data());
  for (std::size_t i = 0; i < whole; ++i, from += 3) {
    const unsigned group = static_cast<unsigned>(from[0]) << 16 | static_cast<unsigned>(from[1]) << 8 | from[2];
    *to++ = letters[group >> 18];
    *to++ = letters[group >> 12 & 63];
    *to++ = letters[group >> 6 & 63];
    *to++ = letters[group & 63];
  }
  if (const std::size_t rest = bytes.size() % 3; rest > 0) {
    const unsigned group = static_cast<unsigned>(from[0]) << 16 | (rest > 1 ? static_cast<unsigned>(from[1]) << 8 : 0u);
    *to++ = letters[group >> 18];
    *to++ = letters[group >> 12 & 63];
    *to++ = rest > 1 ? letters[group >> 6 & 63] : '=';
    *to++ = '=';
  }
}

}  // namespace blockrand::base
