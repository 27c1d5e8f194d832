#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "protocol/protocol.h"

namespace kerf::bench {

/// One answer with what had been asked, after the blinding is lifted.
struct Judgement {
  std::string subject;
  std::size_t session = 1;  ///< of the subject, from 1
  std::string tissue;
  std::array<std::size_t, 2> pair{};  ///< samples of the study: the standard (or first) and the other
  double level = std::numeric_limits<double>::quiet_NaN();
  /// The slot that is right; of a preference, and where levels lie on both sides of the standard, the slot
  /// that played pair[1].
  std::size_t right = 0;
  std::size_t answer = 0;  ///< a slot
  /// From when it could be answered to the answer; of earlier versions' sessions from the first force.
  double response_s = std::numeric_limits<double>::quiet_NaN();
  std::size_t switches = 0;
  bool practice = false;
  /// Of sessions whose forces are known: every slot had a force that can be felt; no fault of law, device or
  /// loop meanwhile.
  std::optional<bool> is_felt;
  std::optional<bool> is_sound;

  [[nodiscard]] bool is_right() const noexcept { return answer == right; }
};

/// What is analysed: the answers of all sessions of one protocol, or of a table of answers.
struct Study {
  std::string name;
  Design design = Design::preference;
  std::vector<std::string> samples;
  std::optional<psychophysics::Task> task;  ///< none: a preference
  IntensityScale scale;                     ///< where the design has levels
  bool slots_known = true;                  ///< of a table of answers perhaps not: which slot held what
  std::vector<Judgement> judgements;        ///< practice included, which is not analysed
  std::vector<std::string> remarks;         ///< what else is to be minded: rehearsals, early openings
};

/// A study without judgements yet.
[[nodiscard]] Study study_of(const Protocol& protocol);

}  // namespace kerf::bench
