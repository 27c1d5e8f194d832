#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <kerf/psychophysics/binomial.h>

namespace kerf::population {

using psychophysics::Interval;

/// What one recording says of one parameter.
struct Estimate {
  double value = 0.0;                    ///< finite; the logarithm of what is positive by nature (`log_of`)
  std::optional<double> standard_error;  ///< >= 0; nothing: not known; infinite: the data set no limit
  std::optional<std::string> specimen;   ///< nothing: not known which
};

/// The logarithm of an estimate of what is positive by nature (stiffnesses, times, amplitudes): specimens
/// differ by factors, and means of logarithms are geometric means. Its standard error is s / value (first
/// order). Refuses a value that is not positive. An exponent or a position may be negative: take it as it is.
[[nodiscard]] Estimate log_of(const Estimate& positive);

/// Over what an interval counts.
enum class Unit {
  specimens,   ///< recordings of one specimen are no evidence of what other specimens do
  recordings,  ///< which specimens they are of is not known; too short if they share some
};

struct Spread {
  double value = 0.0;  ///< a standard deviation, in the unit of the estimates (of logarithms: a relative one)
  std::optional<Interval>
      interval;  ///< nothing below two units; begins at 0 where no spread would do as well
};

/// What several recordings have in common beside their specimen, a blank that was taken off each of them: its
/// error is in no spread among them. Their values with one part of it after the other left out, a row a part,
/// in the order of the estimates; a recording that it was not taken off has its own value in each.
struct Shared {
  std::vector<std::vector<double>> without;  ///< of logarithms as the estimates are
};

/// A standard error and the degrees of freedom by which it is known.
struct SharedError {
  double standard_error = 0.0;
  double degrees_of_freedom = 0.0;
};

struct GroupOptions {
  double confidence = 0.95;          ///< of every interval, between 0 and 1
  std::span<const Shared> shared{};  ///< by several recordings; each source is independent of the others
};

/// What is known of a group (a tissue at a speed). Whatever cannot be known of so few is nothing, never 0.
struct GroupEstimate {
  std::size_t recordings = 0;            ///< that counted
  std::size_t left_out = 0;              ///< recordings whose estimate has no limit, or is not finite
  std::optional<std::size_t> specimens;  ///< nothing if any recording's specimen is not known
  Unit unit = Unit::specimens;
  /// False if any recording's standard error is unknown: then none is used, and what they
  /// stand for is a part of the spread between recordings.
  bool has_standard_errors = true;

  std::optional<double> mean;            ///< nothing without recordings
  std::optional<double> standard_error;  ///< of the mean, by Hartung and Knapp; nothing below two units
  std::optional<Interval> interval;      ///< of the mean of all such specimens, by t of units - 1
  int degrees_of_freedom = 0;            ///< units - 1

  /// Of the mean, by what recordings share; `standard_error` and intervals of the mean and of what is next
  /// have it in them. Nothing without anything shared; unknown where values are not finite, and then the
  /// intervals are, too.
  std::optional<SharedError> shared_error;

  /// Of one specimen alone: the interval of that specimen's mean, over its recordings.
  std::optional<Interval> of_this_specimen;

  std::optional<Spread> between_specimens;  ///< needs two specimens, one of which was recorded twice
  std::optional<Spread>
      between_recordings;  ///< of one specimen, beyond the standard errors; needs one recorded twice
  /// Where the two cannot be told apart (each specimen recorded once, or specimens unknown): both together.
  std::optional<Spread> together;
  /// Where the true mean of a specimen will lie that was not recorded yet. Where `together` is all that is
  /// known: the value of its next recording, without its standard error.
  std::optional<Interval> of_the_next;
};

/// Mean and spreads of a group from the estimates y_ij of its recordings (j) of specimens (i):
///
///     y_ij = mu + u_i + w_ij + e_ij,   u ~ N(0, t_b^2),  w ~ N(0, t_w^2),  e ~ N(0, s_ij^2)
///
/// The spreads by REML [PattersonThompson1971]. With a_ij = 1 / (s_ij^2 + t_w^2), m_i the mean of specimen i
/// by these weights, v_i = t_b^2 + 1 / sum_j a_ij, the mean is that of the m_i by 1 / v_i, and its standard
/// error and interval are those of Hartung and Knapp [HartungKnapp2001], over specimens,
///
///     q = sum_i (m_i - mu)^2 / v_i / ((n - 1) sum_i 1 / v_i),   mu +- t_(n-1) sqrt(q)
///
/// exact in a balanced group whatever the spreads are, also where REML finds no spread between specimens:
/// the usual degrees of freedom would there be those of the recordings. The spread between recordings has the
/// exact interval of the Q-profile [Viechtbauer2007], sum_ij a_ij (y_ij - m_i)^2 ~ chi^2 of N - n; that
/// between specimens a generalized one [Weerahandi1993]: the Q-profile over specimens, averaged over what the
/// former leaves open of t_w; the next specimen the fiducial mixture over both [WangHannigIyer2012].
///
/// What recordings share has an error e_s that is in none of these: by the jackknife of K groups
/// [ShaoTu1995], e_s^2 = (K - 1) / K sum_k (mu_k - mean)^2, with mu_k the mean (its weights as they are) of
/// the values that leave part k out. Then the standard error is sqrt(q + e_s^2), its t that of Welch and
/// Satterthwaite [Welch1947], and what is next as wide as both in squares.
///
/// Refuses a negative standard error, one that is NaN, and a confidence outside of 0 to 1.
[[nodiscard]] GroupEstimate estimate_group(std::span<const Estimate> estimates,
                                           const GroupOptions& options = {});

}  // namespace kerf::population
