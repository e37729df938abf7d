#include "pipeline/outputs/imagery/imagery_output.h"

#include "pipeline/outputs/imagery/imagery_document.h"

namespace blockrand::outputs {
namespace {

class ImageryOutput : public Output {
 public:
  explicit ImageryOutput(const OutputContext& context) : context_(context) {}

  std::any write_tile(FinishedTile&) const override { return {}; }
  void finish(const FinishedBuild& build) override {
    const std::string text = imagery_json(*context_.imagery, context_.repaired.footprints);
    build.files.push_back(context_.folder.write("imagery.json", text));
  }

 private:
  const OutputContext& context_;
};

}  // namespace

OutputFormat imagery_output() {
  return {.name = "imagery.json",
          .in_formats = false,
          .places = {{"imagery.json", "what the aerial images show: whether they fit, a receipt for every building"}},
          .manual = {{"imagery.json", "with --imagery: whether each image fits, and a receipt for every building"}},
          .asked = [](const OutputOptions& o) { return o.imagery; },
          .bytes_per_building = [](const OutputOptions&, std::size_t) { return 500.0; },
          .open = [](const OutputContext& c) -> std::unique_ptr<Output> { return std::make_unique<ImageryOutput>(c); }};
}

}  // namespace blockrand::outputs
