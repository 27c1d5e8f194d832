#include "views/rows/pyramid.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include "views/rows/extremes.h"

namespace kerf::bench {
namespace {

constexpr std::size_t fan = MinMaxPyramid::buckets_a_bucket;

/// Buckets of each level, the finest first; the last has one, or none without a row.
std::vector<std::size_t> level_sizes(std::uint64_t rows) {
  std::vector<std::size_t> sizes{static_cast<std::size_t>((rows + bucket - 1) / bucket)};
  while (sizes.back() > 1) sizes.push_back((sizes.back() + fan - 1) / fan);
  return sizes;
}

/// Extremes of each column of a whole bucket. So many rows at a time that the compiler keeps as many
/// extremes apart as fill its registers.
template <std::size_t width>
void add_bucket(const double* values, std::array<double, width>& smallest,
                std::array<double, width>& largest) {
  constexpr std::size_t together = width == 1 ? 8 : width <= 3 ? 4 : 2;
  constexpr std::size_t lanes = together * width;
  std::array<double, lanes> low{};
  std::array<double, lanes> high{};
  low.fill(std::numeric_limits<double>::infinity());
  high.fill(-std::numeric_limits<double>::infinity());
  for (std::size_t at = 0; at < bucket * width; at += lanes) {
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const double value = values[at + lane];
      const double finite = value + (value - value);  // else NaN, with which no comparison holds
      low[lane] = finite < low[lane] ? finite : low[lane];
      high[lane] = finite > high[lane] ? finite : high[lane];
    }
  }
  for (std::size_t column = 0; column < width; ++column) {
    smallest[column] = low[column];
    largest[column] = high[column];
    for (std::size_t lane = column + width; lane < lanes; lane += width) {
      smallest[column] = std::min(smallest[column], low[lane]);
      largest[column] = std::max(largest[column], high[lane]);
    }
  }
}

/// Where the finest level of each column is written to.
using Finest = std::vector<std::pair<float*, float*>>;

template <std::size_t width>
void add_buckets(std::span<const double> values, std::size_t first_bucket, const Finest& finest) {
  std::array<double, width> smallest{};
  std::array<double, width> largest{};
  for (std::size_t at = 0, to = first_bucket; at < values.size(); at += bucket * width, ++to) {
    add_bucket<width>(values.data() + at, smallest, largest);
    for (std::size_t column = 0; column < width; ++column) {
      RunningExtremes extremes;
      extremes.add(smallest[column]);
      extremes.add(largest[column]);
      finest[column].first[to] = extremes.smallest();
      finest[column].second[to] = extremes.largest();
    }
  }
}

/// Any number of rows and columns, one by one.
void add_slowly(std::span<const double> values, std::size_t width, std::size_t to, const Finest& finest) {
  for (std::size_t column = 0; column < width; ++column) {
    RunningExtremes extremes;
    for (std::size_t at = column; at < values.size(); at += width) extremes.add(values[at]);
    finest[column].first[to] = extremes.smallest();
    finest[column].second[to] = extremes.largest();
  }
}

void build_coarser_levels(std::uint64_t rows, float* numbers) {
  const auto sizes = level_sizes(rows);
  float* finer = numbers;
  for (std::size_t level = 1; level < sizes.size(); ++level) {
    float* const coarser = finer + 2 * sizes[level - 1];
    for (std::size_t to = 0; to < sizes[level]; ++to) {
      RunningExtremes extremes;
      const std::size_t end = std::min((to + 1) * fan, sizes[level - 1]);
      for (std::size_t from = to * fan; from < end; ++from) {
        extremes.add_bucket(finer[from], finer[sizes[level - 1] + from]);
      }
      coarser[to] = extremes.smallest();
      coarser[sizes[level] + to] = extremes.largest();
    }
    finer = coarser;
  }
}

/// Rows that buckets do not cover, read a window at a time: of views from near, neighbouring columns share
/// it.
class RawRows {
 public:
  RawRows(const MinMaxPyramid::ReadRows& read, std::uint64_t end_row, std::uint64_t rows_a_window)
      : read_(read), end_row_(end_row), rows_a_window_(rows_a_window) {}

