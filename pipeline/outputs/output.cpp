#include "pipeline/outputs/output.h"

#include <fmt/format.h>

#include <algorithm>

#include "pipeline/base/version.h"
#include "pipeline/outputs/gzip.h"

namespace blockrand::outputs {

OutputSize output_size(const OutputOptions& options, int lod) {
  const auto level = static_cast<std::size_t>(std::clamp(lod, 0, 3));
  OutputSize all;
  for (const OutputFormat& format : all_outputs())
    if (format.asked(options)) all += format.size(options, level);
  return all;
}

std::string attribution(const OutputContext& context) {
  if (!context.imagery) return kAttribution;
  return attribution(context.imagery->images);
}

std::string attribution(std::span<const observation::ImageReceipt> images) {
  std::string text = kAttribution;
  for (const observation::ImageReceipt& image : images) {
    if (image.buildings == 0) continue;
    const importers::imagery::ImageSource& source = image.description.source;
    const std::string name = source.path.substr(source.path.find_last_of('/') + 1);
    text += fmt::format("; aerial image {}", source.attribution.empty() ? name : source.attribution);
    if (!source.date.empty()) text += ", " + source.date;
    text += source.licence.empty() ? ", licence not stated" : ", " + source.licence;
  }
  return text;
}

std::string generator() { return "Blockrand " + std::string(base::kVersion); }

std::string model_name(model::TileId id) { return fmt::format("Blockrand {}/{}/{}", id.level, id.x, id.y); }

std::string tile_name(model::TileId id) { return fmt::format("{}_{}_{}", id.level, id.x, id.y); }

std::string tile_glb_path(model::TileId id) { return fmt::format("tiles/{}/{}/{}.glb", id.level, id.x, id.y); }

void write_served(const std::string& path, const std::string& bytes, const OutputOptions& options,
                  base::StagedFolder& folder, std::vector<base::PublishedFile>& files) {
  constexpr int kServedLevel = 9;  // once packed, sent many times
  files.push_back(folder.write(path, bytes));
  if (options.precompress) files.push_back(folder.write(path + ".gz", gzip(bytes, kServedLevel)));
}

base::PublishedFile write_text_file(const std::string& path, const std::string& bytes, const OutputContext& context) {
  return context.options.gzip ? context.folder.write(path + ".gz", gzip(bytes)) : context.folder.write(path, bytes);
}

}  // namespace blockrand::outputs
