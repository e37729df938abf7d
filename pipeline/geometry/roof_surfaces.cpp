#include "pipeline/geometry/roof_surfaces.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "pipeline/geometry/polygon_measures.h"

namespace blockrand::geometry {

namespace {

using model::Point2;
using model::Point3;

using Loop = std::vector<std::uint32_t>;

double squared(double v) { return v * v; }

/// Loops and the upper ends of walls over shared nodes, while they are being tidied.
class Tidy {
 public:
  Tidy(const model::Polygon& plan, const WeightedSkeleton& skeleton, double height_scale, double coarseness)
      : near_(coarseness * kMergedNodes),
        narrow_(coarseness * kNarrowestFace),
        level_(coarseness * kMergedHeights),
        merged_(skeleton.merged) {
    for (const WeightedSkeletonNode& n : skeleton.nodes)
      nodes_.push_back(model::snap(Point3{n.point.x, n.point.y, n.height * height_scale}));
    std::uint32_t first = 0;
    const auto add_ring = [&](const model::Ring& ring) {
      const auto count = static_cast<std::uint32_t>(ring.size());
      for (std::uint32_t i = 0; i < count; ++i) end_of_.push_back(first + (i + 1) % count);
      first += count;
    };
    add_ring(plan.outer);
    for (const model::Ring& hole : plan.holes) add_ring(hole);
    corners_ = first;
    group_edges();
    chains_.resize(corners_);
    for (std::uint32_t e = 0; e < corners_; ++e)
      if (merged_[e] == e) chains_[e] = {e, group_end_[e]};
    for (const WeightedSkeletonFace& face : skeleton.faces) {
      if (face.upright && face.level == 0 && make_chain(face.loops[0])) continue;
      groups_.push_back({.edge = face.edge, .level = face.level, .upright = face.upright, .loops = face.loops});
    }
  }

  RoofSurfaces run() {
    parent_.resize(nodes_.size());
    std::iota(parent_.begin(), parent_.end(), 0u);
    align_uprights();
    list_all();
    // Each round takes something out of every face that needs it; two or three are usual.
    const std::size_t most_rounds = 12 + nodes_.size();
    for (std::size_t round = 0; round < most_rounds; ++round) {
      const bool contracted = contract();
      const bool inserted = insert();
      if (!contracted && !inserted) break;
    }
    join_uprights();
    drop_fins();
    drop_columns();
    cut_chains();
    join_planes();
    RoofSurfaces out;
    for (const Group& group : groups_) emit(group, out);
    out.wall_tops.resize(corners_);
    for (std::uint32_t e = 0; e < corners_; ++e)
      for (const std::uint32_t n : chains_[e]) out.wall_tops[e].push_back(nodes_[n]);
    return out;
  }

 private:
  struct Group {
    std::uint32_t edge, level;
    bool upright;
    std::vector<Loop> loops;
    // What a look at the loops as they are would find nothing for.
    bool whole = false;  ///< they do not touch themselves
    bool apart = false;  ///< no two of a loop's nodes are as near as contract() asks
    bool wide = false;   ///< none has a narrow_place()

    void changed() { whole = apart = wide = false; }
  };

  /// Edges on one line that are one edge for the skeleton: where the last of them ends.
  void group_edges() {
    group_end_.resize(corners_);
    for (std::uint32_t e = 0; e < corners_; ++e) {
      std::uint32_t end = end_of_[e];
      while (end != e && merged_[end] == merged_[e] && merged_[end] != end) end = end_of_[end];
      group_end_[e] = end;
    }
  }

  /// An upright face that stands on one edge becomes the upper end of that edge's wall.
  bool make_chain(const Loop& loop) {
    std::optional<std::size_t> base;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const std::uint32_t a = loop[i], b = loop[(i + 1) % loop.size()];
      if (a >= corners_ || merged_[a] != a || group_end_[a] != b) continue;
      if (base) return false;
      base = i;
    }
    if (!base) return false;
    const std::uint32_t edge = loop[*base];
    // The loop has the base, then the top from its end back to its start; the chain runs the other way, without the
    // base.
    Loop chain{edge};
    for (std::size_t k = loop.size() - 1; k >= 2; --k) chain.push_back(loop[(*base + k) % loop.size()]);
    chain.push_back(loop[(*base + 1) % loop.size()]);
    chains_[edge] = std::move(chain);
    return true;
  }

