#include "tests/unit/importers/osm/support.h"

#include <bzlib.h>
#include <stdlib.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <osmium/io/gzip_compression.hpp>
#include <osmium/io/pbf_input.hpp>
#include <osmium/io/pbf_output.hpp>
#include <osmium/io/reader.hpp>
#include <osmium/io/writer.hpp>
#include <osmium/io/xml_input.hpp>
#include <osmium/io/xml_output.hpp>
#include <random>
#include <sstream>
#include <stdexcept>

namespace blockrand::importers::osm::test {
namespace {

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '"')
      out += "&quot;";
    else
      out += c;
  }
  return out;
}

std::string tag_lines(const TagList& tags) {
  std::string out;
  for (const auto& [k, v] : tags) out += "    <tag k=\"" + escaped(k) + "\" v=\"" + escaped(v) + "\"/>\n";
  return out;
}

std::string document(const std::vector<std::string>& objects) {
  std::string out = "<?xml version='1.0' encoding='UTF-8'?>\n<osm version=\"0.6\" generator=\"test\">\n";
  for (const std::string& o : objects) out += o;
  return out + "</osm>\n";
}

std::string head(const char* type, std::int64_t id) {
  return "  <" + std::string(type) + " id=\"" + std::to_string(id) +
         "\" version=\"1\" timestamp=\"2020-01-01T00:00:00Z\"";
}

}  // namespace

TempFolder::TempFolder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "blockrand-osm-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no temporary folder");
  folder_ = pattern;
}

TempFolder::~TempFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

std::string TempFolder::write(std::string_view name, std::string_view bytes) const {
  const std::string file = path(name);
  std::ofstream out(file, std::ios::binary);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return file;
}

OsmText& OsmText::node(std::int64_t id, double lon, double lat, const TagList& tags) {
  std::ostringstream out;
  out.precision(10);
  out << head("node", id) << " lon=\"" << lon << "\" lat=\"" << lat << "\"";
  objects_.push_back(out.str() + ">\n" + tag_lines(tags) + "  </node>\n");
  return *this;
}

OsmText& OsmText::way(std::int64_t id, const std::vector<std::int64_t>& refs, const TagList& tags) {
  std::string out = head("way", id) + ">\n";
  for (const std::int64_t ref : refs) out += "    <nd ref=\"" + std::to_string(ref) + "\"/>\n";
  objects_.push_back(out + tag_lines(tags) + "  </way>\n");
  return *this;
}

OsmText& OsmText::relation(std::int64_t id, const std::vector<std::string>& members, const TagList& tags) {
  std::string out = head("relation", id) + ">\n";
  for (const std::string& m : members) {
    const auto blank = m.find(' ');
    const std::string type = m[0] == 'n' ? "node" : m[0] == 'w' ? "way" : "relation";
    const std::string role = blank == std::string::npos ? "" : m.substr(blank + 1);
    out += "    <member type=\"" + type + "\" ref=\"" + m.substr(1, blank - 1) + "\" role=\"" + role + "\"/>\n";
  }
  objects_.push_back(out + tag_lines(tags) + "  </relation>\n");
  return *this;
}

OsmText& OsmText::corners(std::int64_t first_node, double x, double y, double size) {
  const double step = 1e-4;
  node(first_node, 13 + x * step, 52 + y * step);
  node(first_node + 1, 13 + (x + size) * step, 52 + y * step);
  node(first_node + 2, 13 + (x + size) * step, 52 + (y + size) * step);
  return node(first_node + 3, 13 + x * step, 52 + (y + size) * step);
}

OsmText& OsmText::square(std::int64_t way_id, std::int64_t first_node, double x, double y, double size,
                         const TagList& tags) {
  corners(first_node, x, y, size);
  return way(way_id, {first_node, first_node + 1, first_node + 2, first_node + 3, first_node}, tags);
}

OsmText& OsmText::raw(std::string_view xml) {
  objects_.emplace_back(xml);
  return *this;
}

std::string OsmText::xml() const { return document(objects_); }

std::string OsmText::shuffled_xml(unsigned seed) const {
  std::vector<std::string> mixed = objects_;
  std::mt19937 random(seed);
  std::shuffle(mixed.begin(), mixed.end(), random);
  return document(mixed);
}

model::Extract OsmText::read(const ReadOptions& options) const {
  const TempFolder folder;
  return read_extract(folder.write("test.osm", xml()), options);
}

