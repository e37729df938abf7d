// Element files: every form of piece and kind, what later folders replace, and every error.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>

#include "pipeline/base/random.h"
#include "styles/elements/mesh_builder.h"
#include "tests/unit/elements/element_checks.h"
#include "tests/unit/elements/element_folder.h"
#include "tests/unit/elements/mesh_measures.h"
#include "tests/unit/elements/shipped_elements.h"

namespace blockrand::elements {
namespace {

using model::Point3;
using test::ElementFolder;
using testing::AllOf;
using testing::HasSubstr;

const std::string kWall =
    "meaning = \"a thing\"\nclass = \"installation\"\nwidth = [0.5, 1, 2]\nheight = [0.5, 1, 2]\n";
const std::string kWindow =
    "meaning = \"a thing\"\nclass = \"window\"\nreveal = 0.1\nwidth = [0.5, 1, 2]\nheight = [0.5, 1, 2]\n";
const std::string kPane =
    "[[piece]]\npart = \"glass\"\npolygon = [[\"-w / 2\", 0], [\"w / 2\", 0], [\"w / 2\", \"h\"], "
    "[\"-w / 2\", \"h\"]]\nz = \"-reveal\"\n";
const std::string kBox = "[[piece]]\npart = \"metal\"\nx = [0, 0.5]\ny = [0, \"h\"]\nz = [-0.005, 0.25]\n";

Element made(const ElementCatalogue& catalogue, double w, double h, const std::vector<Parameter>& parameters = {}) {
  const auto e = catalogue.make("thing", w, h, parameters);
  EXPECT_TRUE(e) << e.error();
  return e ? *e : Element{};
}

Element made(const std::string& text, double w = 1, double h = 1, const std::vector<Parameter>& parameters = {}) {
  const ElementFolder folder;
  folder.write("elements/thing.toml", text);
  return made(folder.read(), w, h, parameters);
}

double volume(const Element& e) {
  double sum = 0;
  for (const checks::Body& body : checks::bodies(e.mesh)) {
    EXPECT_TRUE(body.closed);
    sum += checks::volume(e.mesh, body);
  }
  return sum;
}

TEST(ElementFile, BoxesAreClosedOnWallsAndBacklessInOpenings) {
  const Element e = made(kWall + kBox, 1, 1.5);
  EXPECT_EQ(e.mesh.faces.size(), 6u);
  EXPECT_NEAR(volume(e), 0.5 * 1.5 * 0.255, 1e-3);
  EXPECT_EQ(e.kind, "thing");
  EXPECT_EQ(e.name, "thing 1.00 x 1.50");
  EXPECT_TRUE(e.opening.outline.empty());
  const std::string deep =
      "[[piece]]\npart = \"leaf\"\nx = [\"-w / 2\", \"w / 2\"]\ny = [0, \"h\"]\nz = [-0.2, -0.15]\n";
  const Element window = made(kWindow + deep);
  EXPECT_EQ(window.mesh.faces.size(), 5u);
  EXPECT_EQ(window.opening.outline, (Outline{{-0.5, 0}, {0.5, 0}, {0.5, 1}, {-0.5, 1}}));
  EXPECT_EQ(window.opening.reveal, 0.1);
}

TEST(ElementFile, PolygonsMayBeConcaveAndTurnEitherWay) {
  const char* const kAngle = "polygon = [[0, 0], [0, \"h\"], [0.25, \"h\"], [0.25, 0.25], [0.5, 0.25], [0.5, 0]]\n";
  const Element e = made(kWall + "[[piece]]\npart = \"surround\"\nz = [0, 0.5]\n" + kAngle);
  EXPECT_NEAR(volume(e), (0.25 * 1 + 0.25 * 0.25) * 0.5, 1e-9);
  EXPECT_EQ(checks::faces_wrong(e.mesh), "");
  EXPECT_EQ(checks::solid_defect(e.mesh, checks::bodies(e.mesh)[0]), "none");
}

TEST(ElementFile, SectionsRunAlongTheWall) {
  // A wedge under a slope: 1 m high at the wall, 0.5 m out.
  const Element e =
      made(kWall + "[[piece]]\npart = \"panel\"\nx = [-0.5, 0.25]\nsection = [[0, 0], [0.5, 0], [0, 1]]\n");
  EXPECT_NEAR(volume(e), 0.5 * 0.5 * 0.75, 1e-9);
  const Bounds3 box = bounds_of(e.mesh);
  EXPECT_EQ(box.least, (Point3{-0.5, 0, 0}));
  EXPECT_EQ(box.most, (Point3{0.25, 1, 0.5}));
}

TEST(ElementFile, RingsAreFramesAlongTheOutline) {
  const std::string gabled =
      kWindow +
      "outline = [[\"-w / 2\", 0], [\"w / 2\", 0], [\"w / 2\", \"h * 0.75\"], [0, \"h\"], [\"-w / "
      "2\", \"h * 0.75\"]]\n"
      "[[piece]]\npart = \"frame\"\nring = \"outline\"\nwidth = 0.125\nz = [-0.2, \"-reveal\"]\n"
      "[[piece]]\npart = \"glass\"\nz = -0.2\npolygon = [[\"-w / 2\", 0], [\"w / 2\", 0], [\"w / "
      "2\", \"h * 0.75\"], [0, \"h\"], [\"-w / 2\", \"h * 0.75\"]]\n";
  const Element e = made(gabled, 1, 2);
  EXPECT_EQ(e.opening.outline, (Outline{{-0.5, 0}, {0.5, 0}, {0.5, 1.5}, {0, 2}, {-0.5, 1.5}}));
  EXPECT_EQ(checks::faces_wrong(e.mesh), "");
  EXPECT_EQ(checks::open_place(e), "");
  EXPECT_EQ(e.mesh.faces.size(), 5u + 5u + 1u) << "a piece of frame and a side of its hole for each edge, one pane";
}

TEST(ElementFile, MouldingsFollowTheirPathWithTheirUpperSideOnItsLeft) {
  const std::string piece = "[[piece]]\npart = \"surround\"\nheight = 0.25\nprojection = 0.1\n";
  const Element run = made(kWall + piece + "profile = \"plain_band\"\nalong = [[\"-w / 2\", 0.5], [\"w / 2\", 0.5]]\n");
  const Bounds3 box = bounds_of(run.mesh);
  EXPECT_NEAR(box.least.y, 0.5, 1e-6);
  EXPECT_NEAR(box.most.y, 0.75, 0.003);
  EXPECT_NEAR(box.least.z, -kApart, 1e-6);
  EXPECT_GT(box.most.z, 0.01);
  EXPECT_GT(volume(run), 0);
  // Up the left jamb, over the head, down the right one: round an opening.
  const Element round =
      made(kWall + piece +
           "profile_program = 'Modifications { line, abs, 90, 1; line, abs, 0, 4; line, abs, -90, 1; }'\n"
           "along = [[\"-w / 2\", 0], [\"-w / 2\", \"h\"], [\"w / 2\", \"h\"], [\"w / 2\", 0]]\n");
  const Bounds3 outer = bounds_of(round.mesh);
  EXPECT_NEAR(outer.least.x, -0.75, 1e-6);
  EXPECT_NEAR(outer.most.x, 0.75, 1e-6);
  EXPECT_NEAR(outer.most.y, 1.25, 1e-6);
  EXPECT_NEAR(volume(round), 0.25 * (0.0625 + kApart) * (1 + 0.25 + 1 + 0.25 + 1), 1e-6) << "by the middle of the band";
}

TEST(ElementFile, PiecesAreCountedAndMayBeLeftOut) {
  const std::string file = kWall +
                           "[[parameter]]\nname = \"bars\"\nwhole = true\ndefault = 3\nrange = [0, 9]\nmeaning = "
                           "\"bars\"\n[[piece]]\npart = \"metal\"\ncount = \"bars\"\nwhen = \"i - 0.5\"\n"
                           "x = [\"i / 8\", \"i / 8 + 1 / 16\"]\ny = [0, \"(i + 1) / n\"]\nz = [0, 0.125]\n" +
                           kBox;
  const ElementFolder folder;
  folder.write("elements/thing.toml", file);
  const ElementCatalogue catalogue = folder.read();
  EXPECT_EQ(made(catalogue, 1, 1).mesh.faces.size(), 6u * (2 + 1)) << "all but the first";
  EXPECT_EQ(made(catalogue, 1, 1, {{"bars", 0.0}}).mesh.faces.size(), 6u);
  EXPECT_EQ(made(catalogue, 1, 1, {{"bars", 9.0}}).mesh.faces.size(), 6u * (8 + 1));
  EXPECT_THAT(catalogue.make("thing", 1, 1, std::vector<Parameter>{{"bars", 1.5}}).error(), HasSubstr("whole number"));
  EXPECT_THAT(catalogue.make("thing", 3, 1).error(), HasSubstr("the width is 3 m; it goes from 0.5 to 2 m"));
  const auto fitting = catalogue.make_fitting("thing", 3, 1);
  ASSERT_TRUE(fitting);
  EXPECT_THAT(fitting->told, HasSubstr("made instead: thing 2.00 x 1.00"));
}

TEST(ElementFile, RevealsMayBeParametersOrCalculated) {
  const std::string head = "meaning = \"a\"\nclass = \"door\"\nwidth = [0.5, 1, 2]\nheight = [1, 2, 3]\n";
  EXPECT_NEAR(made(head + "reveal = \"w / 10\"\n" + kPane, 1.5, 2).opening.reveal, 0.15, 1e-12);
  const std::string own =
      head + "[[parameter]]\nname = \"reveal\"\ndefault = 0.2\nrange = [0, 0.4]\nmeaning = \"depth\"\n" + kPane;
  const Element e = made(own, 1, 2, {{"reveal", 0.25}});
  EXPECT_EQ(e.opening.reveal, 0.25);
  EXPECT_EQ(bounds_of(e.mesh).least.z, -0.25);
  EXPECT_EQ(e.semantic, ElementClass::door);
}

TEST(ElementFile, FriezesAreRuns) {
  const ElementFolder folder;
  folder.write("elements/thing.toml", kWall + "run = true\n" + kBox);
  EXPECT_EQ(folder.read().find("thing")->width.measures, "run");
  EXPECT_EQ(shipped().find("awning")->width.measures, "whole");
  EXPECT_THAT(folder.error_of(kWindow + "run = true\n" + kPane), HasSubstr("run cannot be true of an opening"));
}

TEST(ElementFile, VariantsHaveOtherDefaults) {
  const std::string file =
      "meaning = \"a thing\"\nbase = \"double_casement\"\nwidth = [0.8, 1, 2]\nheight = [1.2, 2, 3]\n"
      "[defaults]\nhead = \"round\"\nleaves = 1\nbars = 0\nsurround_profile = \"cyma\"\n"
      "sill_profile = 'Modifications { line, abs, 90, 1; line, abs, 0, 4; line, abs, -90, 1; }'\n";
  const ElementFolder folder;
  folder.write("elements/thing.toml", file);
  const ElementCatalogue catalogue = folder.read();
  const std::vector<Parameter> asked{
      {"head", "round"},
      {"leaves", 1.0},
      {"bars", 0.0},
      {"surround_profile", "cyma"},
      {"sill_profile", "Modifications { line, abs, 90, 1; line, abs, 0, 4; line, abs, -90, 1; }"}};
  const Element variant = made(catalogue, 1, 2), base = *catalogue.make("double_casement", 1, 2, asked);
  EXPECT_EQ(variant.mesh.vertices, base.mesh.vertices);
  EXPECT_EQ(variant.mesh.indices, base.mesh.indices);
  EXPECT_EQ(variant.opening.outline, base.opening.outline);
  EXPECT_EQ(variant.kind, "thing");
  EXPECT_EQ(variant.name, "thing 1.00 x 2.00, round head, moulded surround");
  EXPECT_EQ(catalogue.find("thing")->width.most, 2);
  EXPECT_EQ(catalogue.find("double_casement")->width.most, 3.5);
  EXPECT_EQ(made(catalogue, 1, 2, {{"head", "straight"}}).opening.outline.size(), 4u) << "a rule may ask for others";
  folder.write("elements/thing.toml", file +
                                          "[[piece]]\npart = \"metal\"\nx = [\"-w / 2\", \"w / 2\"]\ny = [0, "
                                          "\"frame\"]\nz = [\"-reveal\", 0]\n");
  EXPECT_EQ(made(folder.read(), 1, 2).mesh.faces.size(), base.mesh.faces.size() + 5) << "and a box without its back";
}

TEST(ElementFile, EdgesMayBeDefaultsToo) {
  const Element e = made(
      "meaning = \"a\"\nbase = \"shaped_window\"\nwidth = [0.8, 1, 2]\nheight = [1.2, 2, 3]\n[defaults]\ntop = "
      "\"ogee\"\n"
      "top_size = 0.3\n",
      1, 2);
  EXPECT_GT(e.opening.outline.size(), 6u);
}

TEST(ElementFile, ExamplesOfTheManualAreGood) {
  std::ifstream page(BLOCKRAND_SOURCE_DIR "/docs/element_files.md");
  const std::string text(std::istreambuf_iterator<char>(page), {});
  const ElementFolder folder;
  int examples = 0;
  for (std::size_t at = 0; (at = text.find("```toml\n", at)) != std::string::npos; ++examples) {
    at += 8;
    const std::string example = text.substr(at, text.find("```", at) - at);
    EXPECT_EQ(folder.error_of(example,
                              [](const std::string&) {
                                return model::TriangleModel{{"Cast iron"}, {{{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}}, 0}}};
                              }),
              "")
        << example;
  }
  EXPECT_EQ(examples, 3);
}

TEST(ElementFile, ParametersMayBearNamesOfTrim) {
  std::string file = kWall;
  for (const char* name : {"head", "surround", "pediment", "leaves", "sign"})
    file +=
        "[[parameter]]\nname = \"" + std::string(name) + "\"\ndefault = 0.25\nrange = [0.25, 0.5]\nmeaning = \"a\"\n";
  const Element e = made(file + "[[piece]]\npart = \"metal\"\nx = [0, \"head + sign\"]\ny = [0, 1]\nz = [0, 1]\n");
  EXPECT_EQ(e.name, "thing 1.00 x 1.00");
  EXPECT_EQ(bounds_of(e.mesh).most.x, 0.5);
}

TEST(ElementFile, IsTriedAtEachDetail) {
  const ElementFolder folder;
  EXPECT_THAT(folder.error_of(kWall + kBox +
                              "[[piece]]\npart = \"metal\"\nwhen = \"detail - 1\"\nx = [0, 0]\ny = [0, 1]\nz = "
                              "[0, 1]\n"),
              HasSubstr("at its least size, 0.5 x 0.5 m and detail 2, it cannot be made"));
}

/// Bytes changed, left out and doubled: what is read can be made, the rest is an error that names the file.
TEST(ElementFile, DamagedFilesAreErrorsOrGood) {
  const ElementFolder folder;
  int read = 0, refused = 0;
  for (const char* name : {"awning", "louvre", "window_grille", "tilt_window_pvc"}) {
    std::ifstream file(std::string(BLOCKRAND_SOURCE_DIR "/configs/elements/") + name + ".toml");
    const std::string whole(std::istreambuf_iterator<char>(file), {});
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
      std::string text = whole;
      const auto drawn = [&](std::uint64_t n, std::size_t below) {
        return static_cast<std::size_t>(base::random_unit(seed, n, name) * static_cast<double>(below));
      };
      for (std::uint64_t k = 0; k < 1 + seed % 3; ++k) {
        const std::size_t at = drawn(10 * k, text.size());
        constexpr std::string_view kBytes = "0159.-+*/()[]\"'=\n#whin,";
        if (const std::size_t what = drawn(10 * k + 1, 3); what == 0)
          text[at] = kBytes[drawn(10 * k + 2, kBytes.size())];
        else if (what == 1)
          text.erase(at, 1 + drawn(10 * k + 3, 20));
        else
          text.insert(at, text.substr(drawn(10 * k + 4, text.size()), 30));
      }
      const std::string error = folder.error_of(text);
      ++(error.empty() ? read : refused);
      EXPECT_TRUE(error.empty() || error.find("thing.toml") != std::string::npos) << error << text;
    }
  }
  EXPECT_GT(read, 20);
  EXPECT_GT(refused, 100);
}

