#include "pipeline/outputs/citygml/citygml_writer.h"

#include <libxml/parser.h>
#include <libxml/xmlwriter.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <memory>
#include <new>

#include "pipeline/outputs/citygml/appearance_text.h"
#include "pipeline/outputs/citygml/codes.h"
#include "pipeline/outputs/citygml/element_templates.h"
#include "pipeline/outputs/citygml/flat_openings.h"
#include "pipeline/outputs/citygml/geometry_text.h"
#include "pipeline/outputs/material_classes.h"
#include "pipeline/outputs/number_text.h"
#include "pipeline/outputs/placed_element.h"

namespace blockrand::outputs {
namespace {

/// Whether the model has this building: it is owned by the tile and something of it could be built.
bool is_written(const model::Building& building) { return building.owned && !building.parts.empty(); }

/// The smallest box around everything that is written.
struct Envelope {
  bool empty = true;
  model::Point3 min, max;
  void add(const model::Point3& p) {
    if (empty) min = max = p;
    empty = false;
    min = {std::min(min.x, p.x), std::min(min.y, p.y), std::min(min.z, p.z)};
    max = {std::max(max.x, p.x), std::max(max.y, p.y), std::max(max.z, p.z)};
  }
};

double footprint_height(const model::Attributes& attributes) {
  const double z = attributes.ground_height.value;
  return std::isfinite(z) ? model::snap(z) : 0;
}

/// The next point of the grid, outwards: elements are turned off it.
model::Point3 on_grid(const model::Point3& p, bool down) {
  const auto step = [&](double v) {
    const double steps = v * model::kGridStepsPerMetre;
    return (down ? std::floor(steps) : std::ceil(steps)) / model::kGridStepsPerMetre;
  };
  return {step(p.x), step(p.y), step(p.z)};
}

Envelope envelope(const model::Region& region, int lod, bool lean) {
  Envelope box;
  PlacedBoxes placed(region);
  const auto add_plan = [&](const model::Polygon& plan, double z) {
    for (const model::Point2& p : plan.outer.points) box.add({p.x, p.y, z});
  };
  for (const model::Building& building : region.buildings) {
    if (!is_written(building)) continue;
    for (const model::BuildingPart& part : building.parts) {
      add_plan(part.plan, footprint_height(part.attributes));
      if (lod >= 1)
        for (const model::Point3& p : part.lod1.vertices) box.add(p);
      if (lod >= 2)
        for (const model::Point3& p : part.lod2.vertices) box.add(p);
      if (lod < 3) continue;
      if (!part.lod3.solid.closed)
        for (const model::Point3& p : part.lod3.solid.vertices) box.add(p);
      for (const model::Placement& p : part.lod3.placements) {
        if (lean && p.opening != model::kNoOpening) continue;
        if (const auto* corners = placed.corners(p))
          for (const model::Point3& c : *corners) box.add(on_grid(c, true)), box.add(on_grid(c, false));
      }
      for (const model::WallInstallation& body : part.lod3.installations)
        for (const model::Point3& p : body.solid.vertices) box.add(p);
      for (const model::RoofInstallation& body : part.lod3.roof_installations)
        for (const model::Point3& p : body.solid.vertices) box.add(p);
    }
  }
  return box;
}

bool is_year(std::string_view text) {
  return text.size() == 4 && std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; }) &&
         text != "0000";
}

/// Writes the text of one building after the other. Buildings are put together by hand from fixed pieces: an element at
/// a time through the XML library costs several times as much.
class BuildingText {
 public:
  BuildingText(const model::Region& region, const CityGmlOptions& options, AppearanceText& appearance)
      : region_(region),
        options_(options),
        tags_(region.extract),
        geometry_(out_),
        appearance_(appearance),
        templates_(region, options.lod, options.lean) {}

