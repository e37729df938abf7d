#include "importers/reference/links.h"

#include <algorithm>
#include <utility>

namespace blockrand::importers::reference {
namespace {

/// Links may multiply what they point to. Files use each face in two or three geometries: more than this many visits
/// for each face and link of the file, beyond the first ones, are an attack or a mistake.
constexpr std::size_t kVisitsPerItem = 16, kFreeVisits = 1'000'000;

}  // namespace

void Links::add_link(const std::string& target, bool reversed, int line) {
  items_.push_back({kNone, static_cast<std::uint32_t>(targets_.size()), line, reversed});
  targets_.push_back(target);
}

std::vector<Face> Links::resolve(std::size_t begin, std::size_t end, NoteLog& notes) {
  Walk walk{{}, {}, notes};
  append(begin, end, false, walk);
  return std::move(walk.faces);
}

void Links::append(std::size_t begin, std::size_t end, bool turn, Walk& walk) {
  for (std::size_t i = begin; i < end; ++i) {
    if (++visits_ > kFreeVisits + kVisitsPerItem * items_.size()) {
      if (!exhausted_) walk.notes.add(NoteKind::unresolved_link, items_[i].line, "links multiply without end");
      exhausted_ = true;
      return;
    }
    const Item& item = items_[i];
    const bool reversed = item.reversed != turn;
    if (item.polygon != kNone) {
      walk.faces.push_back({item.polygon, reversed});
      continue;
    }
    const std::string& target = targets_[item.link];
    const auto found = target.size() > 1 && target[0] == '#' ? names_.find(target.substr(1)) : names_.end();
    if (found == names_.end()) {
      walk.notes.add(NoteKind::unresolved_link, item.line,
                     "no geometry of this file has the id that " + target + " points to");
    } else if (std::find(walk.open.begin(), walk.open.end(), i) != walk.open.end()) {
      walk.notes.add(NoteKind::unresolved_link, item.line, "a circle of links: " + target);
    } else {
      walk.open.push_back(i);
      append(found->second.begin, found->second.end, reversed != found->second.reversed, walk);
      walk.open.pop_back();
    }
  }
}

}  // namespace blockrand::importers::reference