TEST(ElementFile, EndsBadInput) {
  const ElementFolder folder;
  const std::string many = "[[piece]]\npart = \"metal\"\ncount = 1000\nx = [0, 0.1]\ny = [0, 0.1]\nz = [0, 0.1]\n";
  std::string pieces, corners;
  for (int i = 0; i < 4; ++i) pieces += many;
  EXPECT_THAT(folder.error_of(kWall + pieces),
              HasSubstr("piece 4 (metal, line 23): the element has more than 20000 faces"));
  pieces.clear();
  for (int i = 0; i < 201; ++i) pieces += kBox;
  EXPECT_THAT(folder.error_of(kWall + pieces), HasSubstr("piece stands more than 200 times"));
  for (int i = 0; i < 201; ++i) corners += "[0, 0], ";
  EXPECT_THAT(folder.error_of(kWall + "[[piece]]\npart = \"metal\"\nz = [0, 1]\npolygon = [" + corners + "]\n"),
              HasSubstr("has more than 200 points"));
  std::string deep = "1";
  for (int i = 0; i < 50; ++i) deep = "(" + deep + ")";
  EXPECT_THAT(
      folder.error_of(kWall + "[[piece]]\npart = \"metal\"\ny = [0, 1]\nz = [0, 1]\nx = [0, \"" + deep + "\"]\n"),
      HasSubstr("brackets lie too deep"));
}