  /// The text of one cityObjectMember; valid until the next call.
  std::string_view member(const model::Building& building) {
    out_.clear();
    const std::string id = building.id();
    const bool single = building.parts.size() == 1 && building.parts.front().id == id;
    out_ += "<core:cityObjectMember><bldg:Building gml:id=\"";
    out_ += id;
    out_ += "\">\n";
    head(building.osm, building.tags);
    if (single) {
      const model::BuildingPart& part = building.parts.front();
      attributes(part.attributes, building.tags, &part, &building);
      geometry(part, id);
    } else {
      attributes(building.attributes, building.tags, nullptr, &building);
      for (const model::BuildingPart& part : building.parts) {
        const std::string part_id = part.id == id ? id + ".1" : part.id;
        out_ += "<bldg:consistsOfBuildingPart><bldg:BuildingPart gml:id=\"";
        out_ += part_id;
        out_ += "\">\n";
        // A remainder or a piece of the outline carries the building's tags, which stand above.
        const bool own_tags = part.osm != building.osm;
        head(part.osm, own_tags ? part.tags : model::Range{});
        attributes(part.attributes, own_tags ? part.tags : model::Range{}, &part);
        geometry(part, part_id);
        if (own_tags) address(part.tags);
        out_ += "</bldg:BuildingPart></bldg:consistsOfBuildingPart>\n";
      }
    }
    address(building.tags);
    out_ += "</bldg:Building></core:cityObjectMember>\n";
    return out_;
  }

 private:
  /// What every city object starts with: its name and where it comes from.
  void head(const model::OsmId& osm, model::Range tags) {
    if (const std::string_view name = tags_.name(tags); !name.empty()) element("gml:name", name);
    const std::string page = osm_page(osm);
    if (page.empty()) return;
    out_ +=
        "<core:externalReference><core:informationSystem>https://www.openstreetmap.org</core:informationSystem>"
        "<core:externalObject><core:uri>";
    out_ += page;
    out_ += "</core:uri></core:externalObject></core:externalReference>\n";
  }

  void element(std::string_view name, std::string_view text) {
    out_ += '<';
    out_ += name;
    out_ += '>';
    append_xml(out_, text);
    out_ += "</";
    out_ += name;
    out_ += ">\n";
  }

  void open_generic(const char* type, std::string_view name, const char* suffix = "") {
    out_ += "<gen:";
    out_ += type;
    out_ += " name=\"";
    append_xml(out_, name);
    out_ += suffix;
    out_ += "\"><gen:value>";
  }
  void close_generic(const char* type) {
    out_ += "</gen:value></gen:";
    out_ += type;
    out_ += ">\n";
  }
  void generic_text(std::string_view name, std::string_view text, const char* suffix = "") {
    if (text.empty()) return;
    open_generic("stringAttribute", name, suffix);
    append_xml(out_, text);
    close_generic("stringAttribute");
  }

  // One overload per type of attribute value.
  void generic(std::string_view name, std::string_view, const std::string& value) { generic_text(name, value); }
  void generic(std::string_view name, std::string_view, model::Colour value) { generic_text(name, model::text(value)); }
  void generic(std::string_view name, std::string_view, model::RoofShape value) {
    generic_text(name, model::name(value));
  }
  void generic(std::string_view name, std::string_view, model::RoofOrientation value) {
    generic_text(name, value == model::RoofOrientation::along ? "along" : "across");
  }
  /// Without a gen:measureAttribute: GDAL loses its name, and takes all of them for one list.
  void generic(std::string_view name, std::string_view, double value) {
    if (!std::isfinite(value)) return;
    open_generic("doubleAttribute", name);
    append_number(out_, value);
    close_generic("doubleAttribute");
  }

