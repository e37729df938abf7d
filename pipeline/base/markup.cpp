#include "pipeline/base/markup.h"

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

/// Appends cleaned text; `escape` says which ASCII characters it writes in another way. Runs of the others are copied
/// in one go.
template <class Escape>
void append_escaped(std::string& out, std::string_view text, const Escape& escape) {
  const auto* p = reinterpret_cast<const unsigned char*>(text.data());
  const auto* const end = p + text.size();
  const auto* plain = p;  // start of what can be copied as it is
  const auto flush = [&] { out.append(reinterpret_cast<const char*>(plain), static_cast<std::size_t>(p - plain)); };
  while (p < end) {
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
  static bool needs(unsigned char) { return false; }
  static void write(std::string&, unsigned char) {}
};

struct XmlEscape {
  static bool needs(unsigned char c) { return c < 0x20 || c == '&' || c == '<' || c == '>' || c == '"'; }
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
  static bool needs(unsigned char c) { return c < 0x20 || c == '"' || c == '\\'; }
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
  out.reserve(out.size() + (bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto at = [&](std::size_t k) { return k < bytes.size() ? static_cast<unsigned char>(bytes[k]) : 0u; };
    const unsigned group = at(i) << 16 | at(i + 1) << 8 | at(i + 2);
    out += letters[group >> 18];
    out += letters[group >> 12 & 63];
    out += i + 1 < bytes.size() ? letters[group >> 6 & 63] : '=';
    out += i + 2 < bytes.size() ? letters[group & 63] : '=';
  }
}

const std::string_view kPageStyle = R"css(
:root { color-scheme: light dark;
  --paper: #fbfaf7; --ink: #22252a; --soft: #62676f; --line: #dcd9d1; --card: #f3f1eb; --link: #1d5a96; --mark: #e0218a;
  --s0: none; --s1: #f3cf83; --s2: #eda75c; --s3: #df7d4e; --s4: #c75750; --s5: #a53c5f; --s6: #7d2f6a; --s7: #552968; --s8: #2d2150;
  --none: #c62f2f; }
@media (prefers-color-scheme: dark) { :root {
  --paper: #17191c; --ink: #e6e4df; --soft: #a2a5aa; --line: #383b40; --card: #212429; --link: #86b9ec; --mark: #ff5fb0;
  --s1: #4c4573; --s2: #6d4d8b; --s3: #965693; --s4: #bf6189; --s5: #e07a72; --s6: #f09b64; --s7: #f8c26a; --s8: #fdeb98;
  --none: #ff6b61; } }
* { box-sizing: border-box; }
html { scroll-padding-top: 1rem; }
body { margin: 0 auto; max-width: 70rem; padding: 2.2rem 1.4rem 4rem; background: var(--paper); color: var(--ink);
  font: 1rem/1.55 system-ui, -apple-system, "Segoe UI", Roboto, "Noto Sans", "DejaVu Sans", sans-serif; }
a { color: var(--link); text-decoration-thickness: .06em; text-underline-offset: .15em; }
h1 { font-size: 2.1rem; line-height: 1.15; margin: 0 0 .3rem; letter-spacing: -.015em; overflow-wrap: anywhere; }
h2 { font-size: 1.4rem; margin: 3.2rem 0 .6rem; padding-top: .9rem; border-top: 1px solid var(--line); letter-spacing: -.01em; }
h3 { font-size: 1.05rem; margin: 1.8rem 0 .4rem; }
p, ul { max-width: 46rem; } p { margin: .5rem 0 .9rem; }
.kicker { color: var(--soft); font-size: .85rem; letter-spacing: .06em; text-transform: uppercase; margin: 0 0 .5rem; }
.lead { font-size: 1.12rem; } .soft { color: var(--soft); } .small { font-size: .86rem; }
nav { display: flex; flex-wrap: wrap; gap: .3rem 1.2rem; margin: 1.3rem 0 0; font-size: .92rem; }
code { font: .9em ui-monospace, "Cascadia Mono", "DejaVu Sans Mono", Menlo, monospace; overflow-wrap: anywhere; }
pre { background: var(--card); padding: .7rem .9rem; border-radius: .4rem; overflow-x: auto; margin: .5rem 0 1rem; }
.facts { display: grid; grid-template-columns: max-content 1fr; gap: .25rem 1.4rem; margin: 1.2rem 0; }
.facts dt { color: var(--soft); } .facts dd { margin: 0; overflow-wrap: anywhere; }
.sum { display: flex; flex-wrap: wrap; align-items: stretch; gap: .5rem; margin: 1.2rem 0 .6rem; }
.sum div { background: var(--card); border-radius: .5rem; padding: .6rem 1rem .65rem; min-width: 7.2rem; }
.sum b { display: block; font-size: 1.65rem; line-height: 1.2; font-weight: 650; font-variant-numeric: tabular-nums; letter-spacing: -.02em; }
.sum span { color: var(--soft); font-size: .88rem; } .sum i { align-self: center; font-style: normal; font-size: 1.4rem; color: var(--soft); }
table { border-collapse: collapse; margin: .8rem 0 1rem; font-size: .94rem; }
th, td { text-align: left; vertical-align: top; padding: .32rem 1.1rem .32rem 0; border-bottom: 1px solid var(--line); }
th { font-weight: 600; } thead th { color: var(--soft); font-weight: 500; font-size: .86rem; }
td.n, th.n { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
.wide { overflow-x: auto; } .wide table { min-width: 46rem; }
figure { margin: 1.2rem 0; } figure img { display: block; width: 100%; height: auto; border-radius: .5rem; }
figcaption { color: var(--soft); font-size: .9rem; margin-top: .4rem; }
.pair { display: grid; grid-template-columns: repeat(auto-fit, minmax(20rem, 1fr)); gap: 0 1.2rem; } .pair figure { margin-top: 0; }
)css";

}  // namespace blockrand::base
