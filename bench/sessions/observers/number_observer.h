#pragma once

#include <map>
#include <utility>

#include "observers/sensation.h"

// Simulated people who answer with numbers.

namespace kerf::bench {

/// One of them. Of an intensity I (the rms of what is felt [N], or 1 + level) a magnitude is
///
///     R = M (I / I0)^a exp(e + n t),   e from N(0, n^2)
///
/// with the exponent a, a modulus M of its own (where a standard is given its number, and I0 is its
/// intensity), a noise n, and a taste t for each sample that is its own, from N(0, preference_spread^2). A
/// lapse is an answer about another sample.
///
/// A rating is the place of what is felt on a scale, monotone in its strength u in JNDs,
///
///     x = P((c (u - mean of u) + t + shift + N(0, 1)) / 3)
///
/// with c = d' of one JND, of this person; on a line 100 x, of k steps floor(k x) + 1. A lapse is anywhere.
class NumberObserver {
 public:
  /// `nothing_to_find`: exponents of 0 in the mean, of levels 1; ratings that hang on nothing but taste.
  NumberObserver(const Protocol& protocol, const Sensation& sensation, const Observer& observer,
                 double sensitivity, bool nothing_to_find, psychophysics::Random& random);

  /// What is written, or the step of a rating from 1.
  [[nodiscard]] double number(const TrialPlan& trial, psychophysics::Random& random);
  /// I of a trial's sample.
  [[nodiscard]] double intensity(const TrialPlan& trial) const;

 private:
  double taste(const TrialPlan& trial, psychophysics::Random& random);
  double magnitude(const TrialPlan& trial, psychophysics::Random& random);
  double rating(const TrialPlan& trial, psychophysics::Random& random);

  const Protocol* protocol_;
  const Sensation* sensation_;
  Observer observer_;
  double sensitivity_;
  double exponent_;
  double log_modulus_;
  double shift_;
  double mean_strength_ = 0.0;
  std::map<std::pair<std::size_t, double>, double> tastes_;
};

}  // namespace kerf::bench
