// Does repair bring outlines nearer to what surveyors measured? Buildings of OSM against the ground surfaces of surveyed
// and hand-built models on the same ground, before repair and after. Skipped where the data is absent.
//
// Prints for each set: the matches, the agreement before and after, and what lost most, step by step.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <optional>

#include "importers/osm/read_extract.h"
#include "pipeline/base/parallel.h"
#include "pipeline/georef/crs.h"
#include "pipeline/georef/projection.h"
#include "pipeline/region/area.h"
#include "pipeline/region/repair_extract.h"
#include "tests/unit/region/survey_match.h"

namespace blockrand::region::test {
namespace {

namespace fs = std::filesystem;
using model::Point2;

/// An extract, ready to be repaired in several ways.
class Town {
 public:
  explicit Town(const fs::path& file)
      : extract_(importers::osm::read_extract(file.string())), area_(area_of(extract_).value()),
        projection_(georef::open_crs(georef::choose_crs(area_.centre.lon, area_.centre.lat), area_.box), area_.box),
        kept_(extract_) {
    model::Report report;
    shards_ = make_shards(extract_, report);
  }
  const std::string& crs() const { return projection_.crs().authority_code; }
  FootprintStore repaired(bool simplify, bool share_walls, bool square) const {
    repair::RepairOptions options;
    options.simplify = simplify;
    options.share_walls = share_walls;
    options.square = square;
    base::Progress progress;
    return repair_extract(extract_, shards_, projection_, kept_, options, base::worker_count(0), progress).footprints;
  }

 private:
  model::Extract extract_;
  Area area_;
  georef::Projection projection_;
  repair::KeptNodes kept_;
  std::vector<Shard> shards_;
};

/// Ways to repair, for finding out which step did what.
enum Step : std::size_t { mapped, simplified, shared, squared, repaired, kSteps };

std::array<FootprintStore, kSteps> repair_step_by_step(const Town& town) {
  return {town.repaired(false, false, false), town.repaired(true, false, false), town.repaired(true, true, false),
          town.repaired(true, false, true), town.repaired(true, true, true)};
}

/// A match, measured.
struct Measured {
  std::string ids;
  std::size_t buildings = 0, surveyed = 0;
  bool gone = false;                  ///< another building stands for one of them now
  double shift = 0;                   ///< m, the largest of the records
  double outline_shift = 0;           ///< m, between the outlines before and after
  double area = 0, survey_area = 0;   ///< m²
  std::array<double, kSteps> iou{};   ///< as is
  std::array<double, kSteps> fitted{};  ///< with the survey's constant offset taken off
  bool moved() const { return shift > 0.05 || outline_shift > 0.05; }
  double gain() const { return iou[repaired] - iou[mapped]; }
};

Point2 median(std::vector<Point2> points) {
  const auto middle = [&](double Point2::* of) {
    std::sort(points.begin(), points.end(), [&](Point2 a, Point2 b) { return a.*of < b.*of; });
    return points.empty() ? 0 : points[points.size() / 2].*of;
  };
  return {middle(&Point2::x), middle(&Point2::y)};
}

/// How far the map lies from the survey: the median of the centroids' differences over matches that agree to 80 %.
Point2 constant_offset(const FootprintStore& as_mapped, const std::vector<SurveyMatch>& matches) {
  std::vector<Point2> differences;
  for (const SurveyMatch& m : matches) {
    const PlanShape shape = shape_of(as_mapped, m.buildings);
    if (shape.intersection_over_union(m.ground) < 0.8) continue;
    const Point2 a = m.ground.centroid(), b = shape.centroid();
    differences.push_back({b.x - a.x, b.y - a.y});
  }
  return median(std::move(differences));
}

Measured measure(const std::array<FootprintStore, kSteps>& steps, const SurveyMatch& match, Point2 offset) {
  Measured out;
  out.buildings = match.buildings.size();
  out.surveyed = match.surveyed.size();
  for (const std::uint32_t b : match.buildings) {
    const StoredFootprint& after = steps[repaired][b];
    out.ids += (out.ids.empty() ? "" : "+") + after.id.text();
    out.gone |= after.settled != model::ObjectState::pending;
    out.shift = std::max(out.shift, after.record.max_shift);
    out.outline_shift = std::max(
        out.outline_shift, shape_of(steps[mapped], {b}).outline_distance(shape_of(steps[repaired], {b})));
  }
  const PlanShape there = match.ground.moved(offset);
  out.survey_area = there.area();
  for (std::size_t s = 0; s < kSteps; ++s) {
    const PlanShape shape = shape_of(steps[s], match.buildings);
    if (s == mapped) out.area = shape.area();
    out.iou[s] = shape.intersection_over_union(match.ground);
    out.fitted[s] = shape.intersection_over_union(there);
  }
  return out;
}

/// Mean agreement of some matches and who lost.
struct Summary {
  std::size_t count = 0, lost = 0;
  double before = 0, after = 0, fitted_before = 0, fitted_after = 0;
  std::size_t fitted_lost = 0;
};

template <class Which>
Summary summary_of(const std::vector<Measured>& all, Which&& which) {
  Summary s;
  for (const Measured& m : all) {
    if (!which(m)) continue;
    ++s.count;
    s.before += m.iou[mapped];
    s.after += m.iou[repaired];
    s.fitted_before += m.fitted[mapped];
    s.fitted_after += m.fitted[repaired];
    s.lost += m.iou[repaired] < m.iou[mapped] - 0.01;
    s.fitted_lost += m.fitted[repaired] < m.fitted[mapped] - 0.01;
  }
  for (double* mean : {&s.before, &s.after, &s.fitted_before, &s.fitted_after})
    *mean /= std::max(1.0, static_cast<double>(s.count));
  return s;
}

void print(const char* what, const Summary& s) {
  std::printf("| %-34s | %4zu | %.4f | %.4f | %+.4f | %zu (%.1f %%) | %.4f | %.4f | %+.4f | %zu |\n", what, s.count,
              s.before, s.after, s.after - s.before, s.lost,
              100 * static_cast<double>(s.lost) / std::max(1.0, static_cast<double>(s.count)), s.fitted_before,
              s.fitted_after, s.fitted_after - s.fitted_before, s.fitted_lost);
}

void print_losers(std::vector<Measured> all) {
  std::erase_if(all, [](const Measured& m) { return !m.moved(); });
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.gain() < b.gain(); });
  std::printf("  worst: buildings (surveyed), area / surveyed, shift / of outline, IoU before, change: simplified, "
              "shared only, squared only, all; all with offset\n");
  for (std::size_t i = 0; i < std::min<std::size_t>(10, all.size()); ++i) {
    const Measured& m = all[i];
    std::printf("  %s (%zu)%s %.0f / %.0f m2, %.2f / %.2f m, %.4f: %+.4f %+.4f %+.4f %+.4f; %+.4f\n", m.ids.c_str(),
                m.surveyed, m.gone ? " covered" : "", m.area, m.survey_area, m.shift, m.outline_shift, m.iou[mapped],
                m.iou[simplified] - m.iou[mapped], m.iou[shared] - m.iou[mapped], m.iou[squared] - m.iou[mapped],
                m.gain(), m.fitted[repaired] - m.fitted[mapped]);
  }
}