  bool same_place(std::uint32_t a, std::uint32_t b) const {
    return nodes_[a].x == nodes_[b].x && nodes_[a].y == nodes_[b].y;
  }

  bool has_uprights() const {
    return std::any_of(groups_.begin(), groups_.end(), [](const Group& g) { return g.upright; }) ||
           std::any_of(chains_.begin(), chains_.end(), [](const Loop& c) { return c.size() > 2; });
  }

  /// Nodes above each other on upright faces get one place: rounding must not tear their line apart.
  void align_uprights() {
    if (!has_uprights()) return;
    std::vector<std::uint32_t> order(nodes_.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return nodes_[a].x != nodes_[b].x ? nodes_[a].x < nodes_[b].x : a < b;
    });
    for (std::size_t i = 0; i < order.size(); ++i)
      for (std::size_t k = i + 1; k < order.size() && nodes_[order[k]].x - nodes_[order[i]].x <= narrow_; ++k) {
        const std::uint32_t a = std::min(order[i], order[k]), b = std::max(order[i], order[k]);
        if (b < corners_ || std::fabs(nodes_[a].y - nodes_[b].y) > narrow_) continue;
        nodes_[b].x = nodes_[a].x;
        nodes_[b].y = nodes_[a].y;
      }
  }

  /// A node on the vertical line between two others of an upright face belongs to it as well; a path that runs up such
  /// a line and back down loses that spur.
  void join_uprights() {
    if (!has_uprights()) return;
    std::vector<Loop*> paths;
    for (Loop& chain : chains_)
      if (!chain.empty()) paths.push_back(&chain);
    for (Group& group : groups_)
      if (group.upright)
        for (Loop& loop : group.loops) paths.push_back(&loop);
    for (Loop* path : paths) {
      for (std::size_t i = 0; i + 2 < path->size();) {
        const std::uint32_t a = (*path)[i], b = (*path)[i + 1], c = (*path)[i + 2];
        const double za = nodes_[a].z, zb = nodes_[b].z, zc = nodes_[c].z;
        if (same_place(a, b) && same_place(b, c) && (zb - za) * (zc - zb) <= 0) {
          path->erase(path->begin() + static_cast<std::ptrdiff_t>(i) + 1);
          if (a == c) path->erase(path->begin() + static_cast<std::ptrdiff_t>(i) + 1);
          i = i > 0 ? i - 1 : 0;
        } else {
          ++i;
        }
      }
    }
    std::vector<std::uint32_t> used;
    for (const Loop* path : paths) used.insert(used.end(), path->begin(), path->end());
    for_each_arc([&](std::uint32_t a, std::uint32_t) { used.push_back(a); });
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    for (Loop* path : paths)
      for (std::size_t i = 0; i + 1 < path->size(); ++i) {
        const std::uint32_t a = (*path)[i], b = (*path)[i + 1];
        if (!same_place(a, b)) continue;
        // The nearest to a of those between: the others follow.
        std::optional<std::uint32_t> nearest;
        for (const std::uint32_t n : used) {
          if (n == a || n == b || !same_place(n, a) || (nodes_[n].z - nodes_[a].z) * (nodes_[b].z - nodes_[n].z) <= 0)
            continue;
          if (!nearest || std::fabs(nodes_[n].z - nodes_[a].z) < std::fabs(nodes_[*nearest].z - nodes_[a].z))
            nearest = n;
        }
        if (nearest) path->insert(path->begin() + static_cast<std::ptrdiff_t>(i) + 1, *nearest);
      }
  }

