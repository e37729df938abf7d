// Straight runs of string courses, cornices and plinths as elements of their own, and single brackets. Chains of walls
// go through sweep().
#include <fmt/format.h>

#include <vector>

#include "styles/elements/parameters.h"
#include "styles/elements/sweep.h"

namespace blockrand::elements {
namespace {

Made run(const Request& r, Element& element, Part part, const ConsoleRow& consoles, const Profile& profile) {
  SweepOptions options;
  options.part = part;
  const std::string& ends = r.values.word("ends");
  options.start_end = ends == "returned" || ends == "left_returned" ? RunEnd::returned : RunEnd::cut;
  options.last_end = ends == "returned" || ends == "right_returned" ? RunEnd::returned : RunEnd::cut;
  options.start_turn = r.values.number("left_turn");
  options.last_turn = r.values.number("right_turn");
  options.consoles = consoles;
  auto made = sweep(profile, std::vector<model::Point2>{{-r.width / 2, 0}, {r.width / 2, 0}}, false, options);
  if (!made) return tl::unexpected(made.error());
  element.mesh = std::move(made->mesh);
  return {};
}

Profile scaled(const Request& r) {
  return scaled_to_height(r.values.profile("profile"), r.height, r.values.number("projection"));
}

}  // namespace

Made make_string_course(const Request& r, Element& element) { return run(r, element, Part::surround, {}, scaled(r)); }

Made make_plinth(const Request& r, Element& element) { return run(r, element, Part::wall, {}, scaled(r)); }

Made make_main_cornice(const Request& r, Element& element) {
  const Values& v = r.values;
  const Profile profile = scaled(r);
  ConsoleRow row;
  row.spacing = v.detail() == 0 ? 0 : v.number("bracket_spacing");
  row.width = v.number("bracket_width");
  row.height = (v.number("bracket_head") - v.number("bracket_foot")) * r.height;
  row.top = v.number("bracket_head") * r.height;
  row.projection =
      clear_of(profile, v.number("bracket_projection") * profile.projection(), row.top - row.height, row.top);
  if (row.spacing > 0) {
    if (profile.projection() < 0.10)
      return tl::unexpected<std::string>("a cornice that stands out less than 0.10 m is too flat for brackets");
    if (row.height < 0.05)
      return tl::unexpected<std::string>("brackets lower than 0.05 m: bracket_head must lie above bracket_foot");
    if (row.spacing < 1.2 * row.width)
      return tl::unexpected(fmt::format("brackets {:.2f} m wide do not fit every {:.2f} m", row.width, row.spacing));
  }
  return run(r, element, Part::surround, row, profile);
}

Made make_console(const Request& r, Element& element) {
  MeshBuilder builder;
  add_console(builder, 0, r.height, r.width, r.height, r.values.number("projection"), r.values.detail());
  element.mesh = builder.take();
  return {};
}

}  // namespace blockrand::elements
