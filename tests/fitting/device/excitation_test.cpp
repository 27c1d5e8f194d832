#include <algorithm>
#include <cmath>
#include <complex>

#include <gtest/gtest.h>

#include <kerf/identification/excitation.h>
#include <kerf/identification/spectra.h>

namespace kerf::identification {
namespace {

TEST(Excitation, HasPowerAtItsLinesAloneAndNoneWhereDistortionIsLookedFor) {
  const ExcitationOptions options{.fast_share = 0.25};
  const Excitation excitation = make_excitation(options);
  const auto spectrum = coefficients(excitation.force, 60);
  for (const std::size_t line : excitation.excited) EXPECT_GT(std::abs(spectrum[line]), 10.0) << line;
  for (const std::size_t line : excitation.odd_quiet) EXPECT_LT(std::abs(spectrum[line]), 1e-9) << line;
  for (const std::size_t line : excitation.even_quiet) EXPECT_LT(std::abs(spectrum[line]), 1e-9) << line;
  EXPECT_GE(excitation.odd_quiet.size(), 3U);
  EXPECT_LT(std::abs(spectrum[0]), 1e-9);
  for (const double force : excitation.force) EXPECT_LE(std::abs(force), 1.0 + 1e-12);
}

TEST(Excitation, HasAFastSquareWaveThatIsHalfAsLargeInEachOtherEighth) {
  // What changes from tick to tick is the square wave: the band ends at 40 Hz.
  const Excitation excitation = make_excitation({.ticks = 1000, .fast_share = 0.25});
  for (std::size_t part = 0; part < 8; ++part) {
    double largest = 0.0;
    for (std::size_t n = 124 * part + 20; n < 124 * part + 100; ++n) {
      largest = std::max(largest, std::abs(excitation.force[n + 1] - excitation.force[n]));
    }
    if (part % 2 == 0) {
      EXPECT_GT(largest, 0.45) << part;
    } else {
      EXPECT_LT(largest, 0.4) << part;
    }
  }
}

TEST(Excitation, RefusesABandWithTooFewLines) {
  EXPECT_THROW((void)make_excitation({.lowest_hz = 1.0, .highest_hz = 5.0}), std::invalid_argument);
  EXPECT_THROW((void)make_excitation({.lowest_hz = 1.0, .highest_hz = 400.0}), std::invalid_argument);
}

TEST(Excitation, TheDesignKeepsForceAndTravelAndTellsMoreThanTheSpectraThatItRefused) {
  const AxisModel axis{.mass_kg = 0.1, .viscous_n_s_per_m = 0.5, .coulomb_n = 0.1, .delay_s = 1.2e-3};
  const DesignLimits limits{.force_n = 2.0, .travel_m = 0.02, .speed_m_s = 1.0};
  const Design design = design_excitation({}, limits, axis, 1e-5, 20.0, 10);
  EXPECT_LE(design.peak_n, 2.0);
  EXPECT_LE(design.prospect.travel_m, 0.02);
  EXPECT_GT(design.prospect.travel_m, 0.001);
  EXPECT_LT(design.prospect.relative_mass, 0.01);
  for (const Prospect& refused : design.refused) EXPECT_LE(refused.information, design.prospect.information);
  EXPECT_EQ(design_excitation({}, {.force_n = 0.0}, axis, 1e-5, 20.0, 10).peak_n, 0.0);
}

TEST(Excitation, AnEncoderOfHalfTheStepHalvesTheIntervals) {
  const AxisModel axis{.mass_kg = 0.1, .viscous_n_s_per_m = 0.5, .coulomb_n = 0.1};
  const Excitation excitation = make_excitation({});
  const Prospect coarse = prospect_of(excitation, 1.0, axis, 1e-3, 2e-5, 20.0, 4);
  const Prospect fine = prospect_of(excitation, 1.0, axis, 1e-3, 1e-5, 20.0, 4);
  const Prospect longer = prospect_of(excitation, 1.0, axis, 1e-3, 2e-5, 20.0, 16);
  EXPECT_NEAR(fine.relative_mass / coarse.relative_mass, 0.5, 1e-6);
  EXPECT_NEAR(longer.relative_coulomb / coarse.relative_coulomb, 0.5, 1e-6);
}

}  // namespace
}  // namespace kerf::identification