  /// Two upright faces on one line that look opposite ways and have nothing between them: where a node joins only the
  /// two, it goes, and the fin with it.
  void drop_fins() {
    if (!has_uprights()) return;
    for (bool again = true; again;) {
      again = false;
      std::vector<std::pair<std::uint32_t, std::uint32_t>> ways;  // node and neighbour
      const auto join = [&](std::uint32_t a, std::uint32_t b) {
        ways.push_back({a, b});
        ways.push_back({b, a});
      };
      for_each_arc(join);
      for (const Loop& chain : chains_)
        for (std::size_t i = 0; i + 1 < chain.size(); ++i) join(chain[i], chain[i + 1]);
      for (const Loop& chain : chains_)
        if (!chain.empty())
          for (const std::uint32_t end : {chain.front(), chain.back()}) ways.push_back({end, kNone});  // the wall below
      std::sort(ways.begin(), ways.end());
      ways.erase(std::unique(ways.begin(), ways.end()), ways.end());
      for (std::size_t i = 0; i < ways.size();) {
        std::size_t k = i;
        while (k < ways.size() && ways[k].first == ways[i].first) ++k;
        const std::uint32_t n = ways[i].first;
        if (k - i <= 2 && n >= corners_ && ways[k - 1].second != kNone) {
          remove(n);
          again = true;
          break;
        }
        i = k;
      }
    }
  }
  void remove(std::uint32_t node) {
    const auto without = [&](Loop& path) {
      std::erase(path, node);
      path.erase(std::unique(path.begin(), path.end()), path.end());
    };
    for (Loop& chain : chains_) without(chain);
    for (Group& group : groups_) {
      for (Loop& loop : group.loops) {
        without(loop);
        while (loop.size() > 1 && loop.front() == loop.back()) loop.pop_back();
      }
      std::erase_if(group.loops, [](const Loop& loop) { return loop.size() < 3; });
    }
  }

  /// Where two gables meet, the corner of the plan is no point of the roof: both walls go straight up.
  void drop_columns() {
    std::vector<std::uint32_t> ending_at(corners_, kNone);
    for (std::uint32_t e = 0; e < corners_; ++e)
      if (!chains_[e].empty()) ending_at[chains_[e].back()] = e;
    for (std::uint32_t c = 0; c < corners_; ++c) {
      if (chains_[c].empty() || ending_at[c] == kNone) continue;
      Loop &right = chains_[c], &left = chains_[ending_at[c]];
      while (right.size() > 2 && left.size() > 2 && same_place(right[1], c) && left[left.size() - 2] == right[1] &&
             !in_roof(right[0])) {
        right.erase(right.begin());
        left.pop_back();
      }
    }
  }
  bool in_roof(std::uint32_t node) const {
    for (const Group& group : groups_)
      for (const Loop& loop : group.loops)
        if (std::find(loop.begin(), loop.end(), node) != loop.end()) return true;
    return false;
  }

  std::uint32_t root(std::uint32_t n) {
    while (parent_[n] != n) n = parent_[n] = parent_[parent_[n]];
    return n;
  }

  template <class Visit>
  void for_each_arc(Visit&& visit) {
    for (const Group& group : groups_)
      for (const Loop& loop : group.loops)
        for (std::size_t i = 0; i < loop.size(); ++i) visit(loop[i], loop[(i + 1) % loop.size()]);
  }

