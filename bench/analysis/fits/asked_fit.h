#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <kerf/fitting/fit.h>
#include <kerf/models/motion.h>
#include <kerf/schema/recording.h>

#include "fits/fit_recording.h"

namespace kerf::bench {

/// A contact in place of the one that is known.
struct AskedContact {
  std::optional<double> position;
  std::string direction;  ///< "increasing", "decreasing", or empty

  [[nodiscard]] bool given() const { return position || !direction.empty(); }
  [[nodiscard]] models::Contact over(models::Contact known) const;
};

/// A JND in place of what is known of forces and torques.
struct AskedJnd {
  std::optional<double> weber_fraction;
  std::optional<double> threshold;
  std::string source;

  /// As given; what is not, that of the axis (fitting::jnd_of()).
  [[nodiscard]] fitting::Jnd over(const fitting::Jnd& known) const;
  /// Puts the JND of an axis, and who measured it, into the options.
  void put_into(fitting::FitOptions& options, const schema::Axis& axis) const;
};

/// A fit in the words of a person, as `kerf fit` and kerf.fit() of Python take them.
struct AskedFit {
  std::string axis;  ///< empty: that of the cycles, or the first
  AskedContact contact;
  std::vector<double> noise;  ///< none, one, or one a recording
  AskedJnd jnd;
  std::string rows = "contact";  ///< or "all"
  std::string cycles = "good";

  std::string segments = "5";
  std::vector<std::string> breakpoints;
  std::size_t arms = 0;         ///< 0: as many as held-out data pay for
  std::size_t memberships = 0;  ///< 0: those of the law
  std::optional<double> thickness;

  bool no_folds = false;
  std::string loss = "squares";
  FitRecordingOptions options;  ///< what of the above stands as it is

  /// Whether one of the laws has segments to be found. @throws std::invalid_argument for what is no law.
  [[nodiscard]] bool fits_segments() const;

  // What may be asked for.
  struct Range {
    double lower;
    double upper;
  };
  struct Count {
    int lower;
    int upper;
  };
  static constexpr Count most_points{1, 1'000'000};  ///< in a segment
  static constexpr Count most_arms{1, 6};
  static constexpr Count most_memberships{1, 5};
  static constexpr Count most_folds{2, 100};
  static constexpr Range rates_hz{100.0, 10000.0};
  static constexpr Range test_shares{0.0, 0.9};
  static constexpr Range confidences{0.5, 0.9999};
  static constexpr Range weber_fractions{0.0, 1.0};
};

/// @param recordings how many are fitted at once; 0: each of a batch by itself
/// @throws std::invalid_argument for options that exclude each other, that no law has, or out of their range.
///         Options are called as on the command line.
void check(const AskedFit& asked, std::size_t recordings);

/// A recording with the axis, contact and noise that were asked for; `place` among the recordings.
[[nodiscard]] FitSource source_of(const AskedFit& asked, const schema::Recording& recording,
                                  const std::string& name, std::size_t place = 0);

/// How to fit; breakpoints are turned to penetrations with the source's axis and contact.
[[nodiscard]] FitRecordingOptions options_of(const AskedFit& asked, const FitSource& source);

/// Fits laws to recordings at once, as asked; their names are those of the files without folder and ending.
/// @throws std::invalid_argument also where no law could be fitted; std::system_error if it was stopped.
[[nodiscard]] RecordingFit fit_files(const std::vector<std::string>& files, const AskedFit& asked);

}  // namespace kerf::bench