struct SurveySet {
  const char* name;
  const char* extract;
  const char* survey;
};

class Surveys : public ::testing::TestWithParam<SurveySet> {};

TEST_P(Surveys, AgreeBetterWithWhatIsRepaired) {
  const fs::path data = fs::path(BLOCKRAND_SHARED_DIR) / "data";
  const fs::path file = data / "osm" / GetParam().extract, folder = data / "reference" / GetParam().survey;
  if (!fs::exists(file) || !fs::exists(folder)) GTEST_SKIP() << "no " << file << " or " << folder;
  const Town town(file);
  const auto survey = read_survey(folder, town.crs());
  const auto steps = repair_step_by_step(town);
  const auto matches = match_survey(steps[mapped], survey);
  const Point2 offset = constant_offset(steps[mapped], matches);
  std::vector<Measured> measured;
  for (const SurveyMatch& m : matches) measured.push_back(measure(steps, m, offset));

  std::printf("%s: %zu surveyed, %zu matches; the map lies %.2f m east, %.2f m north of the survey\n", GetParam().name,
              survey.size(), matches.size(), offset.x, offset.y);
  std::printf("| which | matches | IoU before | after | change | lost > 0.01 | offset taken off: before | after | change "
              "| lost |\n");
  print("all", summary_of(measured, [](const Measured&) { return true; }));
  const Summary moved = summary_of(measured, [](const Measured& m) { return m.moved(); });
  print("moved > 5 cm", moved);
  print("moved > 5 cm, by the record", summary_of(measured, [](const Measured& m) { return m.shift > 0.05; }));
  print("moved > 5 cm, one building", summary_of(measured, [](const Measured& m) { return m.moved() && m.buildings == 1; }));
  print("moved > 5 cm, 1:1", summary_of(measured, [](const Measured& m) {
          return m.moved() && m.buildings == 1 && m.surveyed == 1;
        }));
  print_losers(measured);
  EXPECT_GT(moved.count, 0u);
  EXPECT_GT(moved.after, moved.before);
  EXPECT_LE(static_cast<double>(moved.lost), 0.05 * static_cast<double>(moved.count));
}

INSTANTIATE_TEST_SUITE_P(
    All, Surveys,
    ::testing::Values(SurveySet{"Ingolstadt", "ingolstadt-altstadt.osm", "ingolstadt-lod3"},
                      SurveySet{"Berlin", "berlin-mitte-2014.osm.pbf", "berlin-lod2"},
                      SurveySet{"PariserPlatz", "berlin-pariser-platz-2014.osm.pbf", "berlin-pariser-platz"}),
    [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace blockrand::region::test
