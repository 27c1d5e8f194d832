#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace kerf::fitting::wide {

/// Rows of tissue that is deformed and stiffens, F = alpha exp(k (u - m s)): depths u [m] under a surface
/// that lies m times s further on.
class DeformedRows {
 public:
  void reserve(std::size_t rows);
  void add(double depth_m, double moves, double force_n, double weight);
  /// After the last one: rows that count for nothing, up to a whole packet.
  void end();

  /// r'r, J'r and J'J (upper triangle, row by row) by ln alpha, ln k and s.
  struct Sums {
    double squares = 0.0;
    std::array<double, 3> score{};
    std::array<double, 6> normal{};
  };
  [[nodiscard]] Sums sums(double amplitude_n, double rate_per_m, double shift_m) const noexcept;

  [[nodiscard]] std::size_t size() const noexcept { return count_; }
  [[nodiscard]] double depth(std::size_t i) const { return depth_[i]; }
  [[nodiscard]] double moves(std::size_t i) const { return moves_[i]; }
  [[nodiscard]] double force(std::size_t i) const { return force_[i]; }
  [[nodiscard]] double weight(std::size_t i) const { return weight_[i]; }

 private:
  std::size_t count_ = 0;
  std::vector<double> depth_, moves_, force_, weight_;
};

}  // namespace kerf::fitting::wide
