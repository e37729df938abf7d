#include "pipeline/outputs/gltf/stored_element.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "pipeline/outputs/number_text.h"

namespace blockrand::outputs {
namespace {

constexpr double kMostSteps = 32767;

/// The finest steps in which the geometry fits 16 bits; 0 where it fits none.
double steps_for(const ElementGeometry& g) {
  const double reach = std::max({std::fabs(g.min.x), std::fabs(g.min.y), std::fabs(g.min.z), std::fabs(g.max.x),
                                 std::fabs(g.max.y), std::fabs(g.max.z)});
  for (const model::Point3& p : {g.min, g.max})  // max() passes over what is no number
    for (const double v : {p.x, p.y, p.z})
      if (!std::isfinite(v)) return 0;
  double steps = kGlbStepsPerMetre;
  while (reach * steps > kMostSteps) steps /= 2;
  return steps;
}

/// Half the length of a profile that is drawn along x from -length/2 to length/2 with plane ends; 0 of all else.
double half_length(const ElementGeometry& g) {
  const double half = g.max.x;
  if (!(half > 0)) return 0;
  for (const ElementGeometry::PartTriangles& part : g.parts)
    for (const ElementVertex& v : part.vertices) {
      if (std::fabs(v.position.x) != half) return 0;
      // A scale along x turns no normal that stands on x, or lies in it.
      if (v.normal[0] != 0 && (v.normal[1] != 0 || v.normal[2] != 0)) return 0;
    }
  return half;
}

void append(std::string& key, const void* bytes, std::size_t size) {
  key.append(static_cast<const char*>(bytes), size);
}

struct Vertex {
  std::array<std::int16_t, 4> position{};
  std::array<std::int8_t, 4> normal{};
};

/// Leaves out triangles that have no area once their corners are whole steps.
void drop_flat(std::vector<std::uint32_t>& indices, const std::vector<Vertex>& vertices) {
  std::size_t kept = 0;
  for (std::size_t t = 0; t + 2 < indices.size(); t += 3) {
    const auto &a = vertices[indices[t]].position, &b = vertices[indices[t + 1]].position,
               &c = vertices[indices[t + 2]].position;
    const auto cross = [&](std::size_t i, std::size_t k) {
      return std::int64_t{b[i] - a[i]} * (c[k] - a[k]) - std::int64_t{b[k] - a[k]} * (c[i] - a[i]);
    };
    if (cross(0, 1) == 0 && cross(1, 2) == 0 && cross(2, 0) == 0) continue;
    std::copy_n(indices.begin() + static_cast<std::ptrdiff_t>(t), 3,
                indices.begin() + static_cast<std::ptrdiff_t>(kept));
    kept += 3;
  }
  indices.resize(kept);
}

}  // namespace

ElementForm StoredElements::form(const model::Element& element, Panes panes) {
  const auto [place, added] = forms_.try_emplace({&element, panes});
  ElementForm& form = place->second;
  if (!added) return form;
  ElementGeometry geometry = element_geometry(element, true, panes);
  if (geometry.parts.empty()) return form;
  form.min = geometry.min;
  form.max = geometry.max;
  const double half = half_length(geometry);
  if (half > 0) {
    form.stretch = half;
    for (ElementGeometry::PartTriangles& part : geometry.parts)
      for (ElementVertex& v : part.vertices) v.position.x = v.position.x > 0 ? 1 : -1;
    geometry.min.x = -1;
    geometry.max.x = 1;
  }
  const double steps = steps_for(geometry);
  if (!(steps > 0) || std::any_of(geometry.parts.begin(), geometry.parts.end(), [](const auto& part) {
        return part.vertices.size() > ElementGeometry::kMostVertices;
      }))
    return form;
  form.stored = store(std::move(geometry), steps, half > 0);
  return form;
}

int StoredElements::store(ElementGeometry geometry, double steps, bool stretched) {
  std::vector<std::vector<Vertex>> vertices;
  std::string key;
  append(key, &steps, sizeof(steps));
  key += stretched ? 's' : ' ';
  for (ElementGeometry::PartTriangles& part : geometry.parts) {
    auto& list = vertices.emplace_back();
    for (const ElementVertex& v : part.vertices) {
      Vertex& out = list.emplace_back();
      const double xyz[] = {v.position.x, v.position.y, v.position.z};
      for (std::size_t i = 0; i < 3; ++i) {
        out.position[i] = static_cast<std::int16_t>(std::nearbyint(xyz[i] * steps));
        out.normal[i] = v.normal[i];
      }
    }
    drop_flat(part.indices, list);
    const std::size_t sizes[] = {2 * static_cast<std::size_t>(part.part) + part.screen, list.size(),
                                 part.indices.size()};
    append(key, sizes, sizeof(sizes));
    append(key, list.data(), list.size() * sizeof(list[0]));
    append(key, part.indices.data(), part.indices.size() * sizeof(part.indices[0]));
  }
  // A part of slivers alone has nothing left to show.
  for (std::size_t i = geometry.parts.size(); i-- > 0;)
    if (geometry.parts[i].indices.empty()) {
      geometry.parts.erase(geometry.parts.begin() + static_cast<std::ptrdiff_t>(i));
      vertices.erase(vertices.begin() + static_cast<std::ptrdiff_t>(i));
    }
  if (geometry.parts.empty()) return -1;
  const auto [place, added] = known_.try_emplace(std::move(key), static_cast<int>(stored_.size()));
  if (!added) return place->second;

  StoredElement& out = stored_.emplace_back();
  const double unit = how_ == ElementVertices::floats ? 1 / steps : 1;
  out.steps = steps * unit;
  out.stretched = stretched;
  for (std::size_t first = 0; first < geometry.parts.size();) {
    // As many parts as one block of vertices takes.
    std::vector<float> positions;
    std::vector<std::int8_t> normals;
    std::array<std::array<double, 3>, 2> bounds{};
    std::size_t count = 0;
    std::size_t last = first;
    for (; last < geometry.parts.size() && count + vertices[last].size() <= ElementGeometry::kMostVertices; ++last) {
      std::vector<std::uint16_t> indices;
      for (const std::uint32_t i : geometry.parts[last].indices)
        indices.push_back(static_cast<std::uint16_t>(count + i));
      const std::size_t at = document_.append<std::uint16_t>(Stream::indices, indices);
      out.parts.push_back({geometry.parts[last].part, geometry.parts[last].screen, static_cast<int>(out.blocks.size()),
                           at, indices.size()});
      out.triangles += indices.size() / 3;
      for (const Vertex& v : vertices[last]) {
        for (std::size_t i = 0; i < 3; ++i) {
          const double p = v.position[i] * unit;
          bounds[0][i] = count == 0 ? p : std::min(bounds[0][i], p);
          bounds[1][i] = count == 0 ? p : std::max(bounds[1][i], p);
          positions.push_back(static_cast<float>(p));
        }
        ++count;
        normals.insert(normals.end(), v.normal.begin(), v.normal.end());
      }
    }
    out.blocks.push_back(store_block(positions, normals, count, bounds));
    first = last;
  }
  return place->second;
}

StoredElement::Block StoredElements::store_block(const std::vector<float>& positions,
                                                 const std::vector<std::int8_t>& normals, std::size_t count,
                                                 const std::array<std::array<double, 3>, 2>& bounds) {
  if (how_ == ElementVertices::floats) {
    const std::size_t p = document_.append<float>(Stream::positions, positions);
    return {document_.add_accessor({.stream = Stream::positions,
                                    .offset = p,
                                    .component = Component::float32,
                                    .type = "VEC3",
                                    .count = count,
                                    .bounds = bounds}),
            -1};
  }
  std::vector<std::int16_t> steps;
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t k = 0; k < 4; ++k)
      steps.push_back(k < 3 ? static_cast<std::int16_t>(positions[3 * i + k]) : std::int16_t{0});
  const std::size_t p = document_.append<std::int16_t>(Stream::element_positions, steps);
  const std::size_t n = document_.append<std::int8_t>(Stream::normals, normals);
  const int position = document_.add_accessor({.stream = Stream::element_positions,
                                               .offset = p,
                                               .component = Component::int16,
                                               .type = "VEC3",
                                               .count = count,
                                               .bounds = bounds});
  const int normal = document_.add_accessor({.stream = Stream::normals,
                                             .offset = n,
                                             .component = Component::int8,
                                             .type = "VEC3",
                                             .count = count,
                                             .normalised = true});
  return {position, normal};
}

