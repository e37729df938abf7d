// The conformance tests of docs/rule_language.md §7.4, by their numbers: rule text and what must come out.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "derive_support.h"
#include "styles/grammar/shapes/insert.h"
#include "styles/grammar/shapes/measure.h"
#include "styles/grammar/shapes/scope.h"

namespace blockrand::grammar {
namespace {

using namespace testing_support;
using testing::ElementsAre;

constexpr double kTolerance = 1e-6;  // m, m², m³: the kernel works in doubles on lots of tens of metres

/// The rows whose expectation rests on inference (I): a later correction is one line here.
struct Inferred {
  static constexpr double kFrameTz = -20;  // 1: the pivot lies at the first point, so a footprint has tz = -depth
  static constexpr std::size_t kVariantLeaves = 1;      // 3: what follows the last child has no effect
  static constexpr std::size_t kRidges = 1, kHips = 4;  // 30: roof edges with the bottom face present
  static constexpr double kRidgeLength = 10;            // 30
  static constexpr double kGableRidge = 20;             // 31: along the longer side
};

std::vector<Vector3> world_points(const Shape& shape) {
  std::vector<Vector3> out;
  if (shape.mesh == nullptr) return out;
  const Frame frame = scope_in_world(shape);
  for (const Vector3& v : shape.mesh->vertices) out.push_back(place(frame, v));
  return out;
}
/// Whether a face lies flat at this height in the world.
bool has_flat_face_at(const Shape& shape, double y) {
  const auto points = world_points(shape);
  for (const MeshFace& face : shape.mesh->faces) {
    bool flat = true;
    for (const Corner& corner : face.loops.front()) flat = flat && std::abs(points[corner.vertex].y - y) < kTolerance;
    if (flat) return true;
  }
  return false;
}
std::string split_on(double length, const std::string& block) {
  return lengths(derive_text("Lot --> split(x)" + block, rectangle(length, 4)));
}
std::size_t count(const Derivation& derivation, std::string_view symbol) {
  return leaves_of(derivation, symbol).size();
}
double area(const Derivation& derivation, std::string_view symbol) {
  double out = 0;
  for (const Leaf* leaf : leaves_of(derivation, symbol)) out += geometry_area(leaf->shape);
  return out;
}

TEST(Conformance, Row01InitialShape) {
  const auto d = derive_text("Lot --> X", rectangle(10, 20));
  ASSERT_EQ(d.leaves.size(), 1u);
  EXPECT_EQ(size_text(leaf(d, "X")), "10 0 20");
  EXPECT_NEAR(leaf(d, "X").scope.origin.z, Inferred::kFrameTz, kTolerance);
}

TEST(Conformance, Row02Extrude) {
  const auto d = derive_text("Lot --> extrude(5)", rectangle(10, 20));
  ASSERT_EQ(d.leaves.size(), 1u);
  const Shape& s = leaf(d, "Lot");
  EXPECT_EQ(size_text(s), "10 5 20");
  EXPECT_EQ(geometry_face_count(s), 6);
  EXPECT_EQ(geometry_vertex_count(s), 8);
  EXPECT_EQ(geometry_edge_count(s), 12);
  EXPECT_NEAR(geometry_area(s), 700, kTolerance);
  EXPECT_NEAR(geometry_volume(s), 1000, kTolerance);
  EXPECT_TRUE(geometry_is_closed(s));
}

TEST(Conformance, Row03StepsRunLeftToRight) {
  const auto d = derive_text("Lot --> A t(3,0,0) B", rectangle(10, 20));
  EXPECT_EQ(d.leaves.size(), 2u);
  EXPECT_NEAR(leaf(d, "B").scope.origin.x, leaf(d, "A").scope.origin.x + 3, kTolerance);
  EXPECT_EQ(derive_text("Lot --> A t(3,0,0)", rectangle(10, 20)).leaves.size(), Inferred::kVariantLeaves);
}

TEST(Conformance, Row04BracketsKeepTheShape) {
  const auto d = derive_text("Lot --> [ t(0,5,0) A ] B", rectangle(10, 20));
  EXPECT_NEAR(leaf(d, "A").scope.origin.y, 5, kTolerance);
  EXPECT_NEAR(leaf(d, "B").scope.origin.y, 0, kTolerance);
}

TEST(Conformance, Row05DottedNamesAreLeaves) {
  const auto d = derive_text("House --> extrude(3) House.", rectangle(10, 20));
  EXPECT_EQ(d.leaves.size(), 1u);
  EXPECT_EQ(count(d, "House."), 1u);
  EXPECT_TRUE(d.diagnostics.empty()) << all_diagnostics(d.diagnostics);
}

TEST(Conformance, Row06SplitsCapWhatTheyCut) {
  const auto d = derive_text("Lot --> extrude(10) split(x){ ~1 : X. | ~1 : NIL }", rectangle(10, 20));
  ASSERT_EQ(d.leaves.size(), 1u);
  EXPECT_NEAR(leaf(d, "X.").size.x, 5, kTolerance);
  EXPECT_NEAR(geometry_volume(leaf(d, "X.")), 1000, kTolerance);
  EXPECT_TRUE(geometry_is_closed(leaf(d, "X.")));
}

TEST(Conformance, Row07To12SplitSizes) {
  EXPECT_EQ(split_on(5, "{ 2 : A. | 1 : B. | 1 : C. | 2 : D. | 1 : E. }"), "A 2, B 1, C 1, D 1");
  const auto eight =
      derive_text("Lot --> split(x){ 1.5 : A. | -2 : B. | 1.5 : C. | 1.5 : D. | 0 : E. | 1.5 : F. }", rectangle(5, 4));
  EXPECT_EQ(lengths(eight), "A 1.5, C 1.5, D 1.5, F 0.5");
  EXPECT_NEAR(leaf(eight, "C.").scope.origin.x, 1.5, kTolerance);
  EXPECT_EQ(split_on(10, "{ '0.5 : A. | '0.1 : B. | '0.2 : C. }"), "A 5, B 1, C 2");
  EXPECT_EQ(split_on(10, "{ ~0.5 : A. | ~0.1 : B. | ~0.2 : C. }"), "A 6.25, B 1.25, C 2.5");
  EXPECT_EQ(split_on(10, "{ 3.3 : A. | ~3 : B. | 5 : C. }"), "A 3.3, B 1.7, C 5");
  EXPECT_EQ(split_on(10, "{ '0.5 : A. | '0.6 : B. | 3 : C. }"), "A 5, B 5");
  EXPECT_EQ(split_on(5, "{ 3 : A. | ~1 : B. | 2 : C. }"), "A 3, C 2");
}

TEST(Conformance, Row13To16Repeats) {
  EXPECT_EQ(split_on(10, "{ 2 : A. | 1 : B. }*"), "A 2, B 1, A 2, B 1, A 2, B 1, A 1");
  EXPECT_EQ(split_on(10, "{ ~2 : A. | ~1 : B. }*"), "A 2.222, B 1.111, A 2.222, B 1.111, A 2.222, B 1.111");
  EXPECT_EQ(split_on(10, "{ ~2.1 : A. }*"), "A 2, A 2, A 2, A 2, A 2");
  const auto fifteen =
      derive_text("Lot --> split(x){ 1 : A. | { ~1 : B. | 0.2 : C. | ~1 : B. }* | 1 : A. }", rectangle(10, 4));
  EXPECT_EQ(fifteen.leaves.size(), 14u);
  for (const Leaf* b : leaves_of(fifteen, "B.")) EXPECT_NEAR(b->shape.size.x, 0.9, kTolerance);
  for (const Leaf* c : leaves_of(fifteen, "C.")) EXPECT_NEAR(c->shape.size.x, 0.2, kTolerance);
  EXPECT_EQ(split_on(10, "{ { 1 : A. | ~2.7 : B. }* | 1 : A. }"), "A 1, B 2, A 1, B 2, A 1, B 2, A 1");
}

TEST(Conformance, Row17SplitIndex) {
  const auto d = derive_text("Lot --> primitiveCube() split(x){ '0.1 : A. | '0.1 : B. }*", rectangle(10, 10));
  ASSERT_EQ(d.leaves.size(), 10u);
  for (std::size_t i = 0; i < 10; ++i) {
    EXPECT_EQ(d.leaves[i].shape.split.index, static_cast<int>(i));
    EXPECT_EQ(d.leaves[i].shape.split.total, 10);
    EXPECT_EQ(d.leaves[i].symbol, i % 2 == 0 ? "A." : "B.");
  }
}

TEST(Conformance, Row18Adjust) {
  const auto slabs = derive_text("Lot --> split(x, noAdjust){ '0.5 : A. | '0.5 : B. }", triangle());
  EXPECT_NEAR(leaf(slabs, "A.").size.z, 10, kTolerance);
  EXPECT_NEAR(leaf(slabs, "B.").size.z, 10, kTolerance);
  const auto fitted = derive_text("Lot --> split(x){ '0.5 : A. | '0.5 : B. }", triangle());
  EXPECT_NEAR(leaf(fitted, "A.").size.z, 10, kTolerance);
  EXPECT_NEAR(leaf(fitted, "B.").size.z, 5, kTolerance);
}

TEST(Conformance, Row19To22Components) {
  const auto nineteen =
      derive_text("Lot --> extrude(5) comp(f){ side : S. | top : T. | bottom : B. }", rectangle(10, 20));
  EXPECT_EQ(count(nineteen, "S."), 4u);
  EXPECT_EQ(count(nineteen, "T."), 1u);
  EXPECT_EQ(count(nineteen, "B."), 1u);

  const auto twenty =
      derive_text("Lot --> primitiveCube() comp(f){ front : F. | side : S. | all = A. }", rectangle(10, 10));
  ASSERT_EQ(count(twenty, "F."), 1u);
  EXPECT_EQ(leaf(twenty, "F.").component.index, 0);
  EXPECT_EQ(leaf(twenty, "F.").component.total, 1);
  EXPECT_EQ(leaf(twenty, "F.").component.selector, "front");
  ASSERT_EQ(count(twenty, "S."), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(leaf(twenty, "S.", i).component.index, static_cast<int>(i));
    EXPECT_EQ(leaf(twenty, "S.", i).component.total, 3);
    EXPECT_EQ(leaf(twenty, "S.", i).component.selector, "side");
  }
  ASSERT_EQ(count(twenty, "A."), 1u);
  EXPECT_EQ(geometry_face_count(leaf(twenty, "A.")), 2);
  EXPECT_EQ(leaf(twenty, "A.").component.index, 0);
  EXPECT_EQ(leaf(twenty, "A.").component.total, 1);
  EXPECT_EQ(leaf(twenty, "A.").component.selector, "all");

  const auto front = derive_text("Lot --> extrude(5) comp(f){ front : F. }", rectangle(10, 20));
  ASSERT_EQ(count(front, "F."), 1u);
  EXPECT_EQ(size_text(leaf(front, "F.")), "10 5 0");
  const Frame frame = scope_in_world(leaf(front, "F."));
  EXPECT_NEAR(frame.axes[0].x, 1, kTolerance);
  EXPECT_NEAR(frame.axes[2].z, 1, kTolerance);

  for (const auto& [kind, expected] : {std::pair{"e", 12u}, {"fe", 24u}, {"v", 8u}, {"f", 6u}})
    EXPECT_EQ(derive_text("Lot --> primitiveCube() comp(" + std::string(kind) + "){ all : C. }", rectangle(10, 10))
                  .leaves.size(),
              expected)
        << kind;
}

TEST(Conformance, Row23GroupOperators) {
  const auto run = [](const std::string& op) {
    return derive_text("Lot --> extrude(4) comp(f){ front " + op + " F. | all = M. }", u_shape());
  };
  EXPECT_EQ(count(run(":"), "F."), 3u);
  const auto together = run("=");
  ASSERT_EQ(count(together, "F."), 1u);
  EXPECT_EQ(geometry_face_count(leaf(together, "F.")), 3);
  EXPECT_EQ(count(run("=:"), "F."), 3u);
  ASSERT_EQ(count(together, "M."), 1u);
  EXPECT_EQ(geometry_face_count(leaf(together, "M.")), 7);
}

TEST(Conformance, Row24SlopeSelectors) {
  for (const auto& [angle, symbol] : {std::pair{"10", "H."}, {"30", "A."}, {"80", "V."}}) {
    const auto d = derive_text("Lot --> roofHip(" + std::string(angle) +
                                   ") comp(f){ bottom : NIL | horizontal : H. | aslant : A. | vertical : V. }",
                               rectangle(10, 10));
    EXPECT_EQ(count(d, symbol), 4u) << angle;
    EXPECT_EQ(d.leaves.size(), 4u) << angle;
  }
}

TEST(Conformance, FacesOfDormersAndCrossGablesByName) {
  // A dormer's body: a box with a gable roof. Every face can be told and goes on by itself (Holtmeier 3.3: component split).
  const auto d = derive_text(
      "Lot --> extrude(1.5) comp(f){ front : Front | left : Cheek. | right : Cheek. | top : Roof | bottom : NIL | back "
      ": Back. }\n"
      "Roof --> roofGable(45) comp(f){ bottom : NIL | aslant : Slope. | vertical : Gable. }\n"
      "Front --> split(x){ ~1 : Wall. | 0.9 : Window. | ~1 : Wall. }",
      rectangle(1.4, 2));
  EXPECT_EQ(count(d, "Window."), 1u);
  EXPECT_EQ(count(d, "Wall."), 2u);
  EXPECT_EQ(count(d, "Cheek."), 2u);
  EXPECT_EQ(count(d, "Back."), 1u);
  EXPECT_EQ(count(d, "Slope."), 2u);
  EXPECT_EQ(count(d, "Gable."), 2u);
  EXPECT_NEAR(area(d, "Gable."), 2 * 0.5 * 1.4 * 0.7, kTolerance);
}

TEST(Conformance, Row25Offset) {
  const auto d = derive_text("Lot --> offset(-1) comp(f){ inside = N. | border = B. }", rectangle(10, 20));
  EXPECT_NEAR(area(d, "N."), 144, kTolerance);
  EXPECT_NEAR(area(d, "B."), 56, kTolerance);
  const auto kept = derive_text("Lot --> offset(-1, inside) X.", rectangle(10, 20));
  EXPECT_EQ(size_text(leaf(kept, "X.")), "8 0 18");
}

TEST(Conformance, Row26Setback) {
  const auto d = derive_text("Lot --> setback(3){ front : F. | remainder : R. }", rectangle(10, 20));
  EXPECT_NEAR(area(d, "F."), 30, kTolerance);
  EXPECT_NEAR(area(d, "R."), 170, kTolerance);
  // The first edge of the strip is the outline's front edge at z = 0; the remainder's is the one nearest to it.
  for (const auto& [symbol, z] : {std::pair{"F.", 0.0}, {"R.", -3.0}}) {
    const Shape& s = leaf(d, symbol);
    const auto points = world_points(s);
    const auto& outline = s.mesh->faces.front().loops.front();
    EXPECT_NEAR(points[outline[0].vertex].z, z, kTolerance) << symbol;
    EXPECT_NEAR(points[outline[1].vertex].z, z, kTolerance) << symbol;
  }
}

TEST(Conformance, Row27ShapeLuo) {
  const auto run = [](const std::string& operation) {
    return derive_text("Lot --> " + operation + "{ shape : S. | remainder : R. }", rectangle(10, 20));
  };
  const auto l = run("shapeL(4,5)"), u = run("shapeU(4,3,2)"), o = run("shapeO(4,3,2,1)");
  EXPECT_NEAR(area(l, "S."), 120, kTolerance);
  EXPECT_NEAR(area(l, "R."), 80, kTolerance);
  EXPECT_NEAR(area(u, "S."), 120, kTolerance);
  EXPECT_NEAR(area(u, "R."), 80, kTolerance);
  EXPECT_NEAR(area(o, "S."), 116, kTolerance);
  EXPECT_NEAR(area(o, "R."), 84, kTolerance);
  EXPECT_EQ(geometry_hole_count(leaf(o, "S.")), 1);
}

TEST(Conformance, Row28SetbackToArea) {
  const auto d = derive_text("Lot --> setbackToArea(100){ all = NIL | remainder : R. }", rectangle(20, 20));
  EXPECT_NEAR(area(d, "R."), 100, 1e-4);
  EXPECT_NEAR(leaf(d, "R.").size.x, 10, 1e-4);
  for (const Vector3& p : world_points(leaf(d, "R."))) EXPECT_NEAR(std::abs(p.x - 10), 5, 1e-4);
}

TEST(Conformance, Row29InnerRectangle) {
  const auto d = derive_text("Lot --> innerRectangle(scope){ shape : S. | remainder = R. }", l_shape());
  EXPECT_NEAR(area(d, "S."), 200, kTolerance);
  EXPECT_NEAR(area(d, "R."), 100, kTolerance);
}

TEST(Conformance, Row30RoofHip) {
  const auto d = derive_text("Lot --> roofHip(45) X.", rectangle(10, 20));
  EXPECT_EQ(geometry_face_count(leaf(d, "X.")), 5);
  EXPECT_NEAR(leaf(d, "X.").size.y, 5, kTolerance);
  EXPECT_NEAR(geometry_volume(leaf(d, "X.")), 1250.0 / 3, 1e-4);
  const auto edges = derive_text("Lot --> roofHip(45) comp(e){ ridge : G. | hip : H. }", rectangle(10, 20));
  EXPECT_EQ(count(edges, "G."), Inferred::kRidges);
  EXPECT_EQ(count(edges, "H."), Inferred::kHips);
  EXPECT_NEAR(leaf(edges, "G.").size.x, Inferred::kRidgeLength, kTolerance);
}

TEST(Conformance, Row31RoofGable) {
  for (const char* call : {"roofGable(45)", "roofGable(byHeight, 5)"}) {
    const auto d = derive_text(std::string("Lot --> ") + call + " X.", rectangle(10, 20));
    EXPECT_EQ(geometry_face_count(leaf(d, "X.")), 5) << call;
    EXPECT_NEAR(leaf(d, "X.").size.y, 5, kTolerance) << call;
    EXPECT_NEAR(geometry_volume(leaf(d, "X.")), 500, 1e-4) << call;
    double low = 1e9, high = -1e9;
    for (const Vector3& p : world_points(leaf(d, "X.")))
      if (p.y > 5 - kTolerance) low = std::min(low, p.z), high = std::max(high, p.z);
    EXPECT_NEAR(high - low, Inferred::kGableRidge, kTolerance) << call;
  }
}

TEST(Conformance, Row32RoofShedAndPyramid) {
  const auto shed = derive_text("Lot --> roofShed(byHeight, 3) X.", rectangle(10, 20));
  EXPECT_EQ(geometry_face_count(leaf(shed, "X.")), 5);
  EXPECT_NEAR(geometry_volume(leaf(shed, "X.")), 300, 1e-4);
  for (const Vector3& p : world_points(leaf(shed, "X.")))
    EXPECT_TRUE(p.y <= kTolerance || std::abs(p.z + 20) < kTolerance) << "low along the first edge";
  const auto pyramid = derive_text("Lot --> roofPyramid(byHeight, 6) X.", rectangle(10, 20));
  EXPECT_EQ(geometry_face_count(leaf(pyramid, "X.")), 5);
  EXPECT_NEAR(geometry_volume(leaf(pyramid, "X.")), 400, 1e-4);
}

TEST(Conformance, Row33FlatTop) {
  const Shape sloped = initial_shape({{0, 0, 0}, {10, 0, 0}, {10, 2, -10}, {0, 2, -10}});
  for (const auto& [height, y] : {std::pair{"10", 10.0}, {"0", 2.0}, {"-10", -8.0}}) {
    const auto d = derive_text("Lot --> extrude(world.up.flatTop, " + std::string(height) + ") X.", sloped);
    EXPECT_TRUE(has_flat_face_at(leaf(d, "X."), y)) << height;
  }
}

/// No assets are read: `i` puts a box in their place. So the asset's rule is tried behind `s`, on the shape that `i`
/// gets.
TEST(Conformance, Row34InsertedSizes) {
  const auto inserted = [](const std::string& sizes) {
    const auto d = derive_text("Lot --> t(0,0,0) s(" + sizes + ") X.", rectangle(10, 20));
    Shape s = leaf(d, "X.");
    const Vector3 before = s.scope.origin;
    Mesh box = cube_mesh();
    for (Vector3& v : box.vertices) v = {1 + v.x * 3, 1 + v.y * 6, 1 + v.z * 2};
    insert_asset(s, std::move(box));
    return std::pair(s.size, s.scope.origin - before);
  };
  EXPECT_EQ(inserted("0,0,0"), (std::pair(Vector3{3, 6, 2}, Vector3{1, 1, 1})));
  EXPECT_EQ(inserted("0,12,0"), (std::pair(Vector3{6, 12, 4}, Vector3{2, 0, 2})));
  EXPECT_EQ(inserted("9,9,0"), (std::pair(Vector3{9, 9, 4.5}, Vector3{0, 0, 0})));
  const auto placeholder = derive_text("Lot --> s(2,3,4) i(\"assets/column.obj\") X.", rectangle(10, 20));
  EXPECT_EQ(size_text(leaf(placeholder, "X.")), "2 3 4");
  EXPECT_NEAR(geometry_volume(leaf(placeholder, "X.")), 24, kTolerance);
}

/// Row 40 asks what touches what: the wall between the two boxes touches the other one, the outer one nothing.
TEST(Conformance, Row40ContextLooksAtTheOtherShapes) {
  const auto d = derive_text(
      "Lot --> split(x){ '0.5 : A | '0.5 : B }\n"
      "A --> extrude(10) comp(f){ right : Q | left : Q | all : X. }\n"
      "B --> extrude(10) comp(f){ all : X. }\n"
      "Q --> case touches(intra) : Red. else : Blue.",
      rectangle(10, 10));
  EXPECT_EQ(count(d, "Red."), 1u);
  EXPECT_EQ(count(d, "Blue."), 1u);
}

TEST(Conformance, Row35CenterAndPivot) {
  const auto centred = derive_text("Lot --> s('0.8,'1,'0.6) center(xz) X.", rectangle(10, 20));
  EXPECT_EQ(size_text(leaf(centred, "X.")), "8 0 12");
  EXPECT_NEAR(leaf(centred, "X.").scope.origin.x, 1, kTolerance);
  EXPECT_NEAR(leaf(centred, "X.").scope.origin.z, -16, kTolerance);
  // Along the axes that the scope has now: a chimney stands upright in the middle of a face that looks up.
  const auto chimney =
      derive_text("Lot --> extrude(9) comp(f){ top : alignScopeToAxes(y) s(1,3,1) center(xz) primitiveCube() X. }",
                  rectangle(10, 20));
  const Frame at = scope_in_world(leaf(chimney, "X."));
  EXPECT_NEAR(at.origin.x, 4.5, kTolerance);
  EXPECT_NEAR(at.origin.y, 9, kTolerance);
  EXPECT_NEAR(at.origin.z, -10.5, kTolerance);
  const auto turned = derive_text("Lot --> extrude(5) setPivot(xyz,1) X.", rectangle(10, 20));
  const Shape& s = leaf(turned, "X.");
  EXPECT_EQ(size_text(s), "20 5 10");
  EXPECT_NEAR(length(s.scope.origin), 0, kTolerance);
  EXPECT_NEAR(s.scope.axes[0].x, 1, kTolerance);
  EXPECT_NEAR(s.pivot.axes[0].z, 1, kTolerance) << "x' is the old +z";
}

TEST(Conformance, Row36TrimPlanes) {
  const std::string rules = "Lot --> extrude(10) comp(f){ front : F }\nF --> ";
  const auto trimmed = derive_text(rules + "s(15,'1,2) center(xyz) primitiveCube()", rectangle(10, 10));
  EXPECT_NEAR(geometry_volume(leaf(trimmed, "F")), 200, 1e-4);
  const auto whole =
      derive_text(rules + "set(trim.vertical,false) s(15,'1,2) center(xyz) primitiveCube()", rectangle(10, 10));
  EXPECT_NEAR(geometry_volume(leaf(whole, "F")), 300, 1e-4);
}

TEST(Conformance, Row37AttributesFunctionsConstants) {
  const auto d = derive_text(
      "attr a = rand\nf = rand\nconst c = comp.index\nattr n = 0\n"
      "Lot --> print(a) print(a) print(f) print(f) extrude(3) comp(f){ all : P }\n"
      "P --> print(c) NIL",
      rectangle(10, 20));
  ASSERT_EQ(d.prints.size(), 10u);
  EXPECT_EQ(d.prints[0], d.prints[1]);
  EXPECT_NE(d.prints[2], d.prints[3]);
  for (std::size_t i = 4; i < 10; ++i) EXPECT_EQ(d.prints[i], "-1");
  const auto set =
      derive_text("attr n = 0\nLot --> split(x){ '0.5 : set(n,1) Q | '0.5 : Q }\nQ --> print(n)", rectangle(10, 20));
  EXPECT_THAT(set.prints, ElementsAre("1", "0"));
}

TEST(Conformance, Row38Imports) {
  const Files files{{"imp.cga", "attr h = 10\nLot --> extrude(h)"}};
  const auto height = [&](const std::string& main) {
    const auto d = derive_text(main, rectangle(10, 20), {}, files);
    EXPECT_EQ(d.leaves.size(), 1u) << main;
    return d.leaves.empty() ? 0 : d.leaves[0].shape.size.y;
  };
  const std::string call = "\nMain --> imp.Lot";
  EXPECT_NEAR(height("import imp : \"imp.cga\"\nattr h = 20" + call), 20, kTolerance);
  EXPECT_NEAR(height("import imp : \"imp.cga\" (h)\nattr h = 20" + call), 10, kTolerance);
  EXPECT_NEAR(height("import imp : \"imp.cga\" ()\nattr h = 20" + call), 10, kTolerance);
  EXPECT_NEAR(height("import imp : \"imp.cga\" (h=30)\nattr h = 20" + call), 30, kTolerance);
  EXPECT_NEAR(height("import imp : \"imp.cga\"\nattr h = 20\nMain --> imp(h=40).Lot"), 40, kTolerance);
  EXPECT_NEAR(height("import imp : \"imp.cga\"\nMain --> set(imp.h,5) imp.Lot"), 5, kTolerance);
  EXPECT_NEAR(height("import imp : \"imp.cga\"\nMain --> set(imp.h,5) imp().Lot"), 10, kTolerance);
}

TEST(Conformance, Row39TreeKeysAndSeeds) {
  const auto d = derive_text(
      "Init --> print(getTreeKey) extrude(6) comp(f){ front : F }\n"
      "F --> print(getTreeKey) split(y){ '0.5 : Floor }*\n"
      "Floor --> print(getTreeKey) split(x){ '1/3 : Wall }*\n"
      "Wall --> print(getTreeKey)",
      rectangle(10, 20));
  EXPECT_THAT(d.prints, ElementsAre("0;", "0;0;", "0;0;0;", "0;0;1;", "0;0;0;0;", "0;0;0;1;", "0;0;0;2;", "0;0;1;0;",
                                    "0;0;1;1;", "0;0;1;2;"));
  const Program program = load_text("Lot --> 30% : A. else : B.");
  const Deriver deriver(program);
  int taken = 0;
  for (std::uint64_t seed = 0; seed < 10000; ++seed) {
    DeriveOptions options;
    options.seed = seed;
    const auto one = deriver.run(rectangle(10, 20), options);
    EXPECT_EQ(one.leaves.size(), 1u);
    taken += one.leaves[0].symbol == "A.";
  }
  EXPECT_GE(taken, 2900);
  EXPECT_LE(taken, 3100);
}

TEST(Conformance, Row41ArraysAndTexts) {
  const auto d = derive_text(
      "Lot --> print([1:2:5]) print([4:-1:2]) print([1,2;3,4][1,0]) print(sum([true,false,true]))\n"
      "print(substring(\"0123456789\",-20,5)) print(find(\"CE_Zero CE_One\",\"CE\",1))\n"
      "print(listItem(\"rule;your;city;\",2)) print(getRange(\"a.b.c\",\".\",\".\")) print(str(1.69 - 69/100))",
      rectangle(10, 20));
  EXPECT_THAT(d.prints, ElementsAre("(3)[1,3,5]", "(3)[4,3,2]", "3", "2", "01234", "8", "city", "b", "1"));
}

TEST(Conformance, Row42Reports) {
  const auto d = derive_text("Lot --> extrude(30) comp(f){ side : W }\nW --> report(\"area\", geometry.area) NIL",
                             rectangle(10, 20));
  EXPECT_TRUE(d.leaves.empty());
  const Report* report = d.report("area");
  ASSERT_NE(report, nullptr);
  EXPECT_EQ(report->count, 4u);
  EXPECT_NEAR(report->sum, 1800, kTolerance);
  EXPECT_NEAR(report->minimum, 300, kTolerance);
  EXPECT_NEAR(report->maximum, 600, kTolerance);
  EXPECT_NEAR(report->mean, 450, kTolerance);
}

}  // namespace
}  // namespace blockrand::grammar
