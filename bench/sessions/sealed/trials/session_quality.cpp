#include "sealed/trials/session_quality.h"

#include <cmath>

#include <fmt/core.h>

#include "files/json_number.h"
#include "sealed/trials/quality_tally.h"

namespace kerf::bench {

SessionQuality session_quality(const SessionStore& session) {
  return QualityTally(session).quality(session.finished());
}

std::string in_words(const SessionQuality& quality) {
  std::string words =
      fmt::format("{}; {} unfelt, {} with a fault, {} late ticks, {} at the limits", in_words(quality.counts),
                  quality.unfelt, quality.faulty, quality.late_ticks, quality.limited_ticks);
  if (quality.unknown > 0) words += fmt::format(", {} without a trace", quality.unknown);
  if (std::isfinite(quality.contact_share))
    words += fmt::format(", in contact {:.0f} % of the time a slot played", 100.0 * quality.contact_share);
  if (quality.catches)
    words += fmt::format(", {} of {} catch trials right", quality.catches->right, quality.catches->trials);
  if (std::isfinite(quality.median_response_s))
    words += fmt::format("; answered within {:.2f} s (median), at most {:.2f} s", quality.median_response_s,
                         quality.slowest_response_s);
  return words;
}

nlohmann::ordered_json to_json(const SessionQuality& quality) {
  nlohmann::ordered_json reasons = nlohmann::ordered_json::object();
  for (std::size_t reason = 0; reason < void_reasons; ++reason)
    reasons[std::string(name_of(static_cast<VoidReason>(reason)))] = quality.counts.by_reason[reason];
  return {{"given", quality.counts.given},
          {"practice", quality.counts.practice},
          {"counted", quality.counts.counted},
          {"void", quality.counts.voided},
          {"left_out", quality.counts.left_out},
          {"reasons", std::move(reasons)},
          {"unknown", quality.unknown},
          {"unfelt", quality.unfelt},
          {"faulty", quality.faulty},
          {"late_ticks", quality.late_ticks},
          {"limited_ticks", quality.limited_ticks},
          {"contact_share", json_number(quality.contact_share)},
          {"catch", quality.catches ? nlohmann::ordered_json{{"right", quality.catches->right},
                                                             {"trials", quality.catches->trials}}
                                    : nlohmann::ordered_json(nullptr)},
          {"median_response_s", json_number(quality.median_response_s)},
          {"slowest_response_s", json_number(quality.slowest_response_s)}};
}

}  // namespace kerf::bench
