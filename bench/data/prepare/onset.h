#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "recordings/row_span.h"

namespace kerf::bench {

/// A stretch of time [s].
struct TimeSpan {
  double begin_s = 0.0;
  double end_s = 0.0;
};

/// What contacts are found in: the force along one direction, or several components whose vector counts.
struct ContactSignal {
  std::vector<double> time_s;
  std::vector<std::vector<double>> components;  ///< one or more, as many values as times
  std::vector<double> position;                 ///< of the axis the onset is told along; empty: none
  std::string name;                             ///< for people: "theta", "|x, y, z|"
  std::string unit = "N";
  std::string position_unit = "m";
};

struct OnsetOptions {
  double sigmas = 5.0;         ///< of the free noise, at which contact is declared
  double release_share = 0.5;  ///< of that threshold, below which it ends
  double least = 0.0;          ///< the threshold is never lower [unit of the signal]
  double smoothing_s = 0.02;   ///< window of the moving mean that thresholds are asked of; not the onset
  double shortest_s = 0.05;    ///< shorter contacts are noise, shorter releases are part of a contact
  double lead_s = 0.2;         ///< at the beginning, taken to be free unless `free` says what is
  double baseline_s = 5.0;     ///< time constant with which the free level is followed
  std::vector<TimeSpan> free;  ///< known to be free of contact; their whole scatter counts as noise
};

/// One contact: where it was declared, and its beginning as a hinge tells it.
struct ContactFound {
  RowSpan rows;                ///< from the row of the onset to the last row above the release threshold
  double onset_s = 0.0;        ///< between rows
  double onset_error_s = 0.0;  ///< standard error
  double onset_position = std::numeric_limits<double>::quiet_NaN();
  double onset_position_error = std::numeric_limits<double>::quiet_NaN();
  /// By how much the corner lies farther on than that of the lower half of the rise, and the standard error
  /// of it: a straight rise has one corner.
  double bend = std::numeric_limits<double>::quiet_NaN();
  double bend_error = std::numeric_limits<double>::quiet_NaN();
  double travel = 0.0;   ///< of the position from the onset to the peak, signed
  double peak = 0.0;     ///< largest deviation from the free level
  bool refined = false;  ///< false: the hinge was not found, the onset is where the threshold was crossed
};

struct ContactsFound {
  std::vector<ContactFound> contacts;
  double noise = 0.0;  ///< sigma of the free rows about the level that is followed
  double threshold = 0.0;
};

/// Finds the contacts of a tool in a force that was measured all the time.
///
/// The free level b follows the force with a time constant while nothing is touched and is held during a
/// contact, so that slow drift does no harm: a force that rises more slowly than half the threshold within
/// that time passes for drift. Contact is declared where |f - b|, f a moving mean with its own noise, exceeds
/// max(sigmas * noise, least) and ends where it stays below the release threshold for `shortest_s`. Then
/// level, noise and threshold are found anew from every free row, twice; in a contact b runs straight from
/// the free rows before to those after.
///
/// A threshold is crossed late, and the later the slower the force rises. So each onset is found anew as the
/// corner of a hinge f = b before, rising after, by least squares over the rows about the crossing (up to
/// three times the threshold or 15 times the noise, not beyond the peak): against the position where that
/// moves in one direction there, else against time.
/// @throws std::invalid_argument if the signal is too short, not finite, or a free span holds no row.
[[nodiscard]] ContactsFound find_contacts(const ContactSignal& signal, const OnsetOptions& options);

/// Where the contacts begin along the axis: the middle of their onsets.
struct ContactPlace {
  double position = 0.0;
  double direction = 1.0;  ///< +1 where the position grows from the onsets to the peaks, -1 where it shrinks
  double error = std::numeric_limits<double>::quiet_NaN();  ///< standard error; NaN: not known
};

/// The place of the contacts, none where the position moves in neither direction.
///
/// The standard error has two parts. By chance n onsets have the larger of their own errors and of their
/// scatter, over sqrt(n), and times sqrt(pi/2) for a middle of more than two. And a rise that is bent has its
/// corner elsewhere than its beginning: by 1 / (1 - 2^(-2/3)) = 2.7 times the `bend` where it is that of
/// Hertz, F ~ x^1.5, by less where it sets out at a slope. So much of the mean bend as is beyond its own
/// error counts in full. What it does not see is a force that jumps where contact begins, as damping does
/// from the surface on.
[[nodiscard]] std::optional<ContactPlace> place_of(std::span<const ContactFound> contacts);

/// Rows that no contact and no margin of `margin_s` about one holds; with free spans, the rows in them.
/// @throws std::invalid_argument if a free span holds no row.
[[nodiscard]] std::vector<bool> free_rows(std::span<const double> time_s, const ContactsFound& found,
                                          std::span<const TimeSpan> free, double margin_s = 0.05);

}  // namespace kerf::bench
