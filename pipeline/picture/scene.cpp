#include "pipeline/picture/scene.h"

#include <algorithm>
#include <cassert>
#include <iterator>
#include <utility>

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

namespace {

/// Cosine between normals, and m between planes, up to which triangles are one plane face.
constexpr double kOnePlane = 0.99999, kOnePlaneGap = 0.001;

}  // namespace

void Scene::push(const std::array<Point3, 3>& corners, Colour colour, std::uint32_t object, bool closed) {
  const Point3 normal = unit(cross(corners[1] - corners[0], corners[2] - corners[0]));
  if (!(dot(normal, normal) > 0)) return;  // also what is not a number
  const std::array<Vector, 3> own{local(corners[0]), local(corners[1]), local(corners[2])};
  const auto goes_on = [&] {
    if (faces_.empty() || triangles_.empty()) return false;
    const Face& last = faces_.back();
    if (last.object != object || last.colour != colour || last.closed != closed || last.blend != kNoBlend) return false;
    const Point3 n{last.normal.x, last.normal.y, last.normal.z};
    if (!(dot(n, normal) > kOnePlane)) return false;
    const Vector& v = triangles_.back().corners[0];
    const double gap = n.x * (own[0].x - v.x) + n.y * (own[0].y - v.y) + n.z * (own[0].z - v.z);
    return gap < kOnePlaneGap && gap > -kOnePlaneGap;
  };
  if (!goes_on())
    faces_.push_back(
        {.normal = {static_cast<float>(normal.x), static_cast<float>(normal.y), static_cast<float>(normal.z)},
         .colour = colour,
         .closed = closed,
         .object = object,
         .blend = kNoBlend});
  triangles_.push_back({own, static_cast<std::uint32_t>(faces_.size() - 1)});
}

void Scene::push_face(const model::Solid& solid, const model::SolidTriangles& triangles, std::size_t f, Point3 offset,
                      Colour colour, std::uint32_t object) {
  // Slivers have normals that are noise: larger triangles count more.
  Point3 sum;
  const std::size_t first = triangles_.size();
  for (std::uint32_t t = triangles.first[f]; t < triangles.first[f + 1]; ++t) {
    const auto& c = triangles.triangles[t];
    const Point3 a = solid.vertices[c[0]] + offset, b = solid.vertices[c[1]] + offset,
                 d = solid.vertices[c[2]] + offset;
    const Point3 area = cross(b - a, d - a);
    if (!(dot(area, area) > 0)) continue;
    sum = sum + area;
    triangles_.push_back({{local(a), local(b), local(d)}, static_cast<std::uint32_t>(faces_.size())});
  }
  if (triangles_.size() == first) return;
  const Point3 normal = unit(sum);
  faces_.push_back(
      {.normal = {static_cast<float>(normal.x), static_cast<float>(normal.y), static_cast<float>(normal.z)},
       .colour = colour,
       .closed = true,
       .object = object,
       .blend = kNoBlend});
}

void Scene::add(const model::Solid& solid, const model::SolidTriangles& triangles, std::uint32_t object,
                Point3 offset) {
  assert(solid.empty() || triangles.first.size() == solid.faces.size() + 1);
  for (std::size_t f = 0; f < solid.faces.size(); ++f)
    push_face(solid, triangles, f, offset, solid.faces[f].colour, object);
}

void Scene::add(const model::Solid& solid, const model::SolidTriangles& triangles, std::uint32_t object, Point3 offset,
                Colour colour) {
  for (std::size_t f = 0; f < solid.faces.size(); ++f) push_face(solid, triangles, f, offset, colour, object);
}

void Scene::add_without(const model::Solid& solid, const model::SolidTriangles& triangles,
                        const std::vector<bool>& hidden, std::uint32_t object) {
  for (std::size_t f = 0; f < solid.faces.size(); ++f)
    if (f >= hidden.size() || !hidden[f]) push_face(solid, triangles, f, {}, solid.faces[f].colour, object);
}

void Scene::add_outside(const std::array<Point3, 3>& corners, Colour colour, std::uint32_t object) {
  push(corners, colour, object, true);
}

void Scene::add_triangle(const std::array<Point3, 3>& corners, Colour colour, std::uint32_t object) {
  push(corners, colour, object, false);
}

void Scene::add_blended_triangle(const std::array<Point3, 3>& corners, const std::array<Colour, 3>& colours,
                                 std::uint32_t object) {
  const std::size_t before = triangles_.size();
  push(corners, colours[0], object, false);
  if (triangles_.size() == before || (colours[0] == colours[1] && colours[1] == colours[2])) return;
  // A face of its own, whether or not it goes on in the last one's plane.
  if (before > 0 && triangles_[before - 1].face == triangles_.back().face) {
    faces_.push_back(faces_.back());
    ++triangles_.back().face;
  }
  faces_.back().blend = static_cast<std::uint32_t>(blends_.size());
  blends_.push_back({triangles_.back().corners, colours});
}

void Scene::set_ground(double z, Colour colour) { ground_ = Ground{z - origin_.z, colour}; }

void Scene::append_faces(const Scene& other, std::uint32_t first_object) {
  assert(origin_ == other.origin_);
  const auto first_blend = static_cast<std::uint32_t>(blends_.size());
  const std::size_t first_face = faces_.size();
  // No room to spare: a scene of detail has many triangles.
  faces_.reserve(first_face + other.faces_.size());
  faces_.insert(faces_.end(), other.faces_.begin(), other.faces_.end());
  for (std::size_t f = first_face; f < faces_.size(); ++f) {
    faces_[f].object += first_object;
    if (faces_[f].blend != kNoBlend) faces_[f].blend += first_blend;
  }
  blends_.insert(blends_.end(), other.blends_.begin(), other.blends_.end());
  if (!ground_) ground_ = other.ground_;
}

void Scene::append(const Scene& other, std::uint32_t first_object) {
  const auto first_face = static_cast<std::uint32_t>(faces_.size());
  append_faces(other, first_object);
  triangles_.reserve(triangles_.size() + other.triangles_.size());
  for (const Triangle& t : other.triangles_) triangles_.push_back({t.corners, t.face + first_face});
}

void Scene::append_without(const Scene& other, const std::vector<bool>& hidden) {
  const auto first_face = static_cast<std::uint32_t>(faces_.size());
  append_faces(other, 0);
  const auto stays = [&](const Triangle& t) {
    const std::uint32_t object = other.faces_[t.face].object;
    return object >= hidden.size() || !hidden[object];
  };
  triangles_.reserve(triangles_.size() + static_cast<std::size_t>(std::ranges::count_if(other.triangles_, stays)));
  for (const Triangle& t : other.triangles_)
    if (stays(t)) triangles_.push_back({t.corners, t.face + first_face});
}

void Scene::check() const {
  for (const Triangle& t : triangles_)
    if (t.face >= faces_.size()) throw base::UnpackError();
  for (const Face& f : faces_)
    if (f.blend != kNoBlend && f.blend >= blends_.size()) throw base::UnpackError();
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