  /// Generic attributes, then the elements of bldg:_AbstractBuilding up to the storeys' heights.
  /// \param building  whose attributes they are; null: those of one of its parts
  void attributes(const model::Attributes& a, model::Range tags, const model::BuildingPart* part,
                  const model::Building* building = nullptr) {
    constexpr double kMostStoreys = 1000;  // longer lists of heights would be nonsense
    const bool whole_storeys =
        a.storeys.value >= 0 && a.storeys.value <= kMostStoreys && a.storeys.value == std::floor(a.storeys.value);
    const bool storey_list = whole_storeys && a.storeys.value >= 1 && std::isfinite(a.storey_height.value);
    model::for_each_attribute(
        a,
        [&](std::string_view name, std::string_view unit, const auto& sourced) {
          const bool has_element = name == "use" || name == "height" || (name == "storeys" && whole_storeys) ||
                                   (name == "storey_height" && storey_list);
          if (!has_element) generic(name, unit, sourced.value);
          if (sourced.source == model::Source::tag) return;
          generic_text(name, model::name(sourced.source), "_source");
          open_generic("doubleAttribute", name, "_confidence");
          append_number(out_, sourced.confidence);
          close_generic("doubleAttribute");
          if (options_.evidence && sourced.evidence != 0)
            generic_text(name, region_.evidence[sourced.evidence].text, "_evidence");
        },
        [](std::string_view, std::string_view) {});
    if (part) {
      generic_text("built_roof", model::name(part->built_roof));
      open_generic("intAttribute", "lod");
      append_number(out_, static_cast<std::int64_t>(part->lod));
      close_generic("intAttribute");
      if (!part->fallbacks.empty()) {
        open_generic("stringAttribute", "fallbacks");
        for (std::size_t i = 0; i < part->fallbacks.size(); ++i) {
          if (i) out_ += ' ';
          out_ += model::info(part->fallbacks[i]).text;
        }
        close_generic("stringAttribute");
      }
    }
    if (building && building->replaced) {
      generic_text("origin", "replaced");
      generic_text("replaced_by", model::text(*building->replaced));
    }
    if (building) imagery(building->osm);
    osm_tags(tags);

    if (const std::string_view code = class_code(a.use.value); !code.empty()) coded("class", kClassCodeSpace, code);
    if (!a.use.value.empty()) coded("function", kUseCodeSpace, a.use.value);
    if (const std::string_view use = tags_.building_use(tags); !use.empty()) coded("usage", {}, use);
    if (const std::string_view date = tags_.start_date(tags); is_year(date)) element("bldg:yearOfConstruction", date);
    if (part)
      if (const std::string_view code = roof_type_code(part->built_roof); !code.empty())
        coded("roofType", kRoofTypeCodeSpace, code);
    if (std::isfinite(a.height.value)) {
      out_ += "<bldg:measuredHeight uom=\"m\">";
      append_number(out_, a.height.value);
      out_ += "</bldg:measuredHeight>\n";
    }
    if (whole_storeys) {
      out_ += "<bldg:storeysAboveGround>";
      append_number(out_, a.storeys.value);
      out_ += "</bldg:storeysAboveGround>\n";
    }
    if (storey_list) {
      out_ += "<bldg:storeyHeightsAboveGround uom=\"m\">";
      for (int i = 0; i < static_cast<int>(a.storeys.value); ++i) {
        if (i) out_ += ' ';
        append_number(out_, a.storey_height.value);
      }
      out_ += "</bldg:storeyHeightsAboveGround>\n";
    }
  }

  /// What an aerial image shows of the building.
  void imagery(model::OsmId id) {
    const std::optional<SeenOutline> seen = options_.seen ? options_.seen(id) : std::nullopt;
    if (!seen) return;
    for (const auto& [name, value] : imagery_attributes(*seen)) {
      if (const double* number = std::get_if<double>(&value))
        generic(name, "", *number);
      else
        generic_text(name, std::get<std::string>(value));
    }
  }

  void coded(std::string_view name, std::string_view code_space, std::string_view code) {
    out_ += "<bldg:";
    out_ += name;
    if (!code_space.empty()) {
      out_ += " codeSpace=\"";
      out_ += code_space;
      out_ += '"';
    }
    out_ += '>';
    append_xml(out_, code);
    out_ += "</bldg:";
    out_ += name;
    out_ += ">\n";
  }

