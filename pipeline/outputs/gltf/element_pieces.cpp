#include "pipeline/outputs/gltf/element_pieces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "pipeline/model/vector.h"
#include "pipeline/outputs/gltf/point_numbers.h"

namespace blockrand::outputs {
namespace {

using model::ElementPart;
using model::Point3;

// What things cost in a packed file, about: measured on tiles of three cities.
constexpr double kPlaceBytes = 6;    ///< translation, rotation, scale and feature of a place
constexpr double kShapeBytes = 800;  ///< JSON of a shape
constexpr double kVertexBytes = 8, kTriangleBytes = 1.5;

/// Bytes that a draw less is worth: where a shape saves no more, its pieces are baked. Draws fall by a third for 1 to 4 % more packed
/// bytes up to 2,200; from there to here by 7 % more for 1 % (docs/internal/RESULTS.md, "Gutters, pitches of sides, shaped windows").
constexpr double kDrawBytes = 3500;

/// Shapes of whole pieces that a plan has at least, if there are so many, and how the others are tried.
constexpr std::size_t kFewestWhole = 16, kTrialStep = 4;

/// The cosine of 4 degrees, by which a scaled shape may be shaded otherwise.
constexpr double kNormalCosine = 0.9976;

/// Of places on one wall: components of unit vectors, and m along it or out of it. Frames and grids leave that much.
constexpr double kSameDirection = 1e-3, kSameColumn = 0.01;

constexpr double kFlat = 1e-5;   ///< m; single precision leaves a tenth of it
constexpr double kClean = 1e-6;  ///< of unit vectors

std::array<double, 3> values(const Point3& p) { return {p.x, p.y, p.z}; }

/// Without what rounding left.
Piece::Vector clean_normal(const Point3& n) {
  const auto clean = [](double v) {
    return static_cast<float>(std::fabs(v) < kClean ? 0.0 : std::fabs(v) > 1 - kClean ? std::copysign(1.0, v) : v);
  };
  return {clean(n.x), clean(n.y), clean(n.z)};
}

bool along_an_axis(const Piece::Vector& n) { return (n.x != 0) + (n.y != 0) + (n.z != 0) == 1; }

/// Around points.
class Bounds {
 public:
  void include(const Point3& p) {
    if (empty_) min_ = max_ = p;
    empty_ = false;
    min_ = {std::min(min_.x, p.x), std::min(min_.y, p.y), std::min(min_.z, p.z)};
    max_ = {std::max(max_.x, p.x), std::max(max_.y, p.y), std::max(max_.z, p.z)};
  }
  Point3 middle() const { return (min_ + max_) * 0.5; }
  Point3 half() const {
    const auto half = [](double low, double high) { return high - low > kFlat ? (high - low) / 2 : 0.0; };
    return {half(min_.x, max_.x), half(min_.y, max_.y), half(min_.z, max_.z)};
  }