  bool contract() {
    bool any = false;
    for_each_arc([&](std::uint32_t i, std::uint32_t j) {
      const std::uint32_t a = root(i), b = root(j);
      if (a == b || (a < corners_ && b < corners_)) return;
      const Point3 p = nodes_[a], q = nodes_[b];
      if (squared(p.x - q.x) + squared(p.y - q.y) + squared(p.z - q.z) > squared(near_)) return;
      parent_[std::max(a, b)] = std::min(a, b);  // corners have the lowest numbers, so they stay
      any = true;
    });
    // Nodes of one face that are no neighbours can be as near.
    for (Group& group : groups_) {
      if (group.upright || (group.apart && !(any && renamed(group)))) continue;
      group.apart = true;
      for (const Loop& loop : group.loops)
        for (std::size_t i = 0; i < loop.size(); ++i)
          for (std::size_t k = i + 2; k < loop.size(); ++k) {
            const std::uint32_t a = root(loop[i]), b = root(loop[k]);
            if (a == b || (a < corners_ && b < corners_)) continue;
            const Point3 p = nodes_[a], q = nodes_[b];
            if (std::fabs(p.x - q.x) > narrow_ || std::fabs(p.y - q.y) > narrow_ || std::fabs(p.z - q.z) > level_)
              continue;
            parent_[std::max(a, b)] = std::min(a, b);
            any = true;
          }
    }
    if (!any) return false;
    const auto rename = [&](Loop& path, std::uint32_t number) {
      for (std::uint32_t& n : path)
        if (root(n) != n) list(n = root(n), number);
    };
    for (std::uint32_t g = 0; g < groups_.size(); ++g) {
      if (!renamed(groups_[g])) continue;
      groups_[g].changed();
      for (Loop& loop : groups_[g].loops) rename(loop, g);
    }
    for (std::size_t c = 0; c < chains_.size(); ++c) {
      Loop& chain = chains_[c];
      rename(chain, number_of_chain(c));
      chain.erase(std::unique(chain.begin(), chain.end()), chain.end());
    }
    split_loops();
    return true;
  }

  /// Whether a node of a group has become one with another.
  bool renamed(const Group& group) {
    return std::any_of(group.loops.begin(), group.loops.end(), [&](const Loop& loop) {
      return std::any_of(loop.begin(), loop.end(), [&](std::uint32_t n) { return root(n) != n; });
    });
  }

  /// Loops that touch themselves fall into pieces; pieces without area vanish.
  void split_loops() {
    for (Group& group : groups_) {
      if (group.whole) continue;
      group.changed();
      group.whole = true;
      std::vector<Loop> out;
      for (Loop& loop : group.loops) split(std::move(loop), out);
      group.loops = std::move(out);
    }
  }
  static void split(Loop loop, std::vector<Loop>& out) {
    // A stack of nodes: coming back to one cuts off what lies between.
    Loop path;
    for (const std::uint32_t n : loop) {
      const auto before = std::find(path.begin(), path.end(), n);
      if (before != path.end()) {
        if (path.end() - before >= 3) out.emplace_back(before, path.end());
        path.erase(before, path.end());
      }
      path.push_back(n);
    }
    if (path.size() >= 3) out.push_back(std::move(path));
  }

  /// How far p lies from the segment from a to b seen from above, squared; infinite beside its ends.
  double squared_distance(Point3 p, Point3 a, Point3 b) const {
    const double dx = b.x - a.x, dy = b.y - a.y, length = dx * dx + dy * dy;
    const double t = (p.x - a.x) * dx + (p.y - a.y) * dy;
    if (t <= 0 || t >= length) return INFINITY;
    return squared(dx * (p.y - a.y) - dy * (p.x - a.x)) / length;
  }

  bool insert() {
    bool any = false;
    for (Group& group : groups_) {
      if (group.upright || group.wide) continue;
      group.wide = true;
      for (std::size_t l = 0; l < group.loops.size(); ++l) {
        if (const auto found = narrow_place(group.loops[l])) {
          put_on_listed(found->node, found->from, found->to);
          any = true;
        }
      }
    }
    if (any) split_loops();
    return any;
  }

  /// Groups by number, and chains after them: each node knows those that it lies or once lay in.
  std::uint32_t number_of_chain(std::size_t chain) const { return static_cast<std::uint32_t>(groups_.size() + chain); }
  void list(std::uint32_t node, std::uint32_t number) {
    std::vector<std::uint32_t>& numbers = listed_[node];
    if (std::find(numbers.begin(), numbers.end(), number) == numbers.end()) numbers.push_back(number);
  }
  void list_all() {
    listed_.resize(nodes_.size());
    for (std::uint32_t g = 0; g < groups_.size(); ++g)
      for (const Loop& loop : groups_[g].loops)
        for (const std::uint32_t n : loop) list(n, g);
    for (std::size_t c = 0; c < chains_.size(); ++c)
      for (const std::uint32_t n : chains_[c]) list(n, number_of_chain(c));
  }
  /// put_on() where the lists lead.
  void put_on_listed(std::uint32_t node, std::uint32_t a, std::uint32_t b) {
    const std::vector<std::uint32_t> numbers = listed_[listed_[a].size() < listed_[b].size() ? a : b];
    for (const std::uint32_t number : numbers) {
      bool found = false;
      if (number >= groups_.size()) {
        found = put_between(chains_[number - groups_.size()], false, node, a, b);
      } else {
        for (Loop& loop : groups_[number].loops) found = put_between(loop, true, node, a, b) || found;
        if (found) groups_[number].changed();
      }
      if (found) list(node, number);
    }
  }

