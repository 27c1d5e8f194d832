#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/models/law.h>

#include "kerf/fitting/jnd.h"

namespace kerf::fitting {

/// The samples of one recording as a law sees them. All spans have one length.
struct Series {
  std::span<const double> time_s;        ///< increasing
  std::span<const double> penetration;   ///< x, in the tool's direction of engagement [m or rad]
  std::span<const double> velocity;      ///< dx/dt
  std::span<const double> force;         ///< resisting force [N]
  std::span<const std::uint32_t> cycle;  ///< cycle of each sample, 0 for none; empty if not segmented
  double noise_n = 0.0;                  ///< standard deviation of the force's noise; 0: not known [N]
  /// Whether a sample counts: laws run through all samples, and are fitted to and judged by these. Empty:
  /// all.
  std::span<const std::uint8_t> counts;
  /// Standard error of the place where x is zero, the same for all samples: intervals allow for it, but those
  /// of tables and of the line at which a law ruptures. 0: taken for exact [m or rad].
  double contact_error = 0.0;
};

/// What a residual r costs, in units of a scale s: r^2 (least squares), or less for those far off.
enum class Loss : std::uint8_t {
  squares,  ///< r^2
  huber,    ///< r^2 up to s, 2 s |r| - s^2 beyond
  soft_l1,  ///< 2 s^2 (sqrt(1 + (r/s)^2) - 1)
  cauchy    ///< s^2 ln(1 + (r/s)^2)
};

/// How the number of segments of a piecewise law, or of arms of a Maxwell law, is found where it is not
/// given.
enum class CountBy : std::uint8_t {
  given,  ///< the law's own option, or its default
  bic,    ///< least Bayesian information criterion, by the effective number of samples
  jnd     ///< the fewest whose root mean square error stays within the JND
};

/// What the intervals take the residuals for.
enum class Intervals : std::uint8_t {
  correlated,  ///< noise with a memory, estimated from them; by whole cycles where there are eight or more
  white        ///< independent from sample to sample: s^2 (J'J)^-1, at no cost; too narrow at 1 kHz
};

/// Piecewise curves that were found for every number of segments up to a limit, so that fits of the same
/// samples with other numbers of segments find them again. Fits on several threads may share one.
class SegmentedMemory;
[[nodiscard]] std::shared_ptr<SegmentedMemory> remember_segments(std::size_t max_segments,
                                                                 std::size_t points_per_segment = 4);

struct FitOptions {
  models::Options
      law_options;  ///< integrator, thickness, segments, points, loop, ...; the rest from the data
  Jnd jnd;
  std::string jnd_source;        ///< who measured it, in words
  std::string force_unit = "N";  ///< in the words of warnings and reasons
  std::size_t folds =
      5;  ///< of the cross-validation: by cycle, or by blocks of time where there are no cycles; 0: none
  std::size_t threads = 1;   ///< share out folds and intervals; the result does not depend on it
  double test_share = 0.0;   ///< last share of the cycles (or of the time) that no fit sees, in [0, 0.9]
  double confidence = 0.95;  ///< of the intervals
  Intervals intervals = Intervals::correlated;
  /// Ends a search where the error no longer changes, as on all folds: for a law that is compared with
  /// others, and found anew if it is taken.
  bool brief = false;
  Loss loss = Loss::squares;
  double loss_scale_n = 0.0;  ///< s [N]; 0: 1.345 robust standard deviations of the least-squares residuals
  bool profile = false;       ///< also intervals from the profile of the sum of squares
  CountBy segments = CountBy::given;
  std::size_t points_per_segment = 4;  ///< fewest, on each branch, the segment's ends included; at least 1
  std::vector<double> breakpoints;     ///< inner knots of a piecewise law by hand, as penetrations
  std::vector<std::string> per_recording;             ///< parameters that each recording has of its own
  std::shared_ptr<SegmentedMemory> segmented_memory;  ///< none: curves are found anew each time
  /// The force that a loop gives with a law at each sample of a recording, by its velocity and its latency;
  /// none: laws are judged as fitted.
  std::function<std::vector<double>(const models::Law& law, std::size_t recording)> render;
  /// Called when a part of the fit is done, by the thread that did it: parts_of_a_fit() times at most.
  std::function<void()> part_done;
};

/// The law itself, its intervals, and each fold that is held out.
[[nodiscard]] std::size_t parts_of_a_fit(const FitOptions& options) noexcept;

/// Where an interval comes from; none: the data set no limit on either side, or nothing was asked.
enum class IntervalBy : std::uint8_t { none, held, wald, profile };

/// What the covariance was made of.
enum class CovarianceBy : std::uint8_t {
  residuals,  ///< noise with a memory, estimated from them
  cycles,     ///< each cycle as one observation
  white       ///< as asked, s^2 (J'J)^-1
};

/// A parameter with its uncertainty. A parameter that was not searched (the ends of a piecewise law's knots)
/// has a standard error of zero. A limit that the data do not set is infinite, and so is the standard error
/// of a parameter that they do not determine.
struct Estimate {
  models::ParameterInfo info;
  double value = 0.0;
  double std_error = 0.0;
  double lower = 0.0;  ///< confidence interval
  double upper = 0.0;
  IntervalBy by = IntervalBy::none;
  /// How likely an estimate as far from zero is, if there is nothing: of a parameter that may be zero; else
  /// NaN.
  double p_zero = std::numeric_limits<double>::quiet_NaN();
  std::size_t recording = shared;  ///< whose own it is, where recordings differ