 private:
  Point3 min_, max_;
  bool empty_ = true;
};

/// About a middle.
Piece::Vector about(const Point3& middle, const Point3& p) {
  const Point3 d = p - middle;
  return {static_cast<float>(d.x), static_cast<float>(d.y), static_cast<float>(d.z)};
}

bool is_upright(std::span<const Piece::Vertex> vertices) {
  return std::ranges::all_of(vertices, [](const Piece::Vertex& v) { return along_an_axis(v.normal); });
}

enum Kind : std::uint8_t { filling, pane, trim, sill, reveal, kinds };

Kind kind_of(ElementPart part, bool opening, bool glazed) {
  switch (part) {
    case ElementPart::glass:
      return glazed ? pane : filling;
    case ElementPart::frame:
    case ElementPart::leaf:
    case ElementPart::metal:
    case ElementPart::panel:
      return filling;
    case ElementPart::surround:
      return trim;
    case ElementPart::sill:
      return sill;
    case ElementPart::wall:
      return opening ? reveal : sill;
  }
  return filling;
}

struct KindOfPiece {
  Piece piece;
  Kind kind = filling;
};

/// \param materials  null: panes are as modelled, and part of the filling
std::vector<KindOfPiece> pieces_of(const model::ColouredElement& element, const ElementGeometry& geometry, Panes panes,
                                   const PaneMaterials* materials, PieceStore& store) {
  const bool opening = !element.element->opening.outline.empty();
  std::vector<KindOfPiece> out;
  std::vector<const ElementGeometry::PartTriangles*> parts;  // of the piece
  std::size_t vertex_count = 0;
  for (int kind = 0; kind < kinds; ++kind) {
    const auto end = [&] {
      if (parts.empty()) return;
      Bounds bounds;
      std::size_t index_count = 0;
      for (const auto* part : parts) {
        for (const ElementVertex& v : part->vertices) bounds.include(v.position);
        index_count += part->indices.size();
      }
      const Point3 middle = bounds.middle();
      const std::span<Piece::Vertex> vertices = store.add_vertices(vertex_count);
      const std::span<std::uint16_t> indices = store.add_indices(index_count);
      std::size_t next = 0, next_index = 0;
      for (const auto* part : parts) {
        const std::size_t first = next;
        model::PartMaterial look = element.materials[static_cast<std::size_t>(part->part)];
        if (materials && part->part == ElementPart::glass) look = materials->look(panes, part->screen, look);
        for (const ElementVertex& v : part->vertices)
          vertices[next++] = {about(middle, v.position), clean_normal(v.exact_normal), look};
        for (const std::uint32_t i : part->indices) indices[next_index++] = static_cast<std::uint16_t>(first + i);
      }
      out.push_back({{vertices, indices, middle, bounds.half(), is_upright(vertices)}, static_cast<Kind>(kind)});
      parts.clear();
      vertex_count = 0;
    };
    for (const ElementGeometry::PartTriangles& part : geometry.parts) {
      if (kind_of(part.part, opening, materials != nullptr) != kind || part.indices.empty()) continue;
      if (vertex_count + part.vertices.size() > ElementGeometry::kMostVertices) end();
      parts.push_back(&part);
      vertex_count += part.vertices.size();
    }
    end();
  }
  return out;
}

/// Finds the parts of pieces.
class PartFinder {
 public:
  explicit PartFinder(PieceStore& store) : store_(store) {}

  /// Parts that share no corner, each in one look; valid until the next call.
  std::span<const Piece> connected_parts(const Piece& piece) {
    const std::size_t n = piece.vertices.size();
    root_.resize(n);
    std::iota(root_.begin(), root_.end(), std::uint16_t{0});
    for (std::size_t t = 0; t + 2 < piece.indices.size(); t += 3)
      join(piece.indices[t], piece.indices[t + 1]), join(piece.indices[t], piece.indices[t + 2]);
    numbers_.start(n);
    for (std::uint32_t i = 0; i < n; ++i) {
      const Piece::Vertex& v = piece.vertices[i];
      join(i, numbers_.first(hash_of(v.position), i, [&](std::uint32_t other) {
        return piece.vertices[other].position == v.position && piece.vertices[other].look == v.look;
      }));
    }

    used_.assign(n, false);
    for (const std::uint16_t i : piece.indices) used_[i] = true;
    part_of_.assign(n, kNone), at_.resize(n);
    counts_.clear();
    for (std::uint32_t i = 0; i < n; ++i) {
      if (!used_[i]) continue;
      const std::uint32_t r = find(i);
      if (part_of_[r] == kNone) {
        part_of_[r] = static_cast<std::uint16_t>(counts_.size());
        counts_.emplace_back();
      }
      Counts& part = counts_[part_of_[r]];
      at_[i] = static_cast<std::uint16_t>(part.vertices++);
      part.bounds.include(piece.vertices[i].position);
    }
    for (std::size_t t = 0; t < piece.indices.size(); ++t) ++counts_[part_of_[find(piece.indices[t])]].indices;

    std::vector<std::span<Piece::Vertex>> vertices;
    std::vector<std::span<std::uint16_t>> indices;
    for (const Counts& part : counts_) {
      vertices.push_back(store_.add_vertices(part.vertices));
      indices.push_back(store_.add_indices(part.indices));
    }
    for (std::uint32_t i = 0; i < n; ++i) {
      if (!used_[i]) continue;
      const std::size_t part = part_of_[find(i)];
      const Piece::Vertex& v = piece.vertices[i];
      vertices[part][at_[i]] = {about(counts_[part].bounds.middle(), v.position), v.normal, v.look};
    }
    for (Counts& part : counts_) part.indices = 0;
    for (const std::uint16_t i : piece.indices) {
      const std::size_t part = part_of_[find(i)];
      indices[part][counts_[part].indices++] = at_[i];
    }
    parts_.clear();
    for (std::size_t p = 0; p < counts_.size(); ++p)
      parts_.push_back({vertices[p], indices[p], piece.middle + counts_[p].bounds.middle(), counts_[p].bounds.half(),
                        is_upright(vertices[p])});
    return parts_;
  }

