#pragma once

#include <complex>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace kerf::compare {

/// Windows of a signal, each without its straight line and under a Hann window, that overlap by half.
struct Windows {
  std::size_t length = 0;  ///< rows, a power of two
  std::size_t count = 0;
  [[nodiscard]] std::size_t begin(std::size_t window) const noexcept { return window * length / 2; }
};

/// Windows of about `seconds`; none if there are fewer rows than one has.
[[nodiscard]] Windows windows_of(std::size_t rows, double rate_hz, double seconds);

/// The spectrum of one window, frequencies 0 to half the rate: `length / 2 + 1` values, scaled so that the
/// squares of their sizes add up to the mean square of the window's signal.
class WindowSpectrum {
 public:
  explicit WindowSpectrum(std::size_t length);
  ~WindowSpectrum();

  /// Of so many values; those that are not finite count as zero.
  [[nodiscard]] const std::vector<std::complex<double>>& of(std::span<const double> values);

 private:
  struct Transform;
  std::unique_ptr<Transform> transform_;
};

/// The plain transform of real values, filled up with zeros to a power of two of `length` or more.
[[nodiscard]] std::vector<std::complex<double>> transform_of(std::span<const double> values,
                                                             std::size_t length);
/// Back from it: `length` real values.
[[nodiscard]] std::vector<double> back_from(const std::vector<std::complex<double>>& spectrum,
                                            std::size_t length);

}  // namespace kerf::compare
