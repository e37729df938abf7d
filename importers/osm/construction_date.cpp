#include "importers/osm/construction_date.h"

#include <algorithm>
#include <initializer_list>
#include <string>

namespace blockrand::importers::osm {
namespace {

constexpr float kYear = 0.95f, kRange = 0.9f, kDecade = 0.85f, kPartOfDecade = 0.8f, kCentury = 0.8f,
                kPartOfCentury = 0.75f;
constexpr float kDecadeOrCentury = 0.5f, kOpenEnd = 0.5f;
constexpr float kCirca = 0.85f, kDoubtful = 0.7f, kOneOfSeveral = 0.85f;

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return c >= 'a' && c <= 'z'; }

/// Lower case, underscores and every run of blanks as one blank, none at the ends.
std::string plain(std::string_view text) {
  std::string out;
  for (char c : text) {
    if (c == '_' || c == '\t' || c == '\n' || c == '\r') c = ' ';
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    if (c != ' ' || (!out.empty() && out.back() != ' ')) out += c;
  }
  if (!out.empty() && out.back() == ' ') out.pop_back();
  return out;
}

void skip_blank(std::string_view& text) {
  if (text.starts_with(' ')) text.remove_prefix(1);
}

bool take(std::string_view& text, std::string_view sign) {
  if (!text.starts_with(sign)) return false;
  text.remove_prefix(sign.size());
  skip_blank(text);
  return true;
}

/// Takes one of `words` off the front where it ends there: `mid` of `mid C19` and `mid-C19`, not of `midday`.
bool take_word(std::string_view& text, std::initializer_list<std::string_view> words) {
  for (const std::string_view word : words) {
    if (!text.starts_with(word)) continue;
    std::string_view rest = text.substr(word.size());
    if (is_letter(word.back()) && !rest.empty() && is_letter(rest.front()) && !(rest.size() > 1 && is_digit(rest[1])))
      continue;
    if (rest.starts_with('.') && !rest.starts_with("..")) rest.remove_prefix(1);
    if (rest.starts_with('-')) rest.remove_prefix(1);
    skip_blank(rest);
    text = rest;
    return true;
  }
  return false;
}

/// A run of digits at the front.
struct Digits {
  int value = 0;
  std::size_t count = 0;
};

Digits take_digits(std::string_view& text) {
  Digits d;
  while (d.count < text.size() && is_digit(text[d.count])) {
    if (d.count < 6) d.value = d.value * 10 + (text[d.count] - '0');
    ++d.count;
  }
  text.remove_prefix(d.count);
  return d;
}

enum class PartOf { whole, early, mid, late };

/// A year, decade, century or range, and how it was told.
struct Period {
  int from = 0, to = 0;
  float confidence = 0;
  bool to_the_month = false;  ///< `before 1910-05` may still be 1910
  bool range = false;
};

/// Thirds of a decade or a century; the middle one takes what is left over.
void cut_to(Period& period, PartOf part) {
  const int third = (period.to - period.from + 1) / 3;
  if (part == PartOf::early) period.to = period.from + third - 1;
  if (part == PartOf::late) period.from = period.to - third + 1;
  if (part == PartOf::mid) {
    period.from += third;
    period.to -= third;
  }
}

std::optional<Period> century(int number, PartOf part) {
  Period p{number * 100 - 99, number * 100, part == PartOf::whole ? kCentury : kPartOfCentury};
  cut_to(p, part);
  return p;
}

bool is_month(Digits d) { return d.count >= 1 && d.count <= 2 && d.value >= 1 && d.value <= 12; }
bool is_day(Digits d) { return d.count >= 1 && d.count <= 2 && d.value >= 1 && d.value <= 31; }
bool is_year(Digits d) { return d.count == 4 || d.count == 3; }

/// Takes the `-05`, `-05-01`, `/05/01` behind a year, or the `/39` and `-39` of 1938/39 as the end of a range.
void take_month_or_short_year(std::string_view& text, Period& p) {
  if (text.empty() || (text.front() != '-' && text.front() != '/')) return;
  const char sign = text.front();
  std::string_view rest = text.substr(1);
  const Digits second = take_digits(rest);
  if (second.count != 2) return;
  if (rest.size() > 1 && rest.front() == sign && is_digit(rest[1])) {
    std::string_view behind = rest.substr(1);
    const Digits day = take_digits(behind);
    if (!is_month(second) || !is_day(day)) return;
    if (take(behind, "t") && !behind.empty()) behind = {};  // a time of day
    p.to_the_month = true;
    text = behind;
    return;
  }
  const int short_year = p.from / 100 * 100 + second.value;
  // A hyphen and 01 to 12 is ISO 8601; with a slash it is how two winters are written (1907/08).
  const bool month = is_month(second) && (sign == '-' || short_year <= p.from);
  if (month) {
    p.to_the_month = true;
  } else if (short_year > p.from) {
    p.to = short_year;
    p.range = true;
    p.confidence = kRange;
  } else {
    return;
  }
  text = rest;
}

/// Takes one period off the front.
std::optional<Period> take_period(std::string_view& text) {
  bool circa = false;
  PartOf part = PartOf::whole;
  for (bool more = true; more;) {
    more = true;
    if (take(text, "~") || take(text, "≈") ||
        take_word(text, {"circa", "around", "about", "approximately", "approx", "ca", "um", "etwa"}) ||
        (text.starts_with("c.") && take_word(text, {"c"})) || (text.starts_with("c ") && take(text, "c")))
      circa = true;
    else if (take_word(text, {"early", "anfang"}))
      part = PartOf::early;
    else if (take_word(text, {"mid", "middle", "mitte"}))
      part = PartOf::mid;
    else if (take_word(text, {"late", "end", "ende"}))
      part = PartOf::late;
    else
      more = false;
  }
  bool to_the_month = false;
  if (take_word(text, {"spring",   "summer",   "autumn",   "fall",   "winter",  "herbst", "sommer", "january",
                       "february", "march",    "april",    "may",    "june",    "july",   "august", "september",
                       "october",  "november", "december", "januar", "februar", "mai",    "juni",   "juli",
                       "oktober",  "dezember", "jan",      "feb",    "mar",     "apr",    "jun",    "jul",
                       "aug",      "sep",      "sept",     "oct",    "nov",     "dec"}))
    to_the_month = true;

  std::optional<Period> p;
  std::string_view rest = text;
  if (rest.size() > 1 && rest.front() == 'c' && is_digit(rest[1])) {
    rest.remove_prefix(1);
    const Digits number = take_digits(rest);
    if (number.count <= 2)
      p = century(number.value, part);
    else if (is_year(number) && part == PartOf::whole) {  // "c1890"
      p = Period{number.value, number.value, kYear};
      circa = true;
    }
  } else {
    const Digits number = take_digits(rest);
    if (is_year(number)) {
      if (take(rest, "'s") || take(rest, "s") || take_word(rest, {"er"})) {
        if (number.value % 10 != 0) return std::nullopt;
        p = Period{number.value, number.value + 9, part == PartOf::whole ? kDecade : kPartOfDecade};
        if (number.value % 100 == 0) p->confidence = kDecadeOrCentury;
        cut_to(*p, part);
      } else if (part == PartOf::whole || number.count == 4) {
        // "early 1920": which months it was does not matter.
        p = Period{number.value, number.value, kYear, to_the_month || part != PartOf::whole};
        take_month_or_short_year(rest, *p);
      }
    } else if (number.count == 1 || number.count == 2) {
      std::string_view behind = rest;
      if (take(behind, ".") && !behind.empty() && is_digit(behind.front())) {  // 01.05.1890
        const Digits month = take_digits(behind);
        if (is_day(number) && is_month(month) && take(behind, ".")) {
          const Digits year = take_digits(behind);
          if (is_year(year)) p = Period{year.value, year.value, kYear, true};
        }
        rest = behind;
      } else {
        behind = rest;
        for (const std::string_view ending : {"st", "nd", "rd", "th", "."})
          if (take(behind, ending)) break;
        skip_blank(behind);
        if (take_word(behind, {"century", "cent", "jahrhundert", "jh", "jhd"})) p = century(number.value, part);
        rest = behind;
      }
    }
  }
  if (!p) return std::nullopt;
  if (p->from < kFirstConstructionYear || p->to > kLastConstructionYear) return std::nullopt;
  if (circa) {
    const int more = std::max(kCircaYears, (p->to - p->from + 1) / 4);
    p->from = std::max(p->from - more, kFirstConstructionYear);
    p->to = std::min(p->to + more, kLastConstructionYear);
    p->confidence *= kCirca;
  }
  skip_blank(rest);
  text = rest;
  return p;
}

Period open_start(const Period& p, bool inclusive) {
  const int end = (p.range || inclusive || p.to_the_month ? p.to : p.from) - (inclusive || p.to_the_month ? 0 : 1);
  return {std::max(end - kOpenEndYears + 1, kFirstConstructionYear), std::max(end, kFirstConstructionYear), kOpenEnd};
}

Period open_end(const Period& p, bool inclusive) {
  const int start = (p.range || inclusive || p.to_the_month ? p.from : p.to) + (inclusive || p.to_the_month ? 0 : 1);
  const int from = std::min(start, kLastConstructionYear);
  return {from, std::max(from, std::min(from + kOpenEndYears - 1, kLatestOpenEnd)), kOpenEnd};
}

/// Takes a period or a range of two off the front.
std::optional<Period> take_range(std::string_view& text) {
  auto first = take_period(text);
  if (!first) return std::nullopt;
  std::string_view rest = text;
  if (!take(rest, "...") && !take(rest, "..") && !take(rest, "--") && !take(rest, "-") && !take(rest, "–") &&
      !take(rest, "—") && !take(rest, "/") && !take_word(rest, {"to", "until", "bis"}))
    return first;
  if (rest.empty() && text.starts_with("..")) {
    text = rest;
    return open_end(*first, true);
  }
  const auto second = take_period(rest);
  if (!second || second->from < first->from || second->to < first->to) return std::nullopt;
  text = rest;
  return Period{first->from, second->to, std::min({kRange, first->confidence, second->confidence}), false, true};
}

}  // namespace

