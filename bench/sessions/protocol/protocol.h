#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/psychophysics/dprime.h>
#include <kerf/psychophysics/psychometric.h>
#include <kerf/psychophysics/quest_plus.h>
#include <kerf/psychophysics/staircase.h>

#include "laws/law_file.h"
#include "protocol/apparatus.h"
#include "protocol/attention/catch_trials.h"
#include "protocol/guide/guided_motion.h"
#include "protocol/questionnaire/questionnaire.h"
#include "protocol/trial_rules.h"
#include "scene/motion.h"
#include "texts/subject_texts.h"

namespace kerf::bench {

/// What a trial asks.
enum class Design : std::uint8_t {
  preference,      ///< two samples: which is more like ... [Okamura2003]; no answer is right
  abx,             ///< A, B and X, which is one of them: which one?
  two_interval,    ///< two samples, one of them the signal: which one has more of ...?
  three_interval,  ///< three, one of them the signal (or the odd one)
  constant,        ///< a standard and a comparison from fixed levels
  staircase,       ///< a standard and a comparison whose level follows the answers, n up and m down
  quest_plus,      ///< likewise, by QUEST+
  same_different,  ///< two slots that play the same sample or two: same or different?
  yes_no,          ///< one slot, with the signal or without: was it there, and how sure is that?
  magnitude,       ///< one sample, perhaps after a standard: a number for how strong it was [Stevens1975]
  rating,          ///< one sample: a place on a scale, in steps or on a line
};
[[nodiscard]] std::string_view name_of(Design design) noexcept;  ///< as the file says it: "abx", "constant"
[[nodiscard]] bool is_adaptive(Design design) noexcept;
[[nodiscard]] bool has_levels(Design design) noexcept;  ///< constant, staircase and quest_plus
/// The answer is a number about one sample, which nothing makes right or wrong: magnitude and rating.
[[nodiscard]] bool asks_numbers(Design design) noexcept;
struct IntensityScale;
/// How many trials there are follows the answers, so that their count has no test: staircase, and quest_plus
/// that ends by the width of an interval.
[[nodiscard]] bool ends_by_answers(Design design, const IntensityScale& scale) noexcept;

/// A rendering that takes part.
struct SessionSample {
  std::string name;
  std::string law_name;  ///< what the protocol calls its law file or its recording
  std::string law_toml;  ///< its law file, as it was read, or the table that was made of its recording
  LawFile law;
  double gain = 1.0;  ///< of every force, so that the samples of a tissue are equally strong
};

/// Samples that are compared with each other, all pairs of them.
struct SessionTissue {
  std::string name;
  std::vector<std::size_t> samples;
};

/// How a comparison differs from the standard: its parameters, or its whole force, are those of the standard
/// times 1 + level.
struct IntensityScale {
  std::size_t standard = 0;             ///< a sample
  std::vector<std::string> parameters;  ///< empty: the whole force
  std::vector<double> levels;           ///< constant: those shown; quest_plus: those that may be shown
  /// Levels on both sides of the standard, constant design: "which is stronger?" is the probability of
  /// "the comparison", from 0 to 1, on a linear axis. Otherwise an answer is right or wrong.
  [[nodiscard]] bool two_sided() const noexcept;
  psychophysics::Shape shape = psychophysics::Shape::weibull;
  psychophysics::StaircaseOptions staircase;
  std::vector<psychophysics::StaircaseOptions>
      interleaved;            ///< further ones, which take turns with it by chance
  double expected_jnd = 0.1;  ///< quest_plus: the middle of its prior
  std::size_t quest_trials = 60;
  /// quest_plus: its grids and when it ends; shape, guess, intensities and trials are those of the scale, and
  /// where there are no thresholds they follow from expected_jnd.
  psychophysics::QuestPlusOptions quest;