  void osm_tags(model::Range tags) {
    if (!region_.extract) return;
    for (const model::Tag& tag : region_.extract->tags_of(tags)) {
      out_ += "<gen:stringAttribute name=\"osm.";
      append_xml(out_, region_.extract->strings.view(tag.key));
      out_ += "\"><gen:value>";
      append_xml(out_, region_.extract->strings.view(tag.value));
      close_generic("stringAttribute");
    }
  }

  void geometry(const model::BuildingPart& part, const std::string& id) {
    if (part.plan.outer.size() >= 3) {
      out_ += "<bldg:lod0FootPrint><MultiSurface><surfaceMember>";
      geometry_.footprint(part.plan, footprint_height(part.attributes));
      out_ += "</surfaceMember></MultiSurface></bldg:lod0FootPrint>\n";
    }
    const bool lod2 = options_.lod >= 2 && part.lod >= 2 && !part.lod2.empty();
    if (options_.lod >= 1 && part.lod >= 1 && !part.lod1.empty()) {
      const std::string solid_id = id + "_lod1";
      out_ += "<bldg:lod1Solid>";
      geometry_.solid(part.lod1, solid_id, lod2 ? std::string_view() : solid_id);
      out_ += "</bldg:lod1Solid>\n";
      if (!lod2) appearance_.add(part.lod1, solid_id);
    }
    if (!lod2) return;
    const bool lod3 = options_.lod >= 3 && part.lod >= 3 && !part.lod3.solid.empty();
    const bool by_rules = lod3 && !part.lod3.solid.closed;
    out_ += part.lod2.closed ? "<bldg:lod2Solid>" : "<bldg:lod2MultiSurface>";
    if (lod3 && !by_rules)
      geometry_.solid_beside_detail(part.lod2, part.lod3.solid, id + "_lod2", id);
    else
      geometry_.solid(part.lod2, id + "_lod2", id);
    out_ += part.lod2.closed ? "</bldg:lod2Solid>\n" : "</bldg:lod2MultiSurface>\n";
    appearance_.add(part.lod2, id);
    if (by_rules)
      made_by_rules(part, id);
    else if (lod3)
      detail(part, id);
    else
      geometry_.surfaces(part.lod2, id);
  }

  /// What rules for footprints made stands for LoD3: elements, the surfaces of both levels, the MultiSurface.
  void made_by_rules(const model::BuildingPart& part, const std::string& id) {
    std::size_t number = 0;
    for (const model::Placement& p : part.lod3.placements) {
      if (!has_shape(*region_.elements.at(p.element).element)) continue;
      open_installation(id, number++, region_.elements.at(p.element).element->kind);
      implicit(p);
      out_ += "</bldg:BuildingInstallation></bldg:outerBuildingInstallation>\n";
    }
    geometry_.surfaces(part.lod2, id);
    geometry_.surfaces_of_rules(part.lod3, id);
    appearance_.add_rules(part.lod3.solid, id);
    out_ += "<bldg:lod3MultiSurface>";
    geometry_.rule_surfaces(part.lod3.solid, id + "_lod3", id);
    out_ += "</bldg:lod3MultiSurface>\n";
  }