  void add(std::uint64_t first, std::uint64_t end, RunningExtremes& extremes) {
    while (first < end) {
      if (first < begin_ || first >= begin_ + values_.size()) load(first);
      const std::uint64_t until = std::min<std::uint64_t>(end, begin_ + values_.size());
      for (; first < until; ++first) extremes.add(values_[static_cast<std::size_t>(first - begin_)]);
    }
  }

 private:
  void load(std::uint64_t first) {
    begin_ = first;
    values_.resize(static_cast<std::size_t>(std::min(rows_a_window_, end_row_ - first)));
    read_(first, values_);
  }

  const MinMaxPyramid::ReadRows& read_;
  std::uint64_t end_row_;
  std::uint64_t rows_a_window_;
  std::uint64_t begin_ = 0;
  std::vector<double> values_;
};

void check(std::span<const std::uint64_t> boundaries, std::uint64_t rows) {
  if (!boundaries.empty() &&
      (!std::is_sorted(boundaries.begin(), boundaries.end()) || boundaries.back() > rows)) {
    throw std::out_of_range(fmt::format("columns beyond the {} rows there are", rows));
  }
}

}  // namespace

std::size_t MinMaxPyramid::size_of(std::uint64_t rows) {
  std::size_t numbers = 0;
  for (const std::size_t size : level_sizes(rows)) numbers += 2 * size;
  return numbers;
}

MinMaxPyramid::MinMaxPyramid(std::uint64_t rows, std::span<const float> numbers,
                             std::shared_ptr<const void> owner)
    : rows_(rows), numbers_(numbers), owner_(std::move(owner)) {
  if (numbers.size() != size_of(rows)) {
    throw std::invalid_argument(
        fmt::format("a pyramid over {} rows has {} numbers, not {}", rows, size_of(rows), numbers.size()));
  }
  for (const std::size_t size : level_sizes(rows)) {
    levels_.push_back({.smallest = numbers.first(size), .largest = numbers.subspan(size, size)});
    numbers = numbers.subspan(2 * size);
  }
}

TraceView::Extremes MinMaxPyramid::view(std::span<const std::uint64_t> boundaries,
                                        const ReadRows& read) const {
  check(boundaries, rows_);
  TraceView::Extremes view;
  if (boundaries.size() < 2) return view;
  const std::uint64_t span = boundaries.back() - boundaries.front();
  constexpr std::uint64_t near = 4 * bucket;
  constexpr std::uint64_t many_rows = 8192;
  RawRows raw(read, boundaries.back(), span / (boundaries.size() - 1) < near ? many_rows : bucket);
  for (std::size_t column = 0; column + 1 < boundaries.size(); ++column) {
    const std::uint64_t first = boundaries[column];
    const std::uint64_t end = boundaries[column + 1];
    RunningExtremes extremes;
    auto from = static_cast<std::size_t>((first + bucket - 1) / bucket);
    // The last bucket of all may be shorter.
    auto until = static_cast<std::size_t>(end == rows_ ? (end + bucket - 1) / bucket : end / bucket);
    if (from >= until) {
      raw.add(first, end, extremes);
    } else {
      raw.add(first, std::uint64_t{from} * bucket, extremes);
      raw.add(std::uint64_t{until} * bucket, end, extremes);
      for (std::size_t level = 0; from < until; ++level, from /= fan, until /= fan) {
        const auto take = [&](std::size_t at) {
          extremes.add_bucket(levels_[level].smallest[at], levels_[level].largest[at]);
        };
        while (from < until && (from % fan != 0 || level + 1 == levels_.size())) take(from++);
        while (from < until && until % fan != 0) take(--until);
      }
    }
    view.smallest.push_back(extremes.smallest());
    view.largest.push_back(extremes.largest());
  }
  return view;
}

TraceView::Extremes MinMaxPyramid::view(std::uint64_t first_row, std::uint64_t end_row, std::size_t columns,
                                        const ReadRows& read) const {
  return view(column_boundaries(first_row, end_row, columns), read);
}

