#include "pipeline/outputs/explain/find_places.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <tuple>
#include <unordered_map>
#include <unordered_set>

#include "pipeline/base/error.h"
#include "pipeline/outputs/area_folders.h"
#include "pipeline/outputs/explain/find_explanation.h"
#include "pipeline/outputs/explain/place_words.h"

namespace blockrand::outputs {
namespace {

constexpr std::size_t kMostNearest = 5, kMostWords = 24;
/// Letters that the beginning of a word needs to stand for the word.
constexpr std::size_t kLeastBeginning = 3;
/// A digit word as long as this may be a postcode.
constexpr std::size_t kPostcode = 4;

/// Kinds of answers, the best first.
enum class Answer { whole, half, beside, words };

template <class Range, class Value>
bool holds(const Range& range, const Value& value) {
  return std::find(std::begin(range), std::end(range), value) != std::end(range);
}

bool may_be_postcode(std::string_view word) {
  return word.size() >= kPostcode && word.find_first_not_of("0123456789") == std::string_view::npos;
}

struct Candidate {
  Place place;
  Answer answer = Answer::whole;
  std::size_t local = 0;               ///< words that its own postcode and town have
  std::vector<std::string> unknown{};  ///< words that must be a town's of another house
};

/// Edits between two texts, insertions, deletions and replacements of bytes; at most `limit` + 1.
std::size_t edits(std::string_view a, std::string_view b, std::size_t limit) {
  if (a.size() > b.size() + limit || b.size() > a.size() + limit) return limit + 1;
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t above = row[j];
      row[j] = std::min({above + 1, row[j - 1] + 1, diagonal + (a[i - 1] == b[j - 1] ? 0 : 1)});
      diagonal = above;
    }
  }
  return row[b.size()];
}

class Search {
 public:
  explicit Search(std::string_view text) : words_(place_words(text)) {
    if (words_.size() > kMostWords) words_.resize(kMostWords);
    for (std::size_t i = 0; i < words_.size(); ++i)
      for (std::size_t end = i + 1; end <= words_.size(); ++end) runs_[joined(words_, i, end)].emplace_back(i, end);
  }

  void look_at(const Place& place) {
    if (words_.empty()) return;
    const PlaceAddresses addresses = place_addresses(place.addresses);
    localities_.insert(addresses.locality.begin(), addresses.locality.end());
    std::optional<Candidate> best;
    const auto offer = [&](Candidate candidate) {
      const auto key = [](const Candidate& c) { return std::tuple(c.answer, c.unknown.size()); };
      if (!best || key(candidate) < key(*best)) best = std::move(candidate);
    };
    for (const PlaceAddress& address : addresses.all) by_address(place, address, addresses.locality, offer);
    if (!place.name.empty()) by_name(place, addresses, offer);
    if (!best) by_words(place, addresses, offer);
    if (best) candidates_.push_back(std::move(*best));
  }

  FoundPlaces result() {
    std::erase_if(candidates_, [&](const Candidate& c) {
      return std::any_of(c.unknown.begin(), c.unknown.end(),
                         [&](const auto& word) { return !localities_.contains(word); });
    });
    FoundPlaces out;
    const auto rank = [](const Candidate& c) {
      return std::tuple(c.answer, c.place.top <= 0, -static_cast<long>(c.local));
    };
    const auto best = std::min_element(candidates_.begin(), candidates_.end(),
                                       [&](const Candidate& a, const Candidate& b) { return rank(a) < rank(b); });
    if (best == candidates_.end()) return out;
    out.exact = best->answer != Answer::beside;
    for (const Candidate& c : candidates_)
      if (rank(c) == rank(*best)) out.places.push_back(c.place);
    return out;
  }

  // ---- what may have been meant, looked for when nothing was found

  void look_near(const Place& place) {
    const std::string key = asked_key();
    const std::size_t limit = std::max<std::size_t>(2, key.size() / 3);
    const auto far = [&](const std::string& there) {
      if (there.empty() || key.empty()) return limit + 1;
      if (there == key) return std::size_t{0};
      if (there.starts_with(key) && key.size() >= kLeastBeginning) return std::size_t{1};
      return edits(key, there, limit);
    };
    for (const PlaceAddress& address : place_addresses(place.addresses).all) {
      const std::size_t distance = far(address.street);
      if (distance > limit) continue;
      Near& near = near_[{distance, address.street}];
      if (near.shown.empty()) near.shown = address.shown_street;
      near.numbers.insert(address.numbers.begin(), address.numbers.end());
    }
    if (place.name.empty()) return;
    const std::vector<std::string> name = place_words(place.name);
    if (const std::string there = joined(name, 0, name.size()); far(there) <= limit)
      near_[{far(there), there}].shown = place.name;
  }

  std::vector<std::string> nearest() const {
    std::vector<std::string> out;
    const auto wanted = std::find_if(words_.begin(), words_.end(),
                                     [&](const std::string& w) { return is_number(w) && !may_be_postcode(w); });
    const auto add = [&](std::string text) {
      if (out.size() < kMostNearest && !holds(out, text)) out.push_back(std::move(text));
    };
    if (wanted == words_.end()) {
      for (const auto& [key, near] : near_) add(near.shown);
      return out;
    }
    for (const auto& [key, near] : near_) {
      std::vector<std::string> numbers(near.numbers.begin(), near.numbers.end());
      if (key.first == 0 && !numbers.empty()) {  // the right street without this number: its next houses
        std::stable_sort(numbers.begin(), numbers.end(), [&](const std::string& a, const std::string& b) {
          return std::labs(first_number(a) - first_number(*wanted)) <
                 std::labs(first_number(b) - first_number(*wanted));
        });
        for (const std::string& number : numbers) add(near.shown + " " + number);
        return out;
      }
      for (const std::string& number : numbers)  // another street: its house of this number
        if (match_numbers(*wanted, number) == NumberMatch::same) add(near.shown + " " + number);
    }
    if (out.empty())
      for (const auto& [key, near] : near_) add(near.shown);
    return out;
  }