  /// What stands on walls, the surfaces of both levels with windows and doors, and the solid of LoD3.
  void detail(const model::BuildingPart& part, const std::string& id) {
    const model::Detail& lod3 = part.lod3;
    const FlatOpenings flat = options_.lean ? flat_openings(lod3) : FlatOpenings();
    const model::Detail& shown = options_.lean ? flat.detail : lod3;
    const std::vector<double> usual = usual_depths(flat);
    std::vector<const model::Placement*> in_opening(lod3.openings.size(), nullptr);
    std::size_t number = 0;
    for (const model::Placement& p : lod3.placements) {
      if (!has_shape(*region_.elements.at(p.element).element)) continue;
      if (p.opening != model::kNoOpening) {
        if (!options_.lean) in_opening[p.opening] = &p;
        continue;
      }
      open_installation(id, number++, region_.elements.at(p.element).element->kind);
      implicit(p);
      out_ += "</bldg:BuildingInstallation></bldg:outerBuildingInstallation>\n";
    }
    const auto body_of_its_own = [&](const model::Solid& solid, std::string_view kind) {
      const std::string body_id = open_installation(id, number++, kind);
      out_ += "<bldg:lod3Geometry>";
      geometry_.multi_surface(solid, body_id, !has_one_look(solid));
      out_ += "</bldg:lod3Geometry>\n</bldg:BuildingInstallation></bldg:outerBuildingInstallation>\n";
      appearance_.add_body(solid, body_id);
    };
    for (const model::WallInstallation& body : lod3.installations) body_of_its_own(body.solid, body.kind);
    for (const model::RoofInstallation& body : lod3.roof_installations)
      body_of_its_own(body.solid, model::name(body.kind));
    geometry_.surfaces(part.lod2, shown, id,
                       {.wall =
                            [&](std::size_t f) {
                              if (f < usual.size() && usual[f] > 0) reveal_depth(usual[f]);
                            },
                        .opening =
                            [&](std::size_t o) {
                              if (o < flat.depth.size() && flat.depth[o] != usual[shown.openings[o].wall])
                                reveal_depth(flat.depth[o]);
                            },
                        .inside =
                            [&](std::size_t o) {
                              if (in_opening[o]) implicit(*in_opening[o]);
                            }});
    appearance_.add_detail(part.lod2, shown, id);
    out_ += "<bldg:lod3Solid>";
    geometry_.detail_solid(part.lod2, shown.solid, id + "_lod3", id);
    out_ += "</bldg:lod3Solid>\n";
  }

  void reveal_depth(double metres) {
    open_generic("doubleAttribute", "reveal_depth");
    append_number(out_, std::nearbyint(metres * 1e3) / 1e3);
    close_generic("doubleAttribute");
  }

  /// \return the installation's id
  std::string open_installation(const std::string& id, std::size_t number, std::string_view kind) {
    std::string own = id + "_i";
    append_number(own, static_cast<std::int64_t>(number));
    out_ += "<bldg:outerBuildingInstallation><bldg:BuildingInstallation gml:id=\"";
    out_ += own;
    out_ += "\">";
    coded("function", {}, kind);
    return own;
  }

  /// An element where it stands; its own geometry is written with the first of its places in the file.
  void implicit(const model::Placement& p) {
    out_ += "<bldg:lod3ImplicitRepresentation><core:ImplicitGeometry><core:transformationMatrix>";
    const auto number = [&](double v) {
      append_number(out_, std::nearbyint(v * 1e9) / 1e9 + 0.0);
      out_ += ' ';
    };
    number(p.along.x);
    number(0 - p.along.y);
    out_ += "0 0 ";
    number(p.along.y);
    number(p.along.x);
    out_ += "0 0 0 0 1 0 0 0 0 1</core:transformationMatrix>";
    templates_.append(out_, p.element, appearance_);
    out_ += "<core:referencePoint><Point><pos>";
    append_grid(out_, p.origin.x);
    out_ += ' ';
    append_grid(out_, p.origin.y);
    out_ += ' ';
    append_grid(out_, p.origin.z);
    out_ += "</pos></Point></core:referencePoint></core:ImplicitGeometry></bldg:lod3ImplicitRepresentation>\n";
  }

