#include "pipeline/outputs/explain/explain_output.h"

#include <algorithm>
#include <iterator>

#include "pipeline/outputs/explain/explanation.h"
#include "pipeline/outputs/explain/places.h"
#include "pipeline/outputs/gzip.h"

namespace blockrand::outputs {
namespace {

/// Fast; explanations repeat themselves so much that the highest level gains a tenth.
constexpr int kGzipLevel = 4;

/// What a tile's explanations add to the files of the whole build.
struct ExplainedTile {
  std::vector<std::pair<model::OsmId, model::OsmId>> objects;  ///< with the building whose line explains it
  std::vector<std::pair<model::OsmId, std::string>> places;    ///< lines of explain/places.tsv
};

/// Where the line stands that explains an object.
struct ExplainedObject {
  model::OsmId object, building;
  model::TileId tile;
  friend auto operator<=>(const ExplainedObject&, const ExplainedObject&) = default;
};

std::string explain_index(std::vector<ExplainedObject> objects) {
  std::sort(objects.begin(), objects.end());
  std::string text;
  for (const ExplainedObject& o : objects) text += index_line(o.object, tile_name(o.tile), o.building);
  return text;
}

std::string places_text(std::vector<std::pair<model::OsmId, std::string>> places) {
  std::sort(places.begin(), places.end());
  std::string text;
  for (const auto& [building, line] : places) text += line;
  return text;
}

class ExplainOutput : public OutputOf<ExplainedTile> {
 public:
  explicit ExplainOutput(const OutputContext& context) : context_(context) {}

  std::any write_tile(FinishedTile& tile) const override {
    if (tile.region.buildings.empty()) return ExplainedTile();
    ExplainOptions options;
    options.lod = context_.lod;
    options.earlier = context_.earlier;
    options.rule_file = context_.rule_file;
    options.courtyard = [this](std::string_view id) { return courtyard(id); };
    options.seen = context_.seen;
    options.final_state = tile.final_state;
    options.tile = tile.name;
    for (const base::PublishedFile& file : tile.files) options.files.push_back(file.path);
    // Each piece is a member of the file (RFC 1952, 2.2): neither the text nor its compressed form is held as a whole.
    base::StagedFile file = context_.folder.create("explain/" + tile.name + ".jsonl.gz");
    std::string comment = attribution(context_);
    bool any = false;
    const auto append = [&](std::string_view lines) {
      file.append(gzip(lines, kGzipLevel, comment));
      comment.clear();
      any = true;
    };
    Explanations explanations = explain(tile.region, options, append);
    if (!any) append({});
    tile.files.push_back(file.close());
    return ExplainedTile{std::move(explanations.objects), std::move(explanations.places)};
  }
  void take(const FinishedTile& tile, std::any product) override {
    ExplainedTile& explained = *std::any_cast<ExplainedTile>(&product);
    for (const auto& [object, building] : explained.objects)
      explained_.push_back({object, building, context_.shards[tile.shard].tile});
    std::move(explained.places.begin(), explained.places.end(), std::back_inserter(places_));
  }
  void finish(const FinishedBuild& build) override {
    build.files.push_back(context_.folder.write("explain/index.txt", explain_index(std::move(explained_))));
    build.files.push_back(context_.folder.write(kPlacesFile, places_text(std::move(places_))));
  }

 private:
  std::optional<CourtyardFacts> courtyard(std::string_view id) const {
    const std::vector<context::ExtractCourtyard>& all = context_.context.courtyards;
    const auto found =
        std::lower_bound(all.begin(), all.end(), id,
                         [](const context::ExtractCourtyard& y, std::string_view i) { return y.courtyard.id < i; });
    if (found == all.end() || found->courtyard.id != id) return std::nullopt;
    return CourtyardFacts{found->courtyard.area, found->courtyard.closed};
  }

  const OutputContext& context_;
  std::vector<ExplainedObject> explained_;
  std::vector<std::pair<model::OsmId, std::string>> places_;
};

}  // namespace

OutputFormat explain_output() {
  return {.name = "explain",
          .in_formats = false,
          .manual = {{"explain/", "what 'blockrand explain' reads"}},
          .asked = [](const OutputOptions& o) { return o.explain; },
          .size = [](const OutputOptions&, std::size_t) { return OutputSize{.per_building = 1980}; },
          .names_files = true,
          .open = [](const OutputContext& c) -> std::unique_ptr<Output> { return std::make_unique<ExplainOutput>(c); }};
}

}  // namespace blockrand::outputs
