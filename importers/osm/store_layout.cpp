#include "importers/osm/store_layout.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <osmium/osm/node.hpp>
#include <osmium/osm/relation.hpp>
#include <osmium/osm/way.hpp>

#include "importers/osm/read_file.h"
#include "importers/osm/selection.h"
#include "pipeline/base/pack.h"

namespace blockrand::importers::osm::store_layout {

using osmium::OSMObject;

std::uint32_t crc_of(std::string_view bytes) {
  return static_cast<std::uint32_t>(
      crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
}

Box box_of(const std::array<double, 4>& window) {
  const auto unit = [](double degrees, double most, double add) {
    return static_cast<std::int32_t>(std::clamp(std::floor(degrees / kUnit) + add, -most, most));
  };
  return {unit(window[0], 1.8e9, -1), unit(window[1], 9e8, -1), unit(window[2], 1.8e9, 2), unit(window[3], 9e8, 2)};
}

std::string told(const OSMObject& object) {
  base::Packer p;
  p << static_cast<int>(object.type()) << object.id() << object.version()
    << static_cast<std::uint32_t>(object.timestamp());
  for_each_tag(object,
               [&](std::string_view key, std::string_view value) { p << std::string(key) << std::string(value); });
  p << std::string();
  if (object.type() == osmium::item_type::node) {
    const osmium::Location l = static_cast<const osmium::Node&>(object).location();
    p << l.x() << l.y();
  } else if (object.type() == osmium::item_type::way) {
    for (const osmium::NodeRef& n : static_cast<const osmium::Way&>(object).nodes())
      p << n.ref() << n.location().x() << n.location().y();
  } else {
    for (const osmium::RelationMember& m : static_cast<const osmium::Relation&>(object).members())
      p << m.ref() << static_cast<int>(m.type()) << std::string(m.role());
  }
  return std::move(p.bytes);
}

}  // namespace blockrand::importers::osm::store_layout
