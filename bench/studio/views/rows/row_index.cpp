#include "views/rows/row_index.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "views/rows/pyramid.h"

namespace kerf::bench {
namespace {

std::size_t buckets_of(std::uint64_t rows) { return static_cast<std::size_t>((rows + bucket - 1) / bucket); }

/// Some rows of what tells when they were.
struct RowTimes {
  std::vector<double> time_s;
  std::vector<std::uint64_t> tick;
  std::vector<std::uint32_t> flags;  ///< zeros where there are none

  void read(const schema::RecordingFile& file, std::uint64_t first, std::size_t rows) {
    time_s.resize(rows);
    tick.resize(rows);
    flags.assign(file.has_flags() ? rows : 0, 0);
    file.read(schema::Column::time, first, rows, time_s);
    file.read_ticks(first, tick);
    if (file.has_flags()) file.read_flags(first, flags);
    flags.resize(rows);
  }
};

/// Gathers gaps row by row.
class GapFinder {
 public:
  void add(const RowTimes& rows) {
    constexpr std::uint32_t missing = schema::flag_missed_deadline | schema::flag_rows_lost;
    for (std::size_t i = 0; i < rows.tick.size(); ++i) {
      const bool is_gap = rows.tick[i] > last_tick_ && rows.tick[i] - last_tick_ > 1;
      if (!is_first_ && (is_gap || (rows.flags[i] & missing) != 0)) add_gap(last_s_, rows.time_s[i]);
      was_gap_ = !is_first_ && (is_gap || (rows.flags[i] & missing) != 0);
      is_first_ = false;
      last_tick_ = rows.tick[i];
      last_s_ = rows.time_s[i];
    }
  }
  void append_to(std::vector<double>& numbers) const {
    numbers.push_back(static_cast<double>(in_all_));
    numbers.insert(numbers.end(), ends_.begin(), ends_.end());
  }

 private:
  /// Those of neighbouring rows are drawn as one stretch, and counted each, as figures_of() does.
  void add_gap(double from_s, double to_s) {
    ++in_all_;
    const bool has_room = ends_.size() < 2 * RowIndex::max_gaps;
    if (was_gap_ && is_last_kept_) {
      ends_.back() = to_s;
      return;
    }
    is_last_kept_ = has_room;
    if (!has_room) return;
    ends_.push_back(from_s);
    ends_.push_back(to_s);
  }

  std::vector<double> ends_;
  std::uint64_t in_all_ = 0;
  std::uint64_t last_tick_ = 0;
  double last_s_ = 0.0;
  bool is_first_ = true;
  bool was_gap_ = false;
  bool is_last_kept_ = false;
};

}  // namespace

RowIndex RowIndex::of(const schema::RecordingFile& file,
                      const std::function<void(std::uint64_t rows)>& go_on) {
  const std::size_t buckets = buckets_of(file.rows());
  const auto numbers = std::make_shared<std::vector<double>>(2 * buckets);
  double latest = -std::numeric_limits<double>::infinity();
  RowTimes rows;
  GapFinder gaps;
  constexpr std::size_t rows_at_once = PyramidBuilder::rows_at_once;
  for (std::uint64_t first = 0; first < file.rows(); first += rows_at_once) {
    rows.read(file, first,
              static_cast<std::size_t>(std::min<std::uint64_t>(rows_at_once, file.rows() - first)));
    gaps.add(rows);
    if (go_on) go_on(rows.time_s.size());
    for (std::size_t i = 0; i < rows.time_s.size(); ++i) {
      const auto at = static_cast<std::size_t>(first + i) / bucket;
      if (i % bucket == 0) (*numbers)[at] = rows.time_s[i];
      if (rows.time_s[i] > latest && std::isfinite(rows.time_s[i])) latest = rows.time_s[i];
      (*numbers)[buckets + at] = latest;
    }
  }
  gaps.append_to(*numbers);
  return {file.rows(), *numbers, numbers};
}

RowIndex::RowIndex(std::uint64_t rows, std::span<const double> numbers, std::shared_ptr<const void> owner)
    : rows_(rows), numbers_(numbers), owner_(std::move(owner)) {
  const std::size_t buckets = buckets_of(rows);
  const std::size_t ends = numbers.size() - std::min(numbers.size(), 2 * buckets + 1);
  if (numbers.size() < 2 * buckets + 1 || ends % 2 != 0 || ends > 2 * max_gaps ||
      !(numbers[2 * buckets] >= 0.5 * static_cast<double>(ends) && numbers[2 * buckets] <= 1e18)) {
    throw std::invalid_argument("an index of rows whose parts do not fit together");
  }
  first_s_ = numbers.first(buckets);
  latest_s_ = numbers.subspan(buckets, buckets);
  gaps_in_all_ = static_cast<std::uint64_t>(numbers[2 * buckets]);
  for (std::size_t at = 2 * buckets + 1; at < numbers.size(); at += 2) {
    gaps_.emplace_back(numbers[at], numbers[at + 1]);
  }
}

std::uint64_t RowIndex::row_at(double time_s, const ReadTimes& read) const {
  const auto found = std::lower_bound(latest_s_.begin(), latest_s_.end(), time_s);
  if (found == latest_s_.end()) return rows_;
  const std::uint64_t first = static_cast<std::uint64_t>(found - latest_s_.begin()) * bucket;
  std::array<double, bucket> times{};
  const auto within =
      std::span(times).first(static_cast<std::size_t>(std::min<std::uint64_t>(bucket, rows_ - first)));
  read(first, within);
  const auto row = std::find_if(within.begin(), within.end(), [&](double at_s) { return at_s >= time_s; });
  return first + static_cast<std::uint64_t>(row - within.begin());
}

double RowIndex::time_of_bucket(std::uint64_t row) const {
  return first_s_[static_cast<std::size_t>(row / bucket)];
}

}  // namespace kerf::bench
