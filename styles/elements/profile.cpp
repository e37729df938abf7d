// Parsing and drawing of profile programs.
#include "styles/elements/profile.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "pipeline/base/portable_math.h"
#include "pipeline/model/vector.h"
#include "styles/elements/mesh_builder.h"

namespace blockrand::elements {
namespace {

using model::Point2;

/// A word, number or sign of a program, and where it stands.
struct Token {
  std::string_view text;
  int line = 1, column = 1;
  bool end() const { return text.empty(); }
};

class Reader {
 public:
  explicit Reader(std::string_view text) : text_(text) { advance(); }
  const Token& token() const { return token_; }
  Token take() {
    const Token t = token_;
    advance();
    return t;
  }

 private:
  void advance() {
    skip_blanks();
    token_ = {{}, line_, column_};
    if (at_ >= text_.size()) return;
    std::size_t end = at_ + 1;
    const auto is_word = [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' || c == '-' ||
             c == '+' || c == '_';
    };
    if (is_word(text_[at_]))
      while (end < text_.size() && is_word(text_[end])) ++end;
    token_.text = text_.substr(at_, end - at_);
    column_ += static_cast<int>(end - at_);
    at_ = end;
  }
  void skip_blanks() {
    bool comment = false;
    for (; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      if (c == '\n') {
        comment = false;
        ++line_;
        column_ = 1;
        continue;
      }
      if (c == '#') comment = true;
      if (!comment && c != ' ' && c != '\t' && c != '\r') return;
      ++column_;
    }
  }
  std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 1, column_ = 1;
  Token token_;
};

std::string shown(const Token& t) { return t.end() ? "the end" : "\"" + std::string(t.text.substr(0, 40)) + "\""; }

class Parser {
 public:
  explicit Parser(std::string_view text) : reader_(text) {}

  tl::expected<ProfileProgram, ProfileError> run() {
    ProfileProgram program;
    if (!word("Modifications") || !word("{")) return tl::unexpected(error_);
    while (reader_.token().text != "}") {
      ProfileCommand command;
      if (program.commands.size() == kMostProfileCommands)
        return tl::unexpected(at(reader_.token(), fmt::format("more than {} commands", kMostProfileCommands)));
      if (!read(command)) return tl::unexpected(error_);
      program.commands.push_back(command);
    }
    if (program.commands.empty()) return tl::unexpected(at(reader_.token(), "a profile wants a line or an arc"));
    reader_.take();
    if (!reader_.token().end())
      return tl::unexpected(at(reader_.token(), "nothing may follow the closing brace, but " + shown(reader_.token())));
    return program;
  }

