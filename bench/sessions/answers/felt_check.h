#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <kerf/psychophysics/binomial.h>

#include "protocol/judgement.h"

// Was it the law? What was felt of the samples in the trials that count, compared.

namespace kerf::bench {

/// Mean of the subjects' values, with Student's interval from three subjects on.
struct OverPeople {
  double mean = std::numeric_limits<double>::quiet_NaN();
  std::optional<psychophysics::Interval> interval;
};

/// Of one value a subject; those that are not finite are left out.
[[nodiscard]] OverPeople over_people(const std::vector<double>& subjects, double confidence);

/// Of one sample, the mean of the subjects.
struct FeltOfSample {
  std::size_t sample = 0;
  std::size_t slots = 0;
  FeltLevel level;
};

/// Two samples that were compared: the second of the pair less the first, in the trials that compared them.
/// Of a subject the rms is that of its slots' rms, the peak and the shares are their means.
struct FeltOfPair {
  std::array<std::size_t, 2> pair{};
  std::size_t subjects = 0;
  FeltLevel first;  ///< means of the subjects
  FeltLevel second;
  OverPeople rms_jnds;
  OverPeople peak_jnds;
  OverPeople limited_share;
  OverPeople vibration_db;  ///< of those who had any in both

  [[nodiscard]] bool strength_differs() const noexcept;
  [[nodiscard]] bool limits_differ() const noexcept;
  [[nodiscard]] bool vibration_differs() const noexcept;
};

struct FeltCheck {
  std::vector<FeltOfSample> samples;
  std::vector<FeltOfPair> pairs;
  std::string note;  ///< why there is nothing
};

[[nodiscard]] FeltCheck felt_check(const Study& study, double confidence = 0.95);

/// "'a' and 'b' were not felt equally strong: ...", one for each thing by which two samples differ.
[[nodiscard]] std::vector<std::string> felt_findings(const FeltCheck& check,
                                                     const std::vector<std::string>& names,
                                                     double confidence = 0.95);

}  // namespace kerf::bench
