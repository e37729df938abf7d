// Sweeps with mitres, interruptions and brackets.
#include "styles/elements/sweep.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "pipeline/base/portable_math.h"
#include "pipeline/model/vector.h"

namespace blockrand::elements {
namespace {

using model::Point2;
using model::Point3;

Point2 unit(Point2 a) { return a * (1 / length(a)); }
Point2 right_of(Point2 d) { return {d.y, -d.x}; }

/// m. Corners nearer than this to one another or to the straight line are none.
constexpr double kNoCorner = 0.001;
/// m of a wall that must remain between what its two re-entrant corners take.
constexpr double kLeastRun = 0.004;
/// Sine of half the angle below which two walls nearly fold back on one another: no mitre.
constexpr double kFold = 0.05;
/// Degrees that a wall may turn beyond the end of a run: more would be a spike of twice the projection and beyond.
constexpr double kMostTurn = 130;

/// Points of a path that are corners, with their indices in it.
struct Corner {
  Point2 at;
  std::size_t index = 0;
};
std::vector<Corner> corners_of(std::span<const Point2> path, bool closed) {
  std::vector<Corner> out;
  for (std::size_t i = 0; i < path.size(); ++i)
    if (out.empty() || length(path[i] - out.back().at) >= kNoCorner) out.push_back({path[i], i});
  while (closed && out.size() > 1 && length(out.back().at - out.front().at) < kNoCorner) out.pop_back();
  for (std::size_t i = closed ? 0 : 1; out.size() > 2 && i + (closed ? 0 : 1) < out.size();) {
    const Point2 a = out[(i + out.size() - 1) % out.size()].at, b = out[i].at, c = out[(i + 1) % out.size()].at;
    const Point2 ab = b - a, ac = c - a;
    const double along = length(ac);
    const bool straight =
        along > kNoCorner && std::fabs(cross(ab, ac)) / along < kNoCorner && dot(ab, ac) > 0 && dot(c - b, ac) > 0;
    if (straight)
      out.erase(out.begin() + static_cast<std::ptrdiff_t>(i));
    else
      ++i;
  }
  return out;
}

/// What happens at a corner: where a section point goes per metre to the right, on the run that arrives and the one
/// that leaves. They differ where a sharp corner is cut off.
struct Joint {
  Point2 inner;  ///< for what lies left of the path: always the bisector
  Point2 arrive, leave;
  double taken = 0;  ///< m of both walls per metre to the right that a re-entrant corner takes; negative: gives
  bool cut_off = false, broken = false;
};

Joint joint_of(Point2 before, Point2 after, double limit) {
  Joint joint;
  const Point2 n1 = right_of(before), n2 = right_of(after);
  const double c = dot(before, after);  // 1: straight on, -1: back
  const double half = std::sqrt(std::max(0.0, (1 + c) / 2));
  if (half < kFold) {
    joint.broken = true;
    joint.arrive = n1;
    joint.leave = n2;
    return joint;
  }
  joint.inner = (n1 + n2) * (1 / (1 + c));
  joint.arrive = joint.leave = joint.inner;
  const double tangent = std::sqrt(std::max(0.0, 1 - half * half)) / half;
  joint.taken = cross(before, after) > 0 ? -tangent : tangent;
  if (joint.taken < 0 && 1 / half > limit) {
    const Point2 middle = (n1 + n2) * (1 / length(n1 + n2));
    joint.arrive = (n1 + middle) * (1 / (1 + dot(n1, middle)));
    joint.leave = (middle + n2) * (1 / (1 + dot(middle, n2)));
    joint.cut_off = true;
  }
  return joint;
}

struct Station {
  Point2 at;
  Point2 offset, inner;  ///< for section points to the right of the path and to its left
};

class PathBody {
 public:
  PathBody(MeshBuilder& builder, const PathSweep& s) : builder_(builder), s_(s) {}

  bool caps() {
    std::vector<std::uint32_t> loop(s_.section.size());
    for (std::size_t i = 0; i < loop.size(); ++i) loop[i] = static_cast<std::uint32_t>(i);
    const auto faces = convex_faces(s_.section, std::span(&loop, 1));
    if (!faces) return false;
    caps_ = *faces;
    return true;
  }

