#pragma once

#include <cstddef>
#include <vector>

#include <kerf/psychophysics/binomial.h>
#include <kerf/psychophysics/psychometric.h>

namespace kerf::psychophysics {

/// Parameters that nobody asks for: before every trial the posterior is summed over them, and only what is
/// left of it is to become certain.
struct Nuisance {
  bool slope = false;
  bool guess = false;
  bool lapse = false;
  [[nodiscard]] bool any() const noexcept { return slope || guess || lapse; }
};

/// Grids, all ascending; `weights_of_thresholds` is the prior over the thresholds (empty: flat), flat over
/// the others.
struct QuestPlusOptions {
  Shape shape = Shape::weibull;
  Axis axis = Axis::logarithmic;
  double guess = 0.5;               ///< known, unless there are `guesses`
  std::vector<double> intensities;  ///< that can be shown
  std::vector<double> thresholds;   ///< of the curve
  std::vector<double> slopes{1.0, 1.5, 2.0, 3.0, 4.5, 6.5};
  std::vector<double> lapses{0.0, 0.02, 0.04};
  std::vector<double> guesses{};  ///< in [0, 1), with every lapse rate below 1; empty: `guess` alone
  std::vector<double> weights_of_thresholds;
  Nuisance nuisance{};
  int trials = 60;               ///< ends after so many,
  double small_deviation = 0.0;  ///< or when the threshold's deviation on its axis falls under this,
  /// or when its interval is this narrow: upper over lower end on a logarithmic axis, else upper less lower.
  /// 0: it never ends by that.
  double narrow = 0.0;
  double narrow_confidence = 0.95;
  int least_trials = 1;  ///< neither of the two ends it before so many
};

/// count values from first to last, in equal ratios.
[[nodiscard]] std::vector<double> geometric_grid(double first, double last, std::size_t count);

struct QuestPlusEstimate {
  double threshold = 0.0;  ///< posterior mean; of the logarithm on a logarithmic axis, taken back
  double deviation = 0.0;  ///< of the threshold (of its logarithm)
  double slope = 0.0;      ///< posterior mean of the logarithm, taken back
  double guess = 0.0;
  double lapse = 0.0;
  Interval interval;  ///< central, of the threshold, credible; between grid points linear in the distribution
};

/// QUEST+ [Watson2017]: after every answer the posterior over threshold, slope and lapse rate, before every
/// trial the intensity after which the expected entropy of the posterior is least,
///
///     x* = argmin_x sum_r P(r | x) H(posterior | x, r),   H = - sum p ln p
///
/// the least such intensity where several are. With a nuisance H is that of the posterior summed over it,
/// which is the psi-marginal method [Prins2013]: a trial goes to a nuisance only
/// where that tells of the rest. A value without a
/// clock and without chance: the same answers give the same intensities on every machine. A table of
/// intensities x grid points of double; at most 20 million.
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
  /// Of the threshold, summed over all else.
  [[nodiscard]] std::vector<double> marginal() const;

 private:
  [[nodiscard]] std::size_t points_beside_thresholds() const;
  void set_interest();
  void update(std::size_t intensity, bool is_right);
  void choose();
  [[nodiscard]] double expected_entropy(std::size_t intensity) const;
  [[nodiscard]] double expected_entropy_of_interest(std::size_t intensity) const;

  QuestPlusOptions options_;
  std::vector<double> right_;          ///< P(right) for intensity x grid point, row by row
  std::vector<double> weights_;        ///< posterior; thresholds slowest, then slopes, guesses, lapse rates
  std::vector<std::size_t> interest_;  ///< of each grid point, which of what is asked for; empty: all is
  std::size_t next_ = 0;
  int trials_ = 0;
};

}  // namespace kerf::psychophysics
