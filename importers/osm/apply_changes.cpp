#include "importers/osm/apply_changes.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <functional>
#include <osmium/index/id_set.hpp>
#include <osmium/io/gzip_compression.hpp>
#include <osmium/io/pbf_input.hpp>
#include <osmium/io/pbf_output.hpp>
#include <osmium/io/reader.hpp>
#include <osmium/io/writer.hpp>
#include <osmium/io/xml_input.hpp>
#include <osmium/osm/object_comparisons.hpp>
#include <osmium/thread/pool.hpp>
#include <unordered_set>
#include <vector>

#include "importers/osm/bzip2_stream.h"
#include "importers/osm/changed_objects.h"
#include "importers/osm/osm_file.h"
#include "pipeline/base/error.h"
#include "pipeline/model/osm_keys.h"

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

/// Place or members, then tags: to order versions that nothing else tells apart.
std::pair<std::vector<std::int64_t>, std::vector<std::pair<std::string, std::string>>> content_of(
    const OSMObject& object) {
  std::vector<std::int64_t> numbers;
  if (object.type() == osmium::item_type::node) {
    const osmium::Location at = static_cast<const osmium::Node&>(object).location();
    numbers = {at.x(), at.y()};
  } else if (object.type() == osmium::item_type::way) {
    for (const osmium::NodeRef& n : static_cast<const osmium::Way&>(object).nodes()) numbers.push_back(n.ref());
  } else {
    for (const osmium::RelationMember& m : static_cast<const osmium::Relation&>(object).members())
      numbers.push_back(m.ref()), numbers.push_back(static_cast<int>(m.type()));
  }
  std::vector<std::pair<std::string, std::string>> tags;
  for (const osmium::Tag& tag : object.tags()) tags.emplace_back(tag.key(), tag.value());
  std::sort(tags.begin(), tags.end());
  return {std::move(numbers), std::move(tags)};
}

/// Buffers of a file's objects, kept.
using Buffers = std::vector<osmium::memory::Buffer>;

std::string small_letters(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
}

