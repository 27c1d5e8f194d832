#include "signal/filters.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <numbers>
#include <stdexcept>

#include <fmt/core.h>

namespace kerf::bench {
namespace {

using std::numbers::pi;

struct Named {
  std::string_view name;
  FilterKind kind;
  bool has_window;
};
constexpr std::array<Named, 6> named{{{"butterworth2", FilterKind::butterworth2, false},
                                      {"butterworth4", FilterKind::butterworth4, false},
                                      {"critically-damped", FilterKind::critically_damped, false},
                                      {"first-order", FilterKind::first_order, false},
                                      {"moving-mean", FilterKind::moving_mean, true},
                                      {"savitzky-golay", FilterKind::savitzky_golay, true}}};

const Named& name_of(FilterKind kind) { return *std::ranges::find(named, kind, &Named::kind); }

[[noreturn]] void refuse(std::string_view text) {
  std::string names;
  for (const Named& one : named) {
    names += fmt::format("{}{}:{}", names.empty() ? "" : ", ", one.name, one.has_window ? "SECONDS" : "HZ");
  }
  throw std::invalid_argument(
      fmt::format("--filter: '{}' is no filter; expected one of {}; units Hz, rad/s, s, ms", text, names));
}

/// Weights of a window of `count` samples, the oldest first, for the value at sample `at`.
std::vector<double> parabola_weights(std::size_t count, std::size_t at) {
  // With u from -1 to 1, the value at u0 of the parabola of least squares is a sum of Legendre-like
  // polynomials that are orthogonal on these very samples.
  const double middle = 0.5 * static_cast<double>(count - 1);
  const auto u = [&](std::size_t i) { return (static_cast<double>(i) - middle) / middle; };
  double squares = 0.0;
  for (std::size_t i = 0; i < count; ++i) squares += u(i) * u(i);
  const double mean_square = squares / static_cast<double>(count);
  double quartic = 0.0;
  for (std::size_t i = 0; i < count; ++i) quartic += std::pow(u(i) * u(i) - mean_square, 2);
  std::vector<double> weights;
  for (std::size_t i = 0; i < count; ++i) {
    weights.push_back(1.0 / static_cast<double>(count) + u(at) * u(i) / squares +
                      (u(at) * u(at) - mean_square) * (u(i) * u(i) - mean_square) / quartic);
  }
  return weights;
}

std::complex<double> unit_delay(double frequency_hz, double rate_hz) {
  return std::polar(1.0, -2.0 * pi * frequency_hz / rate_hz);
}

}  // namespace

FilterSpec parse_filter(std::string_view text, bool causal) {
  const auto colon = text.find(':');
  if (colon == std::string_view::npos) refuse(text);
  const auto found = std::ranges::find(named, text.substr(0, colon), &Named::name);
  if (found == named.end()) refuse(text);
  const std::string_view rest = text.substr(colon + 1);
  double number = 0.0;
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), number);
  if (error != std::errc{} || !(number > 0.0) || !std::isfinite(number)) refuse(text);
  const std::string_view unit(end, static_cast<std::size_t>(rest.data() + rest.size() - end));
  FilterSpec filter{.kind = found->kind, .causal = causal};
  if (found->has_window) {
    if (unit != "" && unit != "s" && unit != "ms") refuse(text);
    filter.window_s = unit == "ms" ? 1e-3 * number : number;
  } else {
    if (unit != "" && unit != "Hz" && unit != "rad/s") refuse(text);
    filter.corner_hz = unit == "rad/s" ? number / (2.0 * pi) : number;
  }
  return filter;
}

std::string to_text(const FilterSpec& filter) {
  const Named& about = name_of(filter.kind);
  const std::string size =
      about.has_window ? fmt::format("{}s", filter.window_s) : fmt::format("{}Hz", filter.corner_hz);
  return fmt::format("{}:{} {}", about.name, size, filter.causal ? "causal" : "zero-phase");
}

