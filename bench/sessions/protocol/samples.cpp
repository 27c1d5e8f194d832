#include "protocol/samples.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/core.h>

#include <kerf/fitting/jnd.h>

#include "laws/placement.h"
#include "laws/render.h"

namespace kerf::bench {
namespace {

constexpr double largest_gain = 20.0;

/// Peak or root mean square of the force of a sample, at a gain of 1 [N].
double strength_of(const Protocol& protocol, std::size_t sample) {
  const LawFile& law = protocol.samples[sample].law;
  const std::vector<models::LawAxis> axes = axes_of(law);
  const std::vector<double> forces = forces_along(protocol, {.law = law});
  double sum = 0.0;
  double peak = 0.0;
  for (std::size_t i = 0; i < forces.size(); i += axes.size()) {
    double squared = 0.0;
    for (std::size_t axis = 0; axis < axes.size(); ++axis)
      squared += std::pow(1.0 / fitting::felt_lever(axes[axis].force_unit) * forces[i + axis], 2);
    sum += squared;
    peak = std::max(peak, squared);
  }
  const std::size_t ticks = forces.size() / axes.size();
  const bool by_peak = protocol.loudness == Loudness::peak || protocol.loudness == Loudness::felt_peak;
  return std::sqrt(by_peak ? peak : sum / static_cast<double>(ticks));
}

/// What a sample has to be multiplied with to be as strong as the first of its tissue.
double gain_beside(const Protocol& protocol, const std::vector<double>& strengths,
                   const SessionTissue& tissue, std::size_t sample) {
  const double gain = strengths[tissue.samples.front()] / strengths[sample];
  if (gain >= 1.0 / largest_gain && gain <= largest_gain) return gain;
  throw std::invalid_argument(fmt::format(
      "sample '{}' would need a gain of {:.3g} to be as strong as '{}', expected one from {:g} to {:g}; they "
      "are too unlike along the protocol's [motion]",
      protocol.samples[sample].name, gain, protocol.samples[tissue.samples.front()].name, 1.0 / largest_gain,
      largest_gain));
}

}  // namespace

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

OtherRendering rendering_of(const PlayedLaw& law, const drivers::DeviceInfo& device) {
  return {.step = [rendering = LawRendering(law.law.law, law.law.contact, axes_for(law.law, device)),
                   gain = law.gain](const drivers::Sample& now, double period_s) mutable {
    Command command = rendering(now, period_s);
    for (double& force : command.force) force *= gain;
    return command;
  }};
}

SampledMotion motion_along(const Protocol& protocol, const LawFile& law) {
  if (!protocol.motion) {
    throw std::invalid_argument(fmt::format(
        "protocol '{}' has no [motion], so it does not say along what forces are rendered", protocol.name));
  }
  MotionSource motion = *protocol.motion;
  motion.rate_hz = protocol.rate_hz;
  if (motion.scene.empty() && law.law.is_spatial()) {
    throw std::invalid_argument(
        fmt::format("law '{}' acts on several axes; the [motion] of protocol '{}' has to be a 'scene'",
                    law.law.model(), protocol.name));
  }
  return sampled(motion, law);
}

std::vector<double> forces_along(const Protocol& protocol, const PlayedLaw& law) {
  const std::vector<std::size_t> axes = own_axes(law.law);
  const RenderedMotion rendered = render(law.law, axes, motion_along(protocol, law.law));
  if (rendered.first_fault) {
    throw std::invalid_argument(fmt::format(
        "law '{}' faults along the [motion] of protocol '{}', first at {:.4g} s", law.law.law.model(),
        protocol.name, static_cast<double>(*rendered.first_fault) / protocol.rate_hz));
  }
  std::vector<double> forces;
  forces.reserve(rendered.force.size() * axes.size());
  for (const drivers::Axes& force : rendered.force) {
    for (const std::size_t axis : axes) forces.push_back(law.gain * force[axis]);
  }
  return forces;
}

void match_loudness(Protocol& protocol) {
  if (protocol.loudness == Loudness::as_they_are) return;
  std::vector<double> strengths;
  for (std::size_t sample = 0; sample < protocol.samples.size(); ++sample) {
    strengths.push_back(strength_of(protocol, sample));
    if (strengths.back() > 0.0 || sample == protocol.catches.sample) continue;
    throw std::invalid_argument(
        fmt::format("sample '{}' has no force along the [motion] of protocol '{}', so it cannot be made as "
                    "strong as the others; does the motion reach its contact?",
                    protocol.samples[sample].name, protocol.name));
  }
  std::vector<std::optional<double>> gains(protocol.samples.size());
  for (const SessionTissue& tissue : protocol.tissues) {
    for (const std::size_t sample : tissue.samples) {
      const double gain = gain_beside(protocol, strengths, tissue, sample);
      const double before = gains[sample].value_or(gain);
      if (std::abs(gain - before) > 1e-9 * before) {
        throw std::invalid_argument(fmt::format(
            "sample '{}' would need a gain of {:.4g} in tissue '{}' and of {:.4g} in one before it; give the "
            "tissue a sample of its own",
            protocol.samples[sample].name, gain, tissue.name, before));
      }
      gains[sample] = gain;
    }
  }
  for (std::size_t sample = 0; sample < gains.size(); ++sample)
    protocol.samples[sample].gain = gains[sample].value_or(1.0);
  protocol.gain_origin = GainOrigin{};
}

}  // namespace kerf::bench
