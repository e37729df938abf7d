#include "tests/unit/run/survey_match.h"

#include <algorithm>
#include <numeric>

#include "importers/reference/affine_transform.h"
#include "importers/reference/citygml.h"
#include "importers/reference/footprints.h"

namespace blockrand::run::test {

namespace {

namespace fs = std::filesystem;
namespace reference = importers::reference;

bool mostly_the_same(const PlanShape& a, const PlanShape& b) {
  return a.common_area(b) > 0.5 * std::min(a.area(), b.area());
}

/// Sets that grow together.
class Groups {
 public:
  explicit Groups(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0); }
  std::size_t find(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) { parent_[std::max(find(a), find(b))] = std::min(find(a), find(b)); }

 private:
  std::vector<std::size_t> parent_;
};

std::vector<fs::path> models_below(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.path().extension() == ".gml" || entry.path().extension() == ".xml") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

geometry::PlanBox box_around(const std::vector<model::Polygon>& polygons) {
  geometry::PlanBox box;
  for (const model::Polygon& p : polygons) box.include(geometry::box_of(p.outer.points));
  return box;
}

}  // namespace

std::vector<SurveyedBuilding> read_survey(const fs::path& folder, const std::string& crs) {
  std::vector<SurveyedBuilding> out;
  for (const fs::path& file : models_below(folder)) {
    reference::ReferenceModel model = reference::read_citygml(file.string());
    reference::transform_to(model, crs);
    for (const reference::Footprint2D& footprint : reference::ground_footprints(model)) {
      SurveyedBuilding b;
      b.id = model.buildings[footprint.building].id;
      b.ground = PlanShape(footprint.polygons);
      b.box = box_around(footprint.polygons);
      const bool known = std::any_of(out.begin(), out.end(), [&](const SurveyedBuilding& other) {
        return other.box.near(b.box, 0) && mostly_the_same(other.ground, b.ground);
      });
      if (!known && !b.ground.empty()) out.push_back(std::move(b));
    }
  }
  return out;
}

PlanShape shape_of(const footprints::FootprintStore& store, const std::vector<std::uint32_t>& buildings) {
  std::vector<model::Polygon> all;
  for (const std::uint32_t b : buildings)
    for (model::Polygon& p : store.polygons(b)) all.push_back(std::move(p));
  return PlanShape(all);
}

std::vector<SurveyMatch> match_survey(const footprints::FootprintStore& mapped,
                                      const std::vector<SurveyedBuilding>& survey) {
  const geometry::BoxIndex index = footprints::index_of(mapped);
  const std::size_t n = survey.size();
  Groups groups(n + mapped.size());
  std::vector<bool> linked(n + mapped.size(), false);
  for (std::size_t s = 0; s < n; ++s)
    for (const std::uint32_t b : index.near(survey[s].box, 0)) {
      if (!mostly_the_same(survey[s].ground, shape_of(mapped, {b}))) continue;
      groups.join(s, n + b);
      linked[s] = linked[n + b] = true;
    }
  std::vector<SurveyMatch> all(n);  // by the least surveyed building
  for (std::size_t i = 0; i < linked.size(); ++i) {
    if (!linked[i]) continue;
    SurveyMatch& match = all[groups.find(i)];
    if (i >= n) {
      match.buildings.push_back(static_cast<std::uint32_t>(i - n));
      continue;
    }
    match.surveyed.push_back(i);
    match.ground = match.ground.united(survey[i].ground);
  }
  std::erase_if(all, [&](const SurveyMatch& m) {
    if (m.buildings.empty()) return true;
    const PlanShape shape = shape_of(mapped, m.buildings);
    return m.ground.common_area(shape) <= 0.5 * std::max(shape.area(), m.ground.area());
  });
  return all;
}

}  // namespace blockrand::run::test