 private:
  struct Counts {
    std::size_t vertices = 0, indices = 0;
    Bounds bounds;
  };
  static constexpr std::uint16_t kNone = 0xFFFF;  // a piece has at most that many vertices

  std::uint32_t find(std::uint32_t i) {
    while (root_[i] != i) {
      root_[i] = root_[root_[i]];
      i = root_[i];
    }
    return i;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = find(a), b = find(b);
    root_[std::max(a, b)] = static_cast<std::uint16_t>(std::min(a, b));
  }

  PieceStore& store_;
  PointNumbers numbers_;
  std::vector<std::uint16_t> root_, part_of_, at_;  ///< by vertex; part_of_ of roots
  std::vector<char> used_;
  std::vector<Counts> counts_;
  std::vector<Piece> parts_;
};

/// The scale along the axes that makes `piece` of `shape`; nothing where none does.
std::optional<Point3> scale_to(const Piece& piece, const Piece& shape, double tolerance) {
  std::array<double, 3> scale{};
  for (std::size_t k = 0; k < 3; ++k) {
    const double to = values(piece.half)[k], from = values(shape.half)[k];
    if ((to > 0) != (from > 0)) return std::nullopt;
    scale[k] = from > 0 ? to / from : 1;
  }
  for (std::size_t i = 0; i < piece.vertices.size(); ++i) {
    const Piece::Vector &p = piece.vertices[i].position, &q = shape.vertices[i].position;
    if (!(std::fabs(q.x * scale[0] - p.x) <= tolerance && std::fabs(q.y * scale[1] - p.y) <= tolerance &&
          std::fabs(q.z * scale[2] - p.z) <= tolerance))
      return std::nullopt;
  }
  const bool turns = !(piece.upright && shape.upright);
  for (std::size_t i = 0; i < piece.vertices.size(); ++i) {
    const Point3 n = piece.vertices[i].normal, m = shape.vertices[i].normal;
    // Some viewers scale normals as they do positions, others by the inverse as they should.
    const Point3 wrong{m.x * scale[0], m.y * scale[1], m.z * scale[2]},
        right{m.x / scale[0], m.y / scale[1], m.z / scale[2]};
    if (!turns ? dot(n, m) < kNormalCosine
               : !(dot(n, wrong) >= kNormalCosine * length(wrong) && dot(n, right) >= kNormalCosine * length(right)))
      return std::nullopt;
  }
  return Point3{scale[0], scale[1], scale[2]};
}

/// A piece of the elements of a group.
struct Use {
  std::size_t group = 0;  ///< into the groups
  Piece piece;
  std::size_t shape = 0;
  Point3 scale{1, 1, 1};
  std::vector<std::size_t> parts;  ///< uses of the parts that it consists of
};

/// Finds shapes that pieces have in common.
class Shapes {
 public:
  struct Shape {
    std::size_t first = 0;  ///< the use that it looks like
    std::size_t places = 0;
  };
  /// Sets the shape and scale of uses[number].
  void find(std::vector<Use>& uses, std::size_t number, double tolerance) {
    Use& use = uses[number];
    std::vector<Form>& forms = by_hash_[hash_of_form(use.piece)];
    auto form = std::ranges::find_if(
        forms, [&](const Form& f) { return same_form(uses[list[f.like.front()].first].piece, use.piece); });
    if (form == forms.end()) form = forms.emplace(form);
    for (const std::size_t s : form->like)
      if (const auto scale = scale_to(use.piece, uses[list[s].first].piece, tolerance)) {
        use.shape = s;
        use.scale = *scale;
        return;
      }
    use.shape = list.size();
    form->like.push_back(use.shape);
    list.push_back({number, 0});
  }
  std::vector<Shape> list;