  static constexpr std::size_t shared = static_cast<std::size_t>(-1);
};

/// How the sum of squares rises when one parameter is held and the others follow.
struct Profile {
  std::string parameter;
  std::vector<double> value;
  std::vector<double> deviation;  ///< signed root of the rise, in standard errors
  double lower = 0.0;             ///< where it reaches the confidence; infinite where it never does
  double upper = 0.0;
};

/// Errors of a law as a loop renders it [N]; NaN as those of the law as fitted, and where nothing renders it.
struct AsRendered {
  double rmse = std::numeric_limits<double>::quiet_NaN();
  double test_rmse = std::numeric_limits<double>::quiet_NaN();
  double cv_rmse = std::numeric_limits<double>::quiet_NaN();
  double cv_std_error = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> cv_folds;
};

struct FitResult {
  std::string model;
  models::Options law_options;
  std::vector<Estimate> parameters;  ///< of the first recording, where some are each recording's own
  std::vector<Estimate> others;      ///< those of the further recordings' own
  std::size_t free_parameters = 0;
  std::size_t samples = 0;  ///< that count, those of the test too
  double rmse = 0.0;        ///< [N]
  double max_abs = 0.0;     ///< [N]
  double r2 = 0.0;
  double effective_samples = 0.0;  ///< n_e, independent ones that the samples are worth: weigh_information()
  double aic = 0.0;                ///< n_e ln(RSS/n) + 2 (p + 1)
  double aicc = 0.0;               ///< AIC + 2 (p + 1) (p + 2) / (n_e - p - 2); infinite for n_e <= p + 2
  double bic = 0.0;                ///< n_e ln(RSS/n) + (p + 1) ln n_e
  double cv_rmse = 0.0;            ///< on held-out cycles [N]; NaN if not asked for
  double cv_std_error = 0.0;       ///< of cv_rmse, by the spread from fold to fold [N]; NaN as that is
  std::vector<double> cv_folds;    ///< error on each fold that was held out [N]; empty as cv_rmse is NaN
  AsRendered rendered;
  double test_rmse = 0.0;         ///< on the share that no fit saw [N]; NaN if none
  double jnd_fraction = 0.0;      ///< share of samples whose error a person could feel
  double free_fraction = 0.0;     ///< share of the rows before the tissue whose error a person could feel
  double loss_scale_n = 0.0;      ///< s of a robust loss, as it was taken [N]; 0 for squares
  double correlation_time = 1.0;  ///< of the residuals, in samples; the intervals allow for it
  CovarianceBy covariance_by = CovarianceBy::residuals;
  std::vector<double> correlation;    ///< matrix of the searched parameters, row by row; empty for tables
  std::vector<std::string> searched;  ///< their names, in the order of that matrix
  std::vector<Profile> profiles;
  std::size_t undetermined_arms = 0;  ///< that the data do not tell from none: a simpler law says as much
  std::size_t undetermined_directions =
      0;  ///< changes of several parameters that leave the forces as they are
  bool converged = false;
  int iterations = 0;
  double seconds = 0.0;
  std::string message;  ///< why it ended
  std::vector<std::string> warnings;

  /// It converged, and neither to something that the mean of the force explains better, nor to one that is
  /// felt most of the time where the tool is free: what does is no answer, however it compares with others.
  [[nodiscard]] bool can_be_chosen() const noexcept {
    return converged && r2 >= 0.0 && !is_felt_in_free_air();
  }
  [[nodiscard]] bool is_felt_in_free_air() const noexcept { return free_fraction > 0.5; }