  void address(model::Range tags) {
    const Address a = tags_.address(tags);
    const bool locality = !(a.city.empty() && a.suburb.empty() && a.postcode.empty() && a.street.empty() &&
                            a.place.empty() && a.house_number.empty() && a.house_name.empty());
    if (!locality) return;
    out_ += "<bldg:address><core:Address><core:xalAddress><xAL:AddressDetails>";
    if (!a.country.empty()) {
      out_ += "<xAL:Country>";
      element(a.country.size() == 2 ? "xAL:CountryNameCode" : "xAL:CountryName", a.country);
    }
    out_ += "<xAL:Locality Type=\"Town\">";
    if (!a.city.empty()) element("xAL:LocalityName", a.city);
    const std::string_view street = a.street.empty() ? a.place : a.street;
    const std::string_view number = a.house_number.empty() ? a.house_name : a.house_number;
    if (!street.empty() || !number.empty()) {
      out_ += "<xAL:Thoroughfare Type=\"Street\">";
      if (!number.empty()) element("xAL:ThoroughfareNumber", number);
      if (!street.empty()) element("xAL:ThoroughfareName", street);
      out_ += "</xAL:Thoroughfare>";
    }
    if (!a.suburb.empty()) {
      out_ += "<xAL:DependentLocality>";
      element("xAL:DependentLocalityName", a.suburb);
      out_ += "</xAL:DependentLocality>";
    }
    if (!a.postcode.empty()) {
      out_ += "<xAL:PostalCode>";
      element("xAL:PostalCodeNumber", a.postcode);
      out_ += "</xAL:PostalCode>";
    }
    out_ += "</xAL:Locality>";
    if (!a.country.empty()) out_ += "</xAL:Country>";
    out_ += "</xAL:AddressDetails></core:xalAddress></core:Address></bldg:address>\n";
  }

  const model::Region& region_;
  const CityGmlOptions& options_;
  TagReader tags_;
  std::string out_;
  GeometryText geometry_;
  AppearanceText& appearance_;
  ElementTemplates templates_;
};

/// What the callback of libxml2 sees: exceptions must not pass through C code. After an error the rest is swallowed;
/// to report it to libxml2 would only make it print a message.
struct SinkState {
  const Sink* sink = nullptr;
  std::exception_ptr error;
};

int write_to_sink(void* context, const char* bytes, int size) {
  auto& state = *static_cast<SinkState*>(context);
  if (state.error) return size;
  try {
    (*state.sink)(std::string_view(bytes, static_cast<std::size_t>(size)));
  } catch (...) {
    state.error = std::current_exception();
  }
  return size;
}

const xmlChar* xml(const char* text) { return reinterpret_cast<const xmlChar*>(text); }

void write_envelope(xmlTextWriterPtr writer, const Envelope& box, const std::string& srs_name) {
  if (box.empty) return;
  const auto corner = [&](const char* name, const model::Point3& p) {
    std::string text;
    append_grid(text, p.x);
    text += ' ';
    append_grid(text, p.y);
    text += ' ';
    append_grid(text, p.z);
    xmlTextWriterWriteElement(writer, xml(name), xml(text.c_str()));
  };
  xmlTextWriterStartElement(writer, xml("gml:boundedBy"));
  xmlTextWriterStartElement(writer, xml("Envelope"));
  if (!srs_name.empty()) xmlTextWriterWriteAttribute(writer, xml("srsName"), xml(srs_name.c_str()));
  xmlTextWriterWriteAttribute(writer, xml("srsDimension"), xml("3"));
  corner("lowerCorner", box.min);
  corner("upperCorner", box.max);
  xmlTextWriterEndElement(writer);
  xmlTextWriterEndElement(writer);
  xmlTextWriterWriteRaw(writer, xml("\n"));
}

}  // namespace

std::string citygml_description(const CityGmlOptions& options) {
  std::string text;
  const auto add = [&](std::string_view label, std::string_view value) {
    if (value.empty()) return;
    if (!text.empty()) text += "; ";
    text += label;
    append_clean(text, value);
  };
  add("CRS: ", options.srs_name);
  add("heights: ", options.height_reference);
  if (options.lod >= 3 && options.lean)
    add("detail: ",
        "lean, windows and doors in the plane of their walls (reveal_depth says how far behind it they lie), pieces of "
        "ornaments under 0.5 m left out");
  add("data: ", options.attribution);
  return text;
}

