#include "pipeline/cli/rule_files.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <regex>

#include "importers/reference/triangle_model.h"
#include "pipeline/base/error.h"
#include "pipeline/cli/configs_folder.h"
#include "pipeline/facades/facade_context.h"
#include "pipeline/facades/grammar_library.h"
#include "styles/grammar/evaluation/asset_files.h"
#include "styles/grammar/evaluation/pattern.h"

namespace blockrand::cli {

namespace {

namespace fs = std::filesystem;

/// Most files that a search looks at: a project's assets, not a whole disk.
constexpr std::size_t kMostFiles = 100000;

std::optional<std::string> read_file(const std::string& path) {
  std::error_code none;
  if (!fs::is_regular_file(path, none)) return std::nullopt;
  std::ifstream in(path, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  if (!in) return std::nullopt;
  return bytes;
}

std::vector<std::string> names_in(const std::string& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator entry(folder.empty() ? "." : folder, error), end; !error && entry != end;
       entry.increment(error))
    names.push_back(entry->path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

/// The folder above `rules` that the file lies in; its own folder where there is none.
fs::path project_of(const std::string& file) {
  std::error_code none;
  const fs::path path = fs::absolute(file, none).lexically_normal();
  for (fs::path folder = path.parent_path(); folder != folder.root_path(); folder = folder.parent_path())
    if (folder.filename() == "rules") return folder.parent_path();
  return path.parent_path();
}

/// Where a path of a rule file may be: the folders, first come first.
std::vector<fs::path> folders_of(const settings::Settings& settings, const std::string& file) {
  std::vector<fs::path> out;
  const fs::path project = project_of(file);
  for (const char* below : {"assets", "images", "data"}) out.push_back(project / below);
  out.push_back(project);
  for (const std::string& root : settings.rule_roots)
    if (!root.starts_with('/') || root.find('=') == std::string::npos) out.emplace_back(root);
  return out;
}

/// A path that does not leave its folder.
bool stays_below(const fs::path& path) {
  const fs::path normal = path.lexically_normal();
  return normal.is_relative() && !normal.empty() && *normal.begin() != "..";
}

/// The file in the first of the folders that has it.
std::optional<fs::path> find_file(const std::vector<fs::path>& folders, const std::string& path) {
  fs::path relative(path);
  if (relative.is_absolute()) relative = relative.relative_path();
  if (!stays_below(relative)) return std::nullopt;
  std::error_code none;
  for (const fs::path& folder : folders)
    if (fs::is_regular_file(folder / relative, none)) return folder / relative;
  return std::nullopt;
}

/// The files that a query names: `*` any letters, `?` one letter; "$…" is a regular expression
/// (docs/rule_language.md §3.2).
tl::expected<std::vector<std::string>, std::string> search(const std::vector<fs::path>& folders,
                                                           const std::string& query) {
  std::optional<std::regex> pattern;
  if (query.starts_with('$')) {
    auto read = grammar::read_pattern(query.substr(1), /*ignore_case=*/true);
    if (!read) return tl::unexpected(read.error());
    pattern = std::move(*read);
  }
  const auto fits = [&](const std::string& name) {
    if (!pattern) return grammar::matches_wildcards(name, query);
    return name.size() <= grammar::kLongestForPattern && std::regex_match(name, *pattern);
  };
  std::vector<std::string> out;
  std::size_t seen = 0;
  for (const fs::path& folder : folders) {
    std::error_code error;
    std::vector<std::string> found;
    for (fs::recursive_directory_iterator entry(folder, fs::directory_options::skip_permission_denied, error), end;
         !error && entry != end && ++seen < kMostFiles; entry.increment(error)) {
      if (!entry->is_regular_file(error)) continue;
      const std::string name = entry->path().lexically_relative(folder).generic_string();
      // A query without folders is a file's name, wherever it lies.
      if (fits(name) || fits(entry->path().filename().string())) found.push_back(name);
    }
    std::sort(found.begin(), found.end());
    for (std::string& name : found)
      if (std::find(out.begin(), out.end(), name) == out.end()) out.push_back(std::move(name));
    if (!out.empty()) break;
  }
  return out;
}

}  // namespace

grammar::LoadOptions rule_load_options(const settings::Settings& settings, const std::string& file) {
  grammar::LoadOptions options;
  for (const std::string& root : settings.rule_roots) {
    const std::size_t equals = root.starts_with('/') ? root.find('=') : std::string::npos;
    if (equals == std::string::npos)
      options.roots.push_back(root);
    else
      options.mounts.emplace_back(root.substr(0, equals), root.substr(equals + 1));
  }
  options.roots.push_back(project_of(file).string());
  options.read = read_file;
  options.list = names_in;
  return options;
}

grammar::FileAccess rule_file_access(const settings::Settings& settings, const std::string& file) {
  const std::vector<fs::path> folders = folders_of(settings, file);
  grammar::FileAccess access;
  access.exists = [folders](const std::string& path) { return find_file(folders, path).has_value(); };
  access.read = [folders](const std::string& path) -> std::optional<std::string> {
    const auto found = find_file(folders, path);
    return found ? read_file(found->string()) : std::nullopt;
  };
  const auto bytes_of = [read = access.read](const std::string& path) { return read(path).value_or(std::string()); };
  access.asset = [bytes_of](const std::string& path) { return grammar::obj_box(bytes_of(path)); };
  access.image = [bytes_of](const std::string& path) { return grammar::picture_size(bytes_of(path)); };
  access.search = [folders](const std::string& query) { return search(folders, query); };
  return access;
}

elements::ElementCatalogue rule_elements(const settings::Settings& settings, const std::string& file) {
  std::vector<std::string> folders;
  try {
    folders.push_back(configs_folder(settings.build.configs, program_file()));
  } catch (const base::UsageError&) {
    if (!settings.build.configs.empty()) throw;
  }
  std::string own = fs::path(file).parent_path().string();
  if (own.empty()) own = ".";
  if (fs::is_directory(own) && std::ranges::find(folders, own) == folders.end()) folders.push_back(std::move(own));
  return elements::read_element_catalogue(folders, importers::reference::read_triangle_model);
}

grammar::CheckOptions rule_check_options(const elements::ElementCatalogue& elements) {
  grammar::CheckOptions out;
  out.extensions = facades::extension_operations(elements);
  for (const facades::ContextAttribute& attribute : facades::context_attributes())
    out.context.emplace_back(attribute.name);
  return out;
}

}  // namespace blockrand::cli
