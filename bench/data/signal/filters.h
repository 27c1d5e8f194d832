#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kerf::bench {

enum class FilterKind {
  butterworth2,
  butterworth4,
  critically_damped,
  first_order,
  moving_mean,
  savitzky_golay
};

/// A low-pass for uniform samples.
///
/// Recursive ones have their -3 dB at `corner_hz` when they are run once, by the bilinear transform with the
/// corner prewarped; zero phase runs them forward and backward, which squares the gain (-6 dB at the corner)
/// and takes the phase away. With w = corner in rad/s:
///
///     first_order        w / (s + w)
///     butterworth2       w^2 / (s^2 + sqrt(2) w s + w^2)
///     butterworth4       two such sections, of dampings 2 cos(pi/8) and 2 cos(3 pi/8)
///     critically_damped  (c / (s + c))^2,  c = w / sqrt(sqrt(2) - 1): no overshoot
///
/// Those with a window take its samples, an odd number of them: the mean (moving_mean), or the value of the
/// parabola of least squares (savitzky_golay), in the window's middle for zero phase and at its newest sample
/// if causal. They are run once.
struct FilterSpec {
  FilterKind kind = FilterKind::butterworth2;
  double corner_hz = 20.0;  ///< of a recursive filter
  double window_s = 0.0;    ///< of one with a window
  bool causal = false;      ///< else zero phase
};

/// Reads `butterworth2:20`, `butterworth4:20Hz`, `critically-damped:20`, `first-order:10rad/s`,
/// `moving-mean:0.02` and `savitzky-golay:20ms`: Hz or seconds unless a unit says otherwise.
/// @throws std::invalid_argument that says how one is written.
[[nodiscard]] FilterSpec parse_filter(std::string_view text, bool causal);

/// "butterworth2:20Hz zero-phase", which parse_filter() reads up to the blank.
[[nodiscard]] std::string to_text(const FilterSpec& filter);

/// What a filter does to a sine.
struct Response {
  double frequency_hz = 0.0;
  double gain = 1.0;       ///< output amplitude over input amplitude
  double phase_deg = 0.0;  ///< of the output; negative lags; continuous from 0 at 0 Hz
  double delay_ms = 0.0;   ///< phase delay: -phase / (360 frequency)
};

/// A filter made for one rate: runs over samples and knows its own response, exactly that of its
/// coefficients.
class SampledFilter {
 public:
  /// @throws std::invalid_argument unless the corner is below half the rate, or the window holds three
  /// samples.
  SampledFilter(const FilterSpec& spec, double rate_hz);

  /// Zero phase begins and ends with the samples mirrored through the first and the last (odd reflection); a
  /// causal filter begins settled at the first sample. At least two samples.
  [[nodiscard]] std::vector<double> run(std::span<const double> values) const;

  /// How many samples a recursive zero-phase filter sees mirrored before the first of so many, and after the
  /// last. @throws std::invalid_argument for another kind of filter, or fewer than two samples.
  [[nodiscard]] std::size_t mirrored(std::uint64_t samples) const;

  /// The sections of a recursive filter on their way over samples: all that it remembers of those before.
  class Recursion {
   public:
    struct Section {
      double b0, b1, b2, a1, a2;
    };
    /// Settled at the first sample that comes.
    Recursion(std::span<const Section> sections, double first);
    [[nodiscard]] double step(double in) noexcept;

   private:
    struct State {
      double first = 0.0;
      double second = 0.0;
    };
    std::span<const Section> sections_;
    std::array<State, 2> states_{};
  };
  /// Valid as long as the filter. Of a recursive filter only.
  [[nodiscard]] Recursion settled_at(double first) const { return {sections_, first}; }

  /// Frequencies increase, each above 0 and at most half the rate.
  [[nodiscard]] std::vector<Response> response(std::span<const double> frequencies_hz) const;

 private:
  void run_sections(std::vector<double>& values) const;
  [[nodiscard]] std::vector<double> run_window(std::span<const double> values) const;

  FilterSpec spec_;
  double rate_hz_;
  std::vector<Recursion::Section> sections_;  ///< of a recursive filter
  std::vector<double> weights_;               ///< of one with a window, the oldest sample first
};

}  // namespace kerf::bench
