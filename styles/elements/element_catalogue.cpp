// Reads folders of profiles and element files, and finds kinds by name.
#include "styles/elements/element_catalogue.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <system_error>
#include <utility>

#include "pipeline/base/error.h"
#include "pipeline/base/toml_file.h"
#include "styles/elements/element_file.h"
#include "styles/elements/kinds.h"
#include "styles/elements/make_kind.h"

namespace blockrand::elements {
namespace {

namespace fs = std::filesystem;

/// Files of a folder that end in .toml, by name, without hidden ones, which editors leave; none where there is no such
/// folder.
std::vector<std::string> toml_files(const fs::path& folder) {
  std::vector<std::string> out;
  std::error_code error;
  if (!fs::exists(folder, error) && !error) return out;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
    if (at->path().extension() == ".toml" && at->path().filename().string()[0] != '.')
      out.push_back(at->path().string());
  if (error) throw base::InputError(folder.string(), "", error.message(), "Check the folder and its permissions");
  std::sort(out.begin(), out.end());
  return out;
}

std::string text_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text;
  try {
    if (file) text.assign(std::istreambuf_iterator<char>(file), {});
  } catch (const std::ios_base::failure&) {
    file.setstate(std::ios::failbit);  // a folder of that name
  }
  if (!file) throw base::InputError(path, "", "cannot be read", "Check the path and the file's permissions");
  return text;
}

}  // namespace

struct ElementCatalogue::Data {
  std::vector<ElementKind> kinds;
  std::vector<Maker> makers;  ///< parallel to kinds
  std::map<std::string, std::size_t, std::less<>> by_name;
  ProfileLibrary profiles;
  std::vector<std::string> files;
  std::vector<ElementCredit> credits;
  std::map<std::string, bool, std::less<>>
      of_files;  ///< by kind: made of pieces or a model alone, not of a built-in kind

  Data() {
    const auto own = generators();
    for (std::size_t i = 0; i < own.size(); ++i) add(built_in_kinds()[i], own[i]);
  }
  void add(ElementKind kind, Maker maker) {
    by_name.emplace(kind.name, kinds.size());
    kinds.push_back(std::move(kind));
    makers.push_back(std::move(maker));
  }
  /// Error: there is none of that name; names the nearest.
  tl::expected<std::size_t, std::string> number_of(std::string_view name) const {
    if (const auto found = by_name.find(name); found != by_name.end()) return found->second;
    std::vector<std::string> known;
    for (const ElementKind& kind : kinds) known.push_back(kind.name);
    const std::string near = base::nearest(name, known);
    std::string list;
    for (const std::string& n : known) list += (list.empty() ? "" : ", ") + n;
    return tl::unexpected(fmt::format("there is no element \"{}\"; {}", name,
                                      near.empty() ? "known: " + list : fmt::format("did you mean \"{}\"?", near)));
  }
};

ElementCatalogue::ElementCatalogue() {
  static const auto built_in = std::make_shared<const Data>();
  data_ = built_in;
}
ElementCatalogue::ElementCatalogue(std::shared_ptr<const Data> data) : data_(std::move(data)) {}

std::span<const ElementKind> ElementCatalogue::kinds() const { return data_->kinds; }
const ProfileLibrary& ElementCatalogue::profiles() const { return data_->profiles; }
std::span<const std::string> ElementCatalogue::files() const { return data_->files; }
std::span<const ElementCredit> ElementCatalogue::credits() const { return data_->credits; }

const ElementKind* ElementCatalogue::find(std::string_view name) const {
  const auto found = data_->by_name.find(name);
  return found == data_->by_name.end() ? nullptr : &data_->kinds[found->second];
}

std::string ElementCatalogue::defect_of(const Element& element, double width, double height) const {
  const auto found = data_->of_files.find(element.kind);
  if (found == data_->of_files.end()) return {};
  return element_defect(element, model::snap(width), model::snap(height), found->second);
}

tl::expected<Element, std::string> ElementCatalogue::make(std::string_view kind, double width, double height,
                                                          std::span<const Parameter> parameters) const {
  const auto k = data_->number_of(kind);
  if (!k) return tl::unexpected(k.error());
  return make_kind(data_->kinds[*k], data_->makers[*k], width, height, parameters, data_->profiles);
}

tl::expected<FittedElement, std::string> ElementCatalogue::make_fitting(std::string_view kind, double width,
                                                                        double height,
                                                                        std::span<const Parameter> parameters) const {
  const auto k = data_->number_of(kind);
  if (!k) return tl::unexpected(k.error());
  return make_fitting_kind(data_->kinds[*k], data_->makers[*k], width, height, parameters, data_->profiles);
}

ElementCatalogue read_element_catalogue(std::span<const std::string> folders, const ModelReader& reader) {
  auto data = std::make_shared<ElementCatalogue::Data>();
  for (const std::string& folder : folders) {
    if (std::error_code error; !fs::is_directory(folder, error))
      throw base::InputError(folder, "", "there is no such folder", "It may have folders profiles and elements");
    for (const std::string& file : toml_files(fs::path(folder) / "profiles")) {
      parse_profile_preset(text_of(file), file, fs::path(file).stem().string(), data->profiles);
      data->files.push_back(file);
    }
  }
  // Later folders may bring the profiles that elements of earlier ones use.
  std::map<std::string, std::shared_ptr<const ElementFile>> by_name;
  for (const std::string& folder : folders)
    for (const std::string& file : toml_files(fs::path(folder) / "elements")) {
      const std::string name = fs::path(file).stem().string();
      auto read =
          std::make_shared<const ElementFile>(parse_element_file(text_of(file), file, name, data->profiles, reader));
      check_element_file(*read, data->profiles);
      data->files.push_back(file);
      if (!read->model_path.empty()) data->files.push_back(read->model_path);
      by_name[name] = std::move(read);
    }
  for (const auto& [name, read] : by_name) {
    if (!read->licence.empty() || !read->source.empty() || !read->author.empty())
      data->credits.push_back({name, read->licence, read->source, read->author});
    data->of_files.emplace(name, !read->base);
    data->add(read->kind, [file = read](const Request& request, Element& element) {
      return make_from_file(*file, request, element);
    });
  }
  return ElementCatalogue(std::move(data));
}

}  // namespace blockrand::elements
