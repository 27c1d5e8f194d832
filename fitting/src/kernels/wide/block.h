#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

#include "kernels/law_kernel.h"

namespace kerf::fitting::wide {

/// A stretch of a run in columns, and what a law gives along it: its force, and columns of which the
/// derivatives by its parameters are sums. It ends with the last row again, which counts for nothing, where
/// it is no multiple of a packet.
struct Block {  // NOLINT(cppcoreguidelines-pro-type-member-init): filled by take(), and by a law
  static constexpr std::size_t most_rows = 256;
  static constexpr std::size_t most_columns = 13;
  using Column = std::array<double, most_rows>;

  std::size_t count = 0;   ///< of rows
  std::size_t padded = 0;  ///< with those that count for nothing
  bool counts = false;     ///< any of them
  bool all_count = false;
  bool one_period = false;
  const double* period_s = nullptr;
  const double* measured = nullptr;
  const double* weight = nullptr;
  alignas(64) Column penetration;
  Column velocity;
  Column force;
  std::array<Column, most_columns> column;

  /// Rows of a run from `begin` on, as many as there is room for.
  void take(const RunView& run, std::size_t begin);
  /// Moves the rows that count together, with what a law gave there, and leaves out the others.
  void keep_those_that_count(std::size_t columns);

 private:
  std::array<Column, 3> end_;  ///< periods, forces and weights of the last rows of a run
};

/// Products of every two of the columns and the residuals, summed over the rows that count, in the order of
/// the rows, by four places of a packet.
class Products {
 public:
  explicit Products(std::size_t columns) : columns_(columns) {}
  void add(const Block& block);
  [[nodiscard]] Sums sums() const;

 private:
  static constexpr std::size_t most = Block::most_columns + 1;
  std::size_t columns_;
  alignas(64) std::array<std::array<double, 4>, most*(most + 1) / 2> sum_{};
};

}  // namespace kerf::fitting::wide