TEST(ElementCatalogue, LaterFoldersReplaceWhatFilesMade) {
  const ElementFolder a("a"), b("b");
  a.write("elements/thing.toml", kWall + kBox);
  a.write("elements/other.toml", kWall + kBox);
  b.write("elements/thing.toml", kWall + kBox + kBox);
  b.write("elements/readme.txt", "not read");
  b.write("profiles/cyma.toml",
          "meaning = \"mine\"\nheight = [0.1, 0.2, 0.3]\nprogram = 'Modifications { line, abs, "
          "90, 1; line, abs, 0, 4; line, abs, -90, 1; }'\n");
  const std::vector<std::string> folders{BLOCKRAND_SOURCE_DIR "/configs", a.path(), b.path()};
  const ElementCatalogue catalogue = read_element_catalogue(folders);
  EXPECT_EQ(made(catalogue, 1, 1).mesh.faces.size(), 12u);
  EXPECT_EQ(catalogue.profiles().at("cyma").meaning, "mine");
  EXPECT_EQ(catalogue.kinds().size(), shipped().kinds().size() + 2);
  EXPECT_EQ(catalogue.files().size(), shipped().files().size() + 4);
  const auto kinds = catalogue.kinds();
  const std::size_t own = ElementCatalogue().kinds().size();
  EXPECT_EQ(kinds[0].name, "casement_window");
  EXPECT_TRUE(std::is_sorted(kinds.begin() + static_cast<std::ptrdiff_t>(own), kinds.end(),
                             [](const auto& x, const auto& y) { return x.name < y.name; }));
  const ElementCatalogue again = read_element_catalogue(folders), moved = std::move(read_element_catalogue(folders));
  EXPECT_EQ(made(again, 1, 1).mesh.vertices, made(moved, 1, 1).mesh.vertices);
  EXPECT_THAT(catalogue.make("thng", 1, 1).error(), HasSubstr("did you mean \"thing\"?"));
}