  struct Narrow {
    std::uint32_t node, from, to;
  };
  std::optional<Narrow> narrow_place(const Loop& loop) const {
    const std::size_t n = loop.size();
    std::optional<Narrow> best;
    double least = squared(narrow_);
    for (std::size_t i = 0; i < n; ++i) {
      const std::uint32_t a = loop[i], b = loop[(i + 1) % n];
      const Point3 pa = nodes_[a], pb = nodes_[b];
      const double x0 = std::min(pa.x, pb.x) - narrow_, x1 = std::max(pa.x, pb.x) + narrow_;
      const double y0 = std::min(pa.y, pb.y) - narrow_, y1 = std::max(pa.y, pb.y) + narrow_;
      for (std::size_t k = 0; k < n; ++k) {
        const std::uint32_t p = loop[k];
        if (p == a || p == b || (p < corners_ && a < corners_ && b < corners_)) continue;
        const Point3 at = nodes_[p];
        if (at.x < x0 || at.x > x1 || at.y < y0 || at.y > y1) continue;
        const double d = squared_distance(at, pa, pb);
        if (d < least) {
          least = d;
          best = Narrow{p, a, b};
        }
      }
    }
    return best;
  }

  /// Puts a node on the border between two others, wherever that occurs.
  void put_on(std::uint32_t node, std::uint32_t a, std::uint32_t b) {
    for (Group& group : groups_)
      for (Loop& loop : group.loops) put_between(loop, true, node, a, b);
    for (Loop& chain : chains_) put_between(chain, false, node, a, b);
  }
  /// The same on one path; false where that has no such border.
  static bool put_between(Loop& path, bool closed, std::uint32_t node, std::uint32_t a, std::uint32_t b) {
    bool found = false;
    for (std::size_t i = 0; i + (closed ? 0 : 1) < path.size(); ++i) {
      const std::uint32_t p = path[i], q = path[(i + 1) % path.size()];
      if ((p == a && q == b) || (p == b && q == a)) {
        path.insert(path.begin() + static_cast<std::ptrdiff_t>(i) + 1, node);
        ++i;
        found = true;
      }
    }
    return found;
  }

  /// Corners that the skeleton passed over get their place in the upper end of the wall, which is cut there.
  void cut_chains() {
    for (std::uint32_t e = 0; e < corners_; ++e) {
      if (merged_[e] != e || group_end_[e] == end_of_[e]) continue;
      std::uint32_t edge = e;
      for (std::uint32_t c = end_of_[e]; c != group_end_[e]; c = end_of_[c]) {
        Loop& chain = chains_[edge];
        const std::size_t at = place_in(chain, c);
        chains_[c].assign(chain.begin() + static_cast<std::ptrdiff_t>(at), chain.end());
        chain.resize(at + 1);
        edge = c;
      }
    }
  }
  /// Index of corner c's node in a chain that runs along its wall; made where there is none.
  std::size_t place_in(Loop& chain, std::uint32_t c) {
    const Point3 at = nodes_[c], first = nodes_[chain.front()], last = nodes_[chain.back()];
    const double dx = last.x - first.x, dy = last.y - first.y;
    const auto way = [&](Point3 p) { return (p.x - first.x) * dx + (p.y - first.y) * dy; };
    std::size_t i = 0;
    while (i + 2 < chain.size() && way(nodes_[chain[i + 1]]) <= way(at)) ++i;
    const std::uint32_t a = chain[i], b = chain[i + 1];
    const Point3 p = nodes_[a], q = nodes_[b];
    const double span = way(q) - way(p);
    const double t = span > 0 ? std::clamp((way(at) - way(p)) / span, 0.0, 1.0) : 0;
    std::uint32_t node = c;
    const double z = p.z + t * (q.z - p.z);
    if (z > 0) {
      node = static_cast<std::uint32_t>(nodes_.size());
      nodes_.push_back(model::snap(Point3{at.x, at.y, z}));
    }
    put_on(node, a, b);
    return static_cast<std::size_t>(std::find(chain.begin(), chain.end(), node) - chain.begin());
  }

