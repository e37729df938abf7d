#include "pipeline/context/context_extract.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/georef/crs.h"

namespace blockrand::context {
namespace {

constexpr model::Point2 kCorner{391000, 5820000};  // of the cell c1564_23280

/// Buildings of an extract without streets, in metres from kCorner.
class Buildings {
 public:
  explicit Buildings(std::size_t count) : store_(count) { extract_.buildings.resize(count); }

  void square(double x, double y, double size, repair::Level level = {}) {
    footprints::StoredFootprint f;
    f.id = {model::OsmType::way, next_ + 1};
    f.lead = next_;
    f.level = level;
    model::Polygon polygon;
    for (const model::Point2 p : {model::Point2{x, y}, {x + size, y}, {x + size, y + size}, {x, y + size}})
      polygon.outer.points.push_back({kCorner.x + p.x, kCorner.y + p.y});
    polygon.outer.nodes.assign(4, 0);
    store_.set(next_++, f, std::span(&polygon, 1));
  }

  ContextExtract context(std::span<const model::Point2> coverage) const {
    const georef::GeoBox box{13.3, 52.4, 13.5, 52.6};
    const georef::Projection projection(georef::open_crs(georef::choose_crs(13.4, 52.5), box), box);
    base::Progress quiet;
    return context_extract(extract_, store_, coverage, projection, 1, quiet);
  }

 private:
  model::Extract extract_;
  footprints::FootprintStore store_;
  std::uint32_t next_ = 0;
};

TEST(DistrictCells, CountWhatStandsOnTheGroundAsBlocksDo) {
  Buildings b(3);
  b.square(10, 10, 10);
  b.square(40, 10, 20, {.canopy = true});
  b.square(80, 10, 20, {.low = 6});  // floats: a bridge between two houses
  const ContextExtract found = b.context({});
  ASSERT_EQ(found.cells.size(), 1u);
  const context::CellFigures f = context::figures_of(found.cells.begin()->second);
  EXPECT_EQ(f.buildings, 1);
  EXPECT_DOUBLE_EQ(*f.built_share, 100.0 / 62500);
}

TEST(DistrictCells, KnowTheCoverageTheyWereGiven) {
  Buildings b(1);
  b.square(10, 10, 10);
  const std::vector<model::Point2> coverage{kCorner, {kCorner.x + 400, kCorner.y}, {kCorner.x, kCorner.y + 400}};
  EXPECT_EQ(b.context(coverage).coverage, coverage);
}

}  // namespace
}  // namespace blockrand::context
