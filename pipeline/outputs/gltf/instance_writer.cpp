#include "pipeline/outputs/gltf/instance_writer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <span>
#include <string>
#include <utility>

#include "pipeline/outputs/gltf/glb_document.h"
#include "pipeline/outputs/gltf/stored_element.h"
#include "pipeline/outputs/number_text.h"

namespace blockrand::outputs {
namespace {

void number(std::string& json, std::size_t value) { append_number(json, static_cast<std::int64_t>(value)); }

/// A place as it is written.
struct Place {
  const ElementInstance* instance = nullptr;
  double stretch = 1;
};

/// All places of one mesh: of stored geometry in certain colours.
struct PlacedMesh {
  const model::ColouredElement* element = nullptr;  ///< the first of those that share it
  Panes panes = Panes::as_modelled;
  int stored = 0;
  std::vector<Place> places;
};

class InstanceWriter {
 public:
  InstanceWriter(GlbDocument& document, const model::Region& region, const PaneMaterials* panes)
      : document_(document), region_(region), elements_(document, ElementVertices::steps, region, panes) {}

  InstanceFigures write(const std::vector<InstanceGroup>& groups) {
    for (const InstanceGroup& group : groups) collect(group);
    for (const PlacedMesh& placed : meshes_) {
      const int mesh = elements_.add_mesh(placed.stored, *placed.element, placed.panes, MaterialName::plain);
      auto& children = children_[elements_[placed.stored].steps];
      for (const Place& place : placed.places) children.push_back(add_node(mesh, place, placed));
    }
    figures_.elements = meshes_.size();
    for (auto step = children_.rbegin(); step != children_.rend(); ++step) add_parent(step->first, step->second);
    return figures_;
  }

 private:
  /// Finds the mesh that the places of a group belong to.
  void collect(const InstanceGroup& group) {
    const model::ColouredElement& element = region_.elements.at(group.element);
    const ElementForm form = elements_.form(*element.element, group.panes);
    if (form.stored < 0) return;
    const StoredElement& stored = elements_[form.stored];
    const auto [place, added] =
        known_.try_emplace(elements_.mesh_key(form.stored, element, group.panes), meshes_.size());
    if (added) meshes_.push_back({&element, group.panes, form.stored, {}});
    PlacedMesh& mesh = meshes_[place->second];
    for (const ElementInstance& at : group.instances) {
      mesh.places.push_back({&at, form.stretch});
      widen(figures_, at, form.min, form.max, std::exchange(first_, false));
    }
    figures_.places += group.instances.size();
    figures_.triangles += stored.triangles * group.instances.size();
  }

  /// East, north, up to glTF's y up, in whole steps.
  static std::array<double, 3> translation(const Place& place, double steps) {
    const model::Point3& p = place.instance->origin;
    return {std::nearbyint(p.x * steps), std::nearbyint(p.z * steps), 0.0 - std::nearbyint(p.y * steps)};
  }
  int add_node(int mesh, const Place& place, const PlacedMesh& placed) {
    const StoredElement& stored = elements_[placed.stored];
    std::string json = "{\"extras\":{\"feature\":";
    number(json, place.instance->feature);
    json += "},\"mesh\":";
    append_number(json, std::int64_t{mesh});
    const auto list = [&](const char* name, const auto& values) {
      json += name;
      for (std::size_t i = 0; i < values.size(); ++i) {
        if (i) json += ',';
        append_number(json, values[i]);
      }
      json += ']';
    };
    auto turn = rotation_to(place.instance->along);
    for (double& v : turn) v = std::nearbyint(v * 1e7) / 1e7;
    list(",\"rotation\":[", turn);
    if (stored.stretched) list(",\"scale\":[", std::array<double, 3>{place.stretch, 1, 1});
    list(",\"translation\":[", translation(place, stored.steps));
    return document_.add_node(json + '}');
  }

  void add_parent(double steps, const std::vector<int>& children) {
    std::string json = "{\"children\":[";
    for (std::size_t i = 0; i < children.size(); ++i) {
      if (i) json += ',';
      append_number(json, std::int64_t{children[i]});
    }
    json += "],\"scale\":[";
    for (int i = 0; i < 3; ++i) {
      if (i) json += ',';
      append_number(json, 1 / steps);
    }
    document_.add_root(document_.add_node(json + "]}"));
  }

  GlbDocument& document_;
  const model::Region& region_;
  StoredElements elements_;
  std::vector<PlacedMesh> meshes_;
  std::map<std::vector<int>, std::size_t> known_;  ///< by stored geometry and the looks of its parts
  std::map<double, std::vector<int>> children_;    ///< nodes by steps of a metre
  InstanceFigures figures_;
  bool first_ = true;
};

}  // namespace

std::array<double, 4> rotation_to(const model::Point2& along) {
  const double c = std::sqrt(std::max(0.0, (1 + along.x) / 2)), s = std::sqrt(std::max(0.0, (1 - along.x) / 2));
  return {0, along.y < 0 ? -s : s, 0, c};
}

void widen(InstanceFigures& figures, const ElementInstance& at, const model::Point3& min, const model::Point3& max,
           bool first) {
  const model::Point2 out{at.along.y, -at.along.x};
  for (const double x : {min.x, max.x})
    for (const double z : {min.z, max.z}) {
      const double east = at.origin.x + at.along.x * x + out.x * z, north = at.origin.y + at.along.y * x + out.y * z;
      const double low = at.origin.z + min.y, high = at.origin.z + max.y;
      if (first) figures.min = figures.max = {east, north, low};
      first = false;
      figures.min = {std::min(figures.min.x, east), std::min(figures.min.y, north), std::min(figures.min.z, low)};
      figures.max = {std::max(figures.max.x, east), std::max(figures.max.y, north), std::max(figures.max.z, high)};
    }
}

InstanceFigures write_instances(GlbDocument& document, const model::Region& region,
                                const std::vector<InstanceGroup>& groups, const PaneMaterials* panes) {
  return InstanceWriter(document, region, panes).write(groups);
}

}  // namespace blockrand::outputs