  /// What verdicts go by: as rendered where something renders it, else as fitted.
  [[nodiscard]] double held_out_rmse() const noexcept;
  [[nodiscard]] double held_out_test() const noexcept;
  [[nodiscard]] const std::vector<double>& held_out_folds() const noexcept;

  /// Takes the information criteria by a number of independent samples, p the free parameters: neighbours at
  /// 1 kHz say nearly the same, and by their number the richest law always wins. A fit sets them by its own
  /// n / correlation_time. Laws compare only by one and the same number; take the largest that any of them
  /// leaves, since residuals of a law that misfits have a memory that is the misfit's and not the noise's.
  /// Source: [Schwarz1978] (BIC); [HurvichTsai1989] (AICc).
  void weigh_information(double independent_samples);

  /// The law of the first recording, or of another one.
  [[nodiscard]] models::Law law(std::size_t recording = 0) const;
};

/// The laws that can be fitted to a series: every scalar law of the registry, and of plug-ins.
[[nodiscard]] std::vector<std::string_view> fitted_laws();
/// @throws std::invalid_argument for an unknown law, or one that is not among fitted_laws().
void check_model(std::string_view model);

/// Fits one law of the registry by least squares on the law's own step, differentiated by dual numbers.
///
/// Starts come from a scan over what is not linear in the law, the linear rest following by least squares
/// (variable projection) on a thinned series; the best three are solved there, and the best of them on all
/// samples, by a trust region within the law's own bounds. Piecewise laws begin at the global optimum of
/// their breakpoints (segmented.h); tables are linear; laws that break begin at the breaks in the data. Laws
/// with two branches are fitted to cycles as loops, and are judged without their rendering aids.
///
/// Several recordings share all parameters but those of `per_recording`; each is weighed by its own noise,
/// given or estimated from its residuals.
///
/// Intervals allow for the autocorrelation of the residuals (fitting/src/uncertainty.h). Logarithmic
/// parameters get theirs on the log scale. Non-convergence is a value of the result.
/// @throws std::invalid_argument for an unknown law or option, or a series that cannot be fitted at all
/// (fewer samples than parameters, constant position, samples that are not finite), saying which.
[[nodiscard]] FitResult fit(std::string_view model, std::span<const Series> recordings,
                            const FitOptions& options = {});
[[nodiscard]] FitResult fit(std::string_view model, const Series& series, const FitOptions& options = {});

/// Root mean square of the force of the samples that count: the JND of a recording is taken there [N].
[[nodiscard]] double rms_of(const Series& series);

/// Root mean square error of the straight line of force over penetration: what any law has to beat [N].
[[nodiscard]] double line_rmse(const Series& series);

/// Which of several fitted laws describes the recordings best, and why.
struct Choice {
  std::string model;
  std::string why;
};

/// What a law leaves out against a better one, whatever both leave out: sqrt(e^2 - e_b^2) [N]; 0 if that is
/// no better.
[[nodiscard]] double left_out(double error_n, double better_n) noexcept;

/// Whether a law does as well as the best on held-out data: nobody could feel what it leaves out against the
/// best, left_out() <= JND, or its error is larger by no more than 5 % and the mean difference of the folds'
/// mean squares by no more than its standard error, by the spread from fold to fold. Folds share most of the
/// samples that they are trained on, so that this error is rather too small ([BengioGrandvalet2004]). Source:
/// [Breiman1984], the rule of one standard error; here of the paired difference.
[[nodiscard]] bool as_good_as(const FitResult& law, const FitResult& best, double jnd_n);

/// The law with fewest parameters whose error on held-out data stays within the JND at the recording's own
/// force (root mean square); where none does, of those that are as_good_as() the best, and the reason says
/// so. Held out are the cycles or blocks of the cross-validation, else the share that was kept back for a
/// test. Where there is neither, the law with the least BIC.
/// A law with undetermined_arms is chosen only where there is no other; none where no force at all does
/// better than each, or where none is within the JND and each errs by more than 1.05 times `line_rmse`, what
/// held_out_line_rmse() gives (NaN: not known).
[[nodiscard]] Choice choose_simplest(std::span<const FitResult> results, const Series& series,
                                     const FitOptions& options,
                                     double line_rmse = std::numeric_limits<double>::quiet_NaN());

}  // namespace kerf::fitting
