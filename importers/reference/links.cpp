#include "importers/reference/links.h"

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
  std::vector<Face> faces;
  const std::size_t none = items_.size();
  std::vector<Step> way{{begin, end, false, none}};  // no calls: chains of links may be as long as the file
  while (!way.empty()) {
    Step& step = way.back();
    if (step.next >= step.end || exhausted_) {
      if (step.link != none) items_[step.link].open = false;
      way.pop_back();
      continue;
    }
    Item& item = items_[step.next++];
    if (++visits_ > kFreeVisits + kVisitsPerItem * items_.size()) {
      notes.add(NoteKind::unresolved_link, item.line, "links multiply without end");
      exhausted_ = true;
      continue;
    }
    const bool reversed = item.reversed != step.turn;
    if (item.polygon != kNone) {
      faces.push_back({item.polygon, reversed});
      continue;
    }
    const std::string& target = targets_[item.link];
    const auto found = target.size() > 1 && target[0] == '#' ? names_.find(target.substr(1)) : names_.end();
    if (found == names_.end()) {
      notes.add(NoteKind::unresolved_link, item.line,
                "no geometry of this file has the id that " + target + " points to");
    } else if (item.open) {
      notes.add(NoteKind::unresolved_link, item.line, "a circle of links: " + target);
    } else {
      item.open = true;
      const Range& range = found->second;
      way.push_back({range.begin, range.end, reversed != range.reversed, step.next - 1});
    }
  }
  return faces;
}

}  // namespace blockrand::importers::reference
