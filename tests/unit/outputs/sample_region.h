// Small regions made by hand for the exporters' tests and benchmark.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/model/region.h"

namespace blockrand::outputs::test {

using TagList = std::vector<std::pair<std::string, std::string>>;

/// A region with its extract. Buildings are added in ascending id order by the caller.
class SampleRegion {
 public:
  SampleRegion();

  model::Region& region() { return region_; }
  const model::Region& region() const { return region_; }
  model::Extract& extract() { return *extract_; }

  /// Puts tags into the extract.
  model::Range tags(const TagList& list);

  /// A new owned building (way `id`) without parts.
  model::Building& add_building(std::int64_t id, const TagList& list);
  /// A part with LoD1 box and LoD2 box or gable over the rectangle; attributes filled.
  model::BuildingPart& add_box(model::Building& building, const std::string& part_id, double x, double y, double width,
                               double depth, double base, double height);
  model::BuildingPart& add_prism(model::Building& building, const std::string& part_id, model::Polygon plan,
                                 double base, double height);
  model::BuildingPart& add_gable(model::Building& building, const std::string& part_id, double x, double y,
                                 double width, double depth, double base, double eaves, double ridge);
  /// A ring of four wings around a courtyard: faces with holes.
  model::BuildingPart& add_courtyard(model::Building& building, const std::string& part_id, double x, double y,
                                     double size, double court, double height);

  /// One of everything: box, gable house, building with parts, courtyard, odd tags, a part without solid, halo only.
  static SampleRegion zoo();
  /// `count` gable houses with usual tags in rows, like a settlement.
  static SampleRegion settlement(int count, bool with_tags);

 private:
  model::BuildingPart& add_part(model::Building& building, const std::string& part_id, model::Polygon plan);
  std::unique_ptr<model::Extract> extract_;
  model::Region region_;
};

/// A prism over `plan`; its hole, if any, has as many corners as the outer ring, and starts beside its first corner.
std::pair<model::Solid, model::SolidTriangles> prism(const model::Polygon& plan, double base, double top);
std::pair<model::Solid, model::SolidTriangles> gable(double x, double y, double width, double depth, double base,
                                                     double eaves, double ridge);

}  // namespace blockrand::outputs::test
