#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "kerf/models/lattice.h"

namespace kerf::models {

// The cells around a point are numbered counter-clockwise from the south-west one; the point is corner (i +
// 2) % 4 of cell i. Within a cell, corners i and i ^ 1 share a side along x, i and 3 - i one along y, i and i
// ^ 2 a diagonal.

template <typename Real>
std::array<int, 4> Lattice<Real>::cells_around(int point) const noexcept {
  const int column = point % options_.columns, row = point / options_.columns;
  const auto living_or_none = [&](int c, int r) {
    if (c < 0 || c >= cell_columns_ || r < 0 || r >= options_.rows - 1) return -1;
    return corner(cell(c, r), 0) >= 0 ? cell(c, r) : -1;
  };
  return {living_or_none(column - 1, row - 1), living_or_none(column, row - 1), living_or_none(column, row),
          living_or_none(column - 1, row)};
}

/// For each of the cells around a point the first cell of its fan, or -1.
template <typename Real>
std::array<int, 4> Lattice<Real>::fans(const std::array<int, 4>& around) const noexcept {
  const auto uncut = [&](const std::vector<std::uint8_t>& cut, std::size_t owner) {
    return around[owner] >= 0 && cut[index(around[owner])] == 0;
  };
  const std::array<bool, 4> joined_to_next{
      uncut(cut_right_, 0) && around[1] >= 0, uncut(cut_up_, 1) && around[2] >= 0,
      uncut(cut_right_, 3) && around[2] >= 0, uncut(cut_up_, 0) && around[3] >= 0};
  std::array<int, 4> fan{};
  for (int i = 0; i < 4; ++i) fan[index(i)] = around[index(i)] >= 0 ? i : -1;
  for (std::size_t i = 0; i < 4; ++i) {
    if (!joined_to_next[i]) continue;
    const auto [first, second] = std::minmax(fan[i], fan[(i + 1) % 4]);
    std::replace(fan.begin(), fan.end(), int{second}, int{first});
  }
  return fan;
}

/// Gives each fan of a point its own node, after a side or a cell there has gone.
template <typename Real>
void Lattice<Real>::split(int point) noexcept {
  const std::array<int, 4> around = cells_around(point);
  const std::array<int, 4> fan = fans(around);
  std::array<bool, 4> in_use{}, given{};
  for (int i = 0; i < 4; ++i) {
    if (fan[index(i)] >= 0) in_use[index(corner(around[index(i)], (i + 2) % 4) / points_)] = true;
  }
  for (int slot = 0; slot < 4; ++slot) {
    const std::size_t node = index(slot * points_ + point);
    if (corners_[node] != 0) --nodes_;
    corners_[node] = 0;
    if (!in_use[index(slot)]) ux_[node] = uy_[node] = vx_[node] = vy_[node] = Real(0);
  }
  for (int first = 0; first < 4; ++first) {
    if (fan[index(first)] != first) continue;
    const int old = corner(around[index(first)], (first + 2) % 4);
    int own = old;
    if (given[index(old / points_)]) {
      const auto unused = std::find(in_use.begin(), in_use.end(), false) - in_use.begin();
      own = static_cast<int>(unused) * points_ + point;
      for (auto* array : {&ux_, &uy_, &vx_, &vy_}) (*array)[index(own)] = (*array)[index(old)];
    }
    in_use[index(own / points_)] = given[index(own / points_)] = true;
    ++nodes_;
    for (int i = first; i < 4; ++i) {
      if (fan[index(i)] != first) continue;
      corner_node_[index(4 * around[index(i)] + (i + 2) % 4)] = own;
      if (own >= points_) whole_row_[index(around[index(i)] / cell_columns_)] = 0;
      ++corners_[index(own)];
    }
  }
}

/// Whether the sweep by rows computes the point: free, and all around it as in a whole lattice.
template <typename Real>
bool Lattice<Real>::regular(int point) const noexcept {
  if (pinned_[index(point)] != 0) return false;
  for (const int cell : cells_around(point)) {
    if (cell < 0) return false;
    for (int i = 0; i < 4; ++i) {
      if (corner(cell, i) >= points_) return false;
    }
  }
  return true;
}

template <typename Real>
auto Lattice<Real>::stencil_of(int node) const noexcept -> Stencil {
  Stencil stencil;
  stencil.node = node;
  const int quarters = corners_[index(node)];
  stencil.share = quarters == 0 || held(node) ? Real(0) : Real(4) / static_cast<Real>(quarters);
  const std::array<int, 4> around = cells_around(node % points_);
  for (int i = 0; i < 4; ++i) {
    const int cell = around[index(i)], own = (i + 2) % 4;
    const bool ours = cell >= 0 && corner(cell, own) == node;
    stencil.along_x[index(i)] = ours ? corner(cell, own ^ 1) : node;
    stencil.along_y[index(i)] = ours ? corner(cell, 3 - own) : node;
    stencil.across[index(i)] = ours ? corner(cell, own ^ 2) : node;
  }
  return stencil;
}

template <typename Real>
void Lattice<Real>::refresh(int point) noexcept {
  if (entry_[index(point)] < 0 && regular(point)) return;
  for (int node = point; node < node_limit(); node += points_) {
    int& entry = entry_[index(node)];
    if (entry < 0 && node != point && !alive(node)) continue;
    if (entry < 0) entry = irregular_nodes_++;
    stencils_[index(entry)] = stencil_of(node);
  }
}

template <typename Real>
void Lattice<Real>::refresh_around(int point) noexcept {
  const int column = point % options_.columns, row = point / options_.columns;
  for (int r = std::max(row - 1, 0); r <= std::min(row + 1, options_.rows - 1); ++r) {
    for (int c = std::max(column - 1, 0); c <= std::min(column + 1, options_.columns - 1); ++c) {
      refresh(r * options_.columns + c);
    }
  }
}

template <typename Real>
bool Lattice<Real>::cut_side(int cell, int neighbour) noexcept {
  if (!living(cell) || !living(neighbour)) return false;
  const auto [first, second] = std::minmax(cell, neighbour);
  const bool beside = second == first + 1 && second % cell_columns_ != 0;
  if (!beside && second != first + cell_columns_) return false;
  std::uint8_t& cut = (beside ? cut_right_ : cut_up_)[index(first)];
  if (cut != 0) return false;
  cut = 1;
  // The far end of the side is the upper right point of the first cell.
  const int far = (first / cell_columns_ + 1) * options_.columns + first % cell_columns_ + 1;
  const int near = beside ? far - options_.columns : far - 1;
  for (const int point : {near, far}) split(point);
  for (const int point : {near, far}) refresh_around(point);
  return true;
}

template <typename Real>
bool Lattice<Real>::remove_cell(int cell) noexcept {
  if (!living(cell)) return false;
  const int lower_left = cell / cell_columns_ * options_.columns + cell % cell_columns_;
  const int upper_left = lower_left + options_.columns;
  for (int i = 0; i < 4; ++i) corner_node_[index(4 * cell + i)] = -1;
  whole_row_[index(cell / cell_columns_)] = 0;
  for (const int point : {lower_left, lower_left + 1, upper_left, upper_left + 1}) split(point);
  for (const int point : {lower_left, lower_left + 1, upper_left, upper_left + 1}) refresh_around(point);
  return true;
}

template <typename Real>
bool Lattice<Real>::consistent() const {
  std::vector<int> carried(index(node_limit()));
  for (int cell = 0; cell < cells(); ++cell) {
    for (int i = 0; i < 4; ++i) {
      const int node = corner(cell, i);
      if ((node >= 0) != living(cell) || node < -1 || node >= node_limit()) return false;
      if (node < 0) continue;
      const int column = cell % cell_columns_ + (i == 1 || i == 2 ? 1 : 0);
      const int row = cell / cell_columns_ + (i >= 2 ? 1 : 0);
      if (node % points_ != row * options_.columns + column) return false;
      ++carried[index(node)];
    }
  }
  int living_nodes = 0;
  for (int node = 0; node < node_limit(); ++node) {
    const std::size_t n = index(node);
    living_nodes += alive(node) ? 1 : 0;
    if (carried[n] != corners_[n]) return false;
    if (!alive(node) && (ux_[n] != 0 || uy_[n] != 0 || vx_[n] != 0 || vy_[n] != 0)) return false;
    if (pull_x_[n] != 0.0 || pull_y_[n] != 0.0) return false;
    if (entry_[n] >= irregular_nodes_) return false;
    if (entry_[n] >= 0 && stencils_[index(entry_[n])] != stencil_of(node)) return false;
    const bool needs_entry = (alive(node) || node < points_) && (node >= points_ || !regular(node));
    if (needs_entry && entry_[n] < 0) return false;
  }
  if (living_nodes != nodes_) return false;
  for (int cell = 0; cell < cells(); ++cell) {
    for (int i = 0; i < 4 && whole_row_[index(cell / cell_columns_)] != 0; ++i) {
      if (corner(cell, i) < 0 || corner(cell, i) >= points_) return false;
    }
  }
  for (int point = 0; point < points_; ++point) {
    const std::array<int, 4> around = cells_around(point), fan = fans(around);
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < i; ++j) {
        if (fan[index(i)] < 0 || fan[index(j)] < 0) continue;
        const bool one_node = corner(around[index(i)], (i + 2) % 4) == corner(around[index(j)], (j + 2) % 4);
        if (one_node != (fan[index(i)] == fan[index(j)])) return false;
      }
    }
  }
  return true;
}