SampledFilter::SampledFilter(const FilterSpec& spec, double rate_hz) : spec_(spec), rate_hz_(rate_hz) {
  if (name_of(spec.kind).has_window) {
    // Rounded to the nearest odd number of samples, so that the middle is one of them.
    const double half = std::round(0.5 * (spec.window_s * rate_hz - 1.0));
    if (!(half >= 1.0) || half > 1e6) {
      throw std::invalid_argument(fmt::format(
          "--filter: a window of {:g} s holds fewer than three samples at {:.6g} Hz; choose a longer one",
          spec.window_s, rate_hz));
    }
    const auto count = 2 * static_cast<std::size_t>(half) + 1;
    weights_ = spec.kind == FilterKind::moving_mean
                   ? std::vector<double>(count, 1.0 / static_cast<double>(count))
                   : parabola_weights(count, spec.causal ? count - 1 : (count - 1) / 2);
    return;
  }
  if (!(spec.corner_hz > 0.0 && spec.corner_hz < 0.5 * rate_hz)) {
    throw std::invalid_argument(
        fmt::format("a corner of {} Hz is not between zero and half the rate of {} Hz; choose a lower one",
                    spec.corner_hz, rate_hz));
  }
  const double warped = std::tan(pi * spec.corner_hz / rate_hz);
  const auto add_second_order = [&](double damping, double corner) {
    const double norm = 1.0 / (1.0 + damping * corner + corner * corner);
    const double b0 = corner * corner * norm;
    sections_.push_back({.b0 = b0,
                         .b1 = 2.0 * b0,
                         .b2 = b0,
                         .a1 = 2.0 * (corner * corner - 1.0) * norm,
                         .a2 = (1.0 - damping * corner + corner * corner) * norm});
  };
  if (spec.kind == FilterKind::butterworth2) {
    add_second_order(std::numbers::sqrt2, warped);
  } else if (spec.kind == FilterKind::butterworth4) {
    add_second_order(2.0 * std::cos(pi / 8.0), warped);
    add_second_order(2.0 * std::cos(3.0 * pi / 8.0), warped);
  } else if (spec.kind == FilterKind::critically_damped) {
    add_second_order(2.0, warped / std::sqrt(std::numbers::sqrt2 - 1.0));
  } else {
    const double b0 = warped / (1.0 + warped);
    sections_.push_back({.b0 = b0, .b1 = b0, .b2 = 0.0, .a1 = (warped - 1.0) / (warped + 1.0), .a2 = 0.0});
  }
}

SampledFilter::Recursion::Recursion(std::span<const Section> sections, double first) : sections_(sections) {
  double in = first;
  for (std::size_t i = 0; i < sections_.size(); ++i) {
    const Section& s = sections_[i];
    const double second = (s.b2 - s.a2) * in;
    states_[i] = {.first = (s.b1 - s.a1) * in + second, .second = second};
    in = s.b0 * in + states_[i].first;
  }
}

/// Each section in transposed direct form II.
double SampledFilter::Recursion::step(double in) noexcept {
  for (std::size_t i = 0; i < sections_.size(); ++i) {
    const Section& s = sections_[i];
    State& state = states_[i];
    const double out = s.b0 * in + state.first;
    state.first = s.b1 * in - s.a1 * out + state.second;
    state.second = s.b2 * in - s.a2 * out;
    in = out;
  }
  return in;
}

void SampledFilter::run_sections(std::vector<double>& values) const {
  Recursion run = settled_at(values.front());
  for (double& value : values) value = run.step(value);
}

std::size_t SampledFilter::mirrored(std::uint64_t samples) const {
  if (samples < 2) throw std::invalid_argument("a filter needs at least two samples");
  if (sections_.empty() || spec_.causal) {
    throw std::invalid_argument("only a recursive zero-phase filter sees mirrored samples");
  }
  return static_cast<std::size_t>(
      std::min<std::uint64_t>(samples - 1, static_cast<std::uint64_t>(5.0 * rate_hz_ / spec_.corner_hz) + 1));
}

