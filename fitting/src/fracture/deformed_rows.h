#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace kerf::fitting::wide {

/// Rows of tissue that is deformed and stiffens, F = alpha exp(k (u - m s)): depths u [m] under a surface
/// that lies m times s further on.
class DeformedRows {
 public:
  static constexpr std::size_t in_a_packet = 4;

  void reserve(std::size_t rows) { packets_.reserve(rows / in_a_packet + 1); }
  void add(double depth_m, double moves, double force_n, double weight) {
    const std::size_t lane = count_++ % in_a_packet;
    Packet& packet = lane == 0 ? packets_.emplace_back() : packets_.back();
    packet.depth[lane] = depth_m;
    packet.moves[lane] = moves;
    packet.force[lane] = force_n;
    packet.weight[lane] = weight;
  }

  /// r'r, J'r and J'J (upper triangle, row by row) by ln alpha, ln k and s.
  struct Sums {
    double squares = 0.0;
    std::array<double, 3> score{};
    std::array<double, 6> normal{};
  };
  [[nodiscard]] Sums sums(double amplitude_n, double rate_per_m, double shift_m) const noexcept;

  [[nodiscard]] std::size_t size() const noexcept { return count_; }
  [[nodiscard]] double depth(std::size_t i) const { return packets_[i / in_a_packet].depth[i % in_a_packet]; }
  [[nodiscard]] double moves(std::size_t i) const { return packets_[i / in_a_packet].moves[i % in_a_packet]; }
  [[nodiscard]] double force(std::size_t i) const { return packets_[i / in_a_packet].force[i % in_a_packet]; }
  [[nodiscard]] double weight(std::size_t i) const {
    return packets_[i / in_a_packet].weight[i % in_a_packet];
  }

  /// Rows side by side; those that the last one lacks count for nothing.
  struct Packet {
    std::array<double, in_a_packet> depth{}, moves{}, force{}, weight{};
  };

 private:
  std::size_t count_ = 0;
  std::vector<Packet> packets_;
};

}  // namespace kerf::fitting::wide