TEST(ElementCatalogue, ABrokenProfileIsAnError) {
  const ElementFolder folder;
  folder.write("profiles/mine.toml",
               "meaning = \"mine\"\nheight = [0.1, 0.2, 0.3]\nprogram = 'Modifications { lne }'\n");
  EXPECT_THAT(folder.error(), AllOf(HasSubstr(folder.path() + "/profiles/mine.toml:3"), HasSubstr("lne")));
  EXPECT_THROW((void)read_element_catalogue(std::vector<std::string>{"/no/such/folder"}), base::InputError);
}

TEST(ElementCatalogue, NamesAreThoseOfFiles) {
  const ElementFolder folder;
  folder.write("elements/balcony.toml", kWall + kBox);
  EXPECT_THAT(folder.error(), AllOf(HasSubstr("balcony.toml"), HasSubstr("is a built-in element")));
  std::filesystem::remove(folder.path() + "/elements/balcony.toml");
  folder.write("elements/My-Thing.toml", kWall + kBox);
  EXPECT_THAT(folder.error(), HasSubstr("\"My-Thing\" cannot be the name of an element"));
}

TEST(ElementFile, TellsWhatIsWrongWithItsHead) {
  const ElementFolder folder;
  const auto error = [&](const std::string& text) { return folder.error_of(text); };
  EXPECT_THAT(error("class = "), HasSubstr("thing.toml:1"));
  EXPECT_THAT(error("class = \"window\""), HasSubstr("meaning is missing"));
  EXPECT_THAT(error("meaning = \"a\"\nclass = \"roof\""), HasSubstr("thing.toml:2:9: class cannot be \"roof\""));
  EXPECT_THAT(error("meaning = \"a\"\nclass = \"window\"\nwidth = [2, 1, 3]"), HasSubstr("width wants three rising"));
  EXPECT_THAT(error("meaning = \"a\"\nbase = \"casement_windw\""), HasSubstr("Did you mean \"casement_window\"?"));
  const std::string base = "meaning = \"a\"\nbase = \"casement_window\"\n";
  EXPECT_THAT(error(base + "width = [0.1, 1, 2]"), HasSubstr("width reaches beyond its base's"));
  EXPECT_THAT(error(base + "[defaults]\nleafs = 1"), HasSubstr("did you mean \"leaf\"?"));
  EXPECT_THAT(error(base + "[defaults]\nleaves = 9"), HasSubstr("it goes from 1 to 3"));
  EXPECT_THAT(error(base + "[defaults]\nhead = \"flat\""), HasSubstr("\"head\" cannot be \"flat\""));
  EXPECT_THAT(error(base), AllOf(HasSubstr("at its least size, 0.4 x 0.4 m"), HasSubstr("narrow width and height")));
  EXPECT_THAT(error(base + "reveal = 0.1"), HasSubstr("unknown key reveal"));
  EXPECT_THAT(error(kWall), HasSubstr("piece is missing"));
  EXPECT_THAT(error(kWall + "colour = 1\n" + kBox), HasSubstr("unknown key colour"));
  EXPECT_THAT(error(kWall + "outline = [[0, 0]]\n" + kBox), HasSubstr("unknown key outline"));
  const std::string parameter = kWall + kBox + "[[parameter]]\nmeaning = \"p\"\n";
  EXPECT_THAT(error(parameter + "name = \"w\"\ndefault = 1\nrange = [0, 2]"), HasSubstr("name cannot be \"w\""));
  EXPECT_THAT(error(parameter + "name = \"p\"\ndefault = 3\nrange = [0, 2]"), HasSubstr("default is out of range"));
  EXPECT_THAT(error(parameter + "name = \"p\"\ndefault = 1\nrange = [2, 0]"), HasSubstr("two rising numbers"));
  EXPECT_THAT(error(parameter + "name = \"p\"\ndefault = 0.5\nrange = [0, 2]\nwhole = true"),
              HasSubstr("whole numbers"));
  EXPECT_THAT(error(parameter + "name = \"p\"\ndefault = 1\nrange = [0, 2]\nuint = \"m\""), HasSubstr("Did you mean"));
}