  /// Do two edges lie on one line, to what rounding leaves of that?
  bool on_one_line(std::uint32_t e, std::uint32_t f) const {
    const Point3 a = nodes_[e], b = nodes_[end_of_[e]], c = nodes_[f], d = nodes_[end_of_[f]];
    const double dx = b.x - a.x, dy = b.y - a.y, length = std::sqrt(dx * dx + dy * dy);
    if (dx * (d.x - c.x) + dy * (d.y - c.y) <= 0) return false;
    const auto off = [&](Point3 p) { return std::fabs(dx * (p.y - a.y) - dy * (p.x - a.x)) / length; };
    return off(c) < kOneLine && off(d) < kOneLine;
  }
  /// How far the nodes of a loop lie off the plane of another one, m.
  double off_plane(const Loop& of, const Loop& loop) const {
    double nx = 0, ny = 0, nz = 0, mx = 0, my = 0, mz = 0;
    const Point3 o = nodes_[of[0]];
    for (std::size_t i = 0; i < of.size(); ++i) {
      const Point3 p = nodes_[of[i]], q = nodes_[of[(i + 1) % of.size()]];
      const double ax = p.x - o.x, ay = p.y - o.y, az = p.z - o.z, bx = q.x - o.x, by = q.y - o.y, bz = q.z - o.z;
      nx += ay * bz - az * by;
      ny += az * bx - ax * bz;
      nz += ax * by - ay * bx;
      mx += ax, my += ay, mz += az;
    }
    const double length = std::sqrt(nx * nx + ny * ny + nz * nz), n = static_cast<double>(of.size());
    if (length == 0) return INFINITY;
    double most = 0;
    for (const std::uint32_t i : loop) {
      const Point3 p = nodes_[i];
      most = std::max(
          most, std::fabs((p.x - o.x - mx / n) * nx + (p.y - o.y - my / n) * ny + (p.z - o.z - mz / n) * nz) / length);
    }
    return most;
  }

