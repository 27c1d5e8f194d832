#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <kerf/psychophysics/random.h>

#include "protocol/plan.h"

// Somebody simulated who feels what laws render and answers the questions of a session: docs/sessions.md.

namespace kerf::bench {

/// What a simulated observer feels by.
///
/// Strength on a scale of JNDs: a force that is stronger by its JND is one unit further up,
///
///     u(F) = integral from 0 to F of df / j(f),   j(f) = max(f ln(1 + w), f0)
///          = F / f0 up to f0 / ln(1 + w), and from there on 1 / ln(1 + w) more for every factor of e,
///
/// so that u(F + w F) - u(F) = 1 exactly ([LuceEdwards1958]; Fechner's own 1 / (w f) is that for small
/// w). On the axis of a decision everything lies d' = c u apart, c = sqrt2 z(criterion), with a noise of
/// N(0, 1) every time that it is felt.
struct Observer {
  double jnd = 0.07;          ///< w, Weber fraction, above 0; with the next one fitting::force_jnd
  double least_jnd_n = 0.05;  ///< f0 [N], above 0: the JND of weak forces
  /// Share of right answers in two intervals that lie one JND apart, in (0.5, 1): the JND belongs to it.
  double criterion = 0.75;
  double lapse = 0.02;  ///< share of the answers that come by chance, in [0, 1)
  /// To the first slot, in d': of choices of the strongest, and of preferences. To "same" and "no": by how
  /// much the criterion lies higher.
  double bias = 0.0;
  double preference = 0.0;         ///< of the second sample of a pair over the first, in d'
  double spread = 0.0;             ///< between subjects: standard deviation of ln(JND), at least 0
  double preference_spread = 0.0;  ///< between subjects: standard deviation of `preference`, at least 0
  double exponent = 0.8;           ///< of magnitudes [Stevens1957], from -10 to 10
  double exponent_spread = 0.15;   ///< between subjects: its standard deviation, at least 0
  double number_noise = 0.2;       ///< standard deviation of ln of a magnitude, at least 0
  /// Between subjects: standard deviation of ln of the modulus, and of the place of all ratings in d'.
  double modulus_spread = 1.0;
  double share_inattentive = 0.0;  ///< of the subjects, who do not attend; in [0, 1]
  double inattention =
      1.0;  ///< of those: share of the answers that come by chance besides `lapse`, in [0, 1]
  double share_feeling = 1.0;  ///< of the subjects, who feel any difference at all; in [0, 1]
  double slip = 0.0;           ///< share of the trials that are taken back before the answer, in [0, 1)
  double unexplored = 0.0;     ///< of the others, those in which a slot is not felt as asked, in [0, 1)
};

/// @throws std::invalid_argument naming what is out of its range.
void require_observer(const Observer& observer);

/// j(F): what a force has to change by to be one JND stronger or weaker [N].
[[nodiscard]] double jnd_at(const Observer& observer, double force_n) noexcept;
/// u(F) in JNDs.
[[nodiscard]] double strength_in_jnds(const Observer& observer, double force_n) noexcept;
/// c: d' of one JND.
[[nodiscard]] double d_prime_per_jnd(const Observer& observer);

/// How an answer comes of what is felt.
enum class Judging : std::uint8_t {
  strongest,         ///< the slot that has most of what is asked for: forced choices, levels
  abx_independent,   ///< which of A and B is the further one, and on which side of their middle X lies
  abx_differencing,  ///< which of the two X is closer to
  odd_one_out,       ///< the slot that is furthest from the middle of the others [Frijters1979]
  /// A difference that is felt, in a share 2 P(d' / sqrt2) - 1 of the trials (what is not guessed of two
  /// intervals), makes the second sample better liked by `preference`; otherwise by chance.
  preference,
  same_by_likelihood,    ///< same or different, by the likelihood ratio
                         ///< (psychophysics/detection/same_different.h)
  same_by_differencing,  ///< likewise, by the distance of the two
  /// Whether the signal is there: above half of d'. The further from there, half a d' a word, the surer.
  yes_no,
};
[[nodiscard]] Judging judging_of(const Protocol& protocol) noexcept;

/// A trial as it is felt.
struct FeltTrial {
  Judging judging = Judging::strongest;
  std::size_t slots = 2;
  std::array<std::uint8_t, max_slots> plays{};  ///< which of the pair a slot plays
  double d_prime = 0.0;        ///< from the first of the pair to the second; below 0 only of the strongest
  std::size_t confidence = 0;  ///< of yes_no: how many words there are for it
};

/// The slot that is answered, or the choice (choices_of()).
[[nodiscard]] std::size_t drawn_answer(const Observer& observer, const FeltTrial& trial,
                                       psychophysics::Random& random);

/// The probability that it is this one, exactly (integrals to 1e-9).
[[nodiscard]] double answer_probability(const Observer& observer, const FeltTrial& trial, std::size_t slot);

}  // namespace kerf::bench
