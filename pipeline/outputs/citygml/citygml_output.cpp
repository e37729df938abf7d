#include "pipeline/outputs/citygml/citygml_output.h"

#include <string>
#include <string_view>

#include "pipeline/outputs/citygml/citygml_writer.h"
#include "pipeline/outputs/citygml/surroundings_gml.h"
#include "pipeline/outputs/surrounding_objects.h"

namespace blockrand::outputs {
namespace {

CityGmlOptions citygml_options(const model::Region& region, const OutputContext& context) {
  CityGmlOptions o;
  o.lod = context.lod;
  const std::string& code = context.crs.authority_code;
  const std::string number = code.substr(code.find(':') + 1);
  const std::string& vertical = context.heights.vertical_crs;
  o.srs_name = vertical.empty()
                   ? "urn:ogc:def:crs:EPSG::" + number
                   : "urn:ogc:def:crs,crs:EPSG::" + number + ",crs:EPSG::" + vertical.substr(vertical.find(':') + 1);
  o.height_reference = context.heights.words;
  o.attribution = attribution(context);
  o.seen = context.seen;
  o.name = model_name(region.tile);
  o.evidence = context.options.evidence;
  o.lean = context.options.citygml_detail == CityGmlDetail::lean;
  return o;
}

class CityGmlOutput : public OutputOf<bool> {
 public:
  explicit CityGmlOutput(const OutputContext& context) : context_(context) {}

  std::any write_tile(FinishedTile& tile) const override {
    if (tile.has_parts) tile.files.push_back(write(tile.region, tile.name));
    const bool around = has_surroundings(tile, context_);
    if (around) tile.files.push_back(write_surroundings(tile));
    return tile.has_parts || around;
  }
  void take(const FinishedTile&, std::any product) override { empty_ = empty_ && !std::any_cast<bool>(product); }
  void finish(const FinishedBuild& build) override {
    // A file without city objects is a valid city model and says more than no file.
    if (empty_) build.files.push_back(write(model::Region{}, "empty"));
  }

 private:
  base::PublishedFile write(const model::Region& region, const std::string& name) const {
    const CityGmlOptions options = citygml_options(region, context_);
    return write_pieces("citygml/" + name + ".gml", [&](const Sink& sink) { write_citygml(region, options, sink); });
  }

  base::PublishedFile write_surroundings(const FinishedTile& tile) const {
    const CityGmlOptions options = citygml_options(tile.region, context_);
    return write_pieces("citygml/" + tile.name + std::string(kSurroundingsEnding) + ".gml", [&](const Sink& sink) {
      write_surroundings_gml(*tile.surroundings, *context_.surroundings, tile.region.tile, options, sink);
    });
  }

  template <class Text>
  base::PublishedFile write_pieces(const std::string& path, const Text& text) const {
    if (context_.options.gzip) {
      std::string whole;
      text([&](std::string_view bytes) { whole += bytes; });
      return write_text_file(path, whole, context_);
    }
    // Piece by piece: the text of a tile is larger than all else that is made of it.
    constexpr std::size_t kPiece = 1 << 18;
    base::StagedFile file = context_.folder.create(path);
    std::string waiting;
    text([&](std::string_view bytes) {
      waiting += bytes;
      if (waiting.size() < kPiece) return;
      file.append(waiting);
      waiting.clear();
    });
    file.append(waiting);
    return file.close();
  }

  const OutputContext& context_;
  bool empty_ = true;
};

}  // namespace

OutputFormat citygml_output() {
  return {.name = "citygml",
          .places = {{"citygml/", "CityGML 2.0, one file per tile"}},
          .manual = {{"citygml/", "CityGML 2.0, LoD0 to LoD3 with boundary surfaces, one file per tile"}},
          .asked = [](const OutputOptions& o) { return o.writes("citygml"); },
          .size =
              [](const OutputOptions& o, std::size_t lod) {
                constexpr double kBytes[] = {2500, 7500, 16500, 16500}, kPerWall = 100, kFull = 300;
                const double less = !o.gzip ? 1 : lod == 3 ? 12 : 7;
                const double wall = lod < 3 ? 0 : o.citygml_detail == CityGmlDetail::full ? kFull : kPerWall;
                return OutputSize{.per_building = kBytes[lod] / less, .per_wall = wall / less, .memory = 8e6};
              },
          .open = [](const OutputContext& c) -> std::unique_ptr<Output> { return std::make_unique<CityGmlOutput>(c); }};
}

}  // namespace blockrand::outputs
