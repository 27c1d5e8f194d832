#pragma once

#include <array>
#include <string>
#include <vector>

#include "answers/felt_check.h"
#include "protocol/judgement.h"

// Were the samples explored alike? What the hand did with them, in the trials that count.

namespace kerf::bench {

/// Two that were compared: the second less the first, in the trials that compared them. In designs of levels
/// the first is the standard. Of a subject x_s and its mean over the two m_s the difference is
///
///     d_s = 100 (x_s,2 - x_s,1) / m_s   [%]
struct ExploredPair {
  std::array<std::size_t, 2> pair{};
  std::size_t subjects = 0;
  Exploring first;  ///< mean over the subjects' means
  Exploring second;
  OverPeople speed_percent;
  OverPeople peak_speed_percent;
  OverPeople stroke_rate_percent;
  OverPeople off_target_percent;

  /// The interval over people of speed, peak speed or rate of strokes is without 0.
  [[nodiscard]] bool differs() const noexcept;
};

[[nodiscard]] std::vector<ExploredPair> explored_alike(const Study& study, double confidence = 0.95);

/// "'a' and 'b' were not explored alike: ..."
[[nodiscard]] std::vector<std::string> explored_findings(const std::vector<ExploredPair>& pairs,
                                                         const std::vector<std::string>& names,
                                                         double confidence = 0.95);

/// The two of a pair in words; of a design of levels "standard" and "comparison".
[[nodiscard]] std::array<std::string, 2> names_of(const ExploredPair& pair,
                                                  const std::vector<std::string>& names);

}  // namespace kerf::bench