 private:
  struct Near {
    std::string shown;
    std::set<std::string> numbers;
  };

  template <class Offer>
  void by_address(const Place& place, const PlaceAddress& address, const std::vector<std::string>& locality,
                  Offer&& offer) {
    const auto runs = address.street.empty() ? runs_.end() : runs_.find(address.street);
    if (runs == runs_.end()) return;
    for (const auto& [first, end] : runs->second) {
      Candidate c{.place = place};
      std::vector<std::string> wanted;
      for (std::size_t i = 0; i < words_.size(); ++i) {
        if (i >= first && i < end) continue;
        if (holds(locality, words_[i]))
          ++c.local;
        else if (is_number(words_[i]))
          wanted.push_back(words_[i]);
        else
          c.unknown.push_back(words_[i]);
      }
      if (wanted.size() > 1)
        std::erase_if(wanted, [&](const std::string& w) {
          if (!may_be_postcode(w)) return false;
          c.unknown.push_back(w);
          return true;
        });
      NumberMatch match = wanted.empty() ? NumberMatch::same : NumberMatch::none;
      for (const std::string& w : wanted)
        for (const std::string& n : address.numbers) match = std::max(match, match_numbers(w, n));
      if (match == NumberMatch::none) continue;
      c.answer = match == NumberMatch::same   ? Answer::whole
                 : match == NumberMatch::half ? Answer::half
                                              : Answer::beside;
      offer(std::move(c));
    }
  }

  template <class Offer>
  void by_name(const Place& place, const PlaceAddresses& addresses, Offer&& offer) {
    const std::vector<std::string> name = place_words(place.name);
    const auto runs = runs_.find(joined(name, 0, name.size()));
    if (name.empty() || runs == runs_.end()) return;
    const auto& [first, end] = runs->second.front();
    Candidate c{.place = place};
    for (std::size_t i = 0; i < words_.size(); ++i) {
      if (i >= first && i < end) continue;
      if (holds(addresses.locality, words_[i]))
        ++c.local;
      else
        c.unknown.push_back(words_[i]);
    }
    offer(std::move(c));
  }

  /// Every word is one of its name or address, or the beginning of one.
  template <class Offer>
  void by_words(const Place& place, const PlaceAddresses& addresses, Offer&& offer) {
    std::vector<std::string> own = place_words(place.name);
    for (std::string& word : place_words(place.addresses)) own.push_back(std::move(word));
    bool more_than_town = false;
    for (const std::string& word : words_) {
      const bool there = std::any_of(own.begin(), own.end(), [&](const std::string& o) {
        return o == word || (!is_number(word) && word.size() >= kLeastBeginning && o.starts_with(word));
      });
      if (!there) return;
      more_than_town = more_than_town || (!is_number(word) && !holds(addresses.locality, word));
    }
    if (more_than_town) offer(Candidate{.place = place, .answer = Answer::words});
  }

  /// The street or name that was asked for: its words without numbers and towns.
  std::string asked_key() const {
    std::string key;
    for (const std::string& word : words_)
      if (!is_number(word) && !localities_.contains(word)) key += word;
    return key;
  }

  std::vector<std::string> words_;
  /// Each row of neighbouring words, joined, with where it begins and ends.
  std::unordered_map<std::string, std::vector<std::pair<std::size_t, std::size_t>>> runs_;
  std::unordered_set<std::string> localities_;  ///< words of all postcodes and towns met
  std::vector<Candidate> candidates_;
  std::map<std::pair<std::size_t, std::string>, Near> near_;  ///< by distance, street or name
};

/// \param file  for messages
template <class Visit>
void for_each_place(const std::string& file, std::string_view text, Visit&& visit) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::optional<Place> place = read_place(text.substr(0, end));
    if (!place)
      throw base::InputError(file, "",
                             "this line cannot be read: " + std::string(text.substr(0, std::min<std::size_t>(end, 80))),
                             "Build again; 'blockrand validate' lists all damage");
    visit(*place);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

/// Calls `each(visit)` once to find, once more to find what is near. \param each  visits every place
template <class Each>
FoundPlaces searched(std::string_view text, Each&& each) {
  Search search(text);
  each([&](const Place& place) { search.look_at(place); });
  FoundPlaces out = search.result();
  if (!out.places.empty()) return out;
  each([&](const Place& place) { search.look_near(place); });
  out.nearest = search.nearest();
  return out;
}

std::string places_of(const std::string& folder) {
  const std::string path = folder + "/" + kPlacesFile;
  std::ifstream file(path, std::ios::binary);
  if (!file)
    throw base::InputError(path, "", "is missing: an older program made this build, which knows no addresses",
                           "Build again, or ask by id, for example w123");
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

FoundPlaces find_places(const std::string& folder, std::string_view text) {
  check_explained(folder);
  std::vector<std::string> folders;
  for (const std::string& area : area_folders(folder)) {
    check_explained(folder + "/" + area);
    folders.push_back(folder + "/" + area);
  }
  if (folders.empty()) folders.push_back(folder);
  return searched(text, [&](auto&& visit) {
    for (const std::string& each : folders) for_each_place(each + "/" + kPlacesFile, places_of(each), visit);
  });
}

}  // namespace blockrand::outputs
