#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "felt/felt_forces.h"
#include "observers/observer.h"

namespace kerf::bench {

/// By what two renderings are told apart.
enum class ToldBy : std::uint8_t {
  as_the_design_asks,  ///< levels by strength, everything else by the difference in kind
  strength,
  difference,
};

struct SensationOptions {
  FeltOptions felt;
  ToldBy by = ToldBy::as_the_design_asks;
  Loudest strength = Loudest::rms;
  /// All pairs lie so many d' apart for the observer, whatever their laws render; of designs without levels.
  std::optional<double> d_prime;
};

/// What a sample is like, for a report.
struct FeltSample {
  std::string name;
  double rms_n = 0.0;
  double peak_n = 0.0;
  double limited_share = 0.0;  ///< of the ticks
};

/// How far two renderings lie apart in kind, in JNDs:
///
///     D = rms over the ticks that have a force of |F1 - F2| / j((|F1| + |F2|) / 2)
///
/// What is stronger by one JND throughout is one JND apart.
/// @throws std::invalid_argument: of unlike length.
[[nodiscard]] double difference_in_jnds(const Observer& observer, const FeltForces& first,
                                        const FeltForces& second);

/// How far the two of a trial lie apart for an observer, from the forces that their laws really render.
///
/// Without levels that is the difference in kind, with the first of the pair at 0: an observer who is asked
/// for a signal ("which one rubbed?") feels by how much the signal differs. With levels it is the strength
/// u(F): that of the comparison less that of the standard, above 0 where the comparison has more of what the
/// scale varies. Two renderings of a law that chatters are never equally strong, so that the strength over
/// the levels x is a smooth curve through what was rendered, 0 at the standard:
///
///     u(x) - u(0) = sum over k = 1 ... 4 of c_k x^k,   by least squares; scatter() is the rest
class Sensation {
 public:
  /// Renders every sample, and the standard at 33 levels at least.
  /// @throws std::invalid_argument, drivers::DeviceError.
  Sensation(const Protocol& protocol, const Observer& observer, const SensationOptions& options);

  /// In JNDs; below 0 only by strength.
  [[nodiscard]] double jnds(const std::array<std::size_t, 2>& pair, double level) const;

  /// Of a catch trial, of its pair; 0 or more. Always what the laws render.
  [[nodiscard]] double catch_jnds(const std::array<std::size_t, 2>& pair) const { return catches_.at(pair); }
  /// How strong a sample is in JNDs, from no force on; where pairs are to be so many d' apart, as many times
  /// that as its number from 0.
  [[nodiscard]] double strength(std::size_t sample) const { return strengths_.at(sample); }

  [[nodiscard]] const std::vector<FeltSample>& samples() const noexcept { return samples_; }
  /// The levels that were rendered, ascending; none without levels.
  [[nodiscard]] const std::vector<double>& levels() const noexcept { return levels_; }
  /// Root mean square of what was rendered about the curve, in JNDs.
  [[nodiscard]] double scatter() const noexcept { return scatter_; }
  [[nodiscard]] bool is_by_strength() const noexcept { return by_strength_; }
  [[nodiscard]] const std::string& device_uri() const noexcept { return device_uri_; }  ///< empty: open loop

 private:
  std::vector<FeltSample> samples_;
  std::vector<double> strengths_;
  std::map<std::array<std::size_t, 2>, double> pairs_;
  std::map<std::array<std::size_t, 2>, double> catches_;
  std::vector<double> levels_;
  void fit(const std::vector<double>& rendered);

  std::vector<double> coefficients_;  ///< of x, x^2 ...
  double scatter_ = 0.0;
  bool by_strength_ = false;
  std::string device_uri_;
};

}  // namespace kerf::bench
