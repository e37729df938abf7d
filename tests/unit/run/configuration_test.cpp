// What build.json says of options: every one that shapes the result, and which a tile must share with its build.
#include "pipeline/run/configuration.h"

#include <gtest/gtest.h>

#include "tests/unit/settings/another_value.h"

namespace blockrand::run {
namespace {

using base::OptionRecord;

BuildOptions with_another(const base::Option<BuildOptions>& option) {
  BuildOptions options;
  option.set(options, another_value(option, options));
  return options;
}

/// As messages name it.
std::string shown_key(const base::Option<BuildOptions>& option) {
  const bool main = option.section == base::kMainSection;
  return (main ? "" : std::string(option.section.name) + ".") + std::string(option.record_key());
}

/// Without its value in the record.
nlohmann::json without(nlohmann::json record, const base::Option<BuildOptions>& option) {
  const bool main = option.section == base::kMainSection;
  (main ? record : record.at(std::string(option.section.name))).erase(std::string(option.record_key()));
  return record;
}

/// The keys of a record in their order, those of sections behind them.
std::string keys_of(const nlohmann::ordered_json& record) {
  std::string main, sections;
  for (const auto& [key, value] : record.items()) {
    main += key + " ";
    if (value.is_object()) sections += "\n" + key + ": " + keys_of(value);
  }
  return main + sections;
}

TEST(Configuration, EveryOptionIsRecordedUnderItsKeyAlone) {
  for (const auto& option : build_options()) {
    if (option.name.starts_with("imagery")) continue;  // see below
    nlohmann::json fresh = configuration({}), record = configuration(with_another(option));
    // What nobody ordered follows the level of detail.
    if (option.name == "lod") fresh.erase("surroundings"), record.erase("surroundings");
    if (option.record == OptionRecord::none)
      EXPECT_EQ(record, fresh) << option.name;
    else {
      EXPECT_NE(record, fresh) << option.name;
      EXPECT_EQ(without(record, option), without(fresh, option)) << option.name;
    }
  }
}

TEST(Configuration, ABuildWithoutImagesHasNoRecordOfThem) {
  BuildOptions options;
  options.imagery.correct = observation::Correction::apply;
  EXPECT_EQ(configuration(options), configuration({}));
  options.imagery.images = {{"a.tif", {}, {}, {}}, {"b.tif", {}, {}, {}}};
  const nlohmann::json record = configuration(options);
  EXPECT_EQ(record.at("imagery"), nlohmann::json({"a.tif", "b.tif"}));
  EXPECT_EQ(record.at("imagery_correct"), "apply");
  options.imagery.correct = observation::Correction::report;
  EXPECT_EQ(configuration(options).at("imagery_correct"), "report");
  // A tile alone takes the receipts of the whole: it need not name the images again.
  EXPECT_EQ(first_difference(record, {}), "");
}

TEST(Configuration, KeepsItsOrder) {
  BuildOptions options;
  options.tile = "15/35207/25941";
  EXPECT_EQ(keys_of(configuration(options)),
            "lod formats report explain evidence gzip instancing compress single_glb single_cityjson seed tile bbox "
            "objects citygml_detail attributes max_glb_bytes precompress districts overrides terrain "
            "terrain_height_reference surroundings "
            "ground_height repair generate "
            "\nrepair: duplicate_distance spike_width min_piece_area ring_clearance parts_free_area parts_free_width "
            "simplify collinear_distance share_walls square fit_parts arcs settle_coverings resolve_overlaps "
            "max_ring_area_change snap_distance snap_reach snap_angle min_overlap max_shift max_area_change "
            "min_overlap_area max_loss "
            "\ngenerate: neighbour_reach neighbour_minimum min_wall_height max_usual_roof_height min_roof_height "
            "max_roof_pitch canopy_thickness collinear_tolerance simplify_tolerance ");
}

TEST(Configuration, ValuesHaveTheirJsonTypes) {
  BuildOptions options;
  nlohmann::json record = configuration(options);
  EXPECT_EQ(record["lod"].dump(), "3");
  EXPECT_EQ(record["formats"].dump(), R"(["gltf","citygml","cityjson","gpkg"])");
  EXPECT_EQ(record["instancing"].dump(), "\"ext\"");
  EXPECT_EQ(record["bbox"].dump(), "null");
  EXPECT_EQ(record["ground_height"].dump(), "null");
  EXPECT_EQ(record["districts"].dump(), "\"\"");
  EXPECT_EQ(record["repair"]["square"].dump(), "true");
  EXPECT_EQ(record["repair"]["snap_distance"].dump(), "0.4");
  EXPECT_EQ(record["generate"]["neighbour_reach"].dump(), "100.0");
  EXPECT_FALSE(record.contains("tile")) << "a build of the whole has none";
  options.bbox = {1, 2, 3, 4.5};
  options.ground_height = -3.5;
  options.seed = 18446744073709551615u;
  record = configuration(options);
  EXPECT_EQ(record["bbox"].dump(), "[1.0,2.0,3.0,4.5]");
  EXPECT_EQ(record["ground_height"].dump(), "-3.5");
  EXPECT_EQ(record["seed"].dump(), "18446744073709551615");
}

TEST(FirstDifference, NamesWhatATileMustShare) {
  const nlohmann::json fresh = configuration({});
  EXPECT_EQ(first_difference(fresh, {}), "");
  int binding = 0;
  for (const auto& option : build_options()) {
    const bool must = option.record == OptionRecord::binding;
    EXPECT_EQ(first_difference(fresh, with_another(option)), must ? shown_key(option) : "") << option.name;
    binding += must;
  }
  EXPECT_EQ(binding, 6 + 23 + 9);
}

TEST(FirstDifference, WhatARecordLacksHadItsDefault) {
  const nlohmann::json fresh = configuration({});
  for (const auto& option : build_options()) {
    if (option.record != OptionRecord::binding) continue;
    const nlohmann::json older = without(fresh, option);
    EXPECT_EQ(first_difference(older, {}), "") << option.name;
    EXPECT_EQ(first_difference(older, with_another(option)), shown_key(option));
  }
  EXPECT_THROW(first_difference(nlohmann::json::object(), {}), std::exception) << "no sections: no record of a build";
  EXPECT_THROW(first_difference(nlohmann::json::array(), {}), std::exception);
}

TEST(FirstDifference, OfSeveralTheOneThatShapesMost) {
  const nlohmann::json fresh = configuration({});
  BuildOptions options;
  options.generate.min_roof_height = 1;
  options.generate.max_roof_pitch = 60;
  EXPECT_EQ(first_difference(fresh, options), "generate.max_roof_pitch");
  options.repair.square = false;
  EXPECT_EQ(first_difference(fresh, options), "repair.square");
  options.overrides = "x";
  options.districts = "y";
  EXPECT_EQ(first_difference(fresh, options), "districts");
  options.ground_height = 3;
  EXPECT_EQ(first_difference(fresh, options), "ground_height");
  options.seed = 7;
  EXPECT_EQ(first_difference(fresh, options), "seed");
  options.lod = 2;
  EXPECT_EQ(first_difference(fresh, options), "lod");
}

}  // namespace
}  // namespace blockrand::run