std::string read_bytes(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

std::string bzip2(std::string bytes) {
  auto size = static_cast<unsigned>(bytes.size() + bytes.size() / 100 + 600);
  std::string out(size, '\0');
  if (BZ2_bzBuffToBuffCompress(out.data(), &size, bytes.data(), static_cast<unsigned>(bytes.size()), 9, 0, 0) != BZ_OK)
    throw std::runtime_error("bzip2 failed");
  out.resize(size);
  return out;
}

void convert(const std::string& from, const std::string& to) {
  if (to.ends_with(".bz2")) {
    // Not through libosmium: its bzip2 reader would be registered in place of ours.
    std::ofstream(to, std::ios::binary) << bzip2(read_bytes(from));
    return;
  }
  osmium::io::Reader reader(from);
  osmium::io::Writer writer(to, reader.header(), osmium::io::overwrite::allow);
  while (osmium::memory::Buffer buffer = reader.read()) writer(std::move(buffer));
  writer.close();
  reader.close();
}

std::string dump(const model::Extract& e) {
  std::ostringstream out;
  const auto rings = [&](model::Range range) {
    for (const model::MappedRing& ring : e.rings_of(range)) {
      out << (ring.inner ? "  inner" : "  ring");
      const auto nodes = e.nodes_of(ring);
      for (std::size_t i = 0; i < nodes.size(); ++i)
        out << ' ' << nodes[i] << '@' << e.vertices_of(ring)[i].lon << ',' << e.vertices_of(ring)[i].lat;
      out << '\n';
    }
  };
  const auto tags = [&](model::Range range) {
    for (const model::Tag& t : e.tags_of(range))
      out << "  " << t.key << ':' << e.strings.view(t.key) << '=' << t.value << ':' << e.strings.view(t.value) << '\n';
  };
  for (const model::MappedBuilding& b : e.buildings) {
    out << b.id.text() << " kind " << int(b.kind) << " state " << int(b.state) << " code " << info(b.code).text
        << " related " << b.related.text() << " from " << b.geometry_from.text() << '\n';
    rings(b.rings);
    tags(b.tags);
    const auto& a = b.attributes;
    const auto number = [&](const char* name, const std::optional<float>& v) {
      if (v) out << "  " << name << ' ' << *v << '\n';
    };
    number("height", a.height);
    number("min_height", a.min_height);
    number("storeys", a.storeys);
    number("min_storey", a.min_storey);
    number("roof_storeys", a.roof_storeys);
    number("underground", a.storeys_underground);
    number("roof_height", a.roof_height);
    number("roof_angle", a.roof_angle);
    number("roof_direction", a.roof_direction);
    if (a.roof_shape) out << "  roof " << name(*a.roof_shape) << '\n';
    if (a.roof_orientation) out << "  orientation " << int(*a.roof_orientation) << '\n';
    for (const auto& c : {a.wall_colour, a.roof_colour})
      if (c) out << "  colour " << int(c->r) << ' ' << int(c->g) << ' ' << int(c->b) << '\n';
    out << "  materials " << a.wall_material << ' ' << a.roof_material << " use " << a.use << '\n';
  }
  for (const model::Feature& f : e.features) {
    out << f.id.text() << " kinds " << f.kinds << " area " << f.area << '\n';
    rings(f.rings);
    tags(f.tags);
  }
  for (const model::BuildingRelation& r : e.building_relations) {
    out << r.id.text() << " outline " << r.outline.text() << " parts";
    for (const model::OsmId part : r.parts) out << ' ' << part.text();
    out << '\n';
  }
  const auto& c = e.counts;
  out << "counts " << c.nodes << ' ' << c.ways << ' ' << c.relations << ' ' << c.building_nodes << ' '
      << c.building_ways << ' ' << c.building_relations << ' ' << c.part_nodes << ' ' << c.part_ways << ' '
      << c.part_relations << ' ' << c.old_style_multipolygons << ' ' << c.areas_with_holes << ' ' << c.missing_nodes
      << ' ' << c.missing_ways << '\n';
  for (const model::ReportRow& row : e.report.rows)
    out << row.object.text() << ' ' << info(row.code).text << ' ' << row.detail << '\n';
  out << "time " << e.data_time << '\n';
  return out.str();
}

const model::MappedBuilding* building(const model::Extract& extract, std::string_view id) {
  for (const auto& b : extract.buildings)
    if (b.id.text() == id) return &b;
  return nullptr;
}

const model::Feature* feature(const model::Extract& extract, std::string_view id) {
  for (const auto& f : extract.features)
    if (f.id.text() == id) return &f;
  return nullptr;
}

std::string state(const model::Extract& extract, std::string_view id) {
  const model::MappedBuilding* b = building(extract, id);
  if (b == nullptr) return "absent";
  switch (b->state) {
    case model::ObjectState::pending:
      return "pending";
    case model::ObjectState::modelled:
      return "modelled";
    case model::ObjectState::represented:
      return "represented by " + b->related.text();
    case model::ObjectState::duplicate:
      return "duplicate of " + b->related.text();
    case model::ObjectState::reported:
      return std::string(info(b->code).text);
  }
  return "?";
}

std::string rows(const model::Extract& extract, std::string_view id, model::IssueCode code) {
  std::string out;
  bool any = false;
  for (const auto& row : extract.report.rows) {
    if (row.object.text() != id || row.code != code) continue;
    out += (any ? " | " : "") + row.detail;
    any = true;
  }
  return any ? out : "-";
}

std::vector<int> ring_sizes(const model::Extract& extract, model::Range rings) {
  std::vector<int> out;
  for (const auto& ring : extract.rings_of(rings))
    out.push_back(ring.inner ? -static_cast<int>(ring.vertices.count) : static_cast<int>(ring.vertices.count));
  return out;
}

}  // namespace blockrand::importers::osm::test
