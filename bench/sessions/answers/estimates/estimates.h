#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <kerf/psychophysics/repeated_measures.h>

#include "protocol/judgement.h"

// Numbers that subjects gave samples: magnitudes and ratings. The subject is the unit throughout: its answers
// about a sample are one mean before anything else.

namespace kerf::bench {

struct AnalysisOptions;

/// A sample, or a level of one.
struct EstimatedSample {
  std::string name;
  std::size_t sample = 0;
  double level = std::numeric_limits<double>::quiet_NaN();  ///< NaN: as it is
  std::size_t answers = 0;
  /// Of a rating the mean of the subjects' means; of a magnitude the geometric one, over the geometric mean
  /// of all samples of that subject, or over the modulus where a standard had one.
  double value = std::numeric_limits<double>::quiet_NaN();
  psychophysics::Interval interval{.lower = std::numeric_limits<double>::quiet_NaN(),
                                   .upper = std::numeric_limits<double>::quiet_NaN()};
  double intensity = std::numeric_limits<double>::quiet_NaN();  ///< geometric mean, as in Judgement
};

/// Two of a tissue.
struct EstimatedPair {
  std::array<std::size_t, 2> samples{};  ///< places in EstimatedTissue::samples
  /// The second less the first; of magnitudes over it, a ratio.
  double apart = std::numeric_limits<double>::quiet_NaN();
  psychophysics::Interval interval{.lower = std::numeric_limits<double>::quiet_NaN(),
                                   .upper = std::numeric_limits<double>::quiet_NaN()};
  double p = std::numeric_limits<double>::quiet_NaN();
  double p_adjusted = std::numeric_limits<double>::quiet_NaN();  ///< within all pairs of the study
};

struct EstimatedTissue {
  std::string tissue;
  std::vector<EstimatedSample> samples;
  std::vector<EstimatedPair> pairs;                     ///< of two subjects and more
  std::size_t subjects = 0;                             ///< who answered about every sample
  std::size_t left_out = 0;                             ///< who did not
  std::optional<psychophysics::FriedmanTest> friedman;  ///< of ratings of three samples and more
};

/// Stevens' power law R = k I^a, of each subject by least squares of the mean ln R on ln I.
struct PowerLaw {
  std::vector<std::pair<std::string, double>> exponents;       ///< of the subjects
  std::optional<psychophysics::SubjectsMean> mean;             ///< of two subjects and more
  double p_of_one = std::numeric_limits<double>::quiet_NaN();  ///< that the mean is 1: in proportion
  bool of_levels = false;  ///< I = 1 + level; else the rms of what was felt
};

struct EstimateAnalysis {
  bool of_magnitudes = false;
  bool has_modulus = false;
  std::size_t points = 0;
  std::vector<EstimatedTissue> tissues;
  std::optional<PowerLaw> law;  ///< of magnitudes where intensities are known and span a factor of 1.5
  /// Of samples that differ: Friedman's, the least of the tissues' after Holm; of two samples that of the
  /// pair. Of magnitudes the least of the pairs' after Holm; of levels that the exponent is 1.
  double p_value = std::numeric_limits<double>::quiet_NaN();
  std::string main_test;  ///< in words, or why there is none
};

/// None of other designs, or without answers.
/// @throws std::invalid_argument: an answer without a number that its design can have.
[[nodiscard]] std::optional<EstimateAnalysis> analyse_estimates(
    const Study& study, const std::vector<const Judgement*>& judgements, const AnalysisOptions& options);

}  // namespace kerf::bench
