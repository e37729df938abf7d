#include "pipeline/picture/palette.h"

#include <algorithm>
#include <array>
#include <span>

namespace blockrand::picture {
namespace {

struct Entry {
  std::uint32_t rgb = 0;
  std::uint32_t count = 0;
  int channel(int c) const { return static_cast<int>(rgb >> (16 - 8 * c) & 255u); }
};

/// A group of colours: where it lies in the list, and along which channel it varies most.
struct Group {
  std::size_t begin = 0, end = 0;
  int channel = 0;
  double variance = 0;  ///< sum of squares about the mean along `channel`
  std::array<double, 3> mean{};
};

Group group_of(std::span<const Entry> entries, std::size_t begin, std::size_t end) {
  Group g{begin, end, 0, -1, {}};
  for (int c = 0; c < 3; ++c) {
    double weight = 0, sum = 0, squares = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const double v = entries[i].channel(c), w = entries[i].count;
      weight += w;
      sum += w * v;
      squares += w * v * v;
    }
    g.mean[static_cast<std::size_t>(c)] = sum / weight;
    const double variance = squares - sum * sum / weight;
    if (variance > g.variance) {
      g.variance = variance;
      g.channel = c;
    }
  }
  return g;
}

}  // namespace

PaletteImage reduce_colours(const Image& image, int colours) {
  std::vector<std::uint32_t> all(image.rgb.size() / 3);
  for (std::size_t i = 0; i < all.size(); ++i)
    all[i] = static_cast<std::uint32_t>(image.rgb[i * 3]) << 16 |
             static_cast<std::uint32_t>(image.rgb[i * 3 + 1]) << 8 | image.rgb[i * 3 + 2];
  std::vector<std::uint32_t> sorted = all;
  std::sort(sorted.begin(), sorted.end());
  std::vector<Entry> entries;
  for (const std::uint32_t rgb : sorted) {
    if (entries.empty() || entries.back().rgb != rgb) entries.push_back({rgb, 0});
    ++entries.back().count;
  }
  std::vector<std::uint32_t> distinct(entries.size());
  std::transform(entries.begin(), entries.end(), distinct.begin(), [](const Entry& e) { return e.rgb; });

  std::vector<Group> groups{group_of(entries, 0, entries.size())};
  const auto most = static_cast<std::size_t>(std::clamp(colours, 1, 256));
  while (groups.size() < most) {
    const auto widest = std::max_element(groups.begin(), groups.end(),
                                         [](const Group& a, const Group& b) { return a.variance < b.variance; });
    if (widest->end - widest->begin < 2) break;
    const Group g = *widest;
    const double middle = g.mean[static_cast<std::size_t>(g.channel)];
    const auto first = entries.begin();
    const auto cut =
        std::stable_partition(first + static_cast<std::ptrdiff_t>(g.begin), first + static_cast<std::ptrdiff_t>(g.end),
                              [&](const Entry& e) { return e.channel(g.channel) <= middle; });
    const auto at = static_cast<std::size_t>(cut - first);
    if (at == g.begin || at == g.end) break;
    *widest = group_of(entries, g.begin, at);
    groups.push_back(group_of(entries, at, g.end));
  }

  PaletteImage out;
  std::vector<std::uint8_t> index_of(distinct.size());
  for (const Group& g : groups) {
    const auto channel = [&](std::size_t c) { return static_cast<std::uint8_t>(g.mean[c] + 0.5); };
    for (std::size_t i = g.begin; i < g.end; ++i)
      index_of[static_cast<std::size_t>(std::lower_bound(distinct.begin(), distinct.end(), entries[i].rgb) -
                                        distinct.begin())] = static_cast<std::uint8_t>(out.palette.size());
    out.palette.push_back({channel(0), channel(1), channel(2)});
  }
  out.pixels.resize(all.size());
  for (std::size_t i = 0; i < all.size(); ++i)
    out.pixels[i] = index_of[static_cast<std::size_t>(std::lower_bound(distinct.begin(), distinct.end(), all[i]) -
                                                      distinct.begin())];
  return out;
}

}  // namespace blockrand::picture
