#include "pipeline/compare/opening_grid.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

namespace blockrand::compare {
namespace {

constexpr double kMargin = 1e-9;  // m. Equal distances may differ by what a rotation of the model rounds.

/// An opening seen along one axis: vertically for rows, horizontally for columns.
struct Extent {
  double low = 0, high = 0;
  double weight = 0;  // what the rows or columns that it joins gain
  double centre() const { return 0.5 * (low + high); }
  double length() const { return high - low; }
};

/// A row or column.
struct Lane {
  std::vector<std::size_t> members;  // indices of openings
  double weight = 0;
  double low = 0, high = 0, centre = 0;  // medians
  double length() const { return high - low; }
};

long long rounded(double v) { return std::llround(v * 1e6); }

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return n % 2 == 1 ? values[n / 2] : 0.5 * (values[n / 2 - 1] + values[n / 2]);
}

double common(double low_a, double high_a, double low_b, double high_b) {
  return std::min(high_a, high_b) - std::max(low_a, low_b);
}

/// Clusters `which` of the extents: the one that gathers most weight around its centre first.
std::vector<Lane> lanes_of(const std::vector<Extent>& extents, std::vector<std::size_t> which, double gap) {
  std::vector<Lane> lanes;
  std::sort(which.begin(), which.end(), [&](std::size_t a, std::size_t b) {
    const auto key = [&](std::size_t i) {
      return std::tuple(rounded(extents[i].centre()), rounded(extents[i].length()), i);
    };
    return key(a) < key(b);
  });
  const auto joins = [&](const Extent& a, const Extent& b) {
    return std::fabs(a.centre() - b.centre()) < gap * std::min(a.length(), b.length()) - kMargin;
  };
  // What an extent may join lies in a stretch of `which`: its size, not that of all, is what a seed costs.
  const auto near = [&](std::size_t at) {
    const Extent& e = extents[which[at]];
    const double reach = gap * e.length();
    const auto from =
        std::lower_bound(which.begin(), which.end(), rounded(e.centre() - reach) - 1,
                         [&](std::size_t i, long long centre) { return rounded(extents[i].centre()) < centre; });
    const auto to =
        std::upper_bound(which.begin(), which.end(), rounded(e.centre() + reach) + 1,
                         [&](long long centre, std::size_t i) { return centre < rounded(extents[i].centre()); });
    return std::pair(static_cast<std::size_t>(from - which.begin()), static_cast<std::size_t>(to - which.begin()));
  };
  using Value = std::pair<long long, long long>;  // weight, and how near its members lie
  std::vector<std::optional<Value>> values(which.size());
  std::vector<bool> taken(which.size(), false);
  const auto value_of = [&](std::size_t at) {
    const Extent& seed = extents[which[at]];
    const auto [from, to] = near(at);
    double weight = 0, spread = 0;
    for (std::size_t k = from; k < to; ++k) {
      const Extent& e = extents[which[k]];
      if (taken[k] || (k != at && !joins(seed, e))) continue;
      weight += e.weight;
      spread += e.weight * std::fabs(e.centre() - seed.centre());
    }
    return Value{rounded(weight), -rounded(spread)};
  };
  for (std::size_t left = which.size(); left > 0;) {
    std::size_t seed = which.size();
    Value best{-1, 0};
    for (std::size_t at = 0; at < which.size(); ++at) {
      if (taken[at]) continue;
      if (!values[at]) values[at] = value_of(at);
      if (seed == which.size() || *values[at] > best) {
        best = *values[at];
        seed = at;
      }
    }
    Lane lane;
    std::vector<std::size_t> members;  // indices into which
    const auto [first, last] = near(seed);
    for (std::size_t k = first; k < last; ++k)
      if (!taken[k] && (k == seed || joins(extents[which[seed]], extents[which[k]]))) members.push_back(k);
    for (const std::size_t k : members) {
      lane.members.push_back(which[k]);
      taken[k] = true;
    }
    left -= members.size();
    // Those that could join a member are worth less now.
    for (std::size_t at = 0; at < which.size(); ++at) {
      if (taken[at] || !values[at]) continue;
      const auto [from, to] = near(at);
      const auto gone = std::lower_bound(members.begin(), members.end(), from);
      if (gone != members.end() && *gone < to) values[at].reset();
    }
    std::vector<double> lows, highs, centres;
    for (const std::size_t i : lane.members) {
      lane.weight += extents[i].weight;
      lows.push_back(extents[i].low);
      highs.push_back(extents[i].high);
      centres.push_back(extents[i].centre());
    }
    lane.low = median(std::move(lows));
    lane.high = median(std::move(highs));
    lane.centre = median(std::move(centres));
    lanes.push_back(std::move(lane));
  }
  return lanes;
}

/// Index of the lane that has most in common with the extent; lanes.size() where none has more than `least`.
std::size_t most_common(const std::vector<Lane>& lanes, const Extent& extent, double least) {
  std::size_t best = lanes.size();
  double most = least;
  for (std::size_t l = 0; l < lanes.size(); ++l) {
    const double length = common(lanes[l].low, lanes[l].high, extent.low, extent.high);
    if (length > most + kMargin) {
      most = length;
      best = l;
    }
  }
  return best;
}

std::optional<double> pitch(const std::vector<Lane>& lanes) {
  if (lanes.size() < 2) return std::nullopt;
  std::vector<double> distances;
  for (std::size_t l = 1; l < lanes.size(); ++l) distances.push_back(lanes[l].centre - lanes[l - 1].centre);
  return median(std::move(distances));
}

void sort_by_place(std::vector<Lane>& lanes) {
  std::sort(lanes.begin(), lanes.end(), [](const Lane& a, const Lane& b) { return a.centre < b.centre; });
}

bool near_a_storey(const std::vector<Lane>& storeys, double centre) {
  return std::any_of(storeys.begin(), storeys.end(),
                     [&](const Lane& s) { return std::fabs(s.centre - centre) < kLeastStoreyPitch - kMargin; });
}

void add_storeys(std::vector<Lane> rows, std::vector<Lane>& storeys) {
  std::sort(rows.begin(), rows.end(), [](const Lane& a, const Lane& b) {
    return std::tuple(-rounded(a.weight), rounded(a.centre)) < std::tuple(-rounded(b.weight), rounded(b.centre));
  });
  for (Lane& row : rows)
    if (!near_a_storey(storeys, row.centre)) storeys.push_back(std::move(row));
}

void find_rows(Facade& facade, double gap) {
  std::vector<FacadeOpening>& openings = facade.openings;
  std::vector<Extent> heights;
  std::vector<std::size_t> windows, doors;
  for (std::size_t i = 0; i < openings.size(); ++i) {
    const double area = (openings[i].right - openings[i].left) * (openings[i].top - openings[i].bottom);
    heights.push_back({openings[i].bottom, openings[i].top, area});
    (openings[i].door ? doors : windows).push_back(i);
  }
  std::vector<Lane> rows = lanes_of(heights, windows, gap), cellars;
  for (auto row = rows.begin(); row != rows.end();) {
    const bool cellar = std::all_of(row->members.begin(), row->members.end(),
                                    [&](std::size_t i) { return openings[i].top <= kCellarTop + kMargin; });
    if (cellar) cellars.push_back(std::move(*row));
    row = cellar ? rows.erase(row) : row + 1;
  }
  std::vector<Lane> storeys;
  add_storeys(std::move(rows), storeys);
  std::vector<std::size_t> lonely;
  for (const std::size_t d : doors)
    if (most_common(storeys, heights[d], 0) == storeys.size()) lonely.push_back(d);
  add_storeys(lanes_of(heights, lonely, gap), storeys);
  if (storeys.empty()) add_storeys(std::move(cellars), storeys);
  sort_by_place(storeys);

  for (std::size_t i = 0; i < openings.size(); ++i) {
    openings[i].row = -1;
    std::size_t row = most_common(storeys, heights[i], openings[i].door ? 0 : 0.5 * heights[i].length());
    if (openings[i].door && row == storeys.size()) {
      double nearest = kLeastStoreyPitch;
      for (std::size_t s = 0; s < storeys.size(); ++s) {
        const double distance = std::fabs(storeys[s].centre - heights[i].centre());
        if (distance < nearest - kMargin) {
          nearest = distance;
          row = s;
        }
      }
    }
    if (row < storeys.size()) openings[i].row = static_cast<int>(row);
  }
  // Those that made a row are in it, however far they stick out of its median.
  for (std::size_t s = 0; s < storeys.size(); ++s)
    for (const std::size_t i : storeys[s].members) openings[i].row = static_cast<int>(s);
  facade.storeys = static_cast<int>(storeys.size());
  facade.storey_pitch = pitch(storeys);
}

/// The rows that show how many axes the facade has.
std::vector<int> telling_rows(const Facade& facade) {
  std::vector<std::size_t> openings_in(static_cast<std::size_t>(facade.storeys), 0);
  for (const FacadeOpening& o : facade.openings)
    if (o.row >= 0) ++openings_in[static_cast<std::size_t>(o.row)];
  std::size_t first = openings_in.size() > 1 ? 1 : 0;
  if (openings_in.size() == 2 && 2 * openings_in[1] <= openings_in[0]) first = 0;
  std::vector<std::size_t> descending(openings_in.begin() + static_cast<std::ptrdiff_t>(first), openings_in.end());
  std::sort(descending.rbegin(), descending.rend());
  if (descending.empty()) return {};
  const std::size_t usual = descending[(descending.size() - 1) / 2];
  std::vector<int> rows;
  for (std::size_t r = first; r < openings_in.size(); ++r)
    if (openings_in[r] == usual) rows.push_back(static_cast<int>(r));
  return rows;
}

void find_columns(Facade& facade, double gap) {
  std::vector<FacadeOpening>& openings = facade.openings;
  const std::vector<int> rows = telling_rows(facade);
  std::vector<Extent> widths;
  std::vector<std::size_t> telling;
  for (std::size_t i = 0; i < openings.size(); ++i) {
    widths.push_back({openings[i].left, openings[i].right, 1});
    openings[i].column = -1;
    if (std::find(rows.begin(), rows.end(), openings[i].row) != rows.end()) telling.push_back(i);
  }
  std::vector<Lane> columns = lanes_of(widths, telling, gap), axes;
  std::sort(columns.begin(), columns.end(), [](const Lane& a, const Lane& b) {
    const auto key = [](const Lane& l) {
      return std::tuple(-rounded(l.weight), rounded(l.length()), rounded(l.centre));
    };
    return key(a) < key(b);
  });
  for (Lane& column : columns) {
    const bool apart = std::none_of(axes.begin(), axes.end(), [&](const Lane& axis) {
      return common(axis.low, axis.high, column.low, column.high) >
             0.5 * std::min(axis.length(), column.length()) + kMargin;
    });
    if (apart && 2 * column.weight >= static_cast<double>(rows.size()) - kMargin) axes.push_back(std::move(column));
  }
  sort_by_place(axes);
  for (std::size_t i = 0; i < openings.size(); ++i) {
    const std::size_t axis = most_common(axes, widths[i], 0);
    if (axis < axes.size()) openings[i].column = static_cast<int>(axis);
  }
  for (std::size_t a = 0; a < axes.size(); ++a)
    for (const std::size_t i : axes[a].members) openings[i].column = static_cast<int>(a);
  facade.axes = static_cast<int>(axes.size());
  facade.axis_pitch = pitch(axes);
}

}  // namespace

void find_rows_and_columns(Facade& facade, const FacadeOptions& options) {
  find_rows(facade, options.row_gap);
  find_columns(facade, options.row_gap);
}

}  // namespace blockrand::compare
