// Looks: color, texture, and attributes that set() can change and rules can read.
#include <algorithm>
#include <array>
#include <cmath>

#include "pipeline/base/portable_math.h"
#include "styles/grammar/shapes/mesh_tools.h"
#include "styles/grammar/shapes/operation_list.h"

namespace blockrand::grammar {

namespace {

const Material& material_of(const Shape& shape) {
  static const Material kDefault;
  return shape.material ? *shape.material : kDefault;
}

template <typename Change>
void change_material(Shape& shape, Change change) {
  Material material = material_of(shape);
  change(material);
  shape.material = std::make_shared<const Material>(std::move(material));
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

/// "#rrggbb" or "#rrggbboo"; the sign may be missing. Opacity is 1 when it is not given.
std::optional<std::array<double, 4>> colour_of(std::string_view text) {
  if (text.starts_with('#')) text.remove_prefix(1);
  if (text.size() != 6 && text.size() != 8) return {};
  std::array<double, 4> out{0, 0, 0, 1};
  for (std::size_t i = 0; i < text.size() / 2; ++i) {
    const int high = hex_digit(text[2 * i]), low = hex_digit(text[2 * i + 1]);
    if (high < 0 || low < 0) return {};
    out[i] = (high * 16 + low) / 255.0;
  }
  return out;
}

std::string hex_of(const std::array<double, 4>& colour) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string out = "#";
  for (int i = 0; i < 3; ++i) {
    const int byte =
        static_cast<int>(std::floor(std::clamp(colour[static_cast<std::size_t>(i)], 0.0, 1.0) * 255 + 0.5));
    out += kDigits[static_cast<std::size_t>(byte / 16)];
    out += kDigits[static_cast<std::size_t>(byte % 16)];
  }
  return out;
}

double unit(double value) { return std::clamp(std::isfinite(value) ? value : 0, 0.0, 1.0); }

/// "r" … "a" of material.color.
int channel(std::string_view name) {
  constexpr std::array<std::string_view, 4> kNames{"color.r", "color.g", "color.b", "color.a"};
  for (std::size_t i = 0; i < kNames.size(); ++i)
    if (kNames[i] == name) return static_cast<int>(i);
  return -1;
}

/// Names below "material." that are no fields of Material, with their defaults.
std::optional<Value> default_of(std::string_view name) {
  struct Number {
    std::string_view name;
    double value;
  };
  constexpr std::array<Number, 24> kNumbers{
      {{"ambient.r", 0},     {"ambient.g", 0},           {"ambient.b", 0},   {"specular.r", 0},    {"specular.g", 0},
       {"specular.b", 0},    {"emissive.r", 0},          {"emissive.g", 0},  {"emissive.b", 0},    {"opacity", 1},
       {"reflectivity", 0},  {"shininess", 1},           {"bumpValue", 0},   {"ambient.a", 1},     {"specular.a", 1},
       {"emissive.a", 1},    {"opacitymap.cutoff", 0.5}, {"color.rand", 0},  {"opacity.a", 1},     {"specularscale", 0},
       {"emissivescale", 0}, {"diffusescale", 0},        {"normalscale", 0}, {"occlusionscale", 0}}};
  for (const Number& n : kNumbers)
    if (n.name == name) return n.value;
  if (name == "doubleSided") return true;
  if (name == "name" || name == "shader" || name == "opacitymap.mode") return std::string();
  if (name == "ambient.rgb" || name == "specular.rgb" || name == "emissive.rgb") return std::string("#000000");
  constexpr std::array<std::string_view, 10> kMaps{"colormap",     "bumpmap",    "dirtmap",     "specularmap",
                                                   "opacitymap",   "normalmap",  "emissivemap", "occlusionmap",
                                                   "roughnessmap", "metallicmap"};
  const auto dot_at = name.find('.');
  for (const std::string_view map : kMaps) {
    if (name.substr(0, dot_at) != map) continue;
    if (dot_at == std::string_view::npos) return std::string();
    const std::string_view part = name.substr(dot_at + 1);
    if (part == "su" || part == "sv") return 1.0;
    if (part == "tu" || part == "tv" || part == "rw") return 0.0;
  }
  return {};
}

Result set_material(Shape& shape, std::string_view name, const Value& value) {
  const double* number = std::get_if<double>(&value);
  const std::string* text = std::get_if<std::string>(&value);
  if (const int c = channel(name); c >= 0) {
    if (number == nullptr) return failure("takes a number from 0 to 1");
    change_material(shape, [&](Material& m) { m.colour[static_cast<std::size_t>(c)] = unit(*number); });
    return {};
  }
  if (name == "opacity") {
    if (number == nullptr) return failure("takes a number from 0 to 1");
    change_material(shape, [&](Material& m) { m.colour[3] = unit(*number); });
    return {};
  }
  if (name == "color.rgb" || name == "color.rgba" || name == "color") {
    const auto colour = text != nullptr ? colour_of(*text) : std::nullopt;
    if (!colour) return failure("takes a colour \"#rrggbb\"");
    change_material(shape, [&](Material& m) {
      const double opacity = name == "color.rgb" ? m.colour[3] : (*colour)[3];
      m.colour = *colour;
      m.colour[3] = opacity;
    });
    return {};
  }
  if (name == "roughness" || name == "metallic") {
    if (number == nullptr) return failure("takes a number from 0 to 1");
    change_material(shape, [&](Material& m) { (name == "roughness" ? m.roughness : m.metallic) = unit(*number); });
    return {};
  }
  if (name == "colormap") {
    if (text == nullptr) return failure("takes the name of a file");
    change_material(shape, [&](Material& m) { m.colour_map = *text; });
    return {};
  }
  const auto known = default_of(name);
  if (!known) return failure("there is no attribute material." + std::string(name));
  if (type_of(*known) != type_of(value))
    return failure("takes a " + std::string(type_of(*known) == Type::number  ? "number"
                                            : type_of(*known) == Type::truth ? "truth value"
                                                                             : "text"));
  change_material(shape, [&](Material& m) { m.others[std::string(name)] = value; });
  return {};
}

int axis_of(char c) { return c - 'x'; }

bool axis_name(std::string_view name, std::string_view letters) {
  return name.size() == 2 && letters.find(name[0]) != std::string_view::npos && name[1] >= 'x' && name[1] <= 'z';
}

}  // namespace

tl::expected<void, std::string> set_attribute(Shape& shape, std::string_view name, const Value& value) {
  const double* given = std::get_if<double>(&value);
  if (name.starts_with("material.")) return set_material(shape, name.substr(9), value);
  if (name == "trim.vertical" || name == "trim.horizontal") {
    const bool* truth = std::get_if<bool>(&value);
    if (truth == nullptr) return failure("takes true or false");
    (name == "trim.vertical" ? shape.trim_vertical : shape.trim_horizontal) = *truth;
    return {};
  }
  if (name == "seedian") {
    if (given == nullptr) return failure("takes a number");
    const double whole = std::isfinite(*given) ? std::clamp(std::floor(*given), -9e15, 9e15) : 0;
    shape.seed = static_cast<std::uint64_t>(static_cast<std::int64_t>(whole));
    shape.draws = 0;
    return {};
  }
  if (name.starts_with("scope.") && axis_name(name.substr(6), "trs")) {
    if (given == nullptr) return failure("takes a number");
    const double number = std::isfinite(*given) ? *given : 0;
    const int axis = axis_of(name[7]);
    if (name[6] == 't') {
      set_component(shape.scope.origin, axis, number);
    } else if (name[6] == 'r') {
      Vector3 angles = angles_of_axes(shape.scope.axes);
      set_component(angles, axis, number);
      shape.scope.axes = axes_of_angles(angles);
    } else {
      std::array<Argument, 3> sizes;
      for (int i = 0; i < 3; ++i)
        sizes[static_cast<std::size_t>(i)].value = i == axis ? number : component(shape.size, i);
      const Shape before = shape;
      return run_s(shape, {before, before}, sizes);
    }
    return {};
  }
  for (const std::string_view fixed : {"pivot.", "split.", "comp.", "initialShape.", "scope.elevation"})
    if (name.starts_with(fixed)) return failure(std::string(name) + " cannot be set");
  return failure("there is no attribute " + std::string(name) + " that can be set");
}

std::optional<Value> read_attribute(const Shape& shape, std::string_view name) {
  const auto rest = [&](std::string_view prefix) { return name.substr(prefix.size()); };
  if (name.starts_with("scope.")) {
    const auto part = rest("scope.");
    if (part == "elevation") return scope_elevation(shape);
    if (!axis_name(part, "trs")) return {};
    const int axis = axis_of(part[1]);
    if (part[0] == 't') return component(shape.scope.origin, axis);
    if (part[0] == 's') return component(shape.size, axis);
    return component(angles_of_axes(shape.scope.axes), axis);
  }
  if (name.starts_with("pivot.")) {
    const auto part = rest("pivot.");
    if (!axis_name(part, "po")) return {};
    return component(part[0] == 'p' ? shape.pivot.origin : angles_of_axes(shape.pivot.axes), axis_of(part[1]));
  }
  if (name == "split.index") return static_cast<double>(shape.split.index);
  if (name == "split.total") return static_cast<double>(shape.split.total);
  if (name == "comp.sel") return shape.component.selector;
  if (name == "comp.index") return static_cast<double>(shape.component.index);
  if (name == "comp.total") return static_cast<double>(shape.component.total);
  if (name == "trim.vertical") return shape.trim_vertical;
  if (name == "trim.horizontal") return shape.trim_horizontal;
  if (name == "seedian") return static_cast<double>(static_cast<std::int64_t>(shape.seed));
  if (!name.starts_with("material.")) return {};
  const auto part = rest("material.");
  const Material& material = material_of(shape);
  if (const int c = channel(part); c >= 0) return material.colour[static_cast<std::size_t>(c)];
  if (part == "opacity") return material.colour[3];
  if (part == "color.rgb") return hex_of(material.colour);
  if (part == "roughness") return material.roughness;
  if (part == "metallic") return material.metallic;
  if (part == "colormap") return material.colour_map;
  if (const auto it = material.others.find(std::string(part)); it != material.others.end()) return it->second;
  return default_of(part);
}

Result run_color(Shape& shape, const OperationInput&, Arguments arguments) {
  if (const std::string* given = text(arguments, 0)) {
    const auto colour = colour_of(*given);
    if (arguments.size() != 1 || !colour)
      return failure("\"" + *given + "\" is no colour: write \"#rrggbb\" or \"#rrggbboo\"");
    change_material(shape, [&](Material& m) { m.colour = *colour; });
    return {};
  }
  if (arguments.size() < 3) return failure("takes a text or three or four numbers");
  if (auto ok = wants_numbers(arguments); !ok) return ok;
  change_material(shape, [&](Material& m) {
    m.colour = {unit(number(arguments, 0)), unit(number(arguments, 1)), unit(number(arguments, 2)),
                unit(number(arguments, 3, 1))};
  });
  return {};
}

Result run_texture(Shape& shape, const OperationInput&, Arguments arguments) {
  const std::string* file = text(arguments, 0);
  if (file == nullptr) return failure("takes the name of a file");
  change_material(shape, [&](Material& m) {
    m.colour_map = *file;
    m.others.erase("opacitymap");
  });
  return {};
}

Result run_reset_material(Shape& shape, const OperationInput&, Arguments arguments) {
  const std::string_view what = arguments.empty() ? "all" : word(arguments, 0);
  if (what != "shape" && what != "geometry" && what != "all")
    return failure(unknown_word(what, "shape, geometry, all"));
  if (what != "geometry") shape.material = nullptr;
  if (what != "shape" && shape.mesh) {
    Mesh mesh = *shape.mesh;
    for (MeshFace& face : mesh.faces) face.material = 0;
    shape.mesh = std::make_shared<const Mesh>(std::move(mesh));
  }
  return {};
}

}  // namespace blockrand::grammar