std::vector<double> SampledFilter::run_window(std::span<const double> values) const {
  const auto reach = static_cast<std::ptrdiff_t>(spec_.causal ? weights_.size() - 1 : weights_.size() / 2);
  const auto count = static_cast<std::ptrdiff_t>(values.size());
  const auto at = [&](std::ptrdiff_t i) {
    if (i < 0 && spec_.causal) return values.front();
    const auto inside =
        static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(i < 0 ? -i : 2 * (count - 1) - i, 0, count - 1));
    if (i < 0) return 2.0 * values.front() - values[inside];
    if (i >= count) return 2.0 * values.back() - values[inside];
    return values[static_cast<std::size_t>(i)];
  };
  std::vector<double> result;
  result.reserve(values.size());
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    double sum = 0.0;
    for (std::size_t k = 0; k < weights_.size(); ++k) {
      sum += weights_[k] * at(i - reach + static_cast<std::ptrdiff_t>(k));
    }
    result.push_back(sum);
  }
  return result;
}

std::vector<double> SampledFilter::run(std::span<const double> values) const {
  if (values.size() < 2) throw std::invalid_argument("a filter needs at least two samples");
  if (sections_.empty()) return run_window(values);
  if (spec_.causal) {
    std::vector<double> result(values.begin(), values.end());
    run_sections(result);
    return result;
  }
  const std::size_t count = values.size();
  const std::size_t reach = mirrored(count);
  std::vector<double> extended;
  extended.reserve(count + 2 * reach);
  for (std::size_t i = reach; i > 0; --i) extended.push_back(2.0 * values.front() - values[i]);
  extended.insert(extended.end(), values.begin(), values.end());
  for (std::size_t i = 1; i <= reach; ++i) extended.push_back(2.0 * values.back() - values[count - 1 - i]);
  run_sections(extended);
  std::reverse(extended.begin(), extended.end());
  run_sections(extended);
  std::reverse(extended.begin(), extended.end());
  const auto begin = extended.begin() + static_cast<std::ptrdiff_t>(reach);
  return {begin, begin + static_cast<std::ptrdiff_t>(count)};
}

std::vector<Response> SampledFilter::response(std::span<const double> frequencies_hz) const {
  const auto at = [&](double frequency_hz) {
    const std::complex<double> z = unit_delay(frequency_hz, rate_hz_);
    std::complex<double> h(1.0, 0.0);
    for (const Recursion::Section& s : sections_)
      h *= (s.b0 + z * (s.b1 + z * s.b2)) / (1.0 + z * (s.a1 + z * s.a2));
    if (sections_.empty()) {
      h = 0.0;
      const double newest = static_cast<double>(spec_.causal ? weights_.size() - 1 : weights_.size() / 2);
      for (std::size_t k = 0; k < weights_.size(); ++k) {
        const double age = newest - static_cast<double>(k);
        h += weights_[k] * unit_delay(age * frequency_hz, rate_hz_);
      }
      // The window's middle is real; what rounding leaves beside it would be a phase of its own.
      if (!spec_.causal) h = h.real();
    } else if (!spec_.causal) {
      h = std::norm(h);
    }
    return h;
  };
  // The angle is followed in steps that no filter here turns by half a turn within.
  const double step_hz = weights_.empty() ? std::min(rate_hz_ / 32.0, spec_.corner_hz / 8.0)
                                          : rate_hz_ / (32.0 * static_cast<double>(weights_.size()));
  std::vector<Response> responses;
  double followed_hz = 0.0;
  std::complex<double> last = 1.0;
  double phase = 0.0;
  for (const double frequency_hz : frequencies_hz) {
    while (spec_.causal && followed_hz < frequency_hz) {
      const double step = std::min(frequency_hz, followed_hz + step_hz);
      const std::complex<double> now = at(step);
      if (std::abs(last) > 0.0 && std::abs(now) > 0.0) phase += std::arg(now / last);
      followed_hz = step;
      last = now;
    }
    const std::complex<double> h = at(frequency_hz);
    const double phase_deg = spec_.causal ? phase * 180.0 / pi : (h.real() < 0.0 ? 180.0 : 0.0);
    responses.push_back({.frequency_hz = frequency_hz,
                         .gain = std::abs(h),
                         .phase_deg = phase_deg,
                         .delay_ms = spec_.causal ? -phase_deg / 360.0 / frequency_hz * 1e3 : 0.0});
  }
  return responses;
}

}  // namespace kerf::bench
