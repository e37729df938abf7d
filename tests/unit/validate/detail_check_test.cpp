// LoD3 read back: what is written is sound, and what is planted into it is found.
#include "pipeline/validate/detail_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "pipeline/outputs/citygml/citygml_writer.h"
#include "pipeline/outputs/cityjson/cityjson_writer.h"
#include "pipeline/validate/citygml_reader.h"
#include "pipeline/validate/cityjson_reader.h"
#include "pipeline/validate/solids.h"
#include "tests/unit/outputs/facade_region.h"

namespace blockrand::validate {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

outputs::test::SampleRegion region_with_chimney() {
  auto s = outputs::test::facade_region();
  auto& part = s.region().buildings.front().parts.front();
  const auto at = [](double x, double y) { return model::Point2{x, y}; };
  model::Polygon plan;
  plan.outer.points = {at(391005, 5819004), at(391006, 5819004), at(391006, 5819005), at(391005, 5819005)};
  plan.outer.nodes.assign(4, 0);
  auto [solid, triangles] = outputs::test::prism(plan, 46, 49);
  part.lod3.roof_installations.push_back({model::RoofElementKind::chimney, std::move(solid), std::move(triangles)});
  return s;
}

const std::string& sound() {
  static const std::string text = [] {
    outputs::CityGmlOptions o;
    o.lod = 3;
    o.srs_name = "urn:ogc:def:crs:EPSG::25833";
    return outputs::write_citygml(region_with_chimney().region(), o);
  }();
  return text;
}

std::vector<std::string> found(const std::string& text) {
  const CityGml gml = read_citygml(text, "a.gml");
  EXPECT_TRUE(gml.readable);
  std::vector<std::string> out;
  for (const Finding& f : gml.contents.findings) out.push_back(f.object + ": " + f.detail);
  return out;
}

/// The text between two marks, the first after `after`.
struct Piece {
  std::size_t start = 0, length = 0;
};
Piece piece(const std::string& text, const std::string& first, const std::string& last, const std::string& after = "") {
  const std::size_t from = text.find(first, after.empty() ? 0 : text.find(after)), to = text.find(last, from);
  EXPECT_NE(to, std::string::npos) << first;
  return {from, to + last.size() - from};
}

/// The mark before the polygon that the first window refers to.
std::string polygon_of_window(const std::string& text) {
  const std::string before = "xlink:href=\"#", behind = "\"/>";
  const Piece p = piece(text, before, behind, "<bldg:Window");
  return "<Polygon gml:id=\"" + text.substr(p.start + before.size(), p.length - before.size() - behind.size()) + "\"";
}

/// Changes the numbers of the first list after `after`.
template <class Change>
std::string with_numbers(std::string text, const std::string& element, const std::string& after, const Change& change) {
  const Piece p = piece(text, "<" + element + ">", "</" + element + ">", after);
  const std::size_t start = p.start + element.size() + 2;
  std::istringstream in(text.substr(start, p.length - 2 * element.size() - 5));
  std::vector<double> numbers;
  for (double v = 0; in >> v;) numbers.push_back(v);
  change(numbers);
  std::string list;
  for (const double v : numbers) list += (list.empty() ? "" : " ") + std::to_string(v);
  return text.replace(start, p.length - 2 * element.size() - 5, list);
}

TEST(Detail, WhatIsWrittenIsSoundAndComplete) {
  EXPECT_THAT(found(sound()), IsEmpty());
  const CityGml gml = read_citygml(sound(), "a.gml");
  const auto s = region_with_chimney();
  std::size_t body = 0;
  for (const auto& building : s.region().buildings) {
    const auto& part = building.parts.front();
    const ReadBody& read = gml.contents.bodies.at(body++);
    EXPECT_EQ(read.attributes.at("use"), part.attributes.use.value) << "not the function of an installation";
    if (part.lod < 3) continue;
    ASSERT_EQ(read.solids.size(), 3u);
    EXPECT_EQ(read.solids[2].lod, 3);
    EXPECT_EQ(read.solids[2].polygons.size(), part.lod3.solid.faces.size());
    for (std::size_t f = 0; f < read.solids[2].polygons.size(); ++f)
      EXPECT_EQ(read.solids[2].polygons[f].colour, model::text(part.lod3.solid.faces[f].colour));
    EXPECT_EQ(read.detail.openings.size(), part.lod3.openings.size());
    EXPECT_EQ(read.detail.placements.size(), part.lod3.placements.size());
    EXPECT_EQ(read.detail.installations.size(), part.lod3.roof_installations.size());
    for (const ReadSolid& solid : read.solids) EXPECT_TRUE(validator(solid).valid()) << validator(solid).text();
  }
  ASSERT_EQ(gml.contents.bodies[0].detail.installations.size(), 1u);
  EXPECT_EQ(gml.contents.bodies[0].detail.installations[0].kind, "chimney");
  EXPECT_TRUE(validator({3, gml.contents.bodies[0].detail.installations[0].polygons}).valid());
  // Two colours of one window are two elements; equal ones are one.
  EXPECT_NE(gml.contents.bodies[0].detail.placements[3].element, gml.contents.bodies[1].detail.placements[3].element);
  EXPECT_EQ(gml.contents.bodies[0].detail.placements[3].element, gml.contents.bodies[2].detail.placements[3].element);
}

TEST(Detail, ADeletedWindow) {
  std::string text = sound();
  const Piece p = piece(text, "<bldg:opening><bldg:Window", "</bldg:opening>");
  const std::string window = text.substr(p.start, p.length);
  text.erase(p.start, p.length);
  EXPECT_THAT(found(text), Contains(HasSubstr("of LoD3 is in no boundary surface")));
  // Its polygon with it: the solid has a hole.
  const Piece polygon = piece(text, "<surfaceMember>" + polygon_of_window(window), "</surfaceMember>");
  text.erase(polygon.start, polygon.length);
  const CityGml gml = read_citygml(text, "a.gml");
  EXPECT_EQ(validator(gml.contents.bodies[0].solids[2]).number, 302);
  EXPECT_EQ(gml.contents.bodies[0].detail.openings.size() + 1,
            read_citygml(sound(), "a.gml").contents.bodies[0].detail.openings.size());
}

TEST(Detail, AMovedVertexOfAWindow) {
  EXPECT_THAT(found(with_numbers(sound(), "posList", polygon_of_window(sound()),
                                 [](auto& n) {
                                   n[5] += 0.25;  // the second corner, upwards
                                 })),
              Contains(HasSubstr("an edge of it is none of its reveal")));
}

TEST(Detail, AWindowBeforeItsWall) {
  const auto text = with_numbers(sound(), "posList", polygon_of_window(sound()), [](auto& n) {
    for (std::size_t i = 1; i < n.size(); i += 3) n[i] -= 0.5;  // the first wall looks south
  });
  EXPECT_THAT(found(text), Contains(HasSubstr("behind its wall")));
}

TEST(Detail, AnElementBesideItsOpening) {
  const auto aside = with_numbers(sound(), "pos", "<bldg:Window", [](auto& n) { n[0] += 2; });
  EXPECT_THAT(found(aside), Contains(HasSubstr("its element stands outside of the opening")));
  const auto before = with_numbers(sound(), "pos", "<bldg:Window", [](auto& n) { n[1] -= 0.5; });
  EXPECT_THAT(found(before), Contains(HasSubstr("its element does not stand in the plane of the wall")));
  const auto off = with_numbers(sound(), "pos", "<bldg:Window", [](auto& n) { n[0] += 0.0004; });
  EXPECT_THAT(found(off), Contains(HasSubstr("off the 1/1024 m grid")));
}

TEST(Detail, AMirroredElement) {
  EXPECT_THAT(found(with_numbers(sound(), "core:transformationMatrix", "<bldg:Window", [](auto& n) { n[0] = -n[0]; })),
              Contains(HasSubstr("no rotation about the vertical")));
}

TEST(Detail, ReferencesToNowhere) {
  const auto replaced = [](const std::string& before, const std::string& after) {
    std::string text = sound();
    const std::size_t at = text.find(before);
    EXPECT_NE(at, std::string::npos) << before;
    return text.replace(at, before.size(), after);
  };
  EXPECT_THAT(
      found(replaced("<core:relativeGMLGeometry xlink:href=\"#e", "<core:relativeGMLGeometry xlink:href=\"#none")),
      Contains(HasSubstr("which is no element")));
  EXPECT_THAT(found(replaced("<bldg:lod3MultiSurface><MultiSurface><surfaceMember xlink:href=\"#",
                             "<bldg:lod3MultiSurface><MultiSurface><surfaceMember xlink:href=\"#x")),
              Contains(HasSubstr("which is no polygon of the solid of LoD3")));
  EXPECT_THAT(found(replaced("</MultiSurface></core:relativeGMLGeometry>",
                             "<surfaceMember xlink:href=\"#x\"/></MultiSurface></core:relativeGMLGeometry>")),
              Contains(HasSubstr("which is no polygon of an element")));
  EXPECT_THAT(found(replaced("<app:target>#w", "<app:target>#x")), Contains(HasSubstr("which is no surface")));
}

TEST(Detail, AnElementThatIsNotThereHasNoPolygons) {
  std::string text = sound();
  const std::string before = "<core:relativeGMLGeometry xlink:href=\"#e";
  const std::size_t at = text.find(before);
  ASSERT_NE(at, std::string::npos);
  const CityGml gml =
      read_citygml(text.replace(at, before.size(), "<core:relativeGMLGeometry xlink:href=\"#none"), "a.gml");
  std::size_t without = 0;
  for (const ReadBody& body : gml.contents.bodies)
    for (const ReadPlacement& placement : body.detail.placements) {
      const auto element = gml.contents.elements.find(placement.element);
      ASSERT_NE(element, gml.contents.elements.end());
      without += element->second.colours.empty();
    }
  EXPECT_GT(without, 0u);
}

TEST(Detail, PolygonsOfTheSolidLeftOut) {
  std::string text = sound();
  const std::size_t solid = text.find("<bldg:lod3Solid>");
  std::size_t at = solid;
  for (int i = 0; i < 8; ++i) at = text.find("<surfaceMember>", at + 1);
  for (;;) {
    const std::size_t next = text.find("<surfaceMember>", at);
    if (next > text.find("</bldg:lod3Solid>", solid)) break;
    const std::string end = "</surfaceMember>";
    text.erase(next, text.find(end, next) + end.size() - next);
  }
  EXPECT_THAT(found(text), Contains(HasSubstr("which is no polygon of the solid of LoD3")));
  const CityGml gml = read_citygml(text, "a.gml");
  const ReadBody& body = gml.contents.bodies.at(0);
  for (const ReadOpening& o : body.detail.openings) {
    EXPECT_LT(o.polygon, body.solids.at(2).polygons.size());
    for (const std::size_t r : o.reveals) EXPECT_LT(r, body.solids.at(2).polygons.size());
  }
}

TEST(Detail, APartWithinAWindow) {
  std::string text = sound();
  const std::size_t window = text.find("<bldg:Window"), inside = text.find("<bldg:lod3MultiSurface>", window);
  text.insert(inside, "<bldg:BuildingPart gml:id=\"w100.w9\">");
  const std::size_t end = text.find("</bldg:Window>", inside);
  text.insert(end, "</bldg:BuildingPart>");
  EXPECT_THAT(found(text), testing::Not(IsEmpty()));
}

TEST(Detail, AnElementOutsideOfTheEnvelope) {
  for (const char* corner : {"lowerCorner", "upperCorner"}) {
    const double inwards = std::string(corner) == "lowerCorner" ? 0.02 : -0.02;
    EXPECT_THAT(found(with_numbers(sound(), corner, "", [&](auto& n) { n[1] += inwards; })),
                Contains(HasSubstr("an element reaches out of the envelope")));
  }
}

/// The first windows are holes: their element has no face.
outputs::test::SampleRegion region_with_holes() {
  auto s = region_with_chimney();
  auto hole = std::make_shared<model::Element>(*s.region().elements[0].element);
  hole->kind = "reveal";
  hole->mesh = {};
  s.region().elements[0].element = hole;
  return s;
}

outputs::CityJsonOptions json_options() {
  outputs::CityJsonOptions o;
  o.lod = 3;
  o.crs_code = "EPSG:25833";
  return o;
}

TEST(DetailCityJson, SaysTheSameAsCityGml) {
  const auto s = region_with_chimney();
  const CityGml gml = read_citygml(sound(), "a.gml");
  std::string whole;
  outputs::SingleCityJson single(json_options(), [&](std::string_view bytes) { whole += bytes; });
  single.add(s.region());
  single.finish();
  for (const bool sequence : {true, false}) {
    const Contents read =
        sequence ? read_cityjson(outputs::write_cityjson_sequence(s.region(), json_options()), "a.city.jsonl")
                 : read_cityjson(whole, "a.city.json");
    for (const Finding& f : read.findings) ADD_FAILURE() << f.object << ": " << f.detail;
    ASSERT_EQ(read.bodies.size(), gml.contents.bodies.size());
    for (std::size_t i = 0; i < read.bodies.size(); ++i) {
      EXPECT_EQ(detail_difference(gml.contents.bodies[i], read.bodies[i]), "");
      ASSERT_EQ(read.bodies[i].solids.size(), gml.contents.bodies[i].solids.size());
      for (std::size_t k = 0; k < read.bodies[i].solids.size(); ++k) {
        const auto &a = read.bodies[i].solids[k].polygons, &b = gml.contents.bodies[i].solids[k].polygons;
        ASSERT_EQ(a.size(), b.size());
        for (std::size_t f = 0; f < a.size(); ++f) {
          EXPECT_EQ(a[f].rings, b[f].rings);
          if (read.bodies[i].solids[k].lod >= 2) {
            EXPECT_EQ(a[f].kind, b[f].kind);
            EXPECT_EQ(a[f].colour, b[f].colour);
          }
        }
      }
    }
  }
  const auto header = nlohmann::json::parse(whole);
  EXPECT_EQ(header["geometry-templates"]["templates"].size(), 4u) << "once each: lamp and window look alike";
}

TEST(DetailCityJson, ElementsWithoutFacesAreNotWritten) {
  const auto s = region_with_holes();
  outputs::CityGmlOptions o;
  o.lod = 3;
  o.srs_name = "urn:ogc:def:crs:EPSG::25833";
  const CityGml gml = read_citygml(outputs::write_citygml(s.region(), o), "a.gml");
  for (const Finding& f : gml.contents.findings) ADD_FAILURE() << f.object << ": " << f.detail;
  const Contents json = read_cityjson(outputs::write_cityjson_sequence(s.region(), json_options()), "a.city.jsonl");
  for (const Finding& f : json.findings) ADD_FAILURE() << f.object << ": " << f.detail;
  EXPECT_EQ(detail_difference(gml.contents.bodies.at(0), json.bodies.at(0)), "");
  EXPECT_EQ(json.bodies.at(0).detail.placements.size(), 2u) << "door and lamp";
}

TEST(DetailCityJson, LowerLevelsHaveNoneOfIt) {
  auto o = json_options();
  o.lod = 2;
  const std::string text = outputs::write_cityjson_sequence(region_with_chimney().region(), o);
  EXPECT_EQ(text.find("template"), std::string::npos);
  EXPECT_EQ(text.find("BuildingInstallation"), std::string::npos);
  EXPECT_EQ(text.find("\"lod\":\"3\""), std::string::npos);
}

/// The file with one change to its first feature.
template <class Change>
std::vector<std::string> found_in_json(const Change& change) {
  const std::string text = outputs::write_cityjson_sequence(region_with_chimney().region(), json_options());
  const std::size_t first = text.find('\n') + 1, second = text.find('\n', first);
  auto header = nlohmann::ordered_json::parse(text.substr(0, first));
  auto feature = nlohmann::ordered_json::parse(text.substr(first, second - first));
  change(header, feature);
  std::vector<std::string> out;
  for (const Finding& f :
       read_cityjson(header.dump() + "\n" + feature.dump() + text.substr(second), "a.city.jsonl").findings)
    out.push_back(f.object + ": " + f.detail);
  return out;
}

TEST(DetailCityJson, DamageIsFound) {
  const auto solid = [](auto& feature) -> auto& { return feature["CityObjects"]["w100"]["geometry"][3]; };
  EXPECT_THAT(found_in_json([](auto&, auto&) {}), IsEmpty());
  EXPECT_THAT(found_in_json([&](auto&, auto& f) {
                for (auto& surface : solid(f)["semantics"]["surfaces"])
                  if (surface["type"] == "Window") {
                    surface.erase("parent");
                    break;
                  }
              }),
              Contains(HasSubstr("has a window that is in no wall")));
  EXPECT_THAT(found_in_json([&](auto&, auto& f) { solid(f)["semantics"]["surfaces"][0]["children"].erase(0); }),
              Contains(HasSubstr("does not name it as a child")));
  EXPECT_THAT(found_in_json([](auto&, auto& f) { f["CityObjects"]["w100_casement"]["geometry"][0]["template"] = 99; }),
              Contains(HasSubstr("a template that does not exist")));
  EXPECT_THAT(found_in_json([](auto&, auto& f) {
                f["CityObjects"]["w100_casement"]["geometry"][0]["transformationMatrix"][0] = 2;
              }),
              Contains(HasSubstr("no rotation about the vertical")));
  EXPECT_THAT(
      found_in_json([](auto& h, auto&) { h["geometry-templates"]["templates"][0]["boundaries"][0][0][0] = 9999; }),
      Contains(HasSubstr("names a vertex that does not exist")));
  EXPECT_THAT(found_in_json([](auto& h, auto&) {
                auto& south = h["metadata"]["geographicalExtent"][1];
                south = south.template get<double>() + 0.02;
              }),
              Contains(HasSubstr("an element reaches out of geographicalExtent")));
  EXPECT_THAT(found_in_json([](auto&, auto& f) { f["CityObjects"].erase("w100_i1"); }),
              Contains(HasSubstr("its child w100_i1 is not in the file")));
}

TEST(DetailCityJson, TwoSolidsLeaveNoOpenings) {
  const auto twice = [](auto&, auto& f) {
    auto& geometry = f["CityObjects"]["w100"]["geometry"];
    auto first = geometry[1];
    first["lod"] = "3";
    geometry.insert(geometry.begin() + 3, first);
  };
  EXPECT_THAT(found_in_json(twice), Contains(HasSubstr("out of the order of their LoD")));
}

}  // namespace
}  // namespace blockrand::validate
