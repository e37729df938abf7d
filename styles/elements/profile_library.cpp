// Reads profile presets and checks that they can be built.
#include "styles/elements/profile_library.h"

#include "pipeline/base/toml_file.h"

namespace blockrand::elements {
namespace {

void read_preset(base::TomlTable table, const std::string& name, ProfileLibrary& library) {
  ProfilePreset preset;
  const auto meaning = table.text("meaning");
  if (!meaning || meaning->empty())
    table.fail("meaning", "the profile says nothing about itself", "Add meaning = \"…\"");
  preset.meaning = *meaning;
  const auto height = table.numbers("height");
  if (!height || height->size() != 3 ||
      !((*height)[0] > 0 && (*height)[0] <= (*height)[1] && (*height)[1] <= (*height)[2]))
    table.fail("height", "height wants three rising numbers in metres", "For example height = [0.17, 0.26, 0.34]");
  preset.least = (*height)[0];
  preset.typical = (*height)[1];
  preset.most = (*height)[2];
  const auto text = table.text("program");
  if (!text) table.fail("program", "the profile has no program", "See docs/elements.md");
  const auto program = parse_profile(*text);
  if (!program) table.fail("program", "in the program, " + program.error().text(), "See docs/elements.md");
  preset.program = *program;
  for (const int steps : {1, 4, 8}) {
    const auto section = section_of(scaled_to_height(trace(preset.program, steps), preset.typical, 10));
    if (!section) table.fail("program", section.error(), "See docs/elements.md");
  }
  table.finish();
  library.insert_or_assign(name, std::move(preset));
}

}  // namespace

void parse_profile_preset(std::string_view text, const std::string& file, const std::string& name,
                          ProfileLibrary& library) {
  read_preset(base::TomlTable::parse(text, file), name, library);
}

}  // namespace blockrand::elements