  /// Neighbouring faces of edges on one line are one plane: exactly so for the skeleton where the line is exact, here
  /// where rounding has bent it.
  void join_planes() {
    for (std::size_t g = 0; g < groups_.size(); ++g)
      for (std::size_t h = g + 1; h < groups_.size(); ++h) {
        Group &a = groups_[g], &b = groups_[h];
        if (a.upright || b.upright || a.level != b.level || a.edge >= corners_ || b.edge >= corners_ ||
            a.edge == b.edge)
          continue;
        if (a.loops.size() != 1 || b.loops.size() != 1 || !on_one_line(a.edge, b.edge)) continue;
        if (std::max(off_plane(a.loops[0], b.loops[0]), off_plane(b.loops[0], a.loops[0])) > kOnePlane) continue;
        if (auto both = united(a.loops[0], b.loops[0])) {
          a.loops[0] = std::move(*both);
          groups_.erase(groups_.begin() + static_cast<std::ptrdiff_t>(h));
          h = g;  // the larger face may have further neighbours
        }
      }
  }
  /// The loop around two that share one run of arcs; none where they do not, or touch elsewhere as well.
  static std::optional<Loop> united(const Loop& a, const Loop& b) {
    const auto has_arc = [](const Loop& loop, std::uint32_t from, std::uint32_t to) {
      for (std::size_t i = 0; i < loop.size(); ++i)
        if (loop[i] == from && loop[(i + 1) % loop.size()] == to) return true;
      return false;
    };
    std::vector<std::pair<std::uint32_t, std::uint32_t>> arcs;
    const auto add = [&](const Loop& loop, const Loop& other) {
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const std::uint32_t from = loop[i], to = loop[(i + 1) % loop.size()];
        if (!has_arc(other, to, from)) arcs.push_back({from, to});
      }
    };
    add(a, b);
    if (arcs.size() == a.size()) return std::nullopt;
    add(b, a);
    std::sort(arcs.begin(), arcs.end());
    for (std::size_t i = 0; i + 1 < arcs.size(); ++i)
      if (arcs[i].first == arcs[i + 1].first) return std::nullopt;
    Loop out;
    std::uint32_t at = arcs[0].first;
    do {
      out.push_back(at);
      const auto next = std::lower_bound(arcs.begin(), arcs.end(), std::pair(at, 0u));
      if (next == arcs.end() || next->first != at) return std::nullopt;
      at = next->second;
    } while (at != arcs[0].first && out.size() <= arcs.size());
    if (out.size() != arcs.size()) return std::nullopt;
    return out;
  }

  void emit(const Group& group, RoofSurfaces& out) const {
    const auto points = [&](const Loop& loop) {
      std::vector<Point3> path;
      for (const std::uint32_t n : loop) path.push_back(nodes_[n]);
      return path;
    };
    if (group.loops.size() == 1 || group.upright) {
      for (const Loop& loop : group.loops)
        out.surfaces.push_back({group.edge, group.level, group.upright, {points(loop)}});
      return;
    }
    // Pieces of outer rings first, holes to the piece around them.
    const auto twice_area = [&](const Loop& loop) {
      double sum = 0;
      const Point3 o = nodes_[loop[0]];
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const Point3 p = nodes_[loop[i]], q = nodes_[loop[(i + 1) % loop.size()]];
        sum += (p.x - o.x) * (q.y - o.y) - (q.x - o.x) * (p.y - o.y);
      }
      return sum;
    };
    const std::size_t first = out.surfaces.size();
    for (const Loop& loop : group.loops)
      if (twice_area(loop) > 0) out.surfaces.push_back({group.edge, group.level, false, {points(loop)}});
    for (const Loop& loop : group.loops) {
      if (twice_area(loop) > 0) continue;
      for (std::size_t s = first; s < out.surfaces.size(); ++s) {
        std::vector<Point2> ring;
        for (const Point3 p : out.surfaces[s].loops[0]) ring.push_back({p.x, p.y});
        if (!inside(ring, nodes_[loop[0]])) continue;
        out.surfaces[s].loops.push_back(points(loop));
        break;
      }
    }
  }
  static bool inside(const std::vector<Point2>& ring, Point3 at) {
    bool in = false;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point2 p = ring[i], q = ring[(i + 1) % ring.size()];
      if ((p.y > at.y) != (q.y > at.y) && at.x < p.x + (at.y - p.y) / (q.y - p.y) * (q.x - p.x)) in = !in;
    }
    return in;
  }

  static constexpr std::uint32_t kNone = 0xffffffff;
  static constexpr double kOneLine = 0.01;        ///< m: as plans lose corners that bend no wall
  static constexpr double kOnePlane = 0.005;      ///< m: half of what the checker allows
  static constexpr double kMergedHeights = 0.02;  ///< m: what a steep face rises over kNarrowestFace
  double near_, narrow_, level_;                  ///< m: kMergedNodes, kNarrowestFace, kMergedHeights, or coarser
  std::vector<Point3> nodes_;
  std::vector<std::uint32_t> end_of_, group_end_, merged_, parent_;
  std::uint32_t corners_ = 0;
  std::vector<Group> groups_;
  std::vector<std::vector<std::uint32_t>> listed_;  ///< by node: list()
  std::vector<Loop> chains_;  ///< for each edge that leads its group the upper end of the wall, from start to end
};

}  // namespace

RoofSurfaces roof_surfaces(const model::Polygon& plan, const WeightedSkeleton& skeleton, double height_scale,
                           double coarseness) {
  return Tidy(plan, skeleton, height_scale, coarseness).run();
}

}  // namespace blockrand::geometry
