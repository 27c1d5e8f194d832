#include "felt/felt_remarks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include <fmt/core.h>

#include "felt/felt_forces.h"

namespace kerf::bench {
namespace {

std::vector<FeltLevel> levels_of_samples(const Protocol& protocol, const FeltRenderer& renderer) {
  constexpr double as_it_is = std::numeric_limits<double>::quiet_NaN();
  std::vector<FeltLevel> levels;
  for (std::size_t sample = 0; sample < protocol.samples.size(); ++sample)
    levels.push_back(renderer.rendered(played(protocol, sample, as_it_is)).level());
  return levels;
}

bool is_of_peaks(const Protocol& protocol) {
  return protocol.loudness == Loudness::peak || protocol.loudness == Loudness::felt_peak;
}

/// Of the two samples of a pair.
class PairRemarks {
 public:
  PairRemarks(const Protocol& protocol, const std::array<std::size_t, 2>& pair, const FeltLevel& first,
              const FeltLevel& second)
      : first_(first),
        second_(second),
        apart_(felt_apart(first, second)),
        names_(fmt::format("samples '{}' and '{}'", protocol.samples[pair[0]].name,
                           protocol.samples[pair[1]].name)),
        by_peak_(is_of_peaks(protocol)) {}

  [[nodiscard]] std::vector<std::string> told(SamplesTold told, const std::string& where) const {
    const bool named = told == SamplesTold::by_name;
    const std::string who = named ? names_ : std::string("two samples that are compared");
    std::vector<std::string> remarks;
    const double jnds = by_peak_ ? apart_.peak_jnds : apart_.rms_jnds;
    if (is_strength_apart(jnds)) {
      remarks.push_back(fmt::format("{} are {:.1f} JND apart in strength {}{}: strength may tell them apart",
                                    who, std::abs(jnds), where,
                                    named
                                        ? fmt::format(" ({} {:.3g} and {:.3g} N)", by_peak_ ? "peak" : "rms",
                                                      by_peak_ ? first_.peak_n : first_.rms_n,
                                                      by_peak_ ? second_.peak_n : second_.rms_n)
                                        : std::string()));
    }
    if (is_limit_apart(apart_)) {
      remarks.push_back(
          fmt::format("{} are cut to a limit of the device in unlike shares of the ticks {}{}: the limit may "
                      "tell them apart",
                      who, where,
                      named ? fmt::format(" ({:.2f} and {:.2f} %)", 100.0 * first_.limited_share,
                                          100.0 * second_.limited_share)
                            : std::string()));
    }
    if (is_vibration_apart(apart_)) {
      remarks.push_back(fmt::format(
          "{} vibrate {} dB apart from 20 Hz to 1 kHz {}{}: a buzz or the sound of the device may tell them "
          "apart",
          who,
          std::isfinite(apart_.vibration_db) ? fmt::format("{:.0f}", std::abs(apart_.vibration_db))
                                             : std::string("infinitely many"),
          where,
          named ? fmt::format(" ({:.2g} and {:.2g} N rms)", first_.vibration_n, second_.vibration_n)
                : std::string()));
    }
    return remarks;
  }

 private:
  const FeltLevel& first_;
  const FeltLevel& second_;
  FeltApart apart_;
  std::string names_;
  bool by_peak_;
};

}  // namespace

std::vector<std::string> felt_remarks(const Protocol& protocol, const std::string& device_uri,
                                      SamplesTold told) {
  if (has_levels(protocol.design) || !protocol.scale.levels.empty()) return {};
  std::optional<FeltRenderer> renderer;
  try {
    renderer.emplace(protocol, FeltOptions{.device_uri = device_uri, .stand_in = true});
  } catch (const std::invalid_argument& error) {
    if (told == SamplesTold::without_names) return {};
    return {fmt::format("how the samples are felt was not compared: {}", error.what())};
  }
  const std::vector<FeltLevel> levels = levels_of_samples(protocol, *renderer);
  const std::string where = renderer->stands_for().empty()
                                ? fmt::format("in the hand of {}", renderer->device_uri())
                                : fmt::format("in the hand of {}, simulated in place of {}",
                                              renderer->device_uri(), renderer->stands_for());
  std::vector<std::string> remarks;
  for (std::size_t tissue = 0; tissue < protocol.tissues.size(); ++tissue) {
    for (const auto& pair : pairs_of(protocol, tissue)) {
      for (std::string& remark :
           PairRemarks(protocol, pair, levels[pair[0]], levels[pair[1]]).told(told, where)) {
        if (std::ranges::find(remarks, remark) == remarks.end()) remarks.push_back(std::move(remark));
      }
    }
  }
  return remarks;
}

}  // namespace kerf::bench
