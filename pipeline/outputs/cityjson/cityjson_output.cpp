#include "pipeline/outputs/cityjson/cityjson_output.h"

#include <fmt/chrono.h>

#include <algorithm>
#include <ctime>

#include "pipeline/outputs/cityjson/cityjson_writer.h"
#include "pipeline/outputs/cityjson/surroundings_cityjson.h"
#include "pipeline/outputs/surrounding_objects.h"

namespace blockrand::outputs {
namespace {

CityJsonOptions cityjson_options(const OutputContext& context, std::string name) {
  CityJsonOptions o;
  o.lod = context.lod;
  o.crs_code = context.crs.authority_code;
  o.vertical_crs = context.heights.vertical_crs;
  o.height_reference = context.heights.words;
  o.attribution = attribution(context);
  o.seen = context.seen;
  o.name = std::move(name);
  o.generator = generator();
  o.data_time = context.data_time;
  o.evidence = context.options.evidence;
  return o;
}

/// model.city.json, which grows with every tile.
struct WholeFile {
  explicit WholeFile(const OutputContext& context)
      : file(context.folder.create("model.city.json")),
        model(cityjson_options(context, "Blockrand"), [this](std::string_view bytes) { file.append(bytes); }) {}
  base::StagedFile file;
  SingleCityJson model;
};

class CityJsonOutput : public OutputOf<bool> {
 public:
  explicit CityJsonOutput(const OutputContext& context)
      : context_(context), sequences_(context.options.writes("cityjson")) {
    if (context.options.single_cityjson) whole_ = std::make_unique<WholeFile>(context);
  }

  std::any write_tile(FinishedTile& tile) const override {
    const bool houses = sequences_ && tile.has_parts, around = sequences_ && has_surroundings(tile, context_);
    if (houses) tile.files.push_back(write(tile.region, tile.name, newest_edit(tile.shard)));
    if (around) tile.files.push_back(write_surroundings(tile));
    return houses || around;
  }
  void take(const FinishedTile& tile, std::any product) override {
    empty_ = empty_ && !std::any_cast<bool>(product);
    if (whole_) whole_->model.add(tile.region);
  }
  void finish(const FinishedBuild& build) override {
    // A file without city objects is a valid city model and says more than no file.
    if (sequences_ && empty_) build.files.push_back(write(model::Region{}, "empty", context_.data_time));
    if (!whole_) return;
    whole_->model.finish();
    build.files.push_back(whole_->file.close());
  }

 private:
  base::PublishedFile write(const model::Region& region, const std::string& name, std::string_view date) const {
    CityJsonOptions options = cityjson_options(context_, model_name(region.tile));
    options.data_time = date;
    return write_text_file("cityjson/" + name + ".city.jsonl", write_cityjson_sequence(region, options), context_);
  }

  base::PublishedFile write_surroundings(const FinishedTile& tile) const {
    CityJsonOptions options = cityjson_options(context_, model_name(tile.region.tile));
    options.data_time.clear();  // nothing tells when what stands around was edited
    return write_text_file(
        "cityjson/" + tile.name + std::string(kSurroundingsEnding) + ".city.jsonl",
        write_surroundings_cityjson(*tile.surroundings, *context_.surroundings, tile.region.tile, options), context_);
  }

  /// When an object of the tile was last edited: a file changes when what is in it does, not with every edit of the extract.
  std::string newest_edit(std::size_t shard) const {
    std::uint32_t newest = 0;
    const auto look = [&](std::uint32_t object) {
      newest = std::max(newest, context_.extract.buildings[object].edited);
    };
    for (const footprints::Seed& seed : context_.shards[shard].seeds) {
      if (seed.outline != model::kNoIndex) look(seed.outline);
      for (const std::uint32_t part : seed.parts) look(part);
    }
    return newest > 0 ? fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(static_cast<std::time_t>(newest)))
                      : std::string();
  }

  const OutputContext& context_;
  bool sequences_ = true, empty_ = true;
  std::unique_ptr<WholeFile> whole_;  ///< the sink of its model knows its place
};

}  // namespace

OutputFormat cityjson_output() {
  return {
      .name = "cityjson",
      .places = {{"cityjson/", "CityJSON 2.0, one text sequence per tile",
                  [](const OutputOptions& o, std::uint64_t) { return o.writes("cityjson"); }},
                 {"model.city.json", "the whole build as one CityJSON object",
                  [](const OutputOptions& o, std::uint64_t) { return o.single_cityjson; }}},
      .manual = {{"cityjson/", "the same content as CityJSON 2.0 text sequences, at LoD3 with every detail"}},
      .asked = [](const OutputOptions& o) { return o.writes("cityjson") || o.single_cityjson; },
      .size =
          [](const OutputOptions& o, std::size_t lod) {
            constexpr double kBytes[] = {1500, 2000, 3900, 3900}, kPerWall = 65;
            const double less = o.gzip ? 5 : 1, wall = lod >= 3 ? kPerWall : 0;
            OutputSize size;
            if (o.writes("cityjson"))
              size += {.per_building = kBytes[lod] / less, .per_wall = wall / less, .memory = 8e6};
            if (o.single_cityjson) size += {.per_building = kBytes[lod], .per_wall = wall};
            return size;
          },
      .takes_regions = [](const OutputOptions& o) { return o.single_cityjson; },
      .open = [](const OutputContext& c) -> std::unique_ptr<Output> { return std::make_unique<CityJsonOutput>(c); }};
}

}  // namespace blockrand::outputs
