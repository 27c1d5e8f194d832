#include "felt/felt_gains.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include "felt/felt_forces.h"

namespace kerf::bench {
namespace {

constexpr double ln_step = 0.000999500333083533;  ///< ln 1.001
constexpr int most_steps = 2997;                  ///< a gain of 20
constexpr int most_tries = 40;

double gain_of(int steps) { return std::exp(ln_step * steps); }

bool is_felt(Loudness loudness) { return loudness == Loudness::felt_peak || loudness == Loudness::felt_rms; }

/// What a sample is felt like with a gain.
class FeltLoudness {
 public:
  FeltLoudness(const Protocol& protocol, const FeltRenderer& renderer)
      : protocol_(protocol), renderer_(renderer) {}

  [[nodiscard]] double of(std::size_t sample, double gain) const {
    const FeltForces felt = renderer_.rendered({.law = protocol_.samples[sample].law, .gain = gain});
    return protocol_.loudness == Loudness::felt_peak ? felt.peak_n() : felt.rms_n(least_felt_force_n);
  }
  [[nodiscard]] const std::string& name(std::size_t sample) const { return protocol_.samples[sample].name; }

 private:
  const Protocol& protocol_;
  const FeltRenderer& renderer_;
};

struct FeltGain {
  double gain = 1.0;
  double level_n = 0.0;
};

/// @throws std::invalid_argument: none is found.
FeltGain beside(const FeltLoudness& loudness, std::size_t first, std::size_t sample, double wanted_n,
                const std::string& hand) {
  const GainSearch search =
      gain_for([&](double gain) { return loudness.of(sample, gain); }, wanted_n, felt_tolerance);
  if (search.is_found) return {.gain = search.gain, .level_n = search.level};
  throw std::invalid_argument(fmt::format(
      "in the hand of {} no gain from 0.05 to 20 makes sample '{}' as strong as '{}' to {:g} %: {:.3g} N are "
      "felt at a gain of {:.3g}, and {:.3g} N are wanted",
      hand, loudness.name(sample), loudness.name(first), 100.0 * felt_tolerance, search.level, search.gain,
      wanted_n));
}

/// The gains of all samples. @throws std::invalid_argument.
std::vector<FeltGain> felt_gains(const Protocol& protocol, const FeltRenderer& renderer) {
  const FeltLoudness loudness(protocol, renderer);
  std::vector<std::optional<FeltGain>> found(protocol.samples.size());
  for (const SessionTissue& tissue : protocol.tissues) {
    const std::size_t first = tissue.samples.front();
    if (!found[first]) found[first] = FeltGain{.level_n = loudness.of(first, 1.0)};
    const double wanted_n = found[first]->level_n;
    if (wanted_n == 0.0) {
      throw std::invalid_argument(fmt::format("sample '{}' has no force of {:g} N in the hand of {}",
                                              loudness.name(first), least_felt_force_n,
                                              renderer.device_uri()));
    }
    for (const std::size_t sample : tissue.samples) {
      if (!found[sample]) found[sample] = beside(loudness, first, sample, wanted_n, renderer.device_uri());
      if (std::abs(found[sample]->level_n - wanted_n) <= 2.0 * felt_tolerance * wanted_n) continue;
      throw std::invalid_argument(
          fmt::format("sample '{}' is in tissue '{}', where {:.3g} N are wanted, and in one before it, which "
                      "made it {:.3g} N; give the tissue a sample of its own",
                      loudness.name(sample), tissue.name, wanted_n, found[sample]->level_n));
    }
  }
  std::vector<FeltGain> gains;
  for (const auto& one : found) gains.push_back(one.value_or(FeltGain{}));
  return gains;
}

void find_in_closed_loop(Protocol& protocol, const std::string& device_uri) {
  const FeltRenderer renderer(protocol, {.device_uri = device_uri, .stand_in = true});
  const std::vector<FeltGain> gains = felt_gains(protocol, renderer);
  GainOrigin origin{.hand = renderer.device_uri(),
                    .stands_for = renderer.stands_for(),
                    .fallback = {},
                    .tolerance = felt_tolerance,
                    .felt_n = {}};
  for (std::size_t sample = 0; sample < gains.size(); ++sample) {
    protocol.samples[sample].gain = gains[sample].gain;
    origin.felt_n.push_back(gains[sample].level_n);
  }
  protocol.gain_origin = std::move(origin);
}

}  // namespace

GainSearch gain_for(const std::function<double(double gain)>& level_at, double wanted, double tolerance) {
  struct Tried {
    int steps = 0;
    double error = 0.0;  ///< ln of the level over that wanted
  };
  std::optional<Tried> too_little;
  std::optional<Tried> too_much;
  std::optional<Tried> last;
  GainSearch closest{.gain = 1.0, .level = 0.0};
  double least = std::numeric_limits<double>::infinity();
  int steps = 0;
  for (int tries = 0; tries < most_tries; ++tries) {
    const double level = level_at(gain_of(steps));
    // No force at all is far too little, and tells nothing of how far.
    const Tried now{.steps = steps, .error = level > 0.0 ? std::log(level / wanted) : -10.0};
    if (std::abs(now.error) < least) {
      least = std::abs(now.error);
      closest = {.gain = gain_of(steps), .level = level};
    }
    closest.is_found = std::abs(closest.level - wanted) <= tolerance * wanted;
    if (closest.is_found) return closest;
    (now.error < 0.0 ? too_little : too_much) = now;
    const int lower = too_little ? too_little->steps : -most_steps - 1;
    const int upper = too_much ? too_much->steps : most_steps + 1;
    if (std::abs(upper - lower) <= 1) return closest;
    const double slope = last && last->steps != steps && std::abs(now.error - last->error) > 0.0
                             ? (now.error - last->error) / (ln_step * (steps - last->steps))
                             : 1.0;
    const double next = steps - now.error / (ln_step * slope);
    last = now;
    const auto [least_next, most_next] = std::minmax(lower, upper);
    const bool is_within = next > least_next && next < most_next;
    if (is_within && tries % 4 != 3) {
      steps = std::clamp(static_cast<int>(std::lround(next)), least_next + 1, most_next - 1);
    } else if (too_little && too_much) {
      steps = (lower + upper) / 2;
    } else {
      const int end = now.error < 0.0 ? most_steps : -most_steps;
      if (steps == end) return closest;
      steps = end;
    }
  }
  return closest;
}

std::vector<std::string> find_gains(Protocol& protocol, const std::string& device_uri) {
  if (!is_felt(protocol.loudness)) {
    match_loudness(protocol);
    return {};
  }
  std::string fallback;
  try {
    find_in_closed_loop(protocol, device_uri);
  } catch (const std::invalid_argument& error) {
    fallback = error.what();
  }
  if (fallback.empty()) {
    const GainOrigin& origin = *protocol.gain_origin;
    if (origin.stands_for.empty()) return {};
    return {fmt::format("{} has no simulated hand; the gains were found in that of {}, with its limits",
                        origin.stands_for, origin.hand)};
  }
  if (!protocol.motion)
    throw std::invalid_argument(fmt::format(
        "{}; there is no [motion] either, along which gains could be found in open loop", fallback));
  match_loudness(protocol);
  protocol.gain_origin->fallback = fallback;
  return {fmt::format("the gains were found in open loop, along the [motion]: {}", fallback)};
}

}  // namespace kerf::bench
