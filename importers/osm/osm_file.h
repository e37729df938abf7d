// One OSM file, read several times: opening, passes over its objects, and errors in words.
#pragma once

#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <osmium/io/file.hpp>
#include <osmium/osm/entity_bits.hpp>
#include <osmium/osm/object.hpp>
#include <string>
#include <string_view>
#include <unordered_set>
#include <utility>

namespace blockrand::importers::osm {

/// Thrown by for_each_tag when a tag holds a NUL: read again after OsmFile::clean_strings().
struct NulInText {};

class OsmFile {
 public:
  /// Checks that the file can be what its name says, and looks for the objects that an editor marked as deleted.
  /// \throws base::InputError
  explicit OsmFile(const std::string& path);
  ~OsmFile();

  using Visit = std::function<void(const osmium::OSMObject&)>;
  using Progress = std::function<void(double fraction)>;

  /// What lies in a store of ours (extract_store.h): kept objects alone, ways with the places of their nodes.
  /// \param visit_all  as for_each
  OsmFile(std::string name, std::function<void(osmium::osm_entity_bits::type, const Visit&)> visit_all);
  bool ways_have_places() const { return stored_ != nullptr; }

  /// Calls `visit` for every object of the type in the order of the file, deleted ones (visible() == false) included.
  /// \throws base::InputError; whatever `visit` throws passes unchanged
  void for_each(osmium::osm_entity_bits::type type, const Visit& visit, const Progress& progress);

  /// Whether JOSM's `action="delete"` stands on the object.
  bool deleted_by_editor(osmium::item_type type, std::int64_t id) const;

  /// Replaces NUL characters in the strings of a PBF file; see clean_pbf_strings.
  void clean_strings();
  /// Whether clean_strings() changed this text.
  bool was_cleaned(std::string_view text) const { return !cleaned_.empty() && cleaned_.contains(std::string(text)); }

 private:
  void find_deletions();

  struct Workers;
  std::function<void(osmium::osm_entity_bits::type, const Visit&)> stored_;
  std::string path_;       ///< as the user gave it, for messages
  std::string file_name_;  ///< absolute: libosmium takes "http:..." for an address
  std::string format_;     ///< "pbf", "xml", "xml.gz" or "xml.bz2"
  std::string buffer_;     ///< the cleaned file, or empty
  std::unordered_set<std::string> cleaned_;
  std::unordered_set<std::int64_t> deleted_[3];
  std::unique_ptr<Workers> workers_;
};

/// In a catch block: what libosmium and protozero throw about a file, in our words.
/// \throws base::InputError  always
[[noreturn]] void throw_in_words(const std::string& path);

/// Calls `visit(key, value)` for every tag. libosmium's own iteration runs past the end when a string holds a NUL.
/// \throws NulInText when the strings do not come in pairs
template <class Visit>
void for_each_tag(const osmium::OSMObject& object, Visit&& visit) {
  const osmium::TagList& tags = object.tags();
  if (tags.byte_size() <= sizeof(osmium::TagList)) return;
  const auto* at = reinterpret_cast<const char*>(tags.data()) + sizeof(osmium::TagList);
  const auto* const end = reinterpret_cast<const char*>(tags.data()) + tags.byte_size();
  const auto take = [&] {
    const auto* const nul = static_cast<const char*>(std::memchr(at, 0, static_cast<std::size_t>(end - at)));
    if (nul == nullptr) throw NulInText{};
    const std::string_view text(at, static_cast<std::size_t>(nul - at));
    at = nul + 1;
    return text;
  };
  while (at < end) {
    const std::string_view key = take();
    if (at >= end) throw NulInText{};
    visit(key, take());
  }
}

}  // namespace blockrand::importers::osm
