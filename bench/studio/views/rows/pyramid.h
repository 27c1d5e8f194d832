#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "views/trace_view.h"

namespace kerf::bench {

/// The smallest and the largest finite value of every stretch of a column, at ever coarser levels: buckets of
/// 64 rows, then of 8 times as many, and so on until one holds all. With it any zoom costs the same.
///
/// Kept in single precision, rounded outward, so that no spike shrinks. A bucket without a finite value has
/// NaN in both. 64 rows: at 32 a pyramid is twice as large and a view of buckets alone no faster.
class MinMaxPyramid {
 public:
  static constexpr std::size_t rows_a_bucket = 64;
  static constexpr std::size_t buckets_a_bucket = 8;

  /// Gives the rows from `first_row` on, as many as `values` has room for.
  using ReadRows = std::function<void(std::uint64_t first_row, std::span<double> values)>;

  /// Numbers that the pyramid of so many rows consists of.
  [[nodiscard]] static std::size_t size_of(std::uint64_t rows);

  MinMaxPyramid() = default;
  /// Of numbers as built; `owner` keeps them. @throws std::invalid_argument if they are not size_of(rows).
  MinMaxPyramid(std::uint64_t rows, std::span<const float> numbers, std::shared_ptr<const void> owner);

  [[nodiscard]] std::uint64_t rows() const noexcept { return rows_; }
  [[nodiscard]] std::span<const float> numbers() const noexcept { return numbers_; }

  /// Extremes of [boundaries[i], boundaries[i + 1]) for each i: exactly those of the rows. What whole buckets
  /// do not cover is read. @throws std::out_of_range if the boundaries fall or exceed the rows.
  [[nodiscard]] TraceView::Extremes view(std::span<const std::uint64_t> boundaries,
                                         const ReadRows& read) const;
  /// The same of columns of equal width, fewer where there are fewer rows.
  [[nodiscard]] TraceView::Extremes view(std::uint64_t first_row, std::uint64_t end_row, std::size_t columns,
                                         const ReadRows& read) const;

 private:
  struct Level {
    std::span<const float> smallest;
    std::span<const float> largest;
  };

  std::uint64_t rows_ = 0;
  std::span<const float> numbers_;
  std::shared_ptr<const void> owner_;
  std::vector<Level> levels_;
};

/// The pyramids of columns that lie side by side, their numbers one after the other.
class Pyramids {
 public:
  /// Of numbers() as built; `owner` keeps them. @throws std::invalid_argument if they do not fit.
  Pyramids(std::uint64_t rows, std::size_t width, std::span<const float> numbers,
           const std::shared_ptr<const void>& owner);

  [[nodiscard]] const MinMaxPyramid& operator[](std::size_t column) const { return columns_[column]; }
  [[nodiscard]] std::span<const float> numbers() const noexcept { return numbers_; }

 private:
  std::span<const float> numbers_;
  std::vector<MinMaxPyramid> columns_;
};

/// Builds the pyramids of several columns that lie side by side, as the axes of a dataset do, in one pass.
class PyramidBuilder {
 public:
  /// Rows that add() takes at once, but for the last ones.
  static constexpr std::size_t rows_at_once = 64 * MinMaxPyramid::rows_a_bucket;

  PyramidBuilder(std::uint64_t rows, std::size_t width);
  /// The next rows: all their columns, one row after the other. @throws std::invalid_argument if they end
  /// within a bucket and are not the last.
  void add(std::span<const double> values);
  /// @throws std::logic_error if rows are missing.
  [[nodiscard]] Pyramids finish() &&;

 private:
  std::uint64_t rows_;
  std::size_t width_;
  std::uint64_t added_ = 0;
  std::shared_ptr<std::vector<float>> numbers_;
};

/// Where columns of equal width begin, and where the last one ends; at most one column a row.
[[nodiscard]] std::vector<std::uint64_t> column_boundaries(std::uint64_t first_row, std::uint64_t end_row,
                                                           std::size_t columns);

/// The extremes of every `width`-th value from `place` on: of rows whose first is `first_row`, between
/// boundaries that lie within them.
[[nodiscard]] TraceView::Extremes extremes_of_rows(std::span<const double> values, std::size_t width,
                                                   std::size_t place, std::uint64_t first_row,
                                                   std::span<const std::uint64_t> boundaries);

inline constexpr std::size_t bucket = MinMaxPyramid::rows_a_bucket;

}  // namespace kerf::bench