 private:
  static ProfileError at(const Token& t, std::string message) { return {t.line, t.column, std::move(message)}; }
  bool fail(const Token& t, std::string message) {
    error_ = at(t, std::move(message));
    return false;
  }
  bool word(std::string_view wanted) {
    const Token t = reader_.take();
    return t.text == wanted || fail(t, fmt::format("expected \"{}\", found {}", wanted, shown(t)));
  }
  bool number(double& out, const char* what, double most) {
    if (!word(",")) return false;
    const Token t = reader_.take();
    const char* begin = t.text.data();
    const char* const end = begin + t.text.size();
    if (begin != end && *begin == '+') ++begin;
    const auto [stop, problem] = std::from_chars(begin, end, out);
    if (problem != std::errc() || stop != end || begin == end)
      return fail(t, fmt::format("expected {}, found {}", what, shown(t)));
    return std::fabs(out) <= most || fail(t, fmt::format("{} {} is beyond {}", what, shown(t), most));
  }
  bool read(ProfileCommand& command) {
    const Token kind = reader_.take();
    if (kind.text == "arc")
      command.kind = ProfileCommand::Kind::arc;
    else if (kind.text != "line")
      return fail(kind, "expected \"line\", \"arc\" or \"}\", found " + shown(kind));
    if (!word(",")) return false;
    const Token mode = reader_.take();
    if (mode.text != "rel" && mode.text != "abs")
      return fail(mode, "expected \"rel\" or \"abs\", found " + shown(mode));
    command.relative = mode.text == "rel";
    if (!number(command.angle, "an angle in degrees", 360)) return false;
    const bool arc = command.kind == ProfileCommand::Kind::arc;
    if (arc && !number(command.sweep, "the angle of the arc in degrees", 360)) return false;
    const Token before = reader_.token();
    if (!number(command.length, arc ? "a radius" : "a length", 1e6)) return false;
    if (!(command.length > 0)) return fail(before, arc ? "a radius is more than 0" : "a length is more than 0");
    if (reader_.token().text == ",") {
      std::array<int, 3> textures{};
      for (int& texture : textures) {
        double value = 0;
        const Token place = reader_.token();
        if (!number(value, "the number of a texture", 1e6)) return false;
        if (value != std::floor(value)) return fail(place, "the number of a texture is whole");
        texture = static_cast<int>(value);
      }
      command.textures = textures;
    }
    return word(";");
  }
  Reader reader_;
  ProfileError error_;
};

/// Leaves out corners that lie nearer than kFinestMember to the line between their neighbours, flattest first. The foot
/// and the upper end inside the wall stay.
Outline without_fine_members(const Outline& section) {
  Outline out = section;
  while (out.size() > 4) {
    std::size_t flattest = 0;
    double least = kFinestMember;
    for (std::size_t i = 1; i + 1 < out.size(); ++i) {
      const Point2 a = out[i - 1], b = out[i], c = out[i + 1];
      const double l = distance(c, a);
      const double ab = distance(b, a);
      const double off = l > 1e-9 ? std::fabs((c.x - a.x) * (b.y - a.y) - (c.y - a.y) * (b.x - a.x)) / l : ab;
      if (off < least) {
        least = off;
        flattest = i;
      }
    }
    if (flattest == 0) break;
    out.erase(out.begin() + static_cast<std::ptrdiff_t>(flattest));
  }
  return is_simple(out) ? out : section;
}

}  // namespace

std::string ProfileError::text() const { return fmt::format("line {}, column {}: {}", line, column, message); }

tl::expected<ProfileProgram, ProfileError> parse_profile(std::string_view text) { return Parser(text).run(); }

Profile trace(const ProfileProgram& program, int arc_steps) {
  Profile profile;
  Point2 at{0, 0};
  profile.points.push_back(at);
  double heading = 0;
  for (const ProfileCommand& c : program.commands) {
    heading = (c.relative ? heading : 0) + c.angle;
    const auto direction = base::sin_cos(heading * base::kRadiansPerDegree);
    if (c.kind == ProfileCommand::Kind::line) {
      at = {at.x + c.length * direction.sin, at.y + c.length * direction.cos};
      profile.points.push_back(at);
      continue;
    }
    const double side = c.sweep >= 0 ? 1 : -1;
    const Point2 middle{at.x + side * c.length * direction.cos, at.y - side * c.length * direction.sin};
    const int steps = std::max(1, static_cast<int>(std::ceil(std::fabs(c.sweep) / 90.0 * arc_steps - 1e-9)));
    for (int k = 1; k <= steps; ++k) {
      const auto turned = base::sin_cos((heading + c.sweep * k / steps) * base::kRadiansPerDegree);
      at = {middle.x - side * c.length * turned.cos, middle.y + side * c.length * turned.sin};
      profile.points.push_back(at);
    }
    heading += c.sweep;
  }
  profile.heading = heading;
  return profile;
}

Profile scaled_to_height(const Profile& profile, double height, double most_projection) {
  Profile out = profile;
  const double own = profile.height();
  if (!(own > 0)) return out;
  const double up = height / own;
  const double outward = profile.projection() * up > most_projection ? most_projection / profile.projection() : up;
  const double lowest = bounds_of(profile.points).least.y;
  for (Point2& p : out.points) p = {p.x * outward, (p.y - lowest) * up};
  return out;
}

Profile silhouette(const Profile& profile) {
  if (profile.points.size() <= 5) return profile;
  const Bounds2 box = bounds_of(profile.points);
  // The outermost tenth is what casts the shadow line.
  double low = box.most.y, high = box.least.y;
  for (const Point2 p : profile.points)
    if (p.x >= 0.9 * box.most.x) {
      low = std::min(low, p.y);
      high = std::max(high, p.y);
    }
  const double foot = std::max(0.0, std::min(profile.points[0].x, box.most.x));
  Profile out;
  out.points.push_back({foot, box.least.y});
  if (low > box.least.y + kSamePoint) out.points.push_back({box.most.x * 0.5, low - 0.2 * (low - box.least.y)});
  out.points.push_back({box.most.x, low});
  if (high > low + kSamePoint) out.points.push_back({box.most.x, high});
  out.points.push_back({0, box.most.y});
  return out;
}

double clear_of(const Profile& profile, double wanted, double from, double to) {
  double x = wanted;
  for (bool again = true; again && wanted - x < 0.03;) {
    again = false;
    for (std::size_t i = 1; i < profile.points.size(); ++i) {
      const Point2 a = profile.points[i - 1], b = profile.points[i];
      if (std::fabs(a.x - b.x) > kApart || std::max(a.y, b.y) < from || std::min(a.y, b.y) > to) continue;
      if (std::fabs(a.x - x) >= kApart && std::fabs(b.x - x) >= kApart) continue;
      x = std::min(a.x, b.x) - kApart - 1e-6;
      again = true;
    }
  }
  return x;
}

tl::expected<Outline, std::string> section_of(const Profile& profile) {
  const Bounds2 box = bounds_of(profile.points);
  if (profile.points.size() < 2 || box.most.x < kApart || box.height() < kApart)
    return tl::unexpected<std::string>("the profile does not stand out of the wall");
  // What lies deeper in the wall than the foot is cut off.
  Outline out;
  const auto inside = [](Point2 p) { return p.x >= -kApart; };
  const auto crossing = [](Point2 a, Point2 b) {
    const double t = (-kApart - a.x) / (b.x - a.x);
    return Point2{-kApart, a.y + t * (b.y - a.y)};
  };
  for (std::size_t i = 0; i < profile.points.size(); ++i) {
    const Point2 p = profile.points[i];
    if (i > 0 && inside(profile.points[i - 1]) != inside(p)) out.push_back(crossing(profile.points[i - 1], p));
    if (inside(p)) out.push_back(p);
  }
  if (out.size() < 2) return tl::unexpected<std::string>("the profile lies inside the wall");
  if (out.front().x > -kApart) out.insert(out.begin(), {-kApart, out.front().y});
  if (out.back().x > -kApart) out.push_back({-kApart, out.back().y});
  Outline clean;
  for (const Point2 p : out) {
    if (!clean.empty() && std::fabs(clean.back().x - p.x) + std::fabs(clean.back().y - p.y) < 1e-9) continue;
    // A corner on a straight line is no corner.
    if (clean.size() >= 2) {
      const Point2 a = clean[clean.size() - 2], b = clean.back();
      const double turn = (b.x - a.x) * (p.y - b.y) - (b.y - a.y) * (p.x - b.x);
      if (std::fabs(turn) < 1e-9 && (b.x - a.x) * (p.x - b.x) + (b.y - a.y) * (p.y - b.y) > 0) clean.pop_back();
    }
    clean.push_back(p);
  }
  if (clean.size() >= 3) clean = without_fine_members(clean);
  if (clean.size() < 3 || !is_simple(clean))
    return tl::unexpected<std::string>("the line of the profile crosses itself");
  if (signed_area(clean) <= 0)
    return tl::unexpected<std::string>("the profile runs from the top down: draw it from below");
  return clean;
}

}  // namespace blockrand::elements
