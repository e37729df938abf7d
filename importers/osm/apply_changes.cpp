#include "importers/osm/apply_changes.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <osmium/io/gzip_compression.hpp>
#include <osmium/io/pbf_input.hpp>
#include <osmium/io/pbf_output.hpp>
#include <osmium/io/reader.hpp>
#include <osmium/io/writer.hpp>
#include <osmium/io/xml_input.hpp>
#include <osmium/osm/object_comparisons.hpp>
#include <osmium/thread/pool.hpp>
#include <vector>

#include "importers/osm/bzip2_stream.h"
#include "importers/osm/osm_file.h"
#include "pipeline/base/error.h"

namespace blockrand::importers::osm {
namespace {

namespace fs = std::filesystem;
using osmium::OSMObject;

/// An object, and in which file it came: 0 is the base.
struct Versioned {
  const OSMObject* object;
  std::size_t file;
};

/// Nodes, ways, relations by id, as files have them; ids below zero first, by their size.
bool same_object(const OSMObject& a, const OSMObject& b) { return a.type() == b.type() && a.id() == b.id(); }
bool before(const OSMObject& a, const OSMObject& b) {
  const bool negative_a = a.id() < 0, negative_b = b.id() < 0;
  return std::make_tuple(a.type(), !negative_a, std::abs(a.id())) <
         std::make_tuple(b.type(), !negative_b, std::abs(b.id()));
}

/// Buffers of a file's objects, kept.
using Buffers = std::vector<osmium::memory::Buffer>;

std::string format_of_changes(const std::string& path) {
  if (path.ends_with(".gz")) return "osc.gz";
  return path.ends_with(".bz2") ? "osc.bz2" : "osc";
}

/// \throws base::InputError
Buffers read_changes(const std::string& path, osmium::thread::Pool& pool) {
  std::error_code error;
  if (!fs::is_regular_file(path, error))
    throw base::InputError(path, "", fs::exists(path, error) ? "this is not a regular file" : "there is no such file",
                           "Check the path");
  if (fs::file_size(path, error) == 0) throw base::InputError(path, "", "the file is empty", "Fetch it again");
  Buffers buffers;
  try {
    osmium::io::Reader reader(osmium::io::File(fs::absolute(path).string(), format_of_changes(path)), pool);
    if (!reader.header().has_multiple_object_versions())
      throw base::InputError(path, "", "this is no change file (osmChange)",
                             "Name an extract without .osc, so that it is read as one");
    while (osmium::memory::Buffer buffer = reader.read()) buffers.push_back(std::move(buffer));
    reader.close();
  } catch (const base::InputError&) {
    throw;
  } catch (const std::exception&) {
    throw_in_words(path);
  }
  return buffers;
}

/// Of all change files, each object once: its newest version.
class Changes {
 public:
  Changes(std::span<const std::string> files, osmium::thread::Pool& pool) {
    for (std::size_t f = 0; f < files.size(); ++f) {
      buffers_.push_back(read_changes(files[f], pool));
      for (const osmium::memory::Buffer& buffer : buffers_.back())
        for (const OSMObject& object : buffer.select<OSMObject>()) newest_.push_back({&object, f + 1});
    }
    std::ranges::stable_sort(newest_, [](const Versioned& a, const Versioned& b) {
      if (!same_object(*a.object, *b.object)) return before(*a.object, *b.object);
      return std::make_pair(a.object->version(), a.file) > std::make_pair(b.object->version(), b.file);
    });
    const auto twice = std::ranges::unique(
        newest_, [](const Versioned& a, const Versioned& b) { return same_object(*a.object, *b.object); });
    newest_.erase(twice.begin(), twice.end());
  }
  std::span<const Versioned> newest() const { return newest_; }

 private:
  std::vector<Buffers> buffers_;
  std::vector<Versioned> newest_;
};

/// Merges a sorted base with the changes, object by object.
class Merge {
 public:
  Merge(std::span<const Versioned> changes, osmium::io::Writer& out) : changes_(changes), out_(out) {}

  /// In the order of before(); of several versions of an object the last one that is given counts.
  void add(const OSMObject& object) {
    while (next_ < changes_.size() && before(*changes_[next_].object, object)) create(*changes_[next_++].object);
    if (next_ >= changes_.size() || !same_object(*changes_[next_].object, object)) {
      if (object.visible()) out_(object);
      return;
    }
    const OSMObject& change = *changes_[next_++].object;
    if (change.version() < object.version() || (change.version() == object.version() && same_content(change, object))) {
      ++applied_.known;
      if (object.visible()) out_(object);
    } else if (change.visible()) {
      ++applied_.modified;
      out_(change);
    } else {
      ++applied_.deleted;
    }
  }
  AppliedChanges finish() {
    while (next_ < changes_.size()) create(*changes_[next_++].object);
    return applied_;
  }

 private:
  /// Objects of one type and id are the same bytes in memory, but for padding: what they say is compared.
  static bool same_content(const OSMObject& a, const OSMObject& b) {
    if (a.visible() != b.visible() || a.timestamp() != b.timestamp() || a.changeset() != b.changeset()) return false;
    if (!std::equal(a.tags().begin(), a.tags().end(), b.tags().begin(), b.tags().end())) return false;
    if (a.type() == osmium::item_type::node)
      return static_cast<const osmium::Node&>(a).location() == static_cast<const osmium::Node&>(b).location();
    if (a.type() == osmium::item_type::way) {
      const auto &p = static_cast<const osmium::Way&>(a).nodes(), &q = static_cast<const osmium::Way&>(b).nodes();
      return std::equal(p.begin(), p.end(), q.begin(), q.end(),
                        [](const osmium::NodeRef& x, const osmium::NodeRef& y) { return x.ref() == y.ref(); });
    }
    const auto &p = static_cast<const osmium::Relation&>(a).members(),
               &q = static_cast<const osmium::Relation&>(b).members();
    return std::equal(p.begin(), p.end(), q.begin(), q.end(),
                      [](const osmium::RelationMember& x, const osmium::RelationMember& y) {
                        return x.type() == y.type() && x.ref() == y.ref() && std::string_view(x.role()) == y.role();
                      });
  }
  void create(const OSMObject& object) {
    if (!object.visible()) {
      ++applied_.known;  // what is not there cannot be deleted
      return;
    }
    ++applied_.created;
    out_(object);
  }

