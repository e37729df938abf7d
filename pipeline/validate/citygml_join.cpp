// What CityGML says by reference: solids get the polygons of their boundary surfaces, polygons their colours, placed
// elements their shapes.
#include <algorithm>
#include <charconv>
#include <iterator>
#include <set>

#include "pipeline/validate/attribute_names.h"
#include "pipeline/validate/citygml_parser.h"
#include "pipeline/validate/detail_check.h"
#include "pipeline/validate/polygon_order.h"

namespace blockrand::validate {

CityGmlParser::PolygonIndex CityGmlParser::end_solid(const Open& open, ReadBody& body, std::size_t lod) {
  PolygonIndex index;
  const auto solid = std::find_if(body.solids.begin(), body.solids.end(),
                                  [&](const ReadSolid& s) { return s.lod == static_cast<int>(lod); });
  if (solid == body.solids.end()) return index;
  std::unordered_map<std::string_view, const ReadPolygon*> own;
  for (const auto& members : open.solids)
    for (const Member& m : members)
      if (!m.link) own.emplace(m.id, &m.polygon);
  const int number = static_cast<int>(solid - body.solids.begin());
  for (const Member& member : open.solids[lod]) {
    const ReadPolygon* polygon = &member.polygon;
    if (member.link) {
      const auto found = own.find(member.id);
      if (found == own.end()) {
        rule("a reference to #" + member.id + ", which is no polygon of the building", body.id);
        continue;
      }
      polygon = found->second;
    }
    if (!member.id.empty() && !index.emplace(member.id, solid->polygons.size()).second) {
      rule("polygon " + member.id + " is twice in the solid", body.id);
      continue;
    }
    const Place place{open.body, number, solid->polygons.size()};
    if (member.link)
      shared_.push_back({member.id, place});
    else
      note_place(member.id, place);
    solid->polygons.push_back(*polygon);
  }
  return index;
}

std::vector<std::size_t> CityGmlParser::end_surfaces(const Open& open, ReadBody& body, std::size_t lod,
                                                     const PolygonIndex& index) {
  const std::vector<SurfaceMember>& members = open.surfaces[lod];
  std::vector<std::size_t> polygon_of(members.size(), kNowhere);
  const auto solid = std::find_if(body.solids.begin(), body.solids.end(),
                                  [&](const ReadSolid& s) { return s.lod == static_cast<int>(lod); });
  if (solid == body.solids.end()) {
    if (!members.empty()) rule(fmt::format("boundary surfaces of LoD{} without a solid", lod), body.id);
    return polygon_of;
  }
  std::vector<bool> used(solid->polygons.size(), false);
  for (std::size_t i = 0; i < members.size(); ++i) {
    const auto place = index.find(members[i].id);
    if (place == index.end()) {
      rule(fmt::format("a reference to #{}, which is no polygon of the solid of LoD{}", members[i].id, lod), body.id);
      continue;
    }
    if (used[place->second]) {
      rule(fmt::format("polygon {} is twice in the surfaces of LoD{}", members[i].id, lod), body.id);
      continue;
    }
    used[place->second] = true;
    polygon_of[i] = place->second;
    solid->polygons[place->second].kind = members[i].kind;
  }
  for (std::size_t p = 0; p < used.size(); ++p)
    if (!used[p]) rule(fmt::format("face {} of the solid of LoD{} is in no boundary surface", p, lod), body.id);
  return polygon_of;
}

void CityGmlParser::end_openings(const Open& open, ReadBody& body, const std::vector<std::size_t>& polygon_of) {
  // The first polygon of a surface is the wall, what follows are its reveals; openings come after them.
  const std::vector<SurfaceMember>& members = open.surfaces[3];
  std::vector<std::vector<std::size_t>> by_surface(open.boundary_surfaces + 1);
  PolygonIndex polygons;
  for (std::size_t i = 0; i < members.size(); ++i) {
    by_surface[members[i].surface].push_back(polygon_of[i]);
    polygons.emplace(members[i].id, polygon_of[i]);
  }
  std::set<std::size_t> walls_told;
  for (const OpenedWall& o : open.openings) {
    const auto polygon = polygons.find(o.polygon);
    if (o.polygon.empty() || polygon == polygons.end()) {
      rule("has no polygon", o.id);
      continue;
    }
    const auto& wall = by_surface[o.surface];
    ReadOpening opening;
    opening.id = o.id;
    opening.polygon = polygon->second;
    if (opening.polygon == kNowhere) continue;  // was said of its polygon
    if (wall.empty() || wall.front() == kNowhere) {
      rule("has no wall in the solid of LoD3", o.id);
      continue;
    }
    opening.wall = wall.front();
    if (walls_told.insert(o.surface).second)
      std::copy_if(wall.begin() + 1, wall.end(), std::back_inserter(opening.reveals),
                   [&](std::size_t p) { return p != kNowhere; });
    opening.placement = o.placement;
    const auto usual = open.depths.find(o.surface);
    opening.depth = o.depth ? *o.depth : usual == open.depths.end() ? 0 : usual->second;
    body.detail.openings.push_back(std::move(opening));
  }
  check_detail(body, [&](std::string what, const std::string& id) { rule(std::move(what), id); });
}

void CityGmlParser::end_body() {
  const Open open = std::move(open_.back());
  ReadBody& body = out_.contents.bodies[open.body];
  end_solid(open, body, 1);
  const PolygonIndex lod2 = end_solid(open, body, 2), lod3 = end_solid(open, body, 3);
  end_surfaces(open, body, 2, lod2);
  const std::vector<std::size_t> polygon_of = end_surfaces(open, body, 3, lod3);
  if (!open.solids[3].empty()) end_openings(open, body, polygon_of);
  for (std::size_t s = 0; s + 1 < body.solids.size(); ++s)
    if (body.solids[s].lod >= body.solids[s + 1].lod)
      rule("solids out of the order of their LoD, or one twice", body.id);
  if (outside_) rule("a point lies outside of the envelope", body.id);
  outside_ = false;
  finish_attributes(body);
  if (open.has_parts) {
    if (!body.footprint.empty() || !body.solids.empty()) rule("a building with geometry beside its parts", body.id);
    assemblies_.push_back(open.body);
  } else if (!body.attributes.count("lod")) {
    rule("neither parts nor an attribute lod", body.id);
  } else {
    const std::string& lod = body.attributes["lod"];
    if (lod >= "0" && lod <= "9" && body.footprint.empty()) rule("no lod0FootPrint", body.id);
  }
  open_.pop_back();
}

void CityGmlParser::finish_attributes(ReadBody& body) {
  for (const std::string& name : attribute_names()) {
    const auto value = body.attributes.find(name);
    const auto source = body.attributes.find(name + "_source"), confidence = body.attributes.find(name + "_confidence");
    if (source != body.attributes.end()) {
      if (!is_source(source->second))
        found(Check::source_wrong, fmt::format("{} from \"{}\"", name, source->second), body.id);
      if (confidence == body.attributes.end()) found(Check::source_wrong, name + " without confidence", body.id);
    } else {
      if (confidence != body.attributes.end())
        found(Check::source_wrong, name + "_confidence without a source", body.id);
      if (value != body.attributes.end()) body.attributes[name + "_source"] = "tag";
    }
    if (confidence != body.attributes.end()) {
      const std::string& text = confidence->second;
      double c = -1;
      std::from_chars(text.data(), text.data() + text.size(), c);
      if (!(c >= 0 && c <= 1)) found(Check::source_wrong, fmt::format("confidence of {} is {}", name, text), body.id);
    }
  }
}

void CityGmlParser::place_element(const ReadBody& body, ReadPlacement& placement, std::uint64_t element) {
  placement.element = element;
  if (lower_ && upper_ && reaches_beyond(placement, out_.contents.elements.at(element), *lower_, *upper_))
    rule(fmt::format("an element reaches out of the envelope, at {:.3f} {:.3f} {:.3f}", placement.origin.x,
                     placement.origin.y, placement.origin.z),
         body.id);
}

ReadPolygon& CityGmlParser::polygon_at(const Place& place) {
  if (place.solid == kElement) return elements_[place.item].polygons[place.polygon];
  ReadBody& body = out_.contents.bodies[place.body];
  if (place.solid == kInstallation) return body.detail.installations[place.item].polygons[place.polygon];
  if (place.solid == kFootprint) return body.footprint[place.polygon];
  return body.solids[static_cast<std::size_t>(place.solid)].polygons[place.polygon];
}

void CityGmlParser::paint(const Place& place, const std::string& colour, const std::string& id) {
  std::string& slot = polygon_at(place).colour;
  if (!slot.empty() && slot != colour) rule("#" + id + " has two colours", out_.contents.bodies[place.body].id);
  slot = colour;
}

bool CityGmlParser::paint(const std::string& id, const std::string& colour) {
  const auto place = places_.find(id);
  if (place == places_.end()) return false;
  paint(place->second, colour, id);
  return true;
}

void CityGmlParser::finish_colours() {
  std::unordered_set<std::string_view> targets;
  for (const Material& m : materials_)
    for (const std::string& target : m.targets) {
      if (!targets.insert(target).second) rule("two appearances of #" + target, "");
      if (const auto group = groups_.find(target); group != groups_.end()) {
        for (const Place& place : group->second.places) paint(place, m.colour, target);
        for (const std::string& id : group->second.ids)
          if (!paint(id, m.colour)) rule("a reference to #" + id + ", which is no polygon", "");
      } else if (!paint(target, m.colour)) {
        rule("an appearance of #" + target + ", which is no surface", "");
      }
    }
  for (const auto& [id, place] : shared_)
    if (const auto original = places_.find(id); original != places_.end())
      polygon_at(place).colour = polygon_at(original->second).colour;
}

void CityGmlParser::finish_elements() {
  for (Element& element : elements_)
    for (const auto& [polygon, id] : element.links) {
      const auto original = places_.find(id);
      if (original == places_.end() || original->second.solid != kElement)
        rule("a reference to #" + id + ", which is no polygon of an element", element.id);
      else
        element.polygons[polygon] = polygon_at(original->second);
    }
  std::vector<std::uint64_t> digests;
  for (Element& element : elements_) {
    sort_polygons(element.polygons);
    digests.push_back(element_digest(element.polygons));
    if (element.polygons.empty()) rule("an element without polygons", element.id);
    out_.contents.elements.try_emplace(digests.back(), element_of(element.polygons));
  }
  for (const Placed& p : placed_) {
    ReadBody& body = out_.contents.bodies[p.body];
    const auto element = element_at_.find(p.element);
    if (element == element_at_.end()) {
      rule("a reference to #" + p.element + ", which is no element", body.id);
      const std::uint64_t nothing = element_digest({});
      out_.contents.elements.try_emplace(nothing, element_of({}));
      body.detail.placements[p.placement].element = nothing;
    } else {
      place_element(body, body.detail.placements[p.placement], digests[element->second]);
    }
  }
}

void CityGmlParser::finish() {
  finish_colours();
  finish_elements();
  if (!out_.contents.buildings.empty() && (!lower_ || !upper_ || out_.srs_name.empty()))
    rule("no envelope with a reference system", "");
  // Buildings of several parts are no bodies of their own.
  std::vector<ReadBody> bodies;
  for (std::size_t i = 0, next = 0; i < out_.contents.bodies.size(); ++i) {
    if (next < assemblies_.size() && assemblies_[next] == i)
      ++next;
    else
      bodies.push_back(std::move(out_.contents.bodies[i]));
  }
  out_.contents.bodies = std::move(bodies);
}

}  // namespace blockrand::validate