// Member by member, as lattice.cpp instantiates the class.
template std::array<int, 4> Lattice<float>::cells_around(int) const noexcept;
template std::array<int, 4> Lattice<float>::fans(const std::array<int, 4>&) const noexcept;
template void Lattice<float>::split(int) noexcept;
template bool Lattice<float>::regular(int) const noexcept;
template Lattice<float>::Stencil Lattice<float>::stencil_of(int) const noexcept;
template void Lattice<float>::refresh(int) noexcept;
template void Lattice<float>::refresh_around(int) noexcept;
template bool Lattice<float>::cut_side(int, int) noexcept;
template bool Lattice<float>::remove_cell(int) noexcept;
template bool Lattice<float>::consistent() const;
template std::array<int, 4> Lattice<double>::cells_around(int) const noexcept;
template std::array<int, 4> Lattice<double>::fans(const std::array<int, 4>&) const noexcept;
template void Lattice<double>::split(int) noexcept;
template bool Lattice<double>::regular(int) const noexcept;
template Lattice<double>::Stencil Lattice<double>::stencil_of(int) const noexcept;
template void Lattice<double>::refresh(int) noexcept;
template void Lattice<double>::refresh_around(int) noexcept;
template bool Lattice<double>::cut_side(int, int) noexcept;
template bool Lattice<double>::remove_cell(int) noexcept;
template bool Lattice<double>::consistent() const;

}  // namespace kerf::models
