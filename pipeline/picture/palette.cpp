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

/// Groups of entries, which come to stand side by side.
std::vector<Group> split(std::vector<Entry>& entries, int colours) {
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
  return groups;
}

model::Colour mean_of(const Group& g) {
  const auto channel = [&](std::size_t c) { return static_cast<std::uint8_t>(g.mean[c] + 0.5); };
  return {channel(0), channel(1), channel(2)};
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

  const std::vector<Group> groups = split(entries, colours);
  PaletteImage out;
  std::vector<std::uint8_t> index_of(distinct.size());
  for (const Group& g : groups) {
    for (std::size_t i = g.begin; i < g.end; ++i)
      index_of[static_cast<std::size_t>(std::lower_bound(distinct.begin(), distinct.end(), entries[i].rgb) -
                                        distinct.begin())] = static_cast<std::uint8_t>(out.palette.size());
    out.palette.push_back(mean_of(g));
  }
  out.pixels.resize(all.size());
  for (std::size_t i = 0; i < all.size(); ++i)
    out.pixels[i] = index_of[static_cast<std::size_t>(std::lower_bound(distinct.begin(), distinct.end(), all[i]) -
                                                      distinct.begin())];
  return out;
}

void Palette::count(const Image& image, std::uint32_t weight) {
  if (bins_.empty()) bins_.resize(kBins);
  const std::uint8_t* const end = image.rgb.data() + image.rgb.size();
  // Areas are runs of one colour.
  for (const std::uint8_t* p = image.rgb.data(); p < end;) {
    const std::uint8_t* q = p + 3;
    while (q < end && q[0] == p[0] && q[1] == p[1] && q[2] == p[2]) q += 3;
    const std::uint64_t times = static_cast<std::uint64_t>(q - p) / 3 * weight;
    Bin& bin = bins_[bin_of(p)];
    bin.count += times;
    for (std::size_t c = 0; c < 3; ++c) bin.sum[c] += p[c] * times;
    p = q;
  }
}

void Palette::choose(int most) {
  std::vector<Entry> entries;
  for (const Bin& bin : bins_) {
    if (bin.count == 0) continue;
    const auto mean = [&](std::size_t c) {
      return static_cast<std::uint32_t>((bin.sum[c] + bin.count / 2) / bin.count);
    };
    entries.push_back({mean(0) << 16 | mean(1) << 8 | mean(2),
                       static_cast<std::uint32_t>(std::min<std::uint64_t>(bin.count, 0xffffffff))});
  }
  bins_ = {};
  index_.assign(kBins, 0);
  colours_.clear();
  if (entries.empty()) return;
  for (const Group& g : split(entries, most)) {
    colours_.push_back(mean_of(g));
    for (std::size_t i = g.begin; i < g.end; ++i) {
      const std::uint8_t rgb[3] = {static_cast<std::uint8_t>(entries[i].channel(0)),
                                   static_cast<std::uint8_t>(entries[i].channel(1)),
                                   static_cast<std::uint8_t>(entries[i].channel(2))};
      index_[bin_of(rgb)] = static_cast<std::uint16_t>(colours_.size());
    }
  }
}

void Palette::append(const Image& rows, std::vector<std::uint8_t>& pixels) {
  const auto nearest = [&](const std::uint8_t* rgb) {
    int least = 1 << 30;
    std::uint16_t best = 0;
    for (std::size_t i = 0; i < colours_.size(); ++i) {
      const int r = colours_[i].r - rgb[0], g = colours_[i].g - rgb[1], b = colours_[i].b - rgb[2];
      if (const int away = r * r + g * g + b * b; away < least) {
        least = away;
        best = static_cast<std::uint16_t>(i + 1);
      }
    }
    return best;
  };
  const std::uint8_t* const end = rows.rgb.data() + rows.rgb.size();
  for (const std::uint8_t* p = rows.rgb.data(); p < end;) {
    const std::uint8_t* q = p + 3;
    while (q < end && q[0] == p[0] && q[1] == p[1] && q[2] == p[2]) q += 3;
    std::uint16_t& index = index_[bin_of(p)];
    // By the colour that comes first of its bin: rows come in one order.
    if (index == 0) index = nearest(p);
    pixels.insert(pixels.end(), static_cast<std::size_t>(q - p) / 3, static_cast<std::uint8_t>(index - 1));
    p = q;
  }
}

}  // namespace blockrand::picture
