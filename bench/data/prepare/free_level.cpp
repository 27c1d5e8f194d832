#include "prepare/free_level.h"

#include <cmath>
#include <cstddef>

namespace kerf::bench {
namespace {

/// Weighted moments of the rows on one side of a time, about that time.
struct Moments {
  double m0 = 0.0, m1 = 0.0, m2 = 0.0, y0 = 0.0, y1 = 0.0;

  /// The time moves on by `step_s` (negative: back), and all weights shrink.
  void move(double step_s, double keep) noexcept {
    m2 = keep * (m2 - 2.0 * step_s * m1 + step_s * step_s * m0);
    m1 = keep * (m1 - step_s * m0);
    m0 = keep * m0;
    y1 = keep * (y1 - step_s * y0);
    y0 = keep * y0;
  }
  void add(double value) noexcept {
    m0 += 1.0;
    y0 += value;
  }
};

double line_at_origin(const Moments& a, const Moments& b) {
  const double m0 = a.m0 + b.m0, m1 = a.m1 + b.m1, m2 = a.m2 + b.m2, y0 = a.y0 + b.y0, y1 = a.y1 + b.y1;
  const double determinant = m0 * m2 - m1 * m1;
  return determinant > 1e-9 * m0 * m2 ? (m2 * y0 - m1 * y1) / determinant : y0 / m0;
}

/// Fills the rows that are not free from their free neighbours.
void bridge(std::span<const double> time_s, const std::vector<bool>& free, std::vector<double>& level) {
  const std::size_t rows = level.size();
  std::size_t previous = rows;  // the last free row; none yet
  for (std::size_t row = 0; row < rows; ++row) {
    if (free[row]) {
      previous = row;
      continue;
    }
    std::size_t next = row;
    while (next < rows && !free[next]) ++next;
    for (; row < next; ++row) {
      const double before = level[previous < rows ? previous : next];
      const double after = level[next < rows ? next : previous];
      const bool between = previous < rows && next < rows;
      const double share =
          between ? (time_s[row] - time_s[previous]) / (time_s[next] - time_s[previous]) : 0.0;
      level[row] = before + share * (after - before);
    }
    --row;
  }
}

}  // namespace

std::vector<double> free_level(std::span<const double> time_s, std::span<const double> values,
                               const std::vector<bool>& free, double constant_s) {
  const std::size_t rows = values.size();
  std::vector<Moments> behind(rows);  // of the rows before each one
  Moments moments;
  for (std::size_t row = 0; row < rows; ++row) {
    if (row > 0) {
      const double step_s = time_s[row] - time_s[row - 1];
      moments.move(step_s, std::exp(-step_s / constant_s));
    }
    behind[row] = moments;
    if (free[row]) moments.add(values[row]);
  }
  std::vector<double> level(rows, 0.0);
  moments = {};
  for (std::size_t row = rows; row-- > 0;) {
    if (row + 1 < rows) {
      const double step_s = time_s[row + 1] - time_s[row];
      moments.move(-step_s, std::exp(-step_s / constant_s));
    }
    if (!free[row]) continue;
    moments.add(values[row]);
    level[row] = line_at_origin(behind[row], moments);
  }
  bridge(time_s, free, level);
  return level;
}

}  // namespace kerf::bench
