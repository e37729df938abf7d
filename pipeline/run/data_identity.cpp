#include "pipeline/run/data_identity.h"

#include <concepts>
#include <string_view>

#include "pipeline/base/sha256.h"

namespace blockrand::run {
namespace {

using model::Extract;

/// Numbers and texts one after the other, so that no two extracts give the same bytes.
class Digest {
 public:
  void add(std::integral auto value) {
    auto rest = static_cast<std::uint64_t>(value);
    for (int i = 0; i < 8; ++i, rest >>= 8) bytes_ += static_cast<char>(rest & 255);
    if (bytes_.size() > kPiece) flush();
  }
  void add(std::string_view text) {
    add(text.size());
    bytes_ += text;
  }
  void add(model::OsmId id) { add(static_cast<int>(id.type)), add(id.number); }
  std::string finish() {
    flush();
    return hash_.finish();
  }

 private:
  static constexpr std::size_t kPiece = 1 << 16;
  void flush() {
    hash_.add(bytes_);
    bytes_.clear();
  }
  base::Sha256 hash_;
  std::string bytes_;
};

void add_tags(const Extract& e, model::Range tags, Digest& digest) {
  digest.add(tags.count);
  for (const model::Tag& t : e.tags_of(tags)) digest.add(e.strings.view(t.key)), digest.add(e.strings.view(t.value));
}

void add_rings(const Extract& e, model::Range rings, Digest& digest) {
  digest.add(rings.count);
  for (const model::MappedRing& ring : e.rings_of(rings)) {
    digest.add(static_cast<int>(ring.inner)), digest.add(ring.vertices.count);
    const auto vertices = e.vertices_of(ring);
    const auto nodes = e.nodes_of(ring);
    for (std::size_t i = 0; i < vertices.size(); ++i)
      digest.add(vertices[i].lon), digest.add(vertices[i].lat), digest.add(nodes[i]);
  }
}

void add_building(const Extract& e, const model::MappedBuilding& b, Digest& digest) {
  digest.add(b.id), digest.add(static_cast<int>(b.kind)), digest.add(static_cast<int>(b.state));
  digest.add(model::info(b.code).text), digest.add(b.related), digest.add(b.geometry_from), digest.add(b.edited);
  add_rings(e, b.rings, digest), add_tags(e, b.tags, digest);
  digest.add(static_cast<int>(b.place.has_value()));
  if (b.place) digest.add(b.place->lon), digest.add(b.place->lat);
}

}  // namespace

std::string data_sha256(const Extract& e, std::span<const std::uint32_t> buildings) {
  Digest digest;
  for (const std::uint32_t b : buildings) add_building(e, e.buildings[b], digest);
  return digest.finish();
}

std::string data_sha256(const Extract& e) {
  Digest digest;
  digest.add(e.buildings.size());
  for (const model::MappedBuilding& b : e.buildings) add_building(e, b, digest);
  digest.add(e.building_relations.size());
  for (const model::BuildingRelation& r : e.building_relations) {
    digest.add(r.id), digest.add(r.outline), digest.add(r.parts.size());
    for (const model::OsmId part : r.parts) digest.add(part);
  }
  digest.add(e.features.size());
  for (const model::Feature& f : e.features) {
    digest.add(f.id), digest.add(f.kinds), digest.add(static_cast<int>(f.area));
    add_rings(e, f.rings, digest), add_tags(e, f.tags, digest);
  }
  digest.add(e.report.rows.size());
  for (const model::ReportRow& row : e.report.rows)
    digest.add(row.object), digest.add(model::info(row.code).text), digest.add(row.detail);
  return digest.finish();
}

}  // namespace blockrand::run