std::optional<model::ConstructionDate> parse_construction_date(std::string_view raw) {
  // Longer texts are prose, and nobody's date.
  if (raw.size() > 100) return std::nullopt;
  const std::string whole = plain(raw);
  std::string_view text = whole;
  const std::size_t list = text.find(';');
  float factor = 1;
  if (list != std::string_view::npos) {
    if (text.substr(list).find_first_of("0123456789") != std::string_view::npos) factor *= kOneOfSeveral;
    text = text.substr(0, list);
    if (text.ends_with(' ')) text.remove_suffix(1);
  }
  for (const std::string_view doubt : {"(?)", "?"})
    if (text.ends_with(doubt)) {
      text.remove_suffix(doubt.size());
      if (text.ends_with(' ')) text.remove_suffix(1);
      factor *= kDoubtful;
      break;
    }

  enum class Side { none, before, until, after, since } side = Side::none;
  if (take(text, "<=") || take(text, "≤") || take(text, "..") || take_word(text, {"until", "till", "by", "bis"}))
    side = Side::until;
  else if (take(text, ">=") || take(text, "≥") || take_word(text, {"since", "from", "seit", "ab"}))
    side = Side::since;
  else if (take(text, "<") || take_word(text, {"before", "pre", "vor"}))
    side = Side::before;
  else if (take(text, ">") || take_word(text, {"after", "post", "nach"}))
    side = Side::after;

  auto period = take_range(text);
  if (!period || !text.empty()) return std::nullopt;
  // "from 1895 to 1902" is a range, not an open end.
  if (side == Side::since && period->range) side = Side::none;
  if (side == Side::before || side == Side::until) period = open_start(*period, side == Side::until);
  if (side == Side::after || side == Side::since) period = open_end(*period, side == Side::since);
  return model::ConstructionDate{{static_cast<std::int16_t>(period->from), static_cast<std::int16_t>(period->to)},
                                 period->confidence * factor};
}

}  // namespace blockrand::importers::osm
