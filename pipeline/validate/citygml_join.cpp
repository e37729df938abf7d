// What CityGML says by reference: solids get the polygons of their boundary surfaces, polygons their colours, placed
// elements their shapes.
#include <algorithm>
#include <charconv>
#include <iterator>
#include <set>

#include "pipeline/validate/attribute_names.h"
#include "pipeline/validate/citygml_parser.h"
#include "pipeline/validate/detail_check.h"

namespace blockrand::validate {

void CityGmlParser::end_detail(const Open& open, ReadBody& body) {
  ReadSolid* solid = nullptr;
  int number = 0;
  for (std::size_t s = 0; s < body.solids.size(); ++s)
    if (body.solids[s].lod == 3) solid = &body.solids[s], number = static_cast<int>(s);
  if (!solid || !open.has_reference_solid[3]) {
    if (!open.members.empty()) rule("boundary surfaces of LoD3 without a solid", body.id);
    return;
  }
  std::unordered_map<std::string_view, std::size_t> lod2, members;
  for (std::size_t i = 0; i < open.surfaces.size(); ++i) lod2.emplace(open.surfaces[i].first, i);
  for (std::size_t i = 0; i < open.members.size(); ++i)
    if (!members.emplace(open.members[i].id, i).second)
      rule("polygon " + open.members[i].id + " is twice in the surfaces of LoD3", body.id);
  const std::size_t nowhere = open.members.size();  // of polygons that are not in the solid
  std::vector<std::size_t> polygon_of(open.members.size(), nowhere);
  for (const std::string& id : open.references[3]) {
    const auto place = members.find(id);
    if (place == members.end()) {
      rule("a reference to #" + id + ", which is no polygon of LoD3", body.id);
      continue;
    }
    const Member& member = open.members[place->second];
    if (polygon_of[place->second] != nowhere) {
      rule("polygon " + id + " is twice in the solid", body.id);
      continue;
    }
    if (!member.link) {
      polygon_of[place->second] = solid->polygons.size();
      note_place(id, {open.body, number, solid->polygons.size()});
      solid->polygons.push_back(member.polygon);
      continue;
    }
    const auto shared = lod2.find(id);
    if (shared == lod2.end()) {
      rule("a reference to #" + id + ", which is no polygon of the building", body.id);
      continue;
    }
    polygon_of[place->second] = solid->polygons.size();
    shared_.push_back({id, {open.body, number, solid->polygons.size()}});
    solid->polygons.push_back(open.surfaces[shared->second].second);
  }
  for (std::size_t i = 0; i < polygon_of.size(); ++i)
    if (polygon_of[i] == nowhere)
      rule(fmt::format("surface polygon {} is not in the solid of LoD3", open.members[i].id), body.id);
  // The first polygon of a surface is the wall, what follows are its reveals; openings come after them.
  std::vector<std::vector<std::size_t>> by_surface(open.boundary_surfaces + 1);
  for (std::size_t i = 0; i < open.members.size(); ++i) by_surface[open.members[i].surface].push_back(polygon_of[i]);
  std::set<std::size_t> walls_told;
  for (const OpenedWall& o : open.openings) {
    const auto polygon = members.find(o.polygon);
    if (o.polygon.empty() || polygon == members.end()) {
      rule("has no polygon", o.id);
      continue;
    }
    const auto& wall = by_surface[o.surface];
    ReadOpening opening;
    opening.id = o.id;
    opening.polygon = polygon_of[polygon->second];
    if (opening.polygon == nowhere) continue;  // was said of its polygon
    if (wall.empty() || wall.front() == nowhere) {
      rule("has no wall in the solid of LoD3", o.id);
      continue;
    }
    opening.wall = wall.front();
    if (walls_told.insert(o.surface).second)
      std::copy_if(wall.begin() + 1, wall.end(), std::back_inserter(opening.reveals),
                   [&](std::size_t p) { return p != nowhere; });
    opening.placement = o.placement;
    body.detail.openings.push_back(std::move(opening));
  }
  check_detail(body, [&](std::string what, const std::string& id) { rule(std::move(what), id); });
}

void CityGmlParser::end_body() {
  Open open = std::move(open_.back());
  ReadBody& body = out_.contents.bodies[open.body];
  end_detail(open, body);
  ReadSolid* solid = nullptr;
  int number = -1;
  for (std::size_t s = 0; s < body.solids.size(); ++s)
    if (body.solids[s].lod == 2) solid = &body.solids[s], number = static_cast<int>(s);
  if (open.has_reference_solid[2] && solid) {
    std::unordered_map<std::string, std::size_t> index;
    for (std::size_t i = 0; i < open.surfaces.size(); ++i) index.emplace(open.surfaces[i].first, i);
    std::vector<int> used(open.surfaces.size(), 0);
    for (const std::string& id : open.references[2]) {
      const auto place = index.find(id);
      if (place == index.end()) {
        rule("a reference to #" + id + ", which is no polygon of the building", body.id);
        continue;
      }
      if (++used[place->second] > 1) {
        rule("polygon " + id + " is twice in the solid", body.id);
        continue;
      }
      note_place(id, {open.body, number, solid->polygons.size()});
      solid->polygons.push_back(std::move(open.surfaces[place->second].second));
    }
    for (std::size_t i = 0; i < used.size(); ++i)
      if (used[i] == 0) rule(fmt::format("surface polygon {} is not in the solid", open.surfaces[i].first), body.id);
  } else if (!open.surfaces.empty()) {
    rule("boundary surfaces without a solid", body.id);
  }
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

void CityGmlParser::finish() {
  for (const Material& m : materials_)
    for (const std::string& target : m.targets) {
      const auto place = places_.find(target);
      if (place == places_.end()) {
        rule("an appearance of #" + target + ", which is no polygon", "");
        continue;
      }
      std::string& slot = polygon_at(place->second).colour;
      if (!slot.empty()) rule("#" + target + " has two colours", out_.contents.bodies[place->second.body].id);
      slot = m.colour;
    }
  for (const auto& [id, place] : shared_)
    if (const auto original = places_.find(id); original != places_.end())
      polygon_at(place).colour = polygon_at(original->second).colour;
  std::vector<std::uint64_t> digests;
  for (const Element& element : elements_) {
    digests.push_back(element_digest(element.polygons));
    if (element.polygons.empty()) rule("an element without polygons", element.id);
    out_.contents.elements.try_emplace(digests.back(), element_of(element.polygons));
  }
  for (const Placed& p : placed_) {
    ReadBody& body = out_.contents.bodies[p.body];
    const auto element = element_at_.find(p.element);
    if (element == element_at_.end())
      rule("a reference to #" + p.element + ", which is no element", body.id);
    else
      place_element(body, body.detail.placements[p.placement], digests[element->second]);
  }
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
