#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <kerf/schema/recording_file.h>

namespace kerf::bench {

/// When the rows of a recording are: the time of the first row of every bucket of 64 and the latest time up
/// to its end, so that a time is found though the rows of an import may lie irregularly or go back. And where
/// rows are missing.
class RowIndex {
 public:
  static constexpr std::size_t max_gaps = 2000;
  /// Gives the times of the rows from `first_row` on, as many as there is room for.
  using ReadTimes = std::function<void(std::uint64_t first_row, std::span<double> time_s)>;

  /// Reads times, ticks and flags once. @param go_on is told after every so many rows
  /// @throws whatever `go_on` does.
  [[nodiscard]] static RowIndex of(const schema::RecordingFile& file,
                                   const std::function<void(std::uint64_t rows)>& go_on = {});
  /// Of numbers() as they were built; `owner` keeps them. @throws std::invalid_argument if they do not fit.
  RowIndex(std::uint64_t rows, std::span<const double> numbers, std::shared_ptr<const void> owner);

  [[nodiscard]] std::span<const double> numbers() const noexcept { return numbers_; }

  /// The first row that is at `time_s` or later; the number of rows if none is.
  [[nodiscard]] std::uint64_t row_at(double time_s, const ReadTimes& read) const;
  /// Of a row with which a bucket begins.
  [[nodiscard]] double time_of_bucket(std::uint64_t row) const;

  /// From the row before to the row after: where the tick jumps, or a flag tells of missed deadlines or lost
  /// rows. Those that touch are one stretch. The first of them.
  [[nodiscard]] std::span<const std::pair<double, double>> gaps() const noexcept { return gaps_; }
  /// Each by itself, as figures_of() counts them.
  [[nodiscard]] std::uint64_t gaps_in_all() const noexcept { return gaps_in_all_; }

 private:
  std::uint64_t rows_;
  std::span<const double> numbers_;
  std::shared_ptr<const void> owner_;
  std::span<const double> first_s_;   ///< of each bucket
  std::span<const double> latest_s_;  ///< up to the end of each bucket; -inf before the first finite time
  std::vector<std::pair<double, double>> gaps_;
  std::uint64_t gaps_in_all_ = 0;
};

}  // namespace kerf::bench
