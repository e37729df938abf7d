#include "pipeline/picture/scene.h"

#include <algorithm>
#include <cassert>
#include <iterator>

#include "pipeline/model/vector.h"

namespace blockrand::picture {

void Box::include(Point3 p) {
  if (empty) min = max = p;
  empty = false;
  min = {std::min(min.x, p.x), std::min(min.y, p.y), std::min(min.z, p.z)};
  max = {std::max(max.x, p.x), std::max(max.y, p.y), std::max(max.z, p.z)};
}

std::array<Point3, 8> Box::corners() const {
  std::array<Point3, 8> out;
  for (unsigned i = 0; i < 8; ++i) out[i] = {i & 1 ? max.x : min.x, i & 2 ? max.y : min.y, i & 4 ? max.z : min.z};
  return out;
}

Point3 Box::centre() const { return (min + max) * 0.5; }

Scene::Vector Scene::local(Point3 p) const {
  return {static_cast<float>(p.x - origin_.x), static_cast<float>(p.y - origin_.y),
          static_cast<float>(p.z - origin_.z)};
}

void Scene::push(const std::array<Point3, 3>& corners, const std::array<Colour, 3>& colours, std::uint32_t object,
                 bool closed) {
  const Point3 normal = unit(cross(corners[1] - corners[0], corners[2] - corners[0]));
  if (!(dot(normal, normal) > 0)) return;  // also what is not a number
  Triangle t;
  for (std::size_t i = 0; i < 3; ++i) t.corners[i] = local(corners[i]);
  t.normal = {static_cast<float>(normal.x), static_cast<float>(normal.y), static_cast<float>(normal.z)};
  t.colours = colours;
  t.closed = closed;
  t.blended = colours[0] != colours[1] || colours[1] != colours[2];
  t.object = object;
  triangles_.push_back(t);
}

void Scene::add(const model::Solid& solid, const model::SolidTriangles& triangles, std::uint32_t object,
                Point3 offset) {
  assert(solid.empty() || triangles.first.size() == solid.faces.size() + 1);
  for (std::size_t f = 0; f < solid.faces.size(); ++f) {
    const Colour c = solid.faces[f].colour;
    for (std::uint32_t t = triangles.first[f]; t < triangles.first[f + 1]; ++t) {
      const auto& corners = triangles.triangles[t];
      push({solid.vertices[corners[0]] + offset, solid.vertices[corners[1]] + offset,
            solid.vertices[corners[2]] + offset},
           {c, c, c}, object, true);
    }
  }
}

void Scene::add(const model::Solid& solid, const model::SolidTriangles& triangles, std::uint32_t object, Point3 offset,
                Colour colour) {
  const std::size_t first = triangles_.size();
  add(solid, triangles, object, offset);
  for (std::size_t i = first; i < triangles_.size(); ++i) triangles_[i].colours = {colour, colour, colour};
}

void Scene::add_without(const model::Solid& solid, const model::SolidTriangles& triangles,
                        const std::vector<bool>& hidden, std::uint32_t object) {
  for (std::size_t f = 0; f < solid.faces.size(); ++f) {
    if (f < hidden.size() && hidden[f]) continue;
    for (std::uint32_t t = triangles.first[f]; t < triangles.first[f + 1]; ++t) {
      const auto& c = triangles.triangles[t];
      add_outside({solid.vertices[c[0]], solid.vertices[c[1]], solid.vertices[c[2]]}, solid.faces[f].colour, object);
    }
  }
}

void Scene::add_outside(const std::array<Point3, 3>& corners, Colour colour, std::uint32_t object) {
  push(corners, {colour, colour, colour}, object, true);
}

void Scene::add_triangle(const std::array<Point3, 3>& corners, Colour colour, std::uint32_t object) {
  push(corners, {colour, colour, colour}, object, false);
}

void Scene::add_blended_triangle(const std::array<Point3, 3>& corners, const std::array<Colour, 3>& colours,
                                 std::uint32_t object) {
  push(corners, colours, object, false);
}

void Scene::set_ground(double z, Colour colour) { ground_ = Ground{z - origin_.z, colour}; }

void Scene::append(const Scene& other, std::uint32_t first_object) {
  assert(origin_ == other.origin_);
  const std::size_t first = triangles_.size();
  triangles_.reserve(first +
                     other.triangles_.size());  // a scene of detail has 72 bytes a triangle, and many: no room to spare
  triangles_.insert(triangles_.end(), other.triangles_.begin(), other.triangles_.end());
  for (std::size_t i = first; i < triangles_.size(); ++i) triangles_[i].object += first_object;
  if (!ground_) ground_ = other.ground_;
}

Scene Scene::without(const std::vector<bool>& hidden) const {
  Scene out(origin_);
  out.ground_ = ground_;
  std::ranges::copy_if(triangles_, std::back_inserter(out.triangles_),
                       [&](const Triangle& t) { return t.object >= hidden.size() || !hidden[t.object]; });
  return out;
}

Box Scene::bounds() const {
  Box box;
  const auto add = [&](const Vector& v) { box.include({origin_.x + v.x, origin_.y + v.y, origin_.z + v.z}); };
  for (const Triangle& t : triangles_)
    for (const Vector& v : t.corners) add(v);
  return box;
}

std::vector<Point3> Scene::points() const {
  std::vector<Point3> out;
  out.reserve(triangles_.size() * 3);
  for (const Triangle& t : triangles_)
    for (const Vector& v : t.corners) out.push_back({origin_.x + v.x, origin_.y + v.y, origin_.z + v.z});
  return out;
}

}  // namespace blockrand::picture
