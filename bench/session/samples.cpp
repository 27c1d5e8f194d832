#include "session/samples.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/core.h>

namespace kerf::bench {

std::vector<std::size_t> parameters_named(const models::Law& law, std::string_view name) {
  std::vector<std::size_t> places;
  const auto infos = law.parameters();
  for (std::size_t i = 0; i < infos.size(); ++i) {
    const std::string_view whole = infos[i].name;
    if (whole == name || whole.substr(0, whole.find('[')) == name) places.push_back(i);
  }
  return places;
}

PlayedLaw played(const Protocol& protocol, std::size_t sample, double level) {
  const SessionSample& standard = protocol.samples.at(sample);
  PlayedLaw played{.law = standard.law, .gain = standard.gain};
  if (std::isnan(level)) return played;
  if (protocol.scale.parameters.empty()) {
    played.gain *= 1.0 + level;
    return played;
  }
  const models::Law& law = standard.law.law;
  std::vector<bool> varies(law.values().size(), false);
  for (const std::string& name : protocol.scale.parameters) {
    for (const std::size_t place : parameters_named(law, name)) varies[place] = true;
  }
  std::vector<double> values = law.values();
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (varies[i]) values[i] *= 1.0 + level;
  }
  try {
    played.law.law = models::Law::make(law.model(), values, law.options());
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(
        fmt::format("sample '{}' cannot be played at level {:g}: {}", standard.name, level, error.what()));
  }
  played.law.std_errors.clear();
  return played;
}

std::vector<PlayedLaw> played(const Protocol& protocol, const TrialPlan& trial) {
  constexpr double as_it_is = std::numeric_limits<double>::quiet_NaN();
  return {played(protocol, trial.pair[0], as_it_is), played(protocol, trial.pair[1], trial.level)};
}

}  // namespace kerf::bench
