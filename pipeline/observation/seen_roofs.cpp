#include "pipeline/observation/seen_roofs.h"

#include <fmt/format.h>

#include <string>

namespace blockrand::observation {

void put_seen_roofs(model::Region& region, std::span<const std::uint32_t> numbers, const ImageryObservations& seen) {
  const auto words = [&](std::uint32_t image) {
    const importers::imagery::ImageSource& source = seen.images[image].description.source;
    return source.path.substr(source.path.find_last_of('/') + 1) + (source.date.empty() ? "" : " of " + source.date);
  };
  const auto put = [](auto& to, auto value, double confidence, std::string why) {
    to = {value, model::Source::imagery, static_cast<float>(confidence), std::move(why)};
  };
  for (std::size_t i = 0; i < region.buildings.size(); ++i) {
    const std::uint32_t b = numbers[i];
    model::SeenRoof& out = region.buildings[i].seen_roof;
    if (b < seen.heights.size() && seen.heights[b].image < seen.images.size() && seen.heights[b].confidence > 0) {
      const SeenHeight& h = seen.heights[b];
      put(out.eaves, h.height, h.confidence,
          fmt::format("a shadow of {:.1f} m in {} tells a roof's edge at {:.1f} m (within {:.1f})", h.shadow.length,
                      words(h.image), h.height, h.uncertainty));
    }
    if (b >= seen.roofs.size() || seen.roofs[b].pixels == 0 || seen.roofs[b].image >= seen.images.size()) continue;
    const RoofView& roof = seen.roofs[b];
    const std::string image = words(roof.image);
    if (roof.colour) put(out.colour, *roof.colour, roof.colour_confidence, "its sunlit part in " + image);
    if (roof.form != RoofForm::unknown)
      put(out.pitched, roof.form == RoofForm::pitched, roof.form_confidence,
          roof.form == RoofForm::pitched ? "slopes of unlike brightness in " + image
                                         : "one even brightness in " + image);
    if (roof.ridge)
      put(out.ridge, *roof.ridge, roof.ridge_confidence,
          fmt::format("slopes meet at {:.0f} degrees in {}", *roof.ridge, image));
  }
}

}  // namespace blockrand::observation
