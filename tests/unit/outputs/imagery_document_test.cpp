#include "pipeline/outputs/imagery/imagery_document.h"

#include <gtest/gtest.h>

#include "pipeline/outputs/imagery/seen_outline.h"

namespace blockrand::outputs {
namespace {

using observation::RowState;

struct Seen {
  Seen() : store(3) {
    for (std::uint32_t b = 0; b < 3; ++b) {
      footprints::StoredFootprint f;
      f.id = {b == 2 ? model::OsmType::relation : model::OsmType::way, 100 + b};
      store.set(b, f, {});
    }
    observations.images.resize(2);
    observations.images[1].description.source = {"/maps/ortho.tif", "2023-06", "CC BY 4.0", "The town"};
    observations.outlines.resize(3);
    observation::OutlineReceipt& moved = observations.outlines[1];
    moved.state = RowState::corrected, moved.row = 7, moved.image = 1;
    moved.shift = {1.5, 1.4}, moved.centre = {500'000.123, 5'700'000.5}, moved.turn = 0.53;
    moved.before = 0.1234, moved.after = 0.4321, moved.confidence = 0.871, moved.lean = {0.1, -0.2}, moved.eaves = 8.5;
    observation::RefinedOutline& walls = moved.refined;
    walls.state = observation::RefinementState::refined, walls.walls = 2, walls.largest = 0.812;
    walls.before = 0.4321, walls.after = 0.6543, walls.confidence = 0.712;
    walls.from = {{{500'000.123, 5'700'000.001}, {500'010.5, 5'700'000}, {500'010.5, 5'700'008.25}}};
    walls.to = {{{500'001.623, 5'700'001.401}, {500'012.812, 5'700'001.4}, {500'012.812, 5'700'009.65}}};
    walls.evidence.resize(1);
    observation::OutlineReceipt& undecided = observations.outlines[2];
    undecided.state = RowState::undecided, undecided.image = 1;
    undecided.reason = "another place fits nearly as well";
    undecided.gone = 0.93;
    observations.applied = true;
    observations.heights.resize(3);
    observation::SeenHeight& shadow = observations.heights[1];
    shadow.image = 1, shadow.shadow.length = 9.25, shadow.height = 8.4, shadow.uncertainty = 1.1,
    shadow.confidence = 0.8;
    observations.roofs.resize(3);
    observation::RoofView& roof = observations.roofs[1];
    roof.pixels = 900, roof.colour = model::Colour{200, 10, 3}, roof.colour_confidence = 0.72;
    roof.form = observation::RoofForm::pitched, roof.form_confidence = 0.91;
    roof.ridge = 12.5, roof.ridge_confidence = 0.83;
    observation::UnmappedBuilding candidate;
    candidate.id = "u251592_3018242", candidate.image = 1, candidate.area = 112.5, candidate.probability = 0.912;
    candidate.outline = {{500'000.1, 10}, {500'010 + 1.0 / 1024, 10}, {500'010, 21.25}, {500'000, 21.25}};
    candidate.lean = {0.584, -0.328};
    observations.unmapped.push_back(candidate);
    candidate.id = "u1_1", candidate.of_roof = true;
    observations.unmapped.push_back(candidate);
    candidate.id = "u2_2", candidate.probability = 0.4;
    observations.unmapped_unsure.push_back(candidate);
  }
  footprints::FootprintStore store;
  observation::ImageryObservations observations;
};

TEST(ImageryDocument, ReadsWhatItWrote) {
  const Seen seen;
  const ReadImagery read = read_imagery_json(imagery_json(seen.observations, seen.store, {true, true, true}));
  EXPECT_TRUE(read.applied);
  ASSERT_EQ(read.images.size(), 2u);
  EXPECT_EQ(read.images[1].description.source.path, "/maps/ortho.tif");
  EXPECT_EQ(read.images[1].description.source.licence, "CC BY 4.0");
  ASSERT_EQ(read.buildings.size(), 3u);
  const auto& [id, receipt, roof, height] = read.buildings[1];
  const observation::OutlineReceipt& wrote = seen.observations.outlines[1];
  EXPECT_EQ(id.text(), "w101");
  EXPECT_EQ(receipt.state, RowState::corrected);
  EXPECT_EQ(receipt.row, 7u);
  EXPECT_EQ(receipt.shift, wrote.shift);
  EXPECT_EQ(receipt.centre, wrote.centre);
  EXPECT_EQ(receipt.turn, wrote.turn);
  EXPECT_EQ(receipt.before, wrote.before);
  EXPECT_EQ(receipt.confidence, wrote.confidence);
  EXPECT_EQ(receipt.eaves, wrote.eaves);
  EXPECT_EQ(read.buildings[0].receipt.image, observation::OutlineReceipt::kNoImage);
  EXPECT_EQ(roof.pixels, 900u);
  EXPECT_EQ(roof.colour, seen.observations.roofs[1].colour);
  EXPECT_EQ(roof.colour_confidence, 0.72);
  EXPECT_EQ(roof.form, observation::RoofForm::pitched);
  EXPECT_EQ(roof.form_confidence, 0.91);
  EXPECT_EQ(roof.ridge, 12.5);
  EXPECT_EQ(roof.ridge_confidence, 0.83);
  EXPECT_EQ(height.image, 1u);
  EXPECT_EQ(height.shadow.length, 9.25);
  EXPECT_EQ(height.height, 8.4);
  EXPECT_EQ(height.uncertainty, 1.1);
  EXPECT_EQ(height.confidence, 0.8);
  EXPECT_EQ(read.buildings[0].height.image, observation::SeenHeight::kNoImage);
  EXPECT_EQ(receipt.refined.state, observation::RefinementState::refined);
  EXPECT_EQ(receipt.refined.walls, 2u);
  EXPECT_EQ(receipt.refined.largest, wrote.refined.largest);
  EXPECT_EQ(receipt.refined.before, wrote.refined.before);
  EXPECT_EQ(receipt.refined.after, wrote.refined.after);
  EXPECT_EQ(receipt.refined.confidence, wrote.refined.confidence);
  EXPECT_EQ(receipt.refined.from, wrote.refined.from);
  EXPECT_EQ(receipt.refined.to, wrote.refined.to);
  EXPECT_EQ(read.buildings[2].receipt.refined.state, observation::RefinementState::none);
  EXPECT_EQ(receipt.gone, 0);
  EXPECT_EQ(read.buildings[2].receipt.gone, 0.93);
  EXPECT_EQ(read.buildings[2].id.text(), "r102");
  EXPECT_EQ(read.buildings[2].receipt.reason, "another place fits nearly as well");
}

Seen with_courtyards() {
  Seen seen;
  seen.observations.roofs[1].courtyards = {
      {.area = 120.4, .built_over = 0.04, .state = observation::CourtyardState::open, .evidence = {}},
      {.area = 33, .built_over = 0.97, .state = observation::CourtyardState::built_over, .evidence = {}}};
  return seen;
}

TEST(ImageryDocument, ReadsCandidatesThatAreToldAndCourtyards) {
  const Seen seen = with_courtyards();
  const ReadImagery read = read_imagery_json(imagery_json(seen.observations, seen.store, {true, true, true}));
  ASSERT_EQ(read.unmapped.size(), 2u) << "what is not told is written for benches alone";
  const observation::UnmappedBuilding &wrote = seen.observations.unmapped[0], &got = read.unmapped[0];
  EXPECT_EQ(got.id, wrote.id);
  EXPECT_EQ(got.image, 1u);
  EXPECT_EQ(got.outline, wrote.outline);
  EXPECT_EQ(got.lean, wrote.lean);
  EXPECT_EQ(got.area, wrote.area);
  EXPECT_EQ(got.probability, wrote.probability);
  EXPECT_FALSE(got.of_roof);
  EXPECT_TRUE(read.unmapped[1].of_roof);
  const std::vector<observation::CourtyardView>& courtyards = read.buildings[1].roof.courtyards;
  ASSERT_EQ(courtyards.size(), 2u);
  EXPECT_EQ(courtyards[0].state, observation::CourtyardState::open);
  EXPECT_EQ(courtyards[1].state, observation::CourtyardState::built_over);
  EXPECT_EQ(courtyards[1].area, 33);
  EXPECT_EQ(courtyards[1].built_over, 0.97);
  EXPECT_TRUE(read.buildings[0].roof.courtyards.empty());
}

TEST(ImageryDocument, RefusesCandidatesOfNoImageOrWithoutOutline) {
  const Seen seen;
  const std::string text = imagery_json(seen.observations, seen.store, {true, true, true});
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string changed = text;
    const std::size_t at = changed.find(from, changed.find("\"unmapped\""));
    EXPECT_NE(at, std::string::npos);
    return changed.replace(at, from.size(), to);
  };
  EXPECT_THROW(read_imagery_json(with("\"image\": 1", "\"image\": 2")), std::exception);
  EXPECT_THROW(read_imagery_json(with("\"outline\"", "\"line\"")), std::exception);
  EXPECT_THROW(read_imagery_json(with("\"area_m2\": 112.5", "\"area_m2\": \"large\"")), std::exception);
}

TEST(ImageryDocument, OfSeveralCourtyardsTheOneThatIsBuiltOverIsTold) {
  const Seen seen = with_courtyards();
  SeenOutline outline{
      seen.observations.outlines[1], seen.observations.images[1], true, {}, seen.observations.roofs[1].courtyards};
  ASSERT_TRUE(outline.told_courtyard());
  EXPECT_EQ(outline.told_courtyard()->state, observation::CourtyardState::built_over);
  EXPECT_NE(imagery_text(outline).find("courtyard of 33 m²: perhaps built over (0.97)"), std::string::npos);
  outline.courtyards = outline.courtyards.first(1);
  EXPECT_NE(imagery_text(outline).find("courtyard: open (0.96)"), std::string::npos);
  const std::vector<observation::CourtyardView> unsure{{.area = 50, .built_over = 0.5, .state = {}, .evidence = {}}};
  outline.courtyards = unsure;
  EXPECT_FALSE(outline.told_courtyard());
  EXPECT_EQ(imagery_text(outline).find("courtyard"), std::string::npos);
}

TEST(ImageryDocument, RefusesWhatItCannotHaveWritten) {
  EXPECT_THROW(read_imagery_json("{}"), std::exception);
  EXPECT_THROW(read_imagery_json(R"({"applied":true,"images":[],"buildings":[{"id":"w1","state":"lost"}]})"),
               std::exception);
  EXPECT_THROW(
      read_imagery_json(R"({"applied":true,"images":[],"buildings":[{"id":"w1","state":"corrected","image":0}]})"),
      std::exception);
  EXPECT_THROW(read_imagery_json(R"({"applied":true,"images":[],"buildings":[{"id":"w1","state":"outside",)"
                                 R"("shadow":{"image":3,"length_m":1},"height_from_shadow_m":1,)"
                                 R"("height_from_shadow_within_m":1}]})"),
               std::exception);
}

TEST(SeenOutlines, TellWhatWasDoneInWords) {
  const Seen seen;
  const SeenOutlines lookup = seen_outlines(&seen.observations, seen.store);
  EXPECT_FALSE(lookup({model::OsmType::way, 100})) << "no image shows it";
  EXPECT_FALSE(lookup({model::OsmType::way, 9})) << "there is none";
  EXPECT_EQ(
      imagery_text(*lookup({model::OsmType::way, 101})),
      "moved 2.05 m to the NE, turned by 0.5 degrees, as ortho.tif of 2023-06 shows it (walls on edges: 0.12 where "
      "mapped, 0.43 there; confidence 0.87); 2 walls shifted by up to 0.81 m (clearness of all edges 0.43 before, 0.65 "
      "after; confidence 0.71)");
  EXPECT_EQ(
      imagery_text(*lookup({model::OsmType::relation, 102})),
      "perhaps gone (0.93): no roof, wall or shadow is seen; left where it is mapped: another place fits nearly as "
      "well (ortho.tif of 2023-06)");
  EXPECT_FALSE(seen_outlines(nullptr, seen.store)) << "no images";
}

}  // namespace
}  // namespace blockrand::outputs