  std::span<const Versioned> changes_;
  osmium::io::Writer& out_;
  std::size_t next_ = 0;
  AppliedChanges applied_;
};

/// The objects of the base in order. Those of a file that is not sorted are held in memory and sorted.
class Base {
 public:
  explicit Base(const std::string& path) : file_(path) {
    constexpr auto all = osmium::osm_entity_bits::nwr;
    const auto scan = [&] {
      bool sorted = true, first = true;
      osmium::item_type type{};
      osmium::object_id_type id = 0;
      file_.for_each(all,
                     [&](const OSMObject& object) {
                       // Equal ids are several versions: those need sorting as well.
                       sorted = sorted &&
                                (first || std::make_tuple(type, id >= 0, std::abs(id)) <
                                              std::make_tuple(object.type(), object.id() >= 0, std::abs(object.id())));
                       first = false, type = object.type(), id = object.id();
                       for_each_tag(object, [](std::string_view, std::string_view) {});
                     },
                     {});
      return sorted;
    };
    try {
      sorted_ = scan();
    } catch (const NulInText&) {
      file_.clean_strings();
      sorted_ = scan();
    }
  }

  void for_each(const OsmFile::Visit& visit) {
    const auto alive = [&](const OSMObject& object) { return !file_.deleted_by_editor(object.type(), object.id()); };
    constexpr auto all = osmium::osm_entity_bits::nwr;
    if (sorted_) {
      file_.for_each(all,
                     [&](const OSMObject& object) {
                       if (alive(object)) visit(object);
                     },
                     {});
      return;
    }
    osmium::memory::Buffer kept(1 << 20, osmium::memory::Buffer::auto_grow::yes);
    file_.for_each(all,
                   [&](const OSMObject& object) {
                     if (!alive(object)) return;
                     kept.add_item(object);
                     kept.commit();
                   },
                   {});
    std::vector<const OSMObject*> order;
    for (const OSMObject& object : kept.select<OSMObject>()) order.push_back(&object);
    std::ranges::stable_sort(order, [](const OSMObject* a, const OSMObject* b) {
      return same_object(*a, *b) ? a->version() < b->version() : before(*a, *b);
    });
    for (std::size_t i = 0; i < order.size(); ++i)
      if (i + 1 == order.size() || !same_object(*order[i], *order[i + 1])) visit(*order[i]);
  }

 private:
  OsmFile file_;
  bool sorted_ = true;
};

}  // namespace

bool is_change_file(std::string_view path) {
  return path.ends_with(".osc") || path.ends_with(".osc.gz") || path.ends_with(".osc.bz2");
}

ReplicationState replication_state(const std::string& path) {
  ReplicationState state;
  if (!path.ends_with(".pbf")) return state;
  try {
    osmium::io::Reader reader(fs::absolute(path).string(), osmium::osm_entity_bits::nothing);
    const osmium::io::Header header = reader.header();
    reader.close();
    const std::string number = header.get("osmosis_replication_sequence_number");
    std::uint64_t sequence = 0;
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), sequence);
    if (!number.empty() && error == std::errc() && end == number.data() + number.size()) state.sequence = sequence;
    state.time = header.get("osmosis_replication_timestamp");
  } catch (const std::exception&) {
    throw_in_words(path);
  }
  return state;
}

AppliedChanges apply_changes(const std::string& base_path, std::span<const std::string> files, const std::string& out,
                             const ReplicationState& state) {
  use_own_bzip2();
  osmium::thread::Pool pool(2);
  Base base(base_path);
  const Changes changes(files, pool);
  osmium::io::Header header;
  header.set("generator", "blockrand");
  if (state.sequence) header.set("osmosis_replication_sequence_number", std::to_string(*state.sequence));
  if (!state.time.empty()) header.set("osmosis_replication_timestamp", state.time);
  header.set("sorting", "Type_then_ID");
  AppliedChanges applied;
  const auto cannot_write = [&](const std::exception& error) {
    std::error_code ignored;
    fs::remove(out, ignored);
    return base::OutputError(out + ": cannot be written: " + error.what() +
                             ". Free some space or check the permissions");
  };
  std::optional<osmium::io::Writer> writer;
  try {
    writer.emplace(osmium::io::File(fs::absolute(out).string(), "pbf"), header, osmium::io::overwrite::allow,
                   osmium::io::fsync::yes, pool);
    Merge merge(changes.newest(), *writer);
    base.for_each([&](const OSMObject& object) { merge.add(object); });
    applied = merge.finish();
    writer->close();
  } catch (const base::InputError&) {
    std::error_code ignored;
    writer.reset();
    fs::remove(out, ignored);
    throw;
  } catch (const std::system_error& error) {
    throw cannot_write(error);
  } catch (const std::runtime_error& error) {
    throw cannot_write(error);
  }
  return applied;
}

}  // namespace blockrand::importers::osm
