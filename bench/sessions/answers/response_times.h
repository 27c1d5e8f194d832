#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "protocol/judgement.h"

namespace kerf::bench {

/// Times to the answer. NaN: there were none.
struct ResponseTimes {
  std::size_t trials = 0;  ///< that have a time
  double median_s = 0.0;
  double lower_quartile_s = 0.0;
  double upper_quartile_s = 0.0;
  double median_right_s = 0.0;
  double median_wrong_s = 0.0;
  /// That a right answer came faster than a wrong one, ties half: 0.5 where they do not differ.
  double right_is_faster = 0.0;
  /// Two-sided, Mann and Whitney, normal with ties; each time divided by its subject's median before.
  double p_value = 1.0;
  std::string note;
};

[[nodiscard]] ResponseTimes response_times(const Study& study,
                                           const std::vector<const Judgement*>& judgements);

}  // namespace kerf::bench
