#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/psychophysics/dprime.h>
#include <kerf/psychophysics/psychometric.h>
#include <kerf/psychophysics/staircase.h>

#include "laws/law_file.h"
#include "scene/motion.h"

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
};
[[nodiscard]] std::string_view name_of(Design design) noexcept;  ///< as the file says it: "abx", "constant"
[[nodiscard]] bool is_adaptive(Design design) noexcept;
[[nodiscard]] bool has_levels(Design design) noexcept;  ///< constant, staircase and quest_plus

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
  double expected_jnd = 0.1;  ///< quest_plus: the middle of its prior
  std::size_t quest_trials = 60;
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
enum class Loudness : std::uint8_t { as_they_are, peak, rms };

/// A blind comparison, as a file `NAME.protocol.toml` describes it; docs/sessions.md has the format.
struct Protocol {
  std::string name;
  std::string title;  ///< what subjects see over every trial; the name may tell what is compared
  Design design = Design::preference;
  std::string question;      ///< "Which felt more like cutting liver?"
  std::string instructions;  ///< shown before the practice
  std::string consent;       ///< has to be agreed to; empty: nothing is asked
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
  bool differencing = false;          ///< abx: the strategy that d' is reckoned for; else independent
  IntensityScale scale;               ///< where the design has levels
  Loudness loudness = Loudness::as_they_are;
  /// What the tool does where forces are rendered ahead of a session, to match loudness or to simulate
  /// observers: strokes along the one axis of the laws, or a scene's script.
  std::optional<MotionSource> motion;
  std::string device_uri;  ///< empty: --device says it
  double rate_hz = 1000.0;
  std::string toml;  ///< as it was read
};

/// Slots of a trial: what the subject can feel and switch between.
[[nodiscard]] std::size_t slots_of(Design design) noexcept;
/// What they are called: A, B, X; or 1, 2, 3.
[[nodiscard]] std::string_view label_of(Design design, std::size_t slot) noexcept;
/// Slots that may be the answer: not X.
[[nodiscard]] std::size_t answers_of(Design design) noexcept;
/// The task for d' and chance. ABX is taken as independent observations unless the protocol says
/// "differencing"; a trial at a level is a forced choice of two.
/// @throws std::invalid_argument: no answer is right where preferences are asked for, nor where levels lie on
///         both sides of the standard.
[[nodiscard]] psychophysics::Task task_of(const Protocol& protocol);
/// The pairs of samples that the trials of a tissue compare: all of them; where there is a signal those with
/// it, as the second; where there are levels the standard with itself.
[[nodiscard]] std::vector<std::array<std::size_t, 2>> pairs_of(const Protocol& protocol, std::size_t tissue);

/// Reads a protocol and the laws that it names, relative to its folder.
/// @throws std::invalid_argument with file, line, found and expected; std::system_error.
[[nodiscard]] Protocol read_protocol(const std::filesystem::path& file);

/// From text; `law_text` gives the text of a law file by the name that the protocol calls it, or the
/// recording that is looked up, by.
[[nodiscard]] Protocol parse_protocol(const std::string& text, const std::string& name,
                                      const std::function<std::string(const std::string&)>& law_text);

}  // namespace kerf::bench