 private:
  /// Shapes with the same triangles between the same numbers of vertices, which have the same looks.
  struct Form {
    std::vector<std::size_t> like;
  };
  static std::uint64_t hash_of_form(const Piece& piece) {
    std::uint64_t hash = base::mix64(piece.vertices.size());
    for (const std::uint16_t i : piece.indices) hash = (hash ^ i) * 0x100000001b3;  // FNV-1a (Fowler, Noll, Vo)
    return base::mix64(hash);
  }
  static bool same_form(const Piece& a, const Piece& b) {
    return a.vertices.size() == b.vertices.size() && std::ranges::equal(a.indices, b.indices) &&
           std::ranges::equal(a.vertices, b.vertices, {}, &Piece::Vertex::look, &Piece::Vertex::look);
  }
  std::unordered_map<std::uint64_t, std::vector<Form>> by_hash_;  // never gone through
};

double baked_bytes(const Piece& piece) {
  return kVertexBytes * static_cast<double>(piece.vertices.size()) +
         kTriangleBytes * static_cast<double>(piece.triangles());
}

/// What a shape saves when it is placed.
double saved(const Piece& piece, std::size_t places) {
  return (baked_bytes(piece) - kPlaceBytes) * static_cast<double>(places) - kShapeBytes - kDrawBytes -
         baked_bytes(piece);
}

class Planner {
 public:
  Planner(const model::Region& region, const std::vector<InstanceGroup>& groups, const PaneMaterials* materials)
      : groups_(groups) {
    std::vector<std::pair<std::size_t, std::vector<KindOfPiece>>> all;
    std::vector<std::size_t> weight(groups.size(), 0), order;
    // Forms come in several colours: those of one form after each other.
    std::vector<std::size_t> by_form(groups.size());
    std::iota(by_form.begin(), by_form.end(), std::size_t{0});
    {
      std::unordered_map<const model::Element*, std::size_t> first;
      std::vector<std::size_t> form;
      for (std::size_t g = 0; g < groups.size(); ++g)
        form.push_back(first.try_emplace(region.elements.at(groups[g].element).element.get(), g).first->second);
      std::ranges::stable_sort(by_form, {}, [&](std::size_t g) { return form[g]; });
    }
    all.resize(groups.size());
    std::pair<const model::Element*, Panes> known;
    ElementGeometry geometry;
    for (const std::size_t g : by_form) {
      const model::ColouredElement& element = region.elements.at(groups[g].element);
      const std::pair<const model::Element*, Panes> wanted{element.element.get(), groups[g].panes};
      if (known != wanted) geometry = element_geometry(*element.element, true, groups[g].panes);
      known = wanted;
      all[g] = {g, pieces_of(element, geometry, groups[g].panes, materials, store_)};
      for (const KindOfPiece& p : all[g].second) weight[g] += p.piece.triangles() * groups[g].instances.size();
    }
    for (std::size_t g = 0; g < groups.size(); ++g)
      if (!all[g].second.empty()) order.push_back(g);
    // The most popular first: others are told as they are.
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return weight[a] > weight[b]; });
    for (const std::size_t i : order)
      for (KindOfPiece& p : all[i].second) {
        uses_.push_back({all[i].first, p.piece, 0, {1, 1, 1}, {}});
        whole_.find(uses_, uses_.size() - 1, p.kind == reveal ? kRevealTolerance : kPieceTolerance);
        whole_.list[uses_.back().shape].places += places(uses_.back());
      }
  }