PyramidBuilder::PyramidBuilder(std::uint64_t rows, std::size_t width)
    : rows_(rows),
      width_(width),
      numbers_(std::make_shared<std::vector<float>>(width * MinMaxPyramid::size_of(rows))) {}

void PyramidBuilder::add(std::span<const double> values) {
  const std::size_t rows = values.size() / width_;
  if (added_ % bucket != 0 || rows * width_ != values.size() || rows > rows_ - added_) {
    throw std::invalid_argument("rows that do not begin with a bucket, or too many");
  }
  Finest finest;
  const std::size_t buckets = level_sizes(rows_).front();
  for (std::size_t column = 0; column < width_; ++column) {
    float* const smallest = numbers_->data() + column * MinMaxPyramid::size_of(rows_);
    finest.emplace_back(smallest, smallest + buckets);
  }
  const auto to = static_cast<std::size_t>(added_ / bucket);
  const std::size_t whole = rows / bucket;
  const auto in_buckets = values.first(whole * bucket * width_);
  switch (width_) {
    case 1:
      add_buckets<1>(in_buckets, to, finest);
      break;
    case 2:
      add_buckets<2>(in_buckets, to, finest);
      break;
    case 3:
      add_buckets<3>(in_buckets, to, finest);
      break;
    case 4:
      add_buckets<4>(in_buckets, to, finest);
      break;
    case 5:
      add_buckets<5>(in_buckets, to, finest);
      break;
    case 6:
      add_buckets<6>(in_buckets, to, finest);
      break;
    default:
      throw std::invalid_argument("more columns side by side than a recording has axes");
  }
  if (rows % bucket != 0) add_slowly(values.subspan(in_buckets.size()), width_, to + whole, finest);
  added_ += rows;
}

Pyramids PyramidBuilder::finish() && {
  if (added_ != rows_) throw std::logic_error("a pyramid that has not seen all its rows");
  const std::size_t each = MinMaxPyramid::size_of(rows_);
  for (std::size_t column = 0; column < width_; ++column) {
    build_coarser_levels(rows_, numbers_->data() + column * each);
  }
  return {rows_, width_, *numbers_, numbers_};
}

Pyramids::Pyramids(std::uint64_t rows, std::size_t width, std::span<const float> numbers,
                   const std::shared_ptr<const void>& owner)
    : numbers_(numbers) {
  const std::size_t each = MinMaxPyramid::size_of(rows);
  if (numbers.size() != width * each) {
    throw std::invalid_argument(fmt::format("{} pyramids over {} rows have {} numbers, not {}", width, rows,
                                            width * each, numbers.size()));
  }
  for (std::size_t column = 0; column < width; ++column) {
    columns_.emplace_back(rows, numbers.subspan(column * each, each), owner);
  }
}

std::vector<std::uint64_t> column_boundaries(std::uint64_t first_row, std::uint64_t end_row,
                                             std::size_t columns) {
  std::vector<std::uint64_t> boundaries;
  if (end_row <= first_row || columns == 0) return boundaries;
  const std::uint64_t rows = end_row - first_row;
  const auto count = std::min<std::uint64_t>(columns, rows);
  // As rows / count and a rest: their product with a column's number could be too large.
  for (std::uint64_t i = 0; i <= count; ++i) {
    boundaries.push_back(first_row + rows / count * i + rows % count * i / count);
  }
  return boundaries;
}

TraceView::Extremes extremes_of_rows(std::span<const double> values, std::size_t width, std::size_t place,
                                     std::uint64_t first_row, std::span<const std::uint64_t> boundaries) {
  TraceView::Extremes view;
  for (std::size_t column = 0; column + 1 < boundaries.size(); ++column) {
    RunningExtremes extremes;
    for (std::uint64_t row = boundaries[column]; row < boundaries[column + 1]; ++row) {
      extremes.add(values[static_cast<std::size_t>(row - first_row) * width + place]);
    }
    view.smallest.push_back(extremes.smallest());
    view.largest.push_back(extremes.largest());
  }
  return view;
}

}  // namespace kerf::bench