  /// `staircase` and those that are interleaved with it.
  [[nodiscard]] std::vector<psychophysics::StaircaseOptions> staircases() const;
};

/// Of magnitudes and ratings: what a number is answered on.
struct NumberScale {
  std::optional<std::size_t> standard;  ///< magnitude: the sample ahead of each; none: numbers as one likes
  double modulus = 0.0;                 ///< magnitude: the number of the standard
  std::size_t points = 0;               ///< rating: steps; 0: a line from 0 to largest_rating
  std::array<std::string, 2> ends;      ///< rating: words at its lower and its upper end
};
inline constexpr double largest_rating = 100.0;  ///< of a line
/// Of magnitudes, above 0: what is no slip of the hand.
inline constexpr double least_magnitude = 1e-6;
inline constexpr double largest_magnitude = 1e9;

/// What may be written as a number, both ends included.
struct NumberRange {
  double lower = 0.0;
  double upper = 0.0;
  [[nodiscard]] bool holds(double number) const noexcept { return number >= lower && number <= upper; }
};

/// How the samples of a trial come to the hand.
enum class Presentation : std::uint8_t {
  free,      ///< the subject switches between them at will, and answers when they know
  sequence,  ///< each for interval_s, with gap_s of zero force between them; then the subject answers
};

/// How one sample gives way to another.
enum class SwitchKind : std::uint8_t {
  blend,         ///< F = (1 - r) F_old + r F_new: the hand meets no step
  through_zero,  ///< the old force goes to zero, then the new one comes: a switch to the same sample is felt
                 ///< too
};

/// What of the forces is made equal before a session.
enum class Loudness : std::uint8_t {
  as_they_are,
  peak,  ///< along the [motion], which no force disturbs
  rms,
  felt_peak,  ///< in closed loop: what a simulated hand gets after all limits
  felt_rms,
};

/// How the gains of the samples were found. It stands with them under the seal.
struct GainOrigin {
  std::string hand;  ///< URI of the simulated device with a hand on it; empty: open loop, along [motion]
  std::string stands_for;      ///< URI of the real device in whose place it was; empty: none
  std::string fallback;        ///< why not in closed loop, which was asked for; empty: nothing was in the way
  double tolerance = 0.0;      ///< of what is felt, as a fraction; 0 in open loop
  std::vector<double> felt_n;  ///< rms or peak of each sample with its gain; none in open loop
};

/// A blind comparison, as a file `NAME.protocol.toml` describes it; docs/sessions-protocol.md has the format.
struct Protocol {
  std::string name;
  std::string title;  ///< what subjects see over every trial; the name may tell what is compared
  Design design = Design::preference;
  std::string question;      ///< "Which felt more like cutting liver?"
  std::string instructions;  ///< shown before the practice
  std::string consent;       ///< has to be agreed to; empty: nothing is asked
  /// What else the subject reads, in the language of the study.
  std::shared_ptr<const SubjectTexts> texts = english_texts();
  std::vector<SessionSample> samples;
  std::vector<SessionTissue> tissues;  ///< at least one; without a name where the file has none
  std::size_t trials = 12;      ///< of each pair of a tissue, or of each level; of adaptive designs the most
  std::size_t practice = 0;     ///< trials ahead that do not count
  bool feedback = false;        ///< practice says what was right
  std::size_t break_every = 0;  ///< trials; 0: no breaks
  double break_s = 30.0;        ///< at least
  Presentation presentation = Presentation::free;
  double interval_s = 4.0;
  double gap_s = 0.5;
  double longest_s = 60.0;  ///< of a trial; then zero force, and the subject may still answer
  SwitchKind switching = SwitchKind::blend;  ///< of abx through_zero, unless its file says otherwise
  double ramp_s = 0.25;                      ///< from sample to sample
  std::optional<std::size_t> signal;  ///< two_interval, three_interval: the sample that the question asks for
  bool odd_one_out = false;           ///< three_interval: either may be the odd one
  bool differencing = false;  ///< abx, same_different: the strategy that d' is reckoned for; else independent
  std::vector<std::string> confidence;  ///< yes_no: words from the least sure to the surest; empty: not asked
  IntensityScale scale;                 ///< where the design has levels, and of magnitudes that have
  NumberScale numbers;                  ///< of magnitudes and ratings
  TrialRules rules;
  CatchTrials catches;
  Loudness loudness = Loudness::as_they_are;
  std::optional<GainOrigin> gain_origin;  ///< none: as they are, or a session of an earlier version
  double limited_share = 0.05;            ///< of the ticks in which a sample may be cut to a device's limits
  /// What the tool does where forces are rendered ahead of a session, to match loudness or to simulate
  /// observers: strokes along the one axis of the laws, or a scene's script.
  std::optional<MotionSource> motion;
  /// What leads the hand. Where it has a target and there is no [motion], the target's way is the motion.
  std::optional<GuidedMotion> guide;
  Apparatus apparatus;
  Questionnaire questionnaire;
  std::string device_uri;  ///< empty: --device says it
  double rate_hz = 1000.0;
  std::string toml;  ///< as it was read
};

/// Slots of a trial: what the subject can feel and switch between.
[[nodiscard]] std::size_t slots_of(const Protocol& protocol) noexcept;
/// The most that a design has.
[[nodiscard]] std::size_t slots_of(Design design) noexcept;
/// What they are called: A, B, X, or 1, 2, 3.
[[nodiscard]] std::string_view label_of(Design design, std::size_t slot) noexcept;
/// What may be right: slots, but not X; "same" and "different"; "no" and "yes".
[[nodiscard]] std::size_t answers_of(Design design) noexcept;
[[nodiscard]] std::string_view answer_label_of(Design design, std::size_t answer) noexcept;
/// The answer is no slot, but one of two words: its rates of hits and false alarms are those of a detection.
[[nodiscard]] bool has_two_rates(Design design) noexcept;

/// What a subject chooses from: the answers; with confidence from the surest "no" to the surest "yes"; the
/// steps of a rating; one where a number is written.
[[nodiscard]] std::size_t choices_of(const Protocol& protocol) noexcept;
/// What is written as a number instead; nothing where the answer is a choice.
[[nodiscard]] std::optional<NumberRange> written_numbers_of(const Protocol& protocol) noexcept;
/// The number that an answer is, of designs that ask numbers: what was written, or the step from 1.
[[nodiscard]] double number_of_answer(const Protocol& protocol, std::size_t choice, double written) noexcept;
/// Their words, in the subject's language; none where they are slots.
[[nodiscard]] std::vector<std::string> choice_labels_of(const Protocol& protocol);
/// What the subject is told of a slot or a word that was right: A, or "same".
[[nodiscard]] std::string told_answer(const Protocol& protocol, std::size_t answer);
/// The answer that a choice is.
[[nodiscard]] std::size_t answer_of_choice(const Protocol& protocol, std::size_t choice) noexcept;
/// From 1, the least sure; 0 where it is not asked.
[[nodiscard]] std::size_t confidence_of_choice(const Protocol& protocol, std::size_t choice) noexcept;
/// The task for d' and chance. ABX is taken as independent observations unless the protocol says
/// "differencing"; a trial at a level is a forced choice of two.
/// @throws std::invalid_argument: no answer is right where preferences are asked for, nor where levels lie on
///         both sides of the standard.
[[nodiscard]] psychophysics::Task task_of(const Protocol& protocol);
/// The pairs of samples that the trials of a tissue compare: all of them; where there is a signal those with
/// it, as the second; where there are levels the standard with itself; of numbers each sample, as the second,
/// with its standard or itself.
[[nodiscard]] std::vector<std::array<std::size_t, 2>> pairs_of(const Protocol& protocol, std::size_t tissue);

/// The text of a file that a protocol names: as it stands, or the law that is made of a recording or a
/// plugin.
/// @throws std::invalid_argument, std::system_error.
[[nodiscard]] std::string text_named_by_protocol(const std::filesystem::path& file);

/// Reads a protocol and the laws that it names, relative to its folder.
/// @throws std::invalid_argument with file, line, found and expected; std::system_error.
[[nodiscard]] Protocol read_protocol(const std::filesystem::path& file);

/// From text; `text_of` gives the text of a file by the name that the protocol calls it by: of a law, of the
/// recording that is looked up in place of one, of a language of its own. Texts that a session
/// has `kept` are in force, whatever the protocol says of its language.
[[nodiscard]] Protocol parse_protocol(const std::string& text, const std::string& name,
                                      const std::function<std::string(const std::string&)>& text_of,
                                      std::shared_ptr<const SubjectTexts> kept = nullptr);

}  // namespace kerf::bench
