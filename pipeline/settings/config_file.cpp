#include "pipeline/settings/config_file.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>

#include "pipeline/base/text.h"
#include "pipeline/base/toml_file.h"

namespace blockrand::settings {
namespace {

/// The value of an option's key as Option::set wants it.
std::optional<std::string> value_text(base::TomlTable& table, const Option& option) {
  switch (option.type) {
    case OptionType::flag:
      if (const auto v = table.boolean(option.key)) return *v ? "true" : "false";
      return std::nullopt;
    case OptionType::integer: {
      constexpr double most = 9.2e18;
      const auto maximum =
          option.maximum > most ? std::numeric_limits<std::int64_t>::max() : static_cast<std::int64_t>(option.maximum);
      if (const auto v = table.integer(option.key, static_cast<std::int64_t>(option.minimum), maximum))
        return std::to_string(*v);
      return std::nullopt;
    }
    case OptionType::number:
      if (const auto v = table.number(option.key, option.minimum, option.maximum)) return base::shortest(*v);
      return std::nullopt;
    case OptionType::list:
      return table.plain(option.key);
    case OptionType::text:
    case OptionType::path:
    case OptionType::folder:
      return table.text(option.key);
  }
  return std::nullopt;
}

/// Whether a table of the file is about one of the commands.
bool is_of(const base::OptionSection& section, unsigned commands) {
  return std::ranges::any_of(options(), [&](const Option& o) {
    return o.section == section && !o.key.empty() && (o.commands & commands) != 0;
  });
}

/// Empty, "2014", "2014-06" or "2014-06-21".
bool is_date(std::string_view text) {
  static constexpr std::string_view kPattern = "dddd-dd-dd";
  if (text.size() != 0 && text.size() != 4 && text.size() != 7 && text.size() != kPattern.size()) return false;
  for (std::size_t i = 0; i < text.size(); ++i)
    if (kPattern[i] == '-' ? text[i] != '-' : text[i] < '0' || text[i] > '9') return false;
  return true;
}

}  // namespace

void read_config(const std::string& path, Settings& settings, unsigned commands) {
  base::TomlTable root = base::TomlTable::read(path);
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  for (const base::OptionSection& section : sections()) {
    if (!in_config(section) || !is_of(section, commands)) continue;
    std::optional<base::TomlTable> table = root.table(section.name);
    if (!table) continue;
    for (const Option& option : options()) {
      if (option.section != section || option.key.empty()) continue;
      std::optional<std::string> text = value_text(*table, option);
      if (!text) continue;
      const bool path = option.type == OptionType::path || option.type == OptionType::folder;
      if (path && !text->empty()) *text = (folder / *text).lexically_normal().string();
      try {
        option.set(settings, *text);
      } catch (const ValueError& error) {
        table->fail(option.key, std::string("is wrong: ") + error.what(), error.remedy);
      }
    }
    table->finish();
  }
  for (base::TomlTable& image : root.tables("image")) {
    importers::imagery::ImageSource source;
    source.path = image.text("path").value_or("");
    if (source.path.empty()) image.fail("path", "is missing", "Name the image: path = \"ortho.tif\".");
    if (!source.path.starts_with("/vsi")) source.path = (folder / source.path).lexically_normal().string();
    source.date = image.text("date").value_or("");
    source.licence = image.text("licence").value_or("");
    source.attribution = image.text("attribution").value_or("");
    if (!is_date(source.date))
      image.fail("date", "is no date: '" + source.date + "'",
                 "Write a year, a month or a day: 2014, 2014-06, 2014-06-21.");
    image.finish();
    settings.build.imagery.images.push_back(std::move(source));
  }
  root.finish();
}

std::string config_template(unsigned commands) {
  std::string text =
      commands & kUpdate
          ? "# How this region is built: `blockrand update` reads it. Every key stands here with its default, "
            "commented out but for lod.\n"
            "# Relative paths start at this file's folder. Limits in [gates] keep a bad night's build back.\n"
          : "# Options of `blockrand build`, read with --config FILE.toml; the command line is stronger.\n"
            "# Every key stands here with its default. Relative paths start at this file's folder.\n";
  for (const base::OptionSection& section : sections()) {
    if (!in_config(section) || !is_of(section, commands)) continue;
    text += "\n[" + std::string(section.name) + "]\n";
    for (const Option& option : options()) {
      if (option.section != section || option.key.empty()) continue;
      // Where builds of a region lie, the region knows; whether they may be published, its gates.
      if ((commands & kUpdate) &&
          (option.name == "output" || option.name == "strict" || option.name.starts_with("allow-")))
        continue;
      const Settings fresh;
      std::string value = option.show(fresh);
      const bool bare =
          option.type == OptionType::flag || option.type == OptionType::integer || option.type == OptionType::number;
      if (!bare || value.empty()) value = "\"" + value + "\"";
      // Of a region it stands there: its builds stay what they are, should the default change.
      const bool holds = (commands & kUpdate) && option.name == "lod";
      text +=
          "# " + std::string(option.help) + "\n" + (holds ? "" : "# ") + std::string(option.key) + " = " + value + "\n";
    }
  }
  text +=
      "\n# An aerial image; as many of these tables as there are images. All but the path may be left out.\n"
      "# [[image]]\n#   path = \"ortho.tif\"\n#   date = \"2023-06-18\"\n#   licence = \"CC BY 4.0\"\n"
      "#   attribution = \"City of Vienna, data.wien.gv.at\"\n";
  return text;
}

}  // namespace blockrand::settings
