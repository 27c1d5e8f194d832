#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <kerf/identification/axis_model.h>

namespace kerf::identification {

enum class ExcitationKind : std::uint8_t { multisine, chirp };

/// What a periodic excitation is made of.
struct ExcitationOptions {
  ExcitationKind kind = ExcitationKind::multisine;
  double period_s = 1e-3;    ///< of a tick
  std::size_t ticks = 1000;  ///< of a period of the excitation; a multiple of 4
  double lowest_hz = 1.0;
  double highest_hz = 40.0;  ///< < half of the sampling rate
  double slope = 0.0;        ///< amplitude of the force over frequency: f^slope
  /// Of the peak: a square wave of four ticks, half as large in each other eighth of the period. Its large
  /// changes show the delay's jitter, its small ones what is none; and it moves an encoder about in its
  /// steps.
  double fast_share = 0.25;
  std::uint64_t seed = 1;        ///< of the phases
  std::uint64_t lines_seed = 1;  ///< of the lines that are left out
};

/// One period of a force, its largest value 1.
///
/// A multisine of random phases [PintelonSchoukens2012]: of the odd lines in the band one in four, drawn, is
/// left out, as are all even ones, so that what appears there is distortion, odd and even. Of 24 draws of
/// phases the one with the smallest peak is taken. A chirp sweeps the band once up and leaves no line out.
struct Excitation {
  std::vector<double> force;           ///< a value a tick, of at most 1
  std::vector<std::size_t> excited;    ///< lines, in periods of the excitation, without the fast square
  std::vector<std::size_t> odd_quiet;  ///< lines in the band that were left out
  std::vector<std::size_t> even_quiet;
};
/// @throws std::invalid_argument if the band holds fewer than six lines that are excited, or lies too high.
[[nodiscard]] Excitation make_excitation(const ExcitationOptions& options);

/// What an experiment with an excitation would tell of an axis of which something is known already.
struct Prospect {
  double travel_m = 0.0;       ///< between the ends of the motion
  double speed_m_s = 0.0;      ///< the largest
  double relative_mass = 0.0;  ///< half of the 95 % interval over the value
  double relative_viscous = 0.0;
  double relative_coulomb = 0.0;
  double delay_s = 0.0;      ///< half of the 95 % interval
  double information = 0.0;  ///< logarithm of the determinant of what is known of (ln m, ln b, ln f, d)
};
/// Fisher's information of `periods` periods of a force of a peak, read by an encoder of a step q (as noise
/// of variance q^2 / 12), with a centring spring rendered, the state at the begin of each period unknown.
[[nodiscard]] Prospect prospect_of(const Excitation& excitation, double peak_n, const AxisModel& axis,
                                   double period_s, double encoder_step_m, double centring_n_per_m,
                                   std::size_t periods);

/// An excitation chosen for an axis, its peak, and what it promises.
struct Design {
  ExcitationOptions options;
  double peak_n = 0.0;
  Prospect prospect;
  std::vector<Prospect> refused;  ///< of the other spectra, which told less
};
struct DesignLimits {
  double force_n = 1.0;    ///< no force is larger
  double travel_m = 0.02;  ///< no motion is wider, from end to end
  double speed_m_s = 1.0;
};
/// Of spectra that fall with f^-1, are flat, and rise with f, below the band's end and half of it, the one
/// with the largest determinant of information (D-optimal [GoodwinPayne1977]) within the limits.
[[nodiscard]] Design design_excitation(const ExcitationOptions& base, const DesignLimits& limits,
                                       const AxisModel& axis, double encoder_step_m, double centring_n_per_m,
                                       std::size_t periods);

}  // namespace kerf::identification