void write_citygml(const model::Region& region, const CityGmlOptions& options, const Sink& sink) {
  // Once, before several threads are in the library.
  [[maybe_unused]] static const bool initialised = (xmlInitParser(), true);
  SinkState state{&sink, nullptr};
  xmlOutputBufferPtr output = xmlOutputBufferCreateIO(write_to_sink, nullptr, &state, nullptr);
  if (!output) throw std::bad_alloc();
  const std::unique_ptr<xmlTextWriter, void (*)(xmlTextWriterPtr)> owner(xmlNewTextWriter(output), xmlFreeTextWriter);
  xmlTextWriterPtr writer = owner.get();
  if (!writer) {
    xmlOutputBufferClose(output);
    throw std::bad_alloc();
  }

  xmlTextWriterWriteRaw(writer, xml("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"));
  xmlTextWriterStartElement(writer, xml("core:CityModel"));
  const std::pair<const char*, const char*> namespaces[] = {
      {"xmlns:core", "http://www.opengis.net/citygml/2.0"},
      {"xmlns:app", "http://www.opengis.net/citygml/appearance/2.0"},
      {"xmlns:bldg", "http://www.opengis.net/citygml/building/2.0"},
      {"xmlns:gen", "http://www.opengis.net/citygml/generics/2.0"},
      {"xmlns:gml", "http://www.opengis.net/gml"},
      {"xmlns:xAL", "urn:oasis:names:tc:ciq:xsdschema:xAL:2.0"},
      {"xmlns:xlink", "http://www.w3.org/1999/xlink"},
      {"xmlns:xsi", "http://www.w3.org/2001/XMLSchema-instance"},
      {"xsi:schemaLocation",
       "http://www.opengis.net/citygml/appearance/2.0 "
       "http://schemas.opengis.net/citygml/appearance/2.0/appearance.xsd "
       "http://www.opengis.net/citygml/building/2.0 http://schemas.opengis.net/citygml/building/2.0/building.xsd "
       "http://www.opengis.net/citygml/generics/2.0 http://schemas.opengis.net/citygml/generics/2.0/generics.xsd"},
      // Last: readers that look prefixes up by their address take the last one of an address.
      {"xmlns", "http://www.opengis.net/gml"},
  };
  for (const auto& [name, value] : namespaces) xmlTextWriterWriteAttribute(writer, xml(name), xml(value));
  xmlTextWriterWriteRaw(writer, xml("\n"));
  // The description comes before the name in GML's sequence.
  if (const std::string text = citygml_description(options); !text.empty()) {
    xmlTextWriterWriteElement(writer, xml("description"), xml(text.c_str()));
    xmlTextWriterWriteRaw(writer, xml("\n"));
  }
  if (!options.name.empty()) {
    std::string clean;
    append_clean(clean, options.name);
    xmlTextWriterWriteElement(writer, xml("gml:name"), xml(clean.c_str()));
    xmlTextWriterWriteRaw(writer, xml("\n"));
  }
  write_envelope(writer, envelope(region, options.lod, options.lean), options.srs_name);

  const auto write_raw = [&](std::string_view piece) {
    if (!state.error) xmlTextWriterWriteRawLen(writer, xml(piece.data()), static_cast<int>(piece.size()));
  };
  AppearanceText appearance;
  BuildingText text(region, options, appearance);
  for (const model::Building& building : region.buildings) {
    if (!is_written(building)) continue;
    if (state.error) break;
    write_raw(text.member(building));
  }
  appearance.write(region.materials, write_raw);
  xmlTextWriterEndDocument(writer);
  xmlTextWriterFlush(writer);
  if (state.error) std::rethrow_exception(state.error);
}

std::string write_citygml(const model::Region& region, const CityGmlOptions& options) {
  std::string out;
  write_citygml(region, options, [&](std::string_view bytes) { out += bytes; });
  return out;
}

}  // namespace blockrand::outputs