  PiecePlan plan(std::size_t most) {
    std::vector<std::size_t> rank(whole_.list.size()), of_rank(whole_.list.size());
    std::iota(of_rank.begin(), of_rank.end(), std::size_t{0});
    sort_by_saved(of_rank, whole_, uses_);
    for (std::size_t i = 0; i < of_rank.size(); ++i) rank[of_rank[i]] = i;
    const std::size_t fewest = std::min(kFewestWhole, most);
    divide(rank, fewest);

    std::size_t best = 0;
    double best_bytes = 0;
    std::vector<std::size_t> best_parts;
    for (std::size_t n = fewest;; n = std::min(n + kTrialStep, most)) {
      std::size_t whole = std::min(n, of_rank.size());
      double bytes = 0;
      while (whole > 0 && saved_by(whole_, uses_, of_rank[whole - 1]) <= 0) --whole;
      for (std::size_t i = 0; i < whole; ++i) {
        const Shapes::Shape& s = whole_.list[of_rank[i]];
        bytes +=
            baked_bytes(uses_[s.first].piece) + kShapeBytes + kDrawBytes + kPlaceBytes * static_cast<double>(s.places);
      }
      for (Shapes::Shape& s : part_.list) s.places = 0;
      for (const Use& use : uses_)
        if (rank[use.shape] >= whole)
          for (const std::size_t p : use.parts) {
            part_.list[parts_[p].shape].places += places(use);
            bytes += baked_bytes(parts_[p].piece) * static_cast<double>(places(use));
          }
      std::vector<std::size_t> parts(part_.list.size());
      std::iota(parts.begin(), parts.end(), std::size_t{0});
      sort_by_saved(parts, part_, parts_);
      if (parts.size() > most - whole) parts.resize(most - whole);
      while (!parts.empty() && saved_by(part_, parts_, parts.back()) <= 0) parts.pop_back();
      for (const std::size_t p : parts) bytes -= saved_by(part_, parts_, p);
      if (n == fewest || bytes < best_bytes) {
        best = whole;
        best_bytes = bytes;
        best_parts = std::move(parts);
      }
      if (n == most) break;
    }
    return make(rank, best, best_parts);
  }

 private:
  std::size_t places(const Use& use) const { return groups_[use.group].instances.size(); }

