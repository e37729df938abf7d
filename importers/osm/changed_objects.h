// What differs between two states of the data of a region: how a store is brought up to date without reading them as a whole.
// Internal to this folder but for its name.
#pragma once

#include <compare>
#include <cstdint>
#include <cstdlib>
#include <deque>
#include <map>
#include <osmium/memory/buffer.hpp>
#include <osmium/osm/object.hpp>

namespace blockrand::importers::osm {

/// Type and id in the order of files: ids below zero first, by their size.
struct ObjectKey {
  osmium::item_type type = osmium::item_type::undefined;
  std::int64_t id = 0;
  friend bool operator==(const ObjectKey&, const ObjectKey&) = default;
  friend std::strong_ordering operator<=>(const ObjectKey& a, const ObjectKey& b) {
    if (const auto order = a.type <=> b.type; order != 0) return order;
    if (const auto order = (a.id >= 0) <=> (b.id >= 0); order != 0) return order;
    return std::abs(a.id) <=> std::abs(b.id);
  }
};

inline ObjectKey key_of(const osmium::OSMObject& object) { return {object.type(), object.id()}; }

/// Objects before and after, those alone that are not the same. What is not visible is not there.
class ChangedObjects {
 public:
  struct Change {
    const osmium::OSMObject* before = nullptr;  ///< null: it was not there
    const osmium::OSMObject* after = nullptr;   ///< null: it is gone
  };

  /// Either may be null, or not visible.
  void add(const osmium::OSMObject* before, const osmium::OSMObject* after) {
    const auto alive = [](const osmium::OSMObject* o) { return o != nullptr && o->visible(); };
    if (too_many_ || (!alive(before) && !alive(after))) return;
    if (changes_.size() >= kMost) {
      clear();
      too_many_ = true;
      return;
    }
    if (alive(before)) changes_[key_of(*before)].before = copy(*before);
    if (alive(after)) changes_[key_of(*after)].after = copy(*after);
  }
  /// Begin again.
  void clear() { changes_.clear(), copies_.clear(), too_many_ = false; }
  /// They would take too much memory: none are here.
  bool too_many() const { return too_many_; }
  const std::map<ObjectKey, Change>& changes() const { return changes_; }
  const Change* find(const ObjectKey& key) const {
    const auto found = changes_.find(key);
    return found == changes_.end() ? nullptr : &found->second;
  }

 private:
  const osmium::OSMObject* copy(const osmium::OSMObject& object) {
    osmium::memory::Buffer& own = copies_.emplace_back(object.padded_size(), osmium::memory::Buffer::auto_grow::no);
    own.add_item(object);
    own.commit();
    return &own.get<osmium::OSMObject>(0);
  }
  /// About 400 bytes each. What changes as much is no day's edits.
  static constexpr std::size_t kMost = 1'000'000;

  bool too_many_ = false;
  std::map<ObjectKey, Change> changes_;
  std::deque<osmium::memory::Buffer> copies_;
};

}  // namespace blockrand::importers::osm
