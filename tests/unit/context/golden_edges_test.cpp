// The labels of edges against 300 that were made by eye (tests/golden/README.md).
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "tests/unit/context/town.h"

namespace blockrand::context {
namespace {

using model::Point2;
using model::WallSegmentKind;

struct GoldenEdge {
  std::string extract, building;
  std::int64_t from = 0, to = 0;
  std::string label, note;
  bool sure = false;
};

std::vector<GoldenEdge> golden_edges() {
  std::ifstream file(std::string(BLOCKRAND_SOURCE_DIR) + "/tests/golden/edge_labels.csv");
  std::vector<GoldenEdge> out;
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::istringstream in(line);
    GoldenEdge e;
    std::string from, to, lon, lat, confidence;
    for (std::string* field : {&e.extract, &e.building, &from, &to, &lon, &lat, &e.label, &confidence})
      std::getline(in, *field, ',');
    std::getline(in, e.note);
    e.from = std::stoll(from);
    e.to = std::stoll(to);
    e.sure = confidence == "sure";
    out.push_back(e);
  }
  return out;
}

/// Places of the nodes of one object's rings.
std::map<std::int64_t, Point2> nodes_of(const Town& town, const model::Building& b) {
  std::map<std::int64_t, Point2> out;
  for (const model::MappedRing& ring : town.extract.rings_of(town.extract.buildings[b.mapped_index].rings)) {
    const auto vertices = town.extract.vertices_of(ring);
    const auto nodes = town.extract.nodes_of(ring);
    for (std::size_t i = 0; i < nodes.size(); ++i) out[nodes[i]] = model::snap(town.projection->forward(vertices[i]));
  }
  return out;
}

/// What most of the stretch from p to q is, by the stretches of edges that run along it.
WallSegmentKind majority(const model::Building& b, Point2 p, Point2 q) {
  constexpr double kBeside = 0.75;  // m; how far repair may have moved a wall
  const double length = std::sqrt((q.x - p.x) * (q.x - p.x) + (q.y - p.y) * (q.y - p.y));
  const Point2 along{(q.x - p.x) / length, (q.y - p.y) / length};
  std::array<double, model::kWallSegmentKindCount> common{};
  for (const model::WallSegment& f : b.edges) {
    const model::Polygon& polygon = b.outline[f.polygon];
    const model::Ring& ring = f.ring == 0 ? polygon.outer : polygon.holes[f.ring - 1];
    const Point2 a = ring.points[f.edge], e = ring.points[(f.edge + 1) % ring.size()];
    const double edge = std::sqrt((e.x - a.x) * (e.x - a.x) + (e.y - a.y) * (e.y - a.y));
    const auto place = [&](double t) { return Point2{a.x + (e.x - a.x) / edge * t, a.y + (e.y - a.y) / edge * t}; };
    const Point2 s = place(f.start), t = place(f.end), middle = place((f.start + f.end) / 2);
    const auto project = [&](Point2 o) { return (o.x - p.x) * along.x + (o.y - p.y) * along.y; };
    const double beside = std::fabs((middle.x - p.x) * along.y - (middle.y - p.y) * along.x);
    const double overlap = std::min(project(t), length) - std::max(project(s), 0.0);
    const bool parallel = (e.x - a.x) * along.x + (e.y - a.y) * along.y > 0.9 * edge;
    if (beside < kBeside && overlap > 0 && parallel) common[static_cast<std::size_t>(f.kind)] += overlap;
  }
  return static_cast<WallSegmentKind>(std::max_element(common.begin(), common.end()) - common.begin());
}

struct Count {
  int right = 0, all = 0;
  double share() const { return all == 0 ? 1 : static_cast<double>(right) / all; }
};

TEST(GoldenEdges, AgreeWithLabelsMadeByEye) {
  const std::vector<GoldenEdge> golden = golden_edges();
  ASSERT_EQ(golden.size(), 300u);
  const std::string folder = std::string(BLOCKRAND_SHARED_DIR) + "/data/osm/";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no real data at " << folder;

  std::map<std::string, Count> by_extract, by_label;
  std::map<std::string, std::map<std::string, int>> confusion;
  Count sure, doubtful;
  std::string current;
  Town town;
  for (const GoldenEdge& edge : golden) {
    if (edge.extract != current) {
      current = edge.extract;
      town = read_town(folder + current);
      label_town(town);
    }
    const auto building = std::find_if(town.buildings.begin(), town.buildings.end(),
                                       [&](const model::Building& b) { return b.id() == edge.building; });
    std::string found = "lost";
    if (building != town.buildings.end()) {
      const std::map<std::int64_t, Point2> nodes = nodes_of(town, *building);
      ASSERT_TRUE(nodes.contains(edge.from) && nodes.contains(edge.to)) << edge.building;
      found = model::name(majority(*building, nodes.at(edge.from), nodes.at(edge.to)));
    }
    const bool right = found == edge.label;
    for (Count* c : {&by_extract[edge.extract], &by_label[edge.label], edge.sure ? &sure : &doubtful}) {
      ++c->all;
      c->right += right;
    }
    ++confusion[edge.label][found];
    if (!right)
      std::printf("  %-28.28s %-12s n%lld-n%lld  by eye %s (%s), found %s  %s\n", edge.extract.c_str(),
                  edge.building.c_str(), static_cast<long long>(edge.from), static_cast<long long>(edge.to),
                  edge.label.c_str(), edge.sure ? "sure" : "doubtful", found.c_str(), edge.note.c_str());
  }
  const auto print = [](const char* what, const Count& c) {
    std::printf("  %-34s %3d of %3d  %.1f %%\n", what, c.right, c.all, 100 * c.share());
  };
  for (const auto& [name, c] : by_extract) print(name.c_str(), c);
  for (const auto& [name, c] : by_label) print(name.c_str(), c);
  print("sure", sure);
  print("doubtful", doubtful);
  const Count all{sure.right + doubtful.right, sure.all + doubtful.all};
  print("all", all);
  for (const auto& [label, row] : confusion)
    for (const auto& [found, n] : row)
      if (label != found) std::printf("  %s taken for %s: %d\n", label.c_str(), found.c_str(), n);

  EXPECT_GE(all.share(), 0.97);
  for (const auto& [name, c] : by_label) EXPECT_GE(c.share(), 0.90) << name;
}

}  // namespace
}  // namespace blockrand::context
