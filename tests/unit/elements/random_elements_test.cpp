// A thousand elements of every kind with parameters drawn from their whole ranges keep what elements promise.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "pipeline/base/random.h"
#include "styles/elements/element_catalogue.h"
#include "styles/elements/mesh_builder.h"
#include "styles/elements/opening_edges.h"
#include "tests/unit/elements/element_checks.h"
#include "tests/unit/elements/mesh_measures.h"
#include "tests/unit/elements/shipped_elements.h"

namespace blockrand::elements {
namespace {

class Draws {
 public:
  explicit Draws(std::uint64_t seed) : seed_(seed) {}
  double unit() { return base::random_unit(seed_, n_++, "element"); }
  double between(double least, double most) { return least + (most - least) * unit(); }
  int whole(double least, double most) {
    return static_cast<int>(least) + static_cast<int>(unit() * (most - least + 1));
  }

 private:
  std::uint64_t seed_, n_ = 0;
};

/// Every other parameter is drawn; a third of these at one of its limits.
std::vector<Parameter> drawn(const ElementKind& kind, Draws& draws) {
  // Mouldings that stand on their own; slabs as high as a storey's foot are no hoods.
  static const std::vector<std::string> presets{"plain_band",
                                                "plinth_cornice",
                                                "string_course",
                                                "sill_band",
                                                "sill",
                                                "cyma",
                                                "chamfer",
                                                "drip",
                                                "corona",
                                                "hood",
                                                "casing",
                                                "main_cornice",
                                                "main_cornice_brackets"};
  std::vector<Parameter> out;
  for (const ParameterInfo& info : kind.parameters) {
    if (draws.unit() < 0.5) continue;
    const double limit = draws.unit();
    if (kind.name == "shaped_window" && info.unit.starts_with("of the ")) {
      // Edges that move in by more than a quarter leave no opening, mostly.
      out.push_back({info.name, limit < 0.1 ? draws.between(0, 1) : draws.between(0, 0.25)});
      continue;
    }
    switch (info.type) {
      case ParameterInfo::Type::number:
        out.push_back({info.name, limit < 0.15  ? info.least
                                  : limit < 0.3 ? info.most
                                                : draws.between(info.least, info.most)});
        break;
      case ParameterInfo::Type::whole:
        out.push_back({info.name, static_cast<double>(draws.whole(info.least, info.most))});
        break;
      case ParameterInfo::Type::word:
        out.push_back(
            {info.name,
             info.words[static_cast<std::size_t>(draws.whole(0, static_cast<double>(info.words.size()) - 1))]});
        break;
      case ParameterInfo::Type::profile:
        out.push_back(
            {info.name, presets[static_cast<std::size_t>(draws.whole(0, static_cast<double>(presets.size()) - 1))]});
        break;
      case ParameterInfo::Type::edge: {
        const auto shapes = edge_shapes();
        const auto& shape = shapes[static_cast<std::size_t>(draws.whole(0, static_cast<double>(shapes.size()) - 1))];
        out.push_back({info.name, std::string(shape.name)});
        break;
      }
    }
  }
  return out;
}

std::string text(const std::vector<Parameter>& parameters) {
  std::string out;
  for (const Parameter& p : parameters)
    out += " " + p.name + "=" + (p.value.index() == 0 ? fmt::format("{}", std::get<0>(p.value)) : std::get<1>(p.value));
  return out;
}

/// FNV-1a over all that a mesh and an opening say: equal numbers before and after a change mean equal bytes.
void add_bytes(std::uint64_t& hash, const Element& e) {
  const auto add = [&](const auto& value) {
    const auto* const bytes = reinterpret_cast<const unsigned char*>(&value);
    for (std::size_t i = 0; i < sizeof(value); ++i) hash = (hash ^ bytes[i]) * 1099511628211u;
  };
  for (const char c : e.name) add(c);
  for (const model::Point3& p : e.mesh.vertices) {
    add(p.x);
    add(p.y);
    add(p.z);
  }
  for (const std::uint32_t i : e.mesh.indices) add(i);
  for (const ElementFace& f : e.mesh.faces) {
    add(f.first);
    add(f.count);
    add(f.part);
  }
  for (const model::Point2 p : e.opening.outline) {
    add(p.x);
    add(p.y);
  }
  add(e.opening.reveal);
}

class RandomElements : public testing::TestWithParam<std::string> {};

TEST_P(RandomElements, KeepTheirPromises) {
  const ElementKind& kind = *shipped().find(GetParam());
  int built = 0, refused = 0, sound = 0, validated = 0;
  std::uint64_t bytes = 14695981039346656037u;
  std::map<std::string, int> reasons;
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    Draws draws(seed + 1);
    // Sizes around the usual, and the extremes.
    const double w = draws.unit() < 0.1
                         ? kind.width.least
                         : draws.between(kind.width.least, std::min(kind.width.most, 2.5 * kind.width.usual));
    const double h = draws.unit() < 0.1 ? kind.height.least
                                        : draws.between(0.6 * kind.height.usual + 0.4 * kind.height.least,
                                                        std::min(kind.height.most, 1.8 * kind.height.usual));
    const auto parameters = drawn(kind, draws);
    const std::string what = fmt::format("{} {:.3f} x {:.3f}{}", kind.name, w, h, text(parameters));
    const auto made = shipped().make(kind.name, w, h, parameters);
    if (!made) {
      ++refused;
      ++reasons[made.error().substr(std::min(made.error().size(), made.error().find(": ")))];
      ASSERT_FALSE(made.error().empty()) << what;
      continue;
    }
    ++built;
    add_bytes(bytes, *made);
    const ElementMesh& mesh = made->mesh;
    ASSERT_EQ(checks::faces_wrong(mesh), "") << what;
    ASSERT_EQ(checks::flicker(mesh), "") << what;
    for (const checks::Body& body : checks::bodies(mesh)) {
      if (!body.closed) continue;
      ASSERT_GT(checks::volume(mesh, body), 0) << what;
      if (seed % 20 == 0 && body.faces.size() < 400) {
        ++validated;
        const std::string defect = checks::solid_defect(mesh, body);
        sound += defect == "none";
        if (defect != "none" && std::getenv("ELEMENTS_REASONS")) fmt::print("  {}: {}\n", defect, what);
      }
    }
    const Bounds3 box = bounds_of(mesh);
    const Outline& outline = made->opening.outline;
    double room = kDeepest;
    for (const Parameter& p : parameters)
      if (p.name == "leaves" && p.value == std::variant<double, std::string>("open")) room = kDeepest + w / 2;
    ASSERT_GE(box.least.z, -room) << what;
    ASSERT_LE(box.most.z, 2.05) << what;
    if (kind.semantic == ElementClass::installation) {
      ASSERT_TRUE(outline.empty()) << what;
      for (const checks::Body& body : checks::bodies(mesh)) ASSERT_TRUE(body.closed) << what;
      continue;
    }
    ASSERT_TRUE(is_simple(outline)) << what;
    ASSERT_GT(signed_area(outline), 0) << what;
    const Bounds2 hole = bounds_of(outline);
    // Edges that are drawn one by one may move in, and need not be convex.
    const bool shaped = kind.name == "shaped_window";
    if (shaped) {
      ASSERT_LE(std::max(-hole.least.x, hole.most.x), w / 2 + 0.001) << what;
      ASSERT_TRUE(hole.least.y >= 0 && hole.most.y <= h + 0.001) << what;
    } else {
      ASSERT_NEAR(hole.width(), w, 0.0015) << what;
      ASSERT_NEAR(hole.height(), h, 0.001) << what;
      ASSERT_EQ(hole.least.y, 0) << what;
    }
    for (std::size_t i = 0; i < outline.size(); ++i) {
      ASSERT_EQ(model::snap(outline[i]), outline[i]) << what;
      const model::Point2 a = outline[i], b = outline[(i + 1) % outline.size()], c = outline[(i + 2) % outline.size()];
      ASSERT_TRUE(shaped || (b.x - a.x) * (c.y - b.y) - (b.y - a.y) * (c.x - b.x) > 0) << what << ": convex";
    }
    // Behind the reveal everything stays within the opening; before it only trim leaves it.
    for (const ElementFace& f : mesh.faces)
      for (std::uint32_t i = 0; i < f.count; ++i) {
        const model::Point3 p = mesh.vertices[mesh.indices[f.first + i]];
        const bool joinery = f.part == Part::frame || f.part == Part::glass || f.part == Part::leaf;
        const bool trim = f.part == Part::surround || f.part == Part::sill || (f.part == Part::panel && p.z > -0.006);
        const double slack = joinery ? 1e-9 : kApart + 1e-9;
        if (!trim) {
          ASSERT_GE(p.x, hole.least.x - slack) << what;
          ASSERT_LE(p.x, hole.most.x + slack) << what;
          ASSERT_GE(p.y, hole.least.y - slack) << what;
          ASSERT_LE(p.y, hole.most.y + slack) << what;
          ASSERT_LE(p.z, joinery ? 0.06 - made->opening.reveal : 0.1) << what;
        }
      }
    const bool may_be_open = kind.name == "carriage_gateway" || kind.name == "reveal";
    if (!may_be_open) {
      ASSERT_EQ(checks::open_place(*made), "") << what;
    }
  }
  RecordProperty("built", built);
  for (const auto& [reason, count] : reasons)
    if (std::getenv("ELEMENTS_REASONS")) fmt::print("  {} {} {}\n", kind.name, count, reason);
  // Four edges drawn at random seldom leave an opening.
  EXPECT_GE(built, kind.name == "shaped_window" ? 150 : 450) << refused << " refused";
  EXPECT_GE(sound, validated * 97 / 100) << validated << " closed bodies judged";
  fmt::print("{}: {} built, {} refused; {} of {} closed bodies sound on the grid; bytes {:016x}\n", kind.name, built,
             refused, sound, validated, bytes);
}

std::vector<std::string> names() {
  std::vector<std::string> out;
  for (const ElementKind& kind : shipped().kinds()) out.push_back(kind.name);
  return out;
}

INSTANTIATE_TEST_SUITE_P(All, RandomElements, testing::ValuesIn(names()), [](const auto& i) { return i.param; });

}  // namespace
}  // namespace blockrand::elements