TEST(ElementFile, TellsWhatIsWrongWithAPiece) {
  const ElementFolder folder;
  const auto error = [&](const std::string& piece) { return folder.error_of(kWall + "[[piece]]\n" + piece); };
  EXPECT_THAT(error("x = [0, 1]"), HasSubstr("piece.part is missing"));
  EXPECT_THAT(error("part = \"glas\""), AllOf(HasSubstr("part cannot be \"glas\""), HasSubstr("Known: frame, glass")));
  const std::string metal = "part = \"metal\"\n";
  EXPECT_THAT(error(metal), HasSubstr("piece.x is missing"));
  EXPECT_THAT(error(metal + "x = [0]\ny = [0, 1]\nz = [0, 1]"), HasSubstr("x wants two values"));
  EXPECT_THAT(error(metal + "x = [0, \"1 + q\"]\ny = [0, 1]\nz = [0, 1]"),
              AllOf(HasSubstr("thing.toml:7"), HasSubstr("in \"1 + q\", column 5: there is no \"q\"")));
  EXPECT_THAT(error(metal + "x = [0, \"i\"]\ny = [0, 1]\nz = [0, 1]"), HasSubstr("there is no \"i\""));
  EXPECT_THAT(error(metal + "x = [0, \"reveal\"]\ny = [0, 1]\nz = [0, 1]"), HasSubstr("there is no \"reveal\""));
  EXPECT_THAT(error(metal + "x = [0, true]\ny = [0, 1]\nz = [0, 1]"), HasSubstr("numbers and texts only"));
  EXPECT_THAT(error(metal + "x = [0, 1]\ny = [0, 1]\nz = [0, 1]\ncuont = 3"), HasSubstr("Did you mean piece.count?"));
  const auto at_least = [&](const std::string& piece, const std::string& what) {
    EXPECT_THAT(error(metal + piece), AllOf(HasSubstr("at its least size, 0.5 x 0.5 m"),
                                            HasSubstr("piece 1 (metal, line 5)"), HasSubstr(what)));
  };
  at_least("x = [1, 0]\ny = [0, 1]\nz = [0, 1]", "x goes from 1 to 0 m, which leaves nothing");
  at_least("x = [0, \"1 / (w - 0.5)\"]\ny = [0, 1]\nz = [0, 1]", "x is no number of m");
  at_least("x = [0, 1]\ny = [0, 1]\nz = [0, 1]\ncount = 2000", "count is more than 1000");
  at_least("polygon = [[0, 0], [1, 0], [1, 1]]\nz = 0.1", "what stands on a wall is a body");
  at_least("polygon = [[0, 0], [1, 0], [2, 0]]\nz = [0, 0.1]", "it has no area");
  at_least("polygon = [[0, 0], [1, 1], [1, 0], [0, 0.5]]\nz = [0, 0.1]", "cross or touch");
  at_least("ring = \"outline\"\nwidth = 0.1\nz = [0, 0.1]", "only windows and doors have an outline");
  at_least("profile = \"casing\"\nalong = [[0, 0], [0, 0]]\nheight = 0.1\nprojection = 0.1", "no length");
  EXPECT_THAT(error(metal + "x = [0, 1]\ny = [0, 1]\nz = [-0.9, 1]"), HasSubstr("it reaches 0.9"));
  EXPECT_THAT(error(metal + "when = 0\nx = [0, 1]\ny = [0, 1]\nz = [0, 1]"), HasSubstr("nothing is made"));
  EXPECT_THAT(error(metal + "profile = \"casng\"\nalong = [[0, 0], [1, 0]]\nheight = 0.1\nprojection = 0.1"),
              HasSubstr("Did you mean \"casing\"?"));
  EXPECT_THAT(error(metal + "profile_program = 'x'\nalong = [[0, 0], [1, 0]]\nheight = 0.1\nprojection = 0.1"),
              HasSubstr("in the program, line 1"));
}

