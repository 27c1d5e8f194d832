#include "verify/verify.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>

#include <kerf/models/law.h>

namespace kerf::bench {
namespace {

/// How deep a law has something to say [m or rad].
double depth_of(const LawFile& law) {
  if (law.fit.range) return std::max(std::abs(law.fit.range->least), std::abs(law.fit.range->most));
  // Deep enough for what gives way.
  double depth = law.position_unit == "rad" ? 0.8 : 0.08;
  const auto infos = law.law.parameters();
  for (std::size_t i = 0; i < infos.size(); ++i) {
    if (infos[i].quantity == models::Quantity::position)
      depth = std::max(depth, std::abs(law.law.values()[i]));
  }
  if (const auto last = law.law.options().find("last"); last != law.law.options().end())
    depth = std::max(depth, std::abs(std::get<double>(last->second)));
  return depth;
}

/// Places between two numbers among all of their kind, where neighbours are one apart.
template <typename Whole, typename Real>
double places_between(Real a, Real b) {
  const auto from_zero = [](Real value) {
    return static_cast<std::uint64_t>(std::bit_cast<Whole>(std::abs(value)));
  };
  const std::uint64_t of_a = from_zero(a);
  const std::uint64_t of_b = from_zero(b);
  // Before it is a double, which has not the bits for the places themselves.
  if (std::signbit(a) != std::signbit(b)) return static_cast<double>(of_a) + static_cast<double>(of_b);
  return static_cast<double>(of_a > of_b ? of_a - of_b : of_b - of_a);
}

double ulps_between(double a, double b, bool single) {
  const auto single_a = static_cast<float>(a);
  const auto single_b = static_cast<float>(b);
  if (single && static_cast<double>(single_a) == a && static_cast<double>(single_b) == b)
    return places_between<std::uint32_t>(single_a, single_b);
  return places_between<std::uint64_t>(a, b);
}

}  // namespace

std::vector<HostSample> samples_for(const LawFile& law, std::size_t count) {
  std::mt19937_64 random(20261130);
  const auto uniform = [&] { return static_cast<double>(random() >> 11U) * 0x1p-53; };
  const double depth = depth_of(law);
  std::vector<HostSample> samples(count);
  double time_s = 0.0;
  double last = law.contact.position;
  for (std::size_t i = 0; i < count; ++i) {
    // 1 ms, sometimes late, and now and then a stall.
    double elapsed_s = 1e-3;
    if (i % 7 == 3) elapsed_s *= 0.9 + 0.2 * uniform();
    if (i % 997 == 996) elapsed_s = 0.05;
    time_s += elapsed_s;
    // Slow cycles that grow and fall, a tremor on them, and a rest of a fifth of a second every two.
    const double swell = 0.65 + 0.5 * std::sin(2.0 * std::numbers::pi * time_s / 13.7);
    const double cycle = 0.5 - 0.6 * std::cos(2.0 * std::numbers::pi * time_s / 1.9);
    const double tremor = 0.01 * std::sin(2.0 * std::numbers::pi * 9.3 * time_s);
    const double noise = 1e-4 * (uniform() - 0.5);
    const bool rests = std::fmod(time_s, 2.0) < 0.2;
    const double penetration = depth * (swell * cycle + tremor + noise);
    const double position = rests ? last : law.contact.position + law.contact.direction * penetration;
    samples[i] = {.position = position, .velocity = (position - last) / elapsed_s, .elapsed_s = elapsed_s};
    last = position;
  }
  return samples;
}

std::vector<double> own_forces(const LawFile& law, const std::vector<HostSample>& samples) {
  models::Law::State state = law.law.initial_state();
  std::vector<double> forces;
  forces.reserve(samples.size());
  for (const HostSample& sample : samples) {
    const models::Response response =
        law.law.step(state, law.contact.motion(sample.position, sample.velocity), sample.elapsed_s);
    forces.push_back(response.fault ? std::numeric_limits<double>::quiet_NaN()
                                    : law.contact.force_on_axis(response.force));
  }
  return forces;
}

Verified compared(const std::vector<double>& own, const std::vector<double>& host, bool single) {
  Verified result{.samples = own.size()};
  for (std::size_t i = 0; i < own.size(); ++i) {
    if (std::isnan(own[i]) || std::isnan(host[i])) {
      result.faults += std::isnan(own[i]) == std::isnan(host[i]) ? 0 : 1;
      continue;
    }
    result.most_force = std::max(result.most_force, std::abs(own[i]));
    result.largest = std::max(result.largest, std::abs(own[i] - host[i]));
    const double ulp = own[i] == host[i] ? 0.0 : ulps_between(own[i], host[i], single);
    if (ulp > result.largest_ulp) {
      result.largest_ulp = ulp;
      result.at = i;
    }
  }
  return result;
}

Verified verify(const Host& host, const ExportedLaw& law, const std::filesystem::path& folder,
                std::size_t count) {
  const std::vector<HostSample> samples = samples_for(law.file, count);
  const auto precision = law.file.law.options().find("precision");
  const bool single =
      precision != law.file.law.options().end() && std::get<std::string>(precision->second) == "float";
  return compared(own_forces(law.file, samples), host.forces(law, folder, samples), single);
}

}  // namespace kerf::bench