  void run(const std::vector<Station>& stations, bool closed) {
    builder_.begin_body();
    const std::size_t n = s_.section.size();
    for (std::size_t i = 0; i + (closed ? 0 : 1) < stations.size(); ++i) {
      const Station &a = stations[i], &b = stations[(i + 1) % stations.size()];
      for (std::size_t k = 0; k < n; ++k) {
        const Point2 p = s_.section[k], q = s_.section[(k + 1) % n];
        builder_.face(std::array<Point3, 4>{place(a, p), place(b, p), place(b, q), place(a, q)}, s_.part);
      }
    }
    if (closed) return;
    std::vector<Point3> corners;
    for (const auto& f : caps_) {
      corners.clear();
      for (const std::uint32_t i : f) corners.push_back(place(stations.front(), s_.section[i]));
      builder_.face(corners, s_.part);
      corners.clear();
      for (auto i = f.rbegin(); i != f.rend(); ++i) corners.push_back(place(stations.back(), s_.section[*i]));
      builder_.face(corners, s_.part);
    }
  }

 private:
  Point3 place(const Station& s, Point2 p) const {
    const Point2 o = p.x > 0 ? s.offset : s.inner;
    return s_.place(s.at.x + o.x * p.x, s.at.y + o.y * p.x, p.y);
  }
  MeshBuilder& builder_;
  const PathSweep& s_;
  std::vector<std::vector<std::uint32_t>> caps_;
};

/// Decides at every corner of a path how runs meet.
std::vector<Joint> joints_of(const std::vector<Corner>& corners, bool closed, double limit, double out, double in) {
  const std::size_t n = corners.size(), edges = closed ? n : n - 1;
  std::vector<Point2> direction(edges);
  std::vector<double> lengths(edges);
  for (std::size_t e = 0; e < edges; ++e) {
    const Point2 d = corners[(e + 1) % n].at - corners[e].at;
    lengths[e] = length(d);
    direction[e] = d * (1 / lengths[e]);
  }
  std::vector<Joint> joints(n);
  for (std::size_t i = 0; i < n; ++i) {
    const bool first = !closed && i == 0, last = !closed && i + 1 == n;
    const Point2 before = direction[first ? 0 : (i + edges - 1) % edges], after = direction[last ? edges - 1 : i];
    if (first || last)
      joints[i].inner = joints[i].arrive = joints[i].leave = right_of(first ? after : before);
    else
      joints[i] = joint_of(before, after, limit);
  }
  // Where both corners take more of a wall than it has, the one that takes more is not mitred.
  const auto taken = [&](const Joint& j) { return j.broken ? 0 : std::max(j.taken * out, -j.taken * in); };
  for (bool again = true; again;) {
    again = false;
    for (std::size_t e = 0; e < edges; ++e) {
      Joint &a = joints[e], &b = joints[(e + 1) % n];
      if (lengths[e] - taken(a) - taken(b) >= kLeastRun || (taken(a) <= 0 && taken(b) <= 0)) continue;
      (taken(a) > taken(b) ? a : b).broken = true;
      again = true;
    }
  }
  for (std::size_t i = 0; i < n; ++i)
    if (joints[i].broken) {
      joints[i].arrive = right_of(direction[(i + edges - 1) % edges]);
      joints[i].leave = right_of(direction[closed ? i : std::min(i, edges - 1)]);
      joints[i].cut_off = false;
    }
  return joints;
}

/// The parts of a chain that no interruption covers, as paths of their own.
struct MouldingRun {
  std::vector<Point2> points;
  std::vector<std::size_t> index;  ///< of each point in the chain; of cut ends the next one
  bool closed = false;
  bool gap_before = false, gap_after = false;  ///< an end is an interruption's, not the chain's
  double length = 0;
};

std::vector<MouldingRun> moulding_runs(std::span<const Point2> chain, bool closed,
                                       std::span<const std::pair<double, double>> interruptions) {
  const std::size_t edges = closed ? chain.size() : chain.size() - 1;
  std::vector<double> at{0};
  for (std::size_t e = 0; e < edges; ++e) at.push_back(at.back() + length(chain[(e + 1) % chain.size()] - chain[e]));
  const double whole = at.back();
  std::vector<std::pair<double, double>> gaps;
  for (auto [from, to] : interruptions) {
    from = std::max(from, 0.0);
    to = std::min(to, whole);
    if (to - from >= kNoCorner) gaps.emplace_back(from, to);
  }
  std::sort(gaps.begin(), gaps.end());
  std::vector<std::pair<double, double>> kept;
  double from = 0;
  for (const auto& [start, stop] : gaps) {
    if (start - from >= kNoCorner) kept.emplace_back(from, start);
    from = std::max(from, stop);
  }
  if (whole - from >= kNoCorner) kept.emplace_back(from, whole);
  const bool round = closed && gaps.empty();
  std::vector<MouldingRun> out;
  for (const auto& [start, stop] : kept) {
    MouldingRun s;
    s.closed = round;
    s.length = stop - start;
    s.gap_before = closed || start > 0;
    s.gap_after = closed || stop < whole;
    for (std::size_t e = 0; e < edges; ++e) {
      if (at[e + 1] <= start || at[e] >= stop) continue;
      const Point2 a = chain[e], b = chain[(e + 1) % chain.size()];
      const double l = at[e + 1] - at[e];
      const auto point = [&](double t) { return a + (b - a) * ((t - at[e]) / l); };
      if (s.points.empty()) {
        s.points.push_back(at[e] >= start ? a : point(start));
        s.index.push_back(e);
      }
      if (round && e + 1 == edges) break;
      s.points.push_back(at[e + 1] <= stop ? b : point(stop));
      s.index.push_back((e + 1) % chain.size());
    }
    out.push_back(std::move(s));
  }
  // A run over the seam of a closed chain is one run.
  if (closed && !round && out.size() > 1 && kept.front().first == 0 && kept.back().second == whole) {
    MouldingRun last = std::move(out.back());
    out.pop_back();
    last.points.insert(last.points.end(), out.front().points.begin() + 1, out.front().points.end());
    last.index.insert(last.index.end(), out.front().index.begin() + 1, out.front().index.end());
    last.length += out.front().length;
    last.gap_after = true;
    out.front() = std::move(last);
  }
  return out;
}

/// How the ends of a stretch are, from its first point to its last with the wall on the left.
struct Ends {
  RunEnd first = RunEnd::cut, last = RunEnd::cut;
  /// Tangent of half the angle that the wall turns beyond an end; 0: square.
  double first_slope = 0, last_slope = 0;
};

Ends ends_of(const SweepOptions& options, const MouldingRun& s, const std::vector<Corner>& corners,
             double out_of_wall) {
  Ends out{options.ends, options.ends};
  const bool turned = options.wall == WallSide::right;
  const auto& first = turned ? options.last_end : options.start_end;
  const auto& last = turned ? options.start_end : options.last_end;
  const double first_turn = turned ? options.last_turn : options.start_turn;
  const double last_turn = turned ? options.start_turn : options.last_turn;
  if (!s.gap_before) {
    out.first = first.value_or(options.ends);
    out.first_slope = base::tan(std::clamp(first_turn, -kMostTurn, kMostTurn) / 2 / base::kDegreesPerRadian);
  }
  if (!s.gap_after) {
    out.last = last.value_or(options.ends);
    out.last_slope = base::tan(std::clamp(last_turn, -kMostTurn, kMostTurn) / 2 / base::kDegreesPerRadian);
  }
  // What re-entrant corners take of the first and the last piece of the run must be there.
  const auto room = [&](double slope, std::size_t from, double taken) {
    return slope >= 0 || length(corners[from + 1].at - corners[from].at) - taken >= kLeastRun;
  };
  const std::size_t pieces = corners.size() - 1;
  const double first_taken = std::max(0.0, -out.first_slope) * out_of_wall,
               last_taken = std::max(0.0, -out.last_slope) * out_of_wall;
  if (!room(out.first_slope, 0, first_taken + (pieces == 1 ? last_taken : 0))) out.first_slope = 0;
  if (!room(out.last_slope, pieces - 1, last_taken + (pieces == 1 && out.first_slope < 0 ? first_taken : 0)))
    out.last_slope = 0;
  if (out.first_slope != 0) out.first = RunEnd::cut;
  if (out.last_slope != 0) out.last = RunEnd::cut;
  return out;
}

}  // namespace

std::optional<std::vector<std::size_t>> add_sweep(MeshBuilder& builder, const PathSweep& s) {
  const std::vector<Corner> corners = corners_of(s.path, s.closed);
  if (corners.size() < (s.closed ? 3u : 2u)) return std::nullopt;
  PathBody body(builder, s);
  if (!body.caps()) return std::nullopt;
  const Bounds2 box = bounds_of(s.section);
  std::vector<Joint> joints =
      joints_of(corners, s.closed, s.mitre_limit, std::max(0.0, box.most.x), std::max(0.0, -box.least.x));
  if (!s.closed && s.start) joints.front().leave = joints.front().inner = *s.start;
  if (!s.closed && s.end) joints.back().arrive = joints.back().inner = *s.end;

  std::vector<std::size_t> unmitred;
  const std::size_t n = corners.size();
  std::size_t first = 0;
  bool open = !s.closed;
  for (std::size_t i = 0; i < n; ++i)
    if (joints[i].broken) {
      unmitred.push_back(corners[i].index);
      if (!open) first = i;
      open = true;
    }
  std::vector<Station> stations;
  const auto leave = [&](std::size_t i) {
    const Joint& j = joints[i];
    stations.push_back({corners[i].at, j.leave, j.broken ? j.leave : j.inner});
  };
  const auto arrive = [&](std::size_t i) {
    const Joint& j = joints[i];
    stations.push_back({corners[i].at, j.arrive, j.broken ? j.arrive : j.inner});
  };
  const std::size_t steps = s.closed ? n : n - 1;
  if (open) leave(first);
  for (std::size_t k = 1; k <= steps; ++k) {
    const std::size_t i = (first + k) % n;
    const bool last = open && k == steps;
    arrive(i);
    if (last || joints[i].broken) {
      body.run(stations, false);
      stations.clear();
      if (!last) leave(i);
    } else if (joints[i].cut_off) {
      leave(i);
    }
  }
  if (!open) body.run(stations, true);
  return unmitred;
}

tl::expected<Sweep, std::string> sweep(const Profile& profile, std::span<const Point2> chain, bool closed,
                                       const SweepOptions& options) {
  const auto section = section_of(profile);
  if (!section) return tl::unexpected(section.error());
  std::vector<Point2> points(chain.begin(), chain.end());
  const bool turned = options.wall == WallSide::right;
  if (points.size() < (closed ? 3u : 2u))
    return tl::unexpected<std::string>("a chain of walls wants two points, three when closed");
  std::vector<std::pair<double, double>> gaps(options.interruptions.begin(), options.interruptions.end());
  std::vector<MouldingRun> stretches = moulding_runs(points, closed, gaps);
  Sweep out;
  MeshBuilder builder;
  for (MouldingRun& s : stretches) {
    if (turned) {
      std::reverse(s.points.begin(), s.points.end());
      std::reverse(s.index.begin(), s.index.end());
      std::swap(s.gap_before, s.gap_after);
    }
    PathSweep path;
    path.section = *section;
    path.path = s.points;
    path.closed = s.closed;
    path.mitre_limit = options.mitre_limit;
    path.part = options.part;
    const double base = options.base;
    path.place = [base](double x, double y, double up) { return Point3{x, base + up, -y}; };
    std::size_t added = 0;
    std::vector<Point2> bracketed = s.points;
    if (!s.closed) {
      std::vector<Corner> corners = corners_of(s.points, false);
      if (corners.size() < 2) continue;
      const double out_of_wall = bounds_of(*section).most.x;
      const Ends ends = ends_of(options, s, corners, out_of_wall);
      // Two steps into the wall at a returned end: the corner's mitre makes the return. It stands out beyond the end as
      // far as the moulding does; beside an interruption the end steps back by that, where the wall is long enough.
      const auto step_back = [&](Point2 end, Point2 next) {
        const Point2 d = next - end;
        const double l = length(d);
        return l > 2.5 * out_of_wall ? end + d * (out_of_wall / l) : end;
      };
      const std::size_t n = corners.size();
      if (ends.first == RunEnd::returned && s.gap_before)
        s.points.front() = corners[0].at = step_back(corners[0].at, corners[1].at);
      if (ends.last == RunEnd::returned && s.gap_after)
        s.points.back() = corners[n - 1].at = step_back(corners[n - 1].at, corners[n - 2].at);
      path.path = s.points;
      const auto into = [](Point2 d) { return right_of(d) * (-2 * kApart / length(d)); };
      if (ends.first == RunEnd::returned) {
        path.path.insert(path.path.begin(), corners[0].at + into(corners[1].at - corners[0].at));
        added = 1;
      }
      if (ends.last == RunEnd::returned)
        path.path.push_back(corners[n - 1].at + into(corners[n - 1].at - corners[n - 2].at));
      bracketed = s.points;
      // On the bisector the section goes along the wall as well; in re-entrant corners back along it.
      const Point2 first_way = unit(corners[1].at - corners[0].at),
                   last_way = unit(corners[n - 1].at - corners[n - 2].at);
      if (ends.first_slope != 0) {
        path.start = right_of(first_way) + (first_way * -ends.first_slope);
        bracketed.front() = bracketed.front() + first_way * (std::max(0.0, -ends.first_slope) * out_of_wall);
      }
      if (ends.last_slope != 0) {
        path.end = right_of(last_way) + last_way * ends.last_slope;
        bracketed.back() = bracketed.back() + last_way * (std::min(0.0, ends.last_slope) * out_of_wall);
      }
    }
    const auto unmitred = add_sweep(builder, path);
    if (!unmitred) continue;
    out.length += s.length;
    for (const std::size_t i : *unmitred)
      if (i >= added && i - added < s.index.size()) out.unmitred.push_back(s.index[i - added]);
    if (options.consoles.spacing > 0) {
      const ConsoleRow& row = options.consoles;
      MeshBuilder one;
      add_console(one, 0, options.base + row.top, row.width, row.height, row.projection, 1);
      const ElementMesh bracket = one.take();
      for (const ConsolePlace& p :
           console_places(bracketed, s.closed, WallSide::left, row.spacing, row.width, row.projection)) {
        ElementMesh placed = bracket;
        // Along the wall, seen from outside from left to right: outwards turned left.
        const Point2 along{-p.outwards.y, p.outwards.x};
        for (Point3& v : placed.vertices) {
          const Point2 plan = p.at + (along * v.x + p.outwards * v.z);
          v = {plan.x, v.y, -plan.y};
        }
        builder.append(placed);
      }
    }
  }
  out.mesh = builder.take();
  if (out.mesh.faces.empty()) return tl::unexpected<std::string>("no wall is left between the interruptions");
  return out;
}

std::vector<ConsolePlace> console_places(std::span<const Point2> chain, bool closed, WallSide wall, double spacing,
                                         double width, double projection) {
  std::vector<Point2> points(chain.begin(), chain.end());
  if (wall == WallSide::right) std::reverse(points.begin(), points.end());
  std::vector<ConsolePlace> out;
  const std::vector<Corner> corners = corners_of(points, closed);
  if (corners.size() < (closed ? 3u : 2u) || !(spacing > 0)) return out;
  const std::vector<Joint> joints = joints_of(corners, closed, 3, projection, 0);
  const std::size_t n = corners.size(), edges = closed ? n : n - 1;
  for (std::size_t e = 0; e < edges; ++e) {
    const Point2 a = corners[e].at, b = corners[(e + 1) % n].at;
    const double whole = length(b - a);
    const double from = std::max(0.0, joints[e].taken) * projection,
                 to = whole - std::max(0.0, joints[(e + 1) % n].taken) * projection;
    const double room = to - from - width - 2 * kApart;  // clear of the ends: nothing in one plane with them
    if (room < 0) continue;
    const int count = static_cast<int>(std::floor(room / spacing + 1e-9)) + 1;
    const Point2 d = (b - a) * (1 / whole);
    const double first = (from + to) / 2 - spacing * (count - 1) / 2;
    for (int k = 0; k < count; ++k) out.push_back({a + d * (first + spacing * k), right_of(d)});
  }
  return out;
}

void add_console(MeshBuilder& builder, double x, double top, double width, double height, double projection,
                 int detail) {
  // Side view, convex: foot at the wall, belly, nose under what is carried.
  Outline side{{-kApart, top - height}, {projection * 0.3, top - height}};
  if (detail > 0) side.push_back({projection * 0.75, top - height * 0.6});
  side.push_back({projection, top - height * 0.25});
  side.push_back({projection, top});
  side.push_back({-kApart, top});
  builder.begin_body();
  const double left = x - width / 2, right = x + width / 2;
  const std::size_t n = side.size();
  std::vector<Point3> corners;
  for (std::size_t i = 0; i < n; ++i) {
    const Point2 a = side[i], b = side[(i + 1) % n];
    builder.face(std::array<Point3, 4>{{{left, a.y, a.x}, {right, a.y, a.x}, {right, b.y, b.x}, {left, b.y, b.x}}},
                 Part::surround);
  }
  for (std::size_t i = 0; i < n; ++i) corners.push_back({left, side[i].y, side[i].x});
  builder.face(corners, Part::surround);
  for (Point3& c : corners) c.x = right;
  std::reverse(corners.begin(), corners.end());
  builder.face(corners, Part::surround);
}

}  // namespace blockrand::elements
