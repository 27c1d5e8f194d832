#include "protocol/felt_level.h"

#include <cmath>

#include <kerf/fitting/jnd.h>

namespace kerf::bench {
namespace {

double in_jnds(double first_n, double second_n) {
  return (second_n - first_n) / fitting::force_jnd.at(0.5 * (first_n + second_n));
}

}  // namespace

FeltApart felt_apart(const FeltLevel& first, const FeltLevel& second) {
  return {.rms_jnds = in_jnds(first.rms_n, second.rms_n),
          .peak_jnds = in_jnds(first.peak_n, second.peak_n),
          .limited_share = second.limited_share - first.limited_share,
          .vibration_db = first.vibration_n == second.vibration_n
                              ? 0.0
                              : 20.0 * std::log10(second.vibration_n / first.vibration_n),
          .vibrates = first.vibration_thresholds >= 1.0 || second.vibration_thresholds >= 1.0};
}

bool is_strength_apart(double jnds) noexcept { return std::abs(jnds) > most_jnds_apart; }
bool is_limit_apart(const FeltApart& apart) noexcept {
  return std::abs(apart.limited_share) > most_limited_apart;
}
bool is_vibration_apart(const FeltApart& apart) noexcept {
  return apart.vibrates && std::abs(apart.vibration_db) > most_db_apart;
}

std::string_view jnd_of_levels_source() noexcept { return fitting::jnd_source_of("N"); }

}  // namespace kerf::bench
