#include "spectrum.h"

#include <bit>
#include <cmath>
#include <numbers>

#include <unsupported/Eigen/FFT>

namespace kerf::compare {
namespace {

using Fourier = Eigen::FFT<double>;

/// Takes the straight line out of values, by least squares.
void take_line_out(std::vector<double>& values) {
  const auto count = static_cast<double>(values.size());
  double sum = 0.0;
  double moment = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    sum += values[i];
    moment += (static_cast<double>(i) - 0.5 * (count - 1.0)) * values[i];
  }
  const double slope = moment * 12.0 / (count * (count * count - 1.0));
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] -= sum / count + slope * (static_cast<double>(i) - 0.5 * (count - 1.0));
}

}  // namespace

Windows windows_of(std::size_t rows, double rate_hz, double seconds) {
  const double wanted = rate_hz * seconds;
  if (!(wanted >= 2.0) || wanted > 1e9) return {};
  Windows windows{.length = std::bit_ceil(static_cast<std::size_t>(wanted * 0.75))};
  if (rows < windows.length || windows.length < 8) return {};
  windows.count = 2 * (rows - windows.length) / windows.length + 1;
  return windows;
}

struct WindowSpectrum::Transform {
  Fourier fourier;
  std::vector<double> hann;
  std::vector<double> values;
  std::vector<std::complex<double>> spectrum;
};

WindowSpectrum::WindowSpectrum(std::size_t length) : transform_(std::make_unique<Transform>()) {
  Transform& one = *transform_;
  one.fourier.SetFlag(Fourier::HalfSpectrum);
  one.hann.resize(length);
  one.values.resize(length);
  double squares = 0.0;
  for (std::size_t i = 0; i < length; ++i) {
    const double phase = 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(length);
    one.hann[i] = 0.5 - 0.5 * std::cos(phase);
    squares += one.hann[i] * one.hann[i];
  }
  // Two halves of the spectrum have the energy of one side each; by Parseval.
  const double scale = std::sqrt(2.0 / (squares * static_cast<double>(length)));
  for (double& weight : one.hann) weight *= scale;
}

WindowSpectrum::~WindowSpectrum() = default;

const std::vector<std::complex<double>>& WindowSpectrum::of(std::span<const double> values) {
  Transform& one = *transform_;
  for (std::size_t i = 0; i < one.values.size(); ++i)
    one.values[i] = std::isfinite(values[i]) ? values[i] : 0.0;
  take_line_out(one.values);
  for (std::size_t i = 0; i < one.values.size(); ++i) one.values[i] *= one.hann[i];
  one.fourier.fwd(one.spectrum, one.values);
  one.spectrum.front() *= std::numbers::sqrt2 / 2.0;
  one.spectrum.back() *= std::numbers::sqrt2 / 2.0;
  return one.spectrum;
}

std::vector<std::complex<double>> transform_of(std::span<const double> values, std::size_t length) {
  Fourier fourier;
  fourier.SetFlag(Fourier::HalfSpectrum);
  std::vector<double> filled(values.begin(), values.end());
  filled.resize(std::bit_ceil(std::max(length, values.size())), 0.0);
  std::vector<std::complex<double>> spectrum;
  fourier.fwd(spectrum, filled);
  return spectrum;
}

std::vector<double> back_from(const std::vector<std::complex<double>>& spectrum, std::size_t length) {
  Fourier fourier;
  fourier.SetFlag(Fourier::HalfSpectrum);
  std::vector<double> values;
  fourier.inv(values, spectrum, static_cast<Eigen::Index>(2 * (spectrum.size() - 1)));
  values.resize(length);
  return values;
}

}  // namespace kerf::compare
