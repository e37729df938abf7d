// Elements that are glTF models: anchors, fits, parts and errors.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "importers/reference/triangle_model.h"
#include "styles/elements/mesh_builder.h"
#include "tests/unit/elements/element_checks.h"
#include "tests/unit/elements/element_folder.h"
#include "tests/unit/elements/mesh_measures.h"
#include "tests/unit/importers/reference/gltf_support.h"

namespace blockrand::elements {
namespace {

using importers::reference::read_triangle_model;
using importers::reference::test::GltfMaker;
using model::Point3;
using test::ElementFolder;
using testing::AllOf;
using testing::HasSubstr;

/// Two cubes of 0.5 m, one of iron at (0, 0, 0), one of a material without a name in the table 1 m to its right.
std::string two_cubes() {
  GltfMaker file;
  const int iron = file.cube(0.5F), wood = file.cube(0.5F);
  file.json["meshes"][iron]["primitives"][0]["material"] = 0;
  file.json["meshes"][wood]["primitives"][0]["material"] = 1;
  file.json["materials"] = {{{"name", "Iron"}}, {{"name", "Wood"}}};
  file.node({{"children", {1, 2}}});
  file.node({{"mesh", iron}});
  file.node({{"mesh", wood}, {"translation", {1.0, 0.25, 0.0}}});
  return file.glb();
}

std::string head(const std::string& more) {
  return "meaning = \"a\"\nclass = \"installation\"\nwidth = [0.5, 1.5, 3]\nheight = [0.5, 0.75, 3]\nmodel = "
         "\"thing.glb\"\nlicence = \"CC0\"\nsource = \"made here\"\nauthor = \"me\"\n" +
         more;
}

Element made(const ElementFolder& folder, const std::string& more, double w, double h) {
  folder.write("elements/thing.toml", head(more));
  const auto e = folder.read(read_triangle_model).make("thing", w, h);
  EXPECT_TRUE(e) << e.error();
  return e ? *e : Element{};
}

TEST(ModelElement, KeepsItsSizeOrStretches) {
  const ElementFolder folder;
  folder.write("elements/thing.glb", two_cubes());
  const Element kept = made(folder, "anchor = \"origin\"\nfit = \"keep\"\n", 3, 3);
  EXPECT_EQ(bounds_of(kept.mesh).least, (Point3{0, 0, -0.5}));
  EXPECT_EQ(bounds_of(kept.mesh).most, (Point3{1.5, 0.75, 0}));
  EXPECT_EQ(triangle_count(kept.mesh), 24u);
  const Element wide = made(folder, "anchor = \"origin\"\nfit = \"stretch\"\n", 3, 1.5);
  EXPECT_EQ(bounds_of(wide.mesh).most, (Point3{3, 1.5, 0}));
  EXPECT_EQ(bounds_of(wide.mesh).least, (Point3{0, 0, -0.5})) << "its depth stays";
  for (const checks::Body& body : checks::bodies(wide.mesh)) EXPECT_GT(checks::volume(wide.mesh, body), 0);
  EXPECT_EQ(made(folder, "anchor = \"origin\"\nfit = \"stretch\"\n", 3, 1.5).mesh.vertices, wide.mesh.vertices);
}

TEST(ModelElement, StandsWhereItsAnchorSays) {
  const ElementFolder folder;
  folder.write("elements/thing.glb", two_cubes());
  const Bounds3 middle = bounds_of(made(folder, "anchor = \"bottom_centre\"\nfit = \"keep\"\n", 1, 1).mesh);
  EXPECT_EQ(middle.least, (Point3{-0.75, 0, -0.25}));
  EXPECT_EQ(middle.most, (Point3{0.75, 0.75, 0.25}));
  const Bounds3 back = bounds_of(made(folder, "anchor = \"back_bottom_centre\"\nfit = \"keep\"\n", 1, 1).mesh);
  EXPECT_EQ(back.least, (Point3{-0.75, 0, model::snap(-kApart)})) << "just inside the wall";
  EXPECT_EQ(back.most.z, model::snap(0.5 - kApart));
}

TEST(ModelElement, MaterialsAreParts) {
  const ElementFolder folder;
  folder.write("elements/thing.glb", two_cubes());
  const Element e = made(folder, "anchor = \"origin\"\nfit = \"keep\"\n[parts]\nIron = \"metal\"\n", 1, 1);
  for (const ElementFace& f : e.mesh.faces) {
    const bool left = e.mesh.vertices[e.mesh.indices[f.first]].x < 0.75;
    EXPECT_EQ(f.part, left ? Part::metal : Part::panel);
  }
  const ElementCatalogue catalogue = folder.read(read_triangle_model);
  ASSERT_EQ(catalogue.credits().size(), 1u);
  EXPECT_EQ(catalogue.credits()[0].kind, "thing");
  EXPECT_EQ(catalogue.credits()[0].licence, "CC0");
  EXPECT_EQ(catalogue.credits()[0].author, "me");
  EXPECT_THAT(std::vector<std::string>(catalogue.files().begin(), catalogue.files().end()),
              testing::Contains(folder.path() + "/elements/thing.glb"));
}

TEST(ModelElement, WindowsStandAtTheRevealsEnd) {
  const ElementFolder folder;
  GltfMaker file;
  file.cube(1);
  file.node({{"mesh", 0}});
  folder.write("elements/thing.glb", file.glb());
  const std::string window =
      "meaning = \"a\"\nclass = \"window\"\nwidth = [0.5, 1, 2]\nheight = [0.5, 1, 2]\n"
      "model = \"thing.glb\"\nlicence = \"CC0\"\nsource = \"here\"\nanchor = \"back_bottom_centre\"\nfit = "
      "\"stretch\"\n";
  folder.write("elements/thing.toml", window + "reveal = 0.25\n");
  const auto e = folder.read(read_triangle_model).make("thing", 1.5, 2);
  ASSERT_TRUE(e) << e.error();
  EXPECT_EQ(bounds_of(e->mesh).least, (Point3{-0.75, 0, -0.25}));
  EXPECT_EQ(e->opening.reveal, 0.25);
  EXPECT_EQ(checks::open_place(*e), "");
  folder.write("elements/thing.toml", window);
  const auto flush = folder.read(read_triangle_model).make("thing", 1.5, 2);
  ASSERT_TRUE(flush) << flush.error();
  EXPECT_EQ(flush->opening.reveal, 0);
  EXPECT_EQ(bounds_of(flush->mesh).least, (Point3{-0.75, 0, 0}));
}

TEST(ModelElement, TellsWhatIsWrong) {
  const ElementFolder folder;
  folder.write("elements/thing.glb", two_cubes());
  const auto error = [&](const std::string& text) { return folder.error_of(text, read_triangle_model); };
  const std::string good = "anchor = \"origin\"\nfit = \"keep\"\n";
  EXPECT_EQ(error(head(good)), "");
  EXPECT_THAT(folder.error_of(head(good)), HasSubstr("models are not read here"));
  EXPECT_THAT(error(head("fit = \"keep\"\n")), HasSubstr("anchor is missing"));
  EXPECT_THAT(error(head("anchor = \"top\"\nfit = \"keep\"\n")), HasSubstr("anchor cannot be \"top\""));
  EXPECT_THAT(error(head(good + "[parts]\nIrn = \"metal\"\n")), HasSubstr("It has: Iron, Wood"));
  EXPECT_THAT(error(head(good + "[parts]\nIron = \"steel\"\n")), HasSubstr("\"steel\" is no part"));
  std::string text = head(good);
  text.replace(text.find("licence"), 7, "#icence");
  EXPECT_THAT(error(text), HasSubstr("licence is missing"));
  text = head(good);
  text.replace(text.find("thing.glb"), 9, "../a.glb_");
  EXPECT_THAT(error(text), HasSubstr("beside this one"));
  folder.write("elements/thing.glb", "glTF");
  EXPECT_THAT(error(head(good)), HasSubstr("thing.glb"));
  std::filesystem::remove(folder.path() + "/elements/thing.glb");
  EXPECT_THAT(error(head(good)), HasSubstr("thing.glb"));
  const ModelReader many = [](const std::string&) {
    model::TriangleModel out{{""}, {}};
    out.triangles.assign(30'000, {{Point3{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, 0});
    return out;
  };
  EXPECT_THAT(folder.error_of(head(good), many), HasSubstr("has 30000 triangles; at most 20000 can be"));
}

TEST(TriangleModel, MirroredNodesKeepTheirOutside) {
  const ElementFolder folder;
  GltfMaker file;
  file.cube(1);
  file.node({{"mesh", 0}, {"scale", {-1.0, 1.0, 1.0}}});
  folder.write("elements/a.glb", file.glb());
  const model::TriangleModel read = read_triangle_model(folder.path() + "/elements/a.glb");
  ASSERT_EQ(read.triangles.size(), 12u);
  double six = 0;
  for (const auto& t : read.triangles) {
    const auto& [a, b, c] = t.corners;
    six += a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) + a.z * (b.x * c.y - b.y * c.x);
  }
  EXPECT_NEAR(six / 6, 1, 1e-9);
}

TEST(TriangleModel, RefusesWhatIsNoSetOfTriangles) {
  const ElementFolder folder;
  const auto error = [&](const GltfMaker& file) -> std::string {
    folder.write("elements/a.glb", file.glb());
    try {
      (void)read_triangle_model(folder.path() + "/elements/a.glb");
    } catch (const base::InputError& e) {
      return e.what();
    }
    return "";
  };
  GltfMaker strip;
  strip.cube(1);
  strip.json["meshes"][0]["primitives"][0]["mode"] = 5;
  strip.node({{"mesh", 0}});
  EXPECT_THAT(error(strip), AllOf(HasSubstr("a.glb"), HasSubstr("strips, lines or points")));
  GltfMaker endless;
  endless.cube(1);
  endless.node({{"children", {0, 0}}});
  EXPECT_THAT(error(endless), HasSubstr("nodes without end"));
}

}  // namespace
}  // namespace blockrand::elements