TEST(ElementFile, TellsWhatIsWrongWithAnOpening) {
  const ElementFolder folder;
  const auto error = [&](const std::string& text) { return folder.error_of(text); };
  EXPECT_EQ(error(kWindow + kPane), "");
  EXPECT_THAT(error("meaning = \"a\"\nclass = \"window\"\nwidth = [1, 1, 1]\nheight = [1, 1, 1]\n" + kPane),
              HasSubstr("reveal is missing"));
  const auto outline = [&](const char* points) { return error(kWindow + "outline = [" + points + "]\n" + kPane); };
  EXPECT_THAT(outline("[0, 0], [0, 0.5], [0.2, 0.5]"), HasSubstr("runs clockwise"));
  EXPECT_THAT(outline("[0, 0], [0.2, 0], [0.1, 0.1], [0.2, 0.4]"), HasSubstr("not convex at (0.1"));
  EXPECT_THAT(outline("[0, 0], [0.9, 0], [0.9, 0.4]"), HasSubstr("beyond 0.500 x 0.500 m"));
  EXPECT_THAT(
      error(kWindow + "[[piece]]\npart = \"glass\"\nz = -0.1\npolygon = [[\"-w / 2\", 0], [\"w / 2\", 0], [\"w / "
                      "2\", \"h - 0.01\"], [\"-w / 2\", \"h - 0.01\"]]\n"),
      AllOf(HasSubstr("one sees through it near (0.00, 0.49)"), HasSubstr("0.004 m²")));
  EXPECT_THAT(error(kWindow + kBox), HasSubstr("one sees through it")) << "metal closes no opening";
}

}  // namespace
}  // namespace blockrand::elements
