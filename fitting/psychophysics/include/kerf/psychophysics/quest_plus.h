#pragma once

#include <cstddef>
#include <vector>

#include <kerf/psychophysics/binomial.h>
#include <kerf/psychophysics/psychometric.h>

namespace kerf::psychophysics {

/// Grids, all ascending; `weights_of_thresholds` is the prior over the thresholds (empty: flat), flat over
/// the others.
struct QuestPlusOptions {
  Shape shape = Shape::weibull;
  Axis axis = Axis::logarithmic;
  double guess = 0.5;
  std::vector<double> intensities;  ///< that can be shown
  std::vector<double> thresholds;   ///< of the curve
  std::vector<double> slopes{1.0, 1.5, 2.0, 3.0, 4.5, 6.5};
  std::vector<double> lapses{0.0, 0.02, 0.04};
  std::vector<double> weights_of_thresholds;
  int trials = 60;               ///< ends after so many,
  double small_deviation = 0.0;  ///< or when the threshold's deviation on its axis falls under this
};

/// count values from first to last, in equal ratios.
[[nodiscard]] std::vector<double> geometric_grid(double first, double last, std::size_t count);

struct QuestPlusEstimate {
  double threshold = 0.0;  ///< posterior mean; of the logarithm on a logarithmic axis, taken back
  double deviation = 0.0;  ///< of the threshold (of its logarithm)
  double slope = 0.0;      ///< posterior mean of the logarithm, taken back
  double lapse = 0.0;
  Interval interval;  ///< central, of the threshold, credible; between grid points linear in the distribution
};

/// QUEST+ [Watson2017]: after every answer the posterior over threshold, slope and lapse rate, before every
/// trial the intensity after which the expected entropy of the posterior is least,
///
///     x* = argmin_x sum_r P(r | x) H(posterior | x, r),   H = - sum p ln p
///
/// the least such intensity where several are. A value without a clock and without chance: the same answers
/// give the same intensities on every machine. A table of intensities x grid points of double; at most 20
/// million.
class QuestPlus {
 public:
  explicit QuestPlus(QuestPlusOptions options);

  [[nodiscard]] double next() const { return options_.intensities[next_]; }
  void answer(bool is_right);
  /// An answer to an intensity of the grid other than the one that was advised.
  void answer(double intensity, bool is_right);
  [[nodiscard]] bool finished() const;
  [[nodiscard]] int trials() const { return trials_; }
  [[nodiscard]] QuestPlusEstimate estimate(double confidence = 0.95) const;
  /// Of the threshold, summed over slope and lapse rate.
  [[nodiscard]] std::vector<double> marginal() const;

 private:
  void update(std::size_t intensity, bool is_right);
  void choose();

  QuestPlusOptions options_;
  std::vector<double> right_;    ///< P(right) for intensity x grid point, row by row
  std::vector<double> weights_;  ///< posterior, thresholds slowest
  std::size_t next_ = 0;
  int trials_ = 0;
};

}  // namespace kerf::psychophysics
