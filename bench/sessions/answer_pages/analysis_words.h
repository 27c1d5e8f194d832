#pragma once

#include <string>

#include <kerf/psychophysics/psychometric_fit.h>

#include "answers/analysis.h"

// Numbers of an analysis as they are written in sentences and tables.

namespace kerf::bench {

/// "p = 0.030", "p < 0.0001"; of NaN "no p".
[[nodiscard]] std::string p_text(double p);
/// "64.6 %"
[[nodiscard]] std::string percent_text(double share);
/// "49.5 to 77.8 %"
[[nodiscard]] std::string percent_text(psychophysics::Interval interval);
/// "1.05", "no limit" of an infinite one.
[[nodiscard]] std::string d_prime_text(double value);
/// "0.21 to 1.9", "above 0.5"
[[nodiscard]] std::string d_prime_text(psychophysics::Interval interval);
/// "31 of 48 right (64.6 %, 95 % 49.5 to 77.8 %)"
[[nodiscard]] std::string count_text(const AnswerGroup& group, double confidence);
/// "JND 10.3 % of the standard at 75 % right (95 % 8.1 to 13.0 %)"
[[nodiscard]] std::string threshold_text(const char* name, const psychophysics::Threshold& threshold,
                                         const char* of, double confidence);
/// "75 % right"; of a curve on both sides how its JND is defined.
[[nodiscard]] std::string criterion_text(const LevelAnalysis& levels,
                                         const psychophysics::Threshold& threshold);
[[nodiscard]] const char* name_of(psychophysics::Shape shape) noexcept;
/// "catch trials: S01 4 of 4 right, S02 1 of 4"
[[nodiscard]] std::string catches_text(const std::vector<SubjectCatches>& catches);
/// "answered in 2.31 s (median; ...)". Of times that there are.
[[nodiscard]] std::string times_text(const ResponseTimes& times);
/// "12 trials", "1 trial"
[[nodiscard]] std::string plural(std::size_t count, const char* of);
/// The sentence with a full stop, and a capital where it does not begin with the name of a file.
[[nodiscard]] std::string as_sentence(std::string text);

}  // namespace kerf::bench