model::PartMaterial StoredElements::look(const StoredElement::Part& part, const model::ColouredElement& element,
                                         Panes panes) const {
  const model::PartMaterial& modelled = element.materials[static_cast<std::size_t>(part.part)];
  return panes_ && part.part == model::ElementPart::glass ? panes_->look(panes, part.screen, modelled) : modelled;
}

std::vector<int> StoredElements::mesh_key(int stored, const model::ColouredElement& element, Panes panes) const {
  std::vector<int> key{stored};
  for (const StoredElement::Part& part : (*this)[stored].parts) {
    const model::PartMaterial look = this->look(part, element, panes);
    key.insert(key.end(), {look.material, look.colour.r, look.colour.g, look.colour.b});
  }
  return key;
}

int StoredElements::add_mesh(int number, const model::ColouredElement& element, Panes panes, MaterialName name) {
  const StoredElement& stored = (*this)[number];
  const auto look = [&](std::size_t i) { return this->look(stored.parts[i], element, panes); };
  std::string json = "{\"name\":";
  append_json(json, stored.stretched ? element.element->kind : element.element->name);
  json += ",\"primitives\":[";
  for (std::size_t first = 0; first < stored.parts.size();) {
    std::size_t last = first;
    while (last + 1 < stored.parts.size() && stored.parts[last + 1].block == stored.parts[first].block &&
           look(last + 1) == look(first))
      ++last;
    const StoredElement::Block& block = stored.blocks[static_cast<std::size_t>(stored.parts[first].block)];
    if (first > 0) json += ',';
    json += "{\"attributes\":{";
    if (block.normal >= 0) {
      json += "\"NORMAL\":";
      append_number(json, std::int64_t{block.normal});
      json += ',';
    }
    json += "\"POSITION\":";
    append_number(json, std::int64_t{block.position});
    json += "},\"indices\":";
    append_number(json, std::int64_t{indices(number, first, last)});
    json += ",\"material\":";
    append_number(json,
                  std::int64_t{document_.add_material(
                      panes_ ? panes_->json(look(first), name)
                             : material_json(region_.materials.at(look(first).material), look(first).colour, name))});
    json += '}';
    first = last + 1;
  }
  return document_.add_mesh(json + "]}");
}

int StoredElements::indices(int stored, std::size_t first, std::size_t last) {
  StoredElement& e = stored_[static_cast<std::size_t>(stored)];
  std::size_t count = 0;
  for (std::size_t i = first; i <= last; ++i) count += e.parts[i].indices;
  const auto [place, added] = e.ranges.try_emplace({e.parts[first].first_index, count}, 0);
  if (added)
    place->second = document_.add_accessor({.stream = Stream::indices,
                                            .offset = e.parts[first].first_index,
                                            .component = Component::uint16,
                                            .type = "SCALAR",
                                            .count = count});
  return place->second;
}

}  // namespace blockrand::outputs