std::string format_of_changes(const std::string& path) {
  const std::string name = small_letters(path);
  if (name.ends_with(".gz")) return "osc.gz";
  return name.ends_with(".bz2") ? "osc.bz2" : "osc";
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
    // Of what is the same otherwise the last one comes first.
    std::ranges::reverse(newest_);
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

base::OutputError cannot_write(const std::string& path, const std::exception& error) {
  return base::OutputError(path + ": cannot be written: " + error.what() +
                           ". Free some space or check the permissions");
}

/// Merges a sorted base with the changes, object by object.
class Merge {
 public:
  /// \param write  takes each object of the result, in order. \returns  whether it stays
  /// \param leave  takes what was there and does not stay as it is now
  /// \param clip   whether something may be outside: then what was never there is not noted as deleted
  /// \param changed  null, or gets what differs
  Merge(std::span<const Versioned> changes, std::function<bool(const OSMObject&)> write,
        std::function<void(const OSMObject&)> leave, bool clip, ChangedObjects* changed)
      : changes_(changes), write_(std::move(write)), leave_(std::move(leave)), clip_(clip), changed_(changed) {}

  /// In the order of before(), each object once; one that is not visible was deleted before.
  void add(const OSMObject& object) {
    while (next_ < changes_.size() && before(*changes_[next_].object, object)) take_new(*changes_[next_++].object);
    if (next_ >= changes_.size() || !same_object(*changes_[next_].object, object)) {
      keep(object);
      return;
    }
    const OSMObject& change = *changes_[next_++].object;
    if (change.version() < object.version() || (change.version() == object.version() && same_content(change, object))) {
      ++applied_.known;
      keep(object);
      return;
    }
    std::uint64_t& count = change.visible() != object.visible()
                               ? (change.visible() ? applied_.created : applied_.deleted)
                               : (change.visible() ? applied_.modified : applied_.known);
    if (write_(change)) {
      ++count;
      if (changed_) changed_->add(&object, &change);
      return;
    }
    if (changed_) changed_->add(&object, nullptr);
    ++(object.visible() ? applied_.deleted : applied_.outside);
    leave_(change);
  }
  AppliedChanges finish() {
    while (next_ < changes_.size()) take_new(*changes_[next_++].object);
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
  void take_new(const OSMObject& object) {
    if (clip_ && !object.visible()) {
      ++applied_.outside;
      return;
    }
    const bool written = write_(object);
    if (written && changed_) changed_->add(nullptr, &object);
    ++(!written ? applied_.outside : object.visible() ? applied_.created : applied_.known);
  }
  /// As it was, where it is still inside.
  void keep(const OSMObject& object) {
    if (!write_(object) && changed_) changed_->add(&object, nullptr);
  }

  std::span<const Versioned> changes_;
  std::function<bool(const OSMObject&)> write_;
  std::function<void(const OSMObject&)> leave_;
  bool clip_;
  ChangedObjects* changed_;
  std::size_t next_ = 0;
  AppliedChanges applied_;
};

/// A set of ids: those that OSM gives as bits, what a damaged file makes up apart.
class IdSet {
 public:
  void add(std::int64_t id) {
    if (is_usual(id))
      usual_.set(static_cast<std::uint64_t>(id));
    else
      others_.insert(id);
  }
  bool contains(std::int64_t id) const {
    return is_usual(id) ? usual_.get(static_cast<std::uint64_t>(id)) : others_.contains(id);
  }
  bool empty() const { return usual_.empty() && others_.empty(); }

 private:
  static constexpr std::int64_t kUsual = std::int64_t{1} << 36;  ///< five times what OSM has given in 20 years
  static bool is_usual(std::int64_t id) { return id >= 0 && id < kUsual; }
  /// Of 2^this bytes: ids of a city lie all over the planet's.
  static constexpr std::size_t kChunk = 9;
  osmium::index::IdSetDense<std::uint64_t, kChunk> usual_;
  std::unordered_set<std::int64_t> others_;  ///< those below zero, which editors give, as well
};

/// Which objects of sorted data a polygon keeps.
class Clip {
 public:
  using ForEach = std::function<void(const std::function<void(const OSMObject&)>&)>;

  Clip(const ClipPolygon& polygon, const ForEach& for_each) {
    for_each([&](const OSMObject& object) {
      if (object.visible()) look_at(polygon, object);
    });
    choose_relations();
    if (!completed_.empty())
      for_each([&](const OSMObject& object) {
        if (object.type() != osmium::item_type::way || !object.visible() || !completed_.contains(object.id())) return;
        keep_way(static_cast<const osmium::Way&>(object));
      });
  }

  bool keeps(const OSMObject& object) const {
    // What is deleted has no place. It was there: what never was is not noted.
    if (!object.visible()) return true;
    return kept_[index_of(object.type())].contains(object.id());
  }

 private:
  struct Relation {
    std::int64_t id = 0;
    bool completed = false;  ///< all of its nodes and ways belong to it
    std::vector<std::pair<osmium::item_type, std::int64_t>> members;
  };

  static std::size_t index_of(osmium::item_type type) {
    return type == osmium::item_type::node ? 0 : type == osmium::item_type::way ? 1 : 2;
  }

  void look_at(const ClipPolygon& polygon, const OSMObject& object) {
    if (object.type() == osmium::item_type::node) {
      const osmium::Location at = static_cast<const osmium::Node&>(object).location();
      if (at.valid() && polygon.contains({at.x(), at.y()})) inside_.add(object.id()), kept_[0].add(object.id());
    } else if (object.type() == osmium::item_type::way) {
      const auto& way = static_cast<const osmium::Way&>(object);
      if (std::any_of(way.nodes().begin(), way.nodes().end(),
                      [&](const osmium::NodeRef& n) { return inside_.contains(n.ref()); }))
        keep_way(way);
    } else {
      Relation& relation = relations_.emplace_back();
      relation.id = object.id();
      for_each_tag(object, [&](std::string_view key, std::string_view value) {
        if (key == model::osm_key::kType) relation.completed = value == "multipolygon" || value == "building";
      });
      for (const osmium::RelationMember& m : static_cast<const osmium::Relation&>(object).members())
        relation.members.emplace_back(m.type(), m.ref());
    }
  }
  void keep_way(const osmium::Way& way) {
    kept_[1].add(way.id());
    for (const osmium::NodeRef& n : way.nodes()) kept_[0].add(n.ref());
  }
  void choose_relations() {
    for (bool more = true; more;) {
      more = false;
      for (const Relation& r : relations_) {
        if (kept_[2].contains(r.id)) continue;
        const bool chosen = std::any_of(r.members.begin(), r.members.end(), [&](const auto& m) {
          // Nodes that only complete a way bring no relation along.
          return (m.first == osmium::item_type::node ? inside_ : kept_[index_of(m.first)]).contains(m.second);
        });
        if (chosen) kept_[2].add(r.id), more = true;
      }
    }
    for (const Relation& r : relations_)
      if (r.completed && kept_[2].contains(r.id))
        for (const auto& [type, id] : r.members) {
          if (type == osmium::item_type::node) kept_[0].add(id);
          if (type == osmium::item_type::way && !kept_[1].contains(id)) completed_.add(id);
        }
    relations_.clear();
  }

  IdSet inside_, completed_;  ///< nodes; ways
  std::array<IdSet, 3> kept_;
  std::vector<Relation> relations_;
};

/// Thrown by Base::for_each: read again after sort().
struct NotSorted {};

/// The objects of the base in order. Those of a file that is not sorted are held in memory and sorted.
class Base {
 public:
  explicit Base(const std::string& path) : path_(path), file_(path) {}

  void sort() { sorted_ = false; }
  /// After NulInText.
  void clean() {
    if (cleaned_)
      throw base::InputError(path_, "", "tags cannot be read", "The file is damaged: fetch or write it again");
    file_.clean_strings();
    cleaned_ = true;
  }
  bool cleaned() const { return cleaned_; }

  /// \throws NotSorted  unless sort() was called \throws NulInText
  void for_each(const OsmFile::Visit& visit) {
    // What an editor marked as deleted was never sent anywhere: it has no version to keep.
    const auto alive = [&](const OSMObject& object) { return !file_.deleted_by_editor(object.type(), object.id()); };
    constexpr auto all = osmium::osm_entity_bits::nwr;
    const auto check_texts = [](const OSMObject& object) {
      for_each_tag(object, [](std::string_view, std::string_view) {});
    };
    if (sorted_) {
      std::optional<std::tuple<osmium::item_type, bool, std::int64_t>> last;
      file_.for_each(all,
                     [&](const OSMObject& object) {
                       check_texts(object);
                       const auto order = std::make_tuple(object.type(), object.id() >= 0, std::abs(object.id()));
                       // Equal ids are several versions: those need sorting as well.
                       if (last && !(*last < order)) throw NotSorted{};
                       last = order;
                       if (alive(object)) visit(object);
                     },
                     {});
      return;
    }
    osmium::memory::Buffer kept(1 << 20, osmium::memory::Buffer::auto_grow::yes);
    file_.for_each(all,
                   [&](const OSMObject& object) {
                     check_texts(object);
                     if (!alive(object)) return;
                     kept.add_item(object);
                     kept.commit();
                   },
                   {});
    std::vector<const OSMObject*> order;
    for (const OSMObject& object : kept.select<OSMObject>()) order.push_back(&object);
    // As the reader of extracts chooses (raw_data.cpp): of equal versions the newer one, of equal times that whose place and
    // members, then tags, come first.
    std::ranges::stable_sort(order, [](const OSMObject* a, const OSMObject* b) {
      if (!same_object(*a, *b)) return before(*a, *b);
      if (a->version() != b->version()) return a->version() > b->version();
      if (a->timestamp() != b->timestamp()) return a->timestamp() > b->timestamp();
      return content_of(*a) < content_of(*b);
    });
    for (std::size_t i = 0; i < order.size(); ++i)
      if (i == 0 || !same_object(*order[i], *order[i - 1])) visit(*order[i]);
  }

 private:
  std::string path_;
  OsmFile file_;
  bool sorted_ = true, cleaned_ = false;
};

}  // namespace

std::shared_ptr<ChangedObjects> no_changed_objects() { return std::make_shared<ChangedObjects>(); }

bool is_change_file(std::string_view path) {
  const std::string name = small_letters(path);
  return name.ends_with(".osc") || name.ends_with(".osc.gz") || name.ends_with(".osc.bz2");
}

std::optional<std::uint64_t> replication_sequence(const std::string& path) {
  std::error_code missing;
  // What is wrong with a file that is none is told by whoever reads it.
  if (!small_letters(path).ends_with(".pbf") || !fs::is_regular_file(path, missing)) return std::nullopt;
  try {
    osmium::io::Reader reader(osmium::io::File(fs::absolute(path).string(), "pbf"), osmium::osm_entity_bits::nothing);
    const std::string number = reader.header().get("osmosis_replication_sequence_number");
    reader.close();
    std::uint64_t sequence = 0;
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), sequence);
    if (!number.empty() && error == std::errc() && end == number.data() + number.size()) return sequence;
  } catch (const std::exception&) {
    throw_in_words(path);
  }
  return std::nullopt;
}

