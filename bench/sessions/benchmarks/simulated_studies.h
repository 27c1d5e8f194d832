#pragma once

#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include <kerf/psychophysics/random.h>

#include "answers/analysis.h"

/// Studies of people with a known truth, drawn, and how many of them something holds for.
namespace kerf::bench::simulated {

using psychophysics::Random;
using Draw = std::function<Study(Random&)>;

[[nodiscard]] double logistic(double x);

/// Two samples, and the task that is the design's; nobody has answered.
[[nodiscard]] Study study_of_design(Design design);

/// @param is_success right, or for a preference the first of the two
void add_answer(Study& study, int subject, bool is_success, std::size_t trial);

/// The middle of logits whose logistic is `mean` on the average over N(middle, sd).
[[nodiscard]] double middle_of(double mean, double sd);

/// Subjects whose logits are N(middle, sd), each of whom answers `trials` times.
[[nodiscard]] Study drawn_shares(Design design, int subjects, int trials, double middle, double sd,
                                 Random& random);

/// Subjects whose worths of samples are N(worth of each, sd), each pair `trials` times.
[[nodiscard]] Study drawn_ranking(int subjects, int trials, const std::vector<double>& worth, double sd,
                                  Random& random);

/// Levels of a standard of 1, answered by subjects with curves of their own.
struct LevelTruth {
  bool two_sided = true;
  int subjects = 8;
  int trials = 12;  ///< a level
  double sd = 0.0;  ///< of a PSE in half JNDs, of ln(JND) in quarters
  double jnd = 0.1;
  double pse = 0.03;
  double lapse = 0.02;
};
[[nodiscard]] Study drawn_levels(const LevelTruth& truth, Random& random);

/// People who say same or different, by the likelihood ratio.
struct WordsTruth {
  double d_prime = 0.0;
  double bias = 0.0;  ///< to "same", Observer::bias
  double sd = 0.0;    ///< between people: of the logit of being right
  int subjects = 8;
  int trials = 48;  ///< of each, half of them different
};

/// Of each person e of N(0, sd) makes "different" likelier where it is right and less likely where it is not:
///     logit H = logit H(d', bias) + e,   logit F = logit F(d', bias) - e,
/// so that without d' the share of right answers has a mean of 1/2, whatever the leaning.
[[nodiscard]] Study drawn_words(const WordsTruth& truth, double logit_hit, double logit_alarm,
                                Random& random);

/// Without a bootstrap, which would take most of the time.
[[nodiscard]] AnalysisOptions quick();

/// How many of so many studies fulfil something; each has its own Random, by seed and number.
[[nodiscard]] int counted(int studies, std::uint64_t seed, const std::function<bool(Random&)>& holds);

/// The cells of a table in their order, of which only some may be wanted.
class WantedCells {
 public:
  /// @param wanted their numbers from 0; empty: all
  explicit WantedCells(std::vector<int> wanted) : wanted_(std::move(wanted)) {}
  /// Whether the next one is.
  bool next();

 private:
  std::vector<int> wanted_;
  int count_ = 0;
};

}  // namespace kerf::bench::simulated
