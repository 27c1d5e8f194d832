#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "answers/answer_groups.h"
#include "answers/estimates/estimates.h"
#include "answers/estimates/questionnaires.h"
#include "answers/explored/explored_alike.h"
#include "answers/felt_check.h"
#include "answers/level_analysis.h"
#include "answers/rankings.h"
#include "answers/ratings.h"
#include "answers/response_times.h"
#include "answers/tracks.h"
#include "registered/experiment_report.h"

// What the answers of blind sessions say, and what they do not: docs/sessions-analysis.md.

namespace kerf::bench {

/// How p values of one family are adjusted.
enum class FamilyCorrection : std::uint8_t { holm, benjamini_hochberg };

struct AnalysisOptions {
  double confidence = 0.95;  ///< of intervals
  double level = 0.05;       ///< of tests; also of each of the two of an equivalence
  /// Of a look at a study under way: alpha of the whole, of which `level` is what this look may spend.
  /// Whether there are subjects enough for a test of people, and whether they differ, is judged by it.
  std::optional<double> alpha;
  [[nodiscard]] double whole_level() const noexcept { return alpha.value_or(level); }
  /// A preference is none within 50 % +- this. None unless somebody set it: a margin that follows the answers
  /// shows nothing.
  std::optional<double> margin;
  /// Renderings count as equal below it; likewise. In two intervals d' = 1 is 76 % right: about one JND at 75
  /// %.
  std::optional<double> d_prime_bound;
  std::optional<psychophysics::Interval> jnd_margins;  ///< a JND is as wanted within them, in (0, infinity)
  std::vector<double> truths{0.75, 0.60};              ///< for which the power is told
  FamilyCorrection correction = FamilyCorrection::holm;
  std::optional<double> lapse;      ///< fixed; otherwise estimated in 0 to 6 %
  std::optional<double> criterion;  ///< of a threshold; half the way from guessing to certainty otherwise
  int bootstrap = 1000;             ///< samples; 0: none
  bool curves = true;               ///< of main_result: also the curve over the levels, not the test alone
  std::uint64_t seed = 1;
};

/// Which trials were not felt, or not sound, and what the others say without them.
struct AnswerQuality {
  std::size_t known = 0;    ///< trials of which it is known
  std::size_t unfelt = 0;   ///< a slot had no force that can be felt
  std::size_t faulty = 0;   ///< a fault of law, device or loop while a slot played
  std::size_t without = 0;  ///< trials that are left
  double p_value = std::numeric_limits<double>::quiet_NaN();      ///< of the main test over those
  std::size_t voided = 0;                                         ///< not analysed, by the protocol's rules
  std::array<std::size_t, void_reasons> by_reason{};              ///< of those; one may have several
  double p_with_void = std::numeric_limits<double>::quiet_NaN();  ///< of the main test, had they counted
};

/// Everything about a study.
struct Analysis {
  AnalysisOptions options;
  std::string name;
  Design design = Design::preference;
  std::vector<std::string> samples;
  std::size_t trials = 0;
  std::size_t practice = 0;                                   ///< trials left out
  std::vector<SubjectCatches> catches;                        ///< in no test; empty: there are none
  std::vector<std::string> subjects;                          ///< in order of appearance
  std::vector<std::size_t> preferred;                         ///< of a preference: wins by sample
  double p_value = std::numeric_limits<double>::quiet_NaN();  ///< of the main test; NaN: there is none
  std::string main_test;                                      ///< what it is, in words, or why there is none
  std::optional<AnswerGroup> all;  ///< none without answers, nor of preferences among more than two samples
  std::vector<AnswerGroup> by_subject;
  std::vector<AnswerGroup> by_tissue;  ///< only where each has one question; otherwise see by_pair
  std::vector<AnswerGroup> by_pair;    ///< where a tissue has more than one
  SubjectSpread spread;
  SlotBias bias;
  std::vector<TissueRanking> rankings;
  std::optional<LevelAnalysis> levels;
  std::vector<AdaptiveTrack> tracks;
  std::optional<RatingAnalysis> ratings;      ///< where confidence was asked
  std::optional<EstimateAnalysis> estimates;  ///< where numbers were
  std::vector<QuestionnaireScore> questionnaire;
  ResponseTimes times;
  AnswerQuality quality;
  std::vector<ExploredPair> explored;  ///< what the hand did with the samples; none where nothing is known
  FeltCheck felt;                      ///< whether anything but the law told samples apart
  std::vector<std::string> remarks;    ///< of the study; among the warnings, too
  std::optional<ExperimentReport> experiment;  ///< that it is of; add_experiment()
  std::vector<std::string> shows;              ///< sentences
  std::vector<std::string> shows_not;          ///< what one might read into it
  std::vector<std::string> warnings;
};

/// @throws std::invalid_argument: an option out of its range; a level that is no number where the design has
///         levels.
[[nodiscard]] Analysis analyse(const Study& study, const AnalysisOptions& options = {});

/// The main test or fit of a study alone, for simulations that ask thousands of times. NaN: not of this
/// design, or not estimable (`note` says why).
struct MainResult {
  std::size_t trials = 0;
  double p_value = std::numeric_limits<double>::quiet_NaN();
  double d_prime = std::numeric_limits<double>::quiet_NaN();
  psychophysics::Interval d_prime_interval{.lower = std::numeric_limits<double>::quiet_NaN(),
                                           .upper = std::numeric_limits<double>::quiet_NaN()};
  double jnd = std::numeric_limits<double>::quiet_NaN();  ///< of people where there is one, else pooled
  psychophysics::Interval jnd_interval{.lower = std::numeric_limits<double>::quiet_NaN(),
                                       .upper = std::numeric_limits<double>::quiet_NaN()};
  double equality = std::numeric_limits<double>::quiet_NaN();  ///< PSE, likewise
  psychophysics::Interval equality_interval{.lower = std::numeric_limits<double>::quiet_NaN(),
                                            .upper = std::numeric_limits<double>::quiet_NaN()};
  double exponent = std::numeric_limits<double>::quiet_NaN();  ///< of magnitudes, mean of the subjects
  psychophysics::Interval exponent_interval{.lower = std::numeric_limits<double>::quiet_NaN(),
                                            .upper = std::numeric_limits<double>::quiet_NaN()};
  /// Shown: d' below its bound, a preference in its margin, the JND in its; none where no margin was set.
  std::optional<bool> equivalent;
  std::string note;
};
[[nodiscard]] MainResult main_result(const Study& study, const AnalysisOptions& options = {});

/// Fills in the sentences: what is shown, what is not, and warnings.
void add_findings(Analysis& analysis);

/// The analysis in lines for a terminal.
[[nodiscard]] std::vector<std::string> summary_lines(const Analysis& analysis);

}  // namespace kerf::bench
