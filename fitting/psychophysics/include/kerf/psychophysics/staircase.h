#pragma once

#include <vector>

#include <kerf/psychophysics/psychometric.h>

namespace kerf::psychophysics {

struct StaircaseOptions {
  int up = 1;    ///< so many wrong answers in a row raise the intensity
  int down = 2;  ///< so many right ones lower it
  double start = 1.0;
  /// Steps, each used until the next reversal, the last one from then on: differences of intensity on a
  /// linear axis, of its natural logarithm on a logarithmic one.
  std::vector<double> steps{0.4, 0.2, 0.1};
  double step_ratio = 1.0;  ///< step down over step up ([Kaernbach1991]; [GarciaPerez1998])
  Axis axis = Axis::logarithmic;
  double least = 0.0;  ///< intensities are held in least ... most
  double most = 1e9;
  int reversals = 12;  ///< ends after so many
  int dropped = 4;     ///< first reversals that do not count; what remains is even, or one more is dropped
  int max_trials = 400;
};

/// Probability of a right answer where an up-down staircase settles: where the steps of a trial add up to
/// nothing,
///
///     Pdown = r / (1 + r) with r = step up / step down,
///     Pdown = p^(m-1) (1 - q^n) / (p^(m-1) + q^(n-1) - p^(m-1) q^(n-1)),   q = 1 - p, n up, m down
///
/// Pdown: m right answers in a row before n wrong ones. For n = 1 and equal steps p^m = 1/2: 70.7 % for 1 up
/// 2 down, 79.4 % for 1 up 3 down [Levitt1971].
[[nodiscard]] double convergence_point(int up, int down, double step_ratio = 1.0);

struct StaircaseEstimate {
  double threshold = 0.0;       ///< mean of the reversals; geometric on a logarithmic axis
  double standard_error = 0.0;  ///< of the mean of pairs of reversals, of ln(threshold) on a logarithmic axis
  double probability = 0.0;     ///< the convergence point: the criterion that this threshold belongs to
  int reversals = 0;            ///< that count
};

/// Transformed up-down staircase of Levitt [Levitt1971]. A value: it has no clock and no chance in it, so
/// that a session is resumed by giving it the same answers again.
class Staircase {
 public:
  explicit Staircase(StaircaseOptions options);

  /// Intensity of the next trial.
  [[nodiscard]] double next() const;
  /// Refused once finished.
  void answer(bool is_right);
  [[nodiscard]] bool finished() const;
  [[nodiscard]] int trials() const { return trials_; }
  /// Intensities at which the direction turned.
  [[nodiscard]] const std::vector<double>& reversals() const { return reversals_; }
  /// Refused with less than two reversals past those dropped.
  [[nodiscard]] StaircaseEstimate estimate() const;

 private:
  void move(int direction);

  StaircaseOptions options_;
  double at_;  ///< on the axis
  int right_in_row_ = 0;
  int wrong_in_row_ = 0;
  int direction_ = 0;
  int trials_ = 0;
  std::vector<double> reversals_;
};

}  // namespace kerf::psychophysics
