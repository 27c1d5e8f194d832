#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "protocol/felt_level.h"
#include "protocol/protocol.h"
#include "protocol/trial_rules.h"

namespace kerf::bench {

/// Of a trial that was taken back before its answer.
inline constexpr std::size_t no_answer = std::numeric_limits<std::size_t>::max();

/// One answer with what had been asked, after the blinding is lifted.
struct Judgement {
  std::string subject;
  std::size_t session = 1;  ///< of the subject, from 1
  std::string tissue;
  std::array<std::size_t, 2> pair{};  ///< samples of the study: the standard (or first) and the other
  double level = std::numeric_limits<double>::quiet_NaN();
  std::size_t track = 0;  ///< which of several staircases chose the level
  /// The slot that is right; of a preference, and where levels lie on both sides of the standard, the slot
  /// that played pair[1].
  std::size_t right = 0;
  std::size_t answer =
      0;  ///< a slot; 0: "same" or "no", 1: "different" or "yes"; no_answer only of a void trial
  std::size_t confidence = 0;  ///< of yes or no, from 1, the least sure; 0: not known
  double estimate = std::numeric_limits<double>::quiet_NaN();  ///< the number that is the answer, of numbers
  /// Of numbers: what was felt, rms of the force in contact [N]; of levels 1 + level, of the standard's.
  double intensity = std::numeric_limits<double>::quiet_NaN();
  /// From when it could be answered to the answer; of earlier versions' sessions from the first force.
  double response_s = std::numeric_limits<double>::quiet_NaN();
  std::size_t switches = 0;
  bool practice = false;
  bool is_catch = false;  ///< a trial that tells whether somebody attends, and nothing else
  /// Of sessions whose forces are known: every slot had a force that can be felt; no fault of law, device or
  /// loop meanwhile.
  std::optional<bool> is_felt;
  std::optional<bool> is_sound;
  std::vector<VoidReason> void_reasons;  ///< by the protocol's rules; it came again, as long as it might

  [[nodiscard]] bool is_right() const noexcept { return answer == right; }
  /// It is analysed.
  [[nodiscard]] bool counts() const noexcept { return !practice && !is_catch && void_reasons.empty(); }
};

/// What a slot of a trial was felt like.
struct FeltSlot {
  std::string subject;
  std::array<std::size_t, 2> pair{};  ///< of the trial
  std::size_t sample = 0;             ///< that the slot played
  FeltLevel level;
};

/// What a hand did with a sample; NaN: not known.
struct Exploring {
  double speed_m_s = std::numeric_limits<double>::quiet_NaN();
  double peak_speed_m_s = std::numeric_limits<double>::quiet_NaN();
  double strokes_per_s = std::numeric_limits<double>::quiet_NaN();
  double off_target =
      std::numeric_limits<double>::quiet_NaN();  ///< of trials that were led [unit of the axis]
  double lag_s = std::numeric_limits<double>::quiet_NaN();
};

/// The same of a slot of a trial.
struct ExploredSlot {
  std::string subject;
  std::array<std::size_t, 2> pair{};  ///< of the trial
  std::size_t which = 0;              ///< of the two the slot played
  Exploring hand;
};

/// A questionnaire that somebody filled in.
struct QuestionnaireAnswers {
  std::string subject;
  std::size_t session = 1;
  std::string tissue;          ///< after which; empty: at the end, or of tissues without names
  std::vector<double> scores;  ///< item by item
  std::string at;              ///< ISO 8601, UTC
};

/// What is analysed: the answers of all sessions of one protocol, or of a table of answers.
struct Study {
  std::string name;
  Design design = Design::preference;
  std::vector<std::string> samples;
  std::optional<psychophysics::Task> task;  ///< none: no answer is right
  IntensityScale scale;                     ///< where the design has levels
  NumberScale numbers;                      ///< where numbers are the answers
  std::size_t confidence_levels = 0;        ///< of yes or no; 0: confidence was not asked
  bool slots_known = true;                  ///< of a table of answers perhaps not: which slot held what
  std::vector<Judgement> judgements;        ///< practice included, which is not analysed
  std::vector<FeltSlot> felt;               ///< of trials that count, where forces are known; not of levels
  std::vector<ExploredSlot> explored;       ///< of trials that count, where their traces are known
  Questionnaire questionnaire;
  std::vector<QuestionnaireAnswers> questionnaires;
  std::vector<std::string> remarks;  ///< what else is to be minded: rehearsals, early openings
};

/// How somebody answered catch trials that are not void.
struct SubjectCatches {
  std::string subject;
  CatchTally tally;
};
/// Of everybody who had any, in the order in which they appear.
[[nodiscard]] std::vector<SubjectCatches> catches_by_subject(const Study& study);

/// A study without judgements yet.
[[nodiscard]] Study study_of(const Protocol& protocol);

}  // namespace kerf::bench