  static double saved_by(const Shapes& shapes, const std::vector<Use>& uses, std::size_t shape) {
    return saved(uses[shapes.list[shape].first].piece, shapes.list[shape].places);
  }
  static void sort_by_saved(std::vector<std::size_t>& order, const Shapes& shapes, const std::vector<Use>& uses) {
    std::vector<double> by;
    for (std::size_t s = 0; s < shapes.list.size(); ++s) by.push_back(saved_by(shapes, uses, s));
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return by[a] > by[b]; });
  }

  /// Finds the parts of what some plan may not place as a whole.
  void divide(const std::vector<std::size_t>& rank, std::size_t fewest) {
    PartFinder finder(store_);
    for (Use& use : uses_) {
      if (rank[use.shape] < fewest && saved_by(whole_, uses_, use.shape) > 0) continue;
      for (const Piece& part : finder.connected_parts(use.piece)) {
        use.parts.push_back(parts_.size());
        parts_.push_back({use.group, part, 0, {1, 1, 1}, {}});
        part_.find(parts_, parts_.size() - 1, kRevealTolerance);
      }
    }
  }

  void add_places(PlacedPiece& to, const Use& use) const {
    for (const ElementInstance& at : groups_[use.group].instances)
      to.places.push_back({&at, use.piece.middle, use.scale});
  }

  PiecePlan make(const std::vector<std::size_t>& rank, std::size_t whole, const std::vector<std::size_t>& parts) {
    PiecePlan out;
    std::vector<std::size_t> number(part_.list.size(), model::kNoIndex);
    std::vector<std::size_t> whole_number(whole_.list.size(), model::kNoIndex);
    out.placed.resize(whole + parts.size());
    for (std::size_t s = 0; s < rank.size(); ++s)
      if (rank[s] < whole) out.placed[rank[s]].shape = uses_[whole_.list[s].first].piece;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      number[parts[i]] = whole + i;
      out.placed[whole + i].shape = parts_[part_.list[parts[i]].first].piece;
    }
    for (const Use& use : uses_) {
      if (rank[use.shape] < whole) {
        add_places(out.placed[rank[use.shape]], use);
        continue;
      }
      for (const std::size_t p : use.parts) {
        if (number[parts_[p].shape] != model::kNoIndex)
          add_places(out.placed[number[parts_[p].shape]], parts_[p]);
        else
          out.baked.push_back({parts_[p].piece, &groups_[use.group].instances});
      }
    }
    for (PlacedPiece& p : out.placed) sort_places(p.places);
    out.store = std::move(store_);
    return out;
  }

  /// Windows above each other follow each other: a place then differs from the one before in its height alone.
  static void sort_places(std::vector<PlacedPiece::Place>& places) {
    std::vector<Keyed> keyed;
    keyed.reserve(places.size());
    for (const PlacedPiece::Place& p : places) {
      const PieceTurn turn(p.at->along);
      const Point3 d = turn(p.middle);
      const model::Point2 at{p.at->origin.x + d.x, p.at->origin.y + d.y};
      keyed.push_back({p.at->feature,
                       {p.at->along.x, p.at->along.y, dot(at, turn.out), dot(at, turn.along), p.at->origin.z + d.z},
                       p});
    }
    std::stable_sort(keyed.begin(), keyed.end(), [](const Keyed& a, const Keyed& b) { return a.feature < b.feature; });
    for_each_run(
        std::span(keyed), [](const Keyed& a, const Keyed& b) { return a.feature == b.feature; },
        [](std::span<Keyed> run) { sort_by(run, 0); });
    for (std::size_t i = 0; i < places.size(); ++i) places[i] = keyed[i].place;
  }

  struct Keyed {
    std::uint32_t feature;
    std::array<double, 5> keys;  ///< direction (east, north), distance of its wall, along the wall, up
    PlacedPiece::Place place;
  };

  template <class Together, class Visit>
  static void for_each_run(std::span<Keyed> all, const Together& together, const Visit& visit) {
    for (std::size_t begin = 0, end = 1; begin < all.size(); begin = end++) {
      while (end < all.size() && together(all[end - 1], all[end])) ++end;
      visit(all.subspan(begin, end - begin));
    }
  }

  /// By the key with that number; those that hardly differ in it by the next.
  static void sort_by(std::span<Keyed> all, std::size_t key) {
    std::stable_sort(all.begin(), all.end(), [&](const Keyed& a, const Keyed& b) { return a.keys[key] < b.keys[key]; });
    if (key + 1 == std::tuple_size_v<decltype(Keyed::keys)>) return;
    const double same = key < 2 ? kSameDirection : kSameColumn;
    for_each_run(
        all, [&](const Keyed& a, const Keyed& b) { return b.keys[key] - a.keys[key] <= same; },
        [&](std::span<Keyed> run) { sort_by(run, key + 1); });
  }

  const std::vector<InstanceGroup>& groups_;
  PieceStore store_;
  std::vector<Use> uses_, parts_;
  Shapes whole_, part_;
};

}  // namespace

PiecePlan plan_pieces(const model::Region& region, const std::vector<InstanceGroup>& groups, std::size_t most,
                      const PaneMaterials* materials) {
  return Planner(region, groups, materials).plan(most);
}

}  // namespace blockrand::outputs