AppliedChanges apply_changes(const std::string& base_path, std::span<const std::string> files, const std::string& out,
                             const ClipPolygon* polygon, ChangedObjects* changed) {
  use_own_bzip2();
  osmium::thread::Pool pool(2);
  Base base(base_path);
  const Changes changes(files, pool);
  const auto merged = [&](
                          const std::function<bool(const OSMObject&)>& write,
                          const std::function<void(const OSMObject&)>& leave = [](const OSMObject&) {},
                          ChangedObjects* noted = nullptr) {
    Merge merge(changes.newest(), write, leave, polygon != nullptr, noted);
    base.for_each([&](const OSMObject& object) { merge.add(object); });
    return merge.finish();
  };
  osmium::io::Header header;
  header.set("generator", "blockrand");
  header.set("sorting", "Type_then_ID");
  header.set_has_multiple_object_versions(true);  // else nobody would read who was deleted
  osmium::io::File file(fs::absolute(out).string(), "pbf");
  file.set_has_multiple_object_versions(true);
#ifdef OSMIUM_WITH_LZ4
  // A fifth larger than with zlib, but written in a fifth and read in half of the time, every night.
  file.set("pbf_compression", "lz4");
#endif
  std::optional<osmium::io::Writer> writer;
  const auto write = [&] {
    std::optional<Clip> clip;
    if (polygon)
      clip.emplace(*polygon, [&](const std::function<void(const OSMObject&)>& visit) {
        merged([&](const OSMObject& object) {
          visit(object);
          return true;
        });
      });
    try {
      writer.emplace(file, header, osmium::io::overwrite::allow, osmium::io::fsync::yes, pool);
    } catch (const std::exception& error) {
      throw cannot_write(out, error);
    }
    const auto put = [&](const OSMObject& object) {
      try {
        (*writer)(object);
      } catch (const std::exception& error) {
        // The reader that calls must not take it for an error of its own file.
        throw cannot_write(out, error);
      }
    };
    osmium::memory::Buffer copy(1024, osmium::memory::Buffer::auto_grow::yes);
    if (changed) changed->clear();
    AppliedChanges applied = merged(
        [&](const OSMObject& object) {
          if (clip && !clip->keeps(object)) return false;
          put(object);
          return true;
        },
        [&](const OSMObject& object) {
          // Noted as deleted, so that an older change that comes later does not bring it back.
          copy.clear();
          copy.add_item(object);
          copy.commit();
          auto& gone = copy.get<OSMObject>(0);
          gone.set_visible(false);
          put(gone);
        },
        changed);
    applied.cleaned_texts = base.cleaned();
    try {
      writer->close();
    } catch (const std::exception& error) {
      throw cannot_write(out, error);
    }
    return applied;
  };
  const auto remove = [&] {
    std::error_code ignored;
    writer.reset();
    fs::remove(out, ignored);
  };
  for (;;) try {
      return write();
    } catch (const NotSorted&) {
      remove();
      base.sort();
    } catch (const NulInText&) {
      remove();
      base.clean();
    } catch (...) {
      remove();
      throw;
    }
}

}  // namespace blockrand::importers::osm
