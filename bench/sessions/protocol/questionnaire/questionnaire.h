#pragma once

#include <array>
#include <string>
#include <vector>

#include "laws/law_toml.h"
#include "texts/subject_texts.h"

namespace kerf::bench {

/// A question that is answered on a line from 0 to 100, in steps of 5.
struct QuestionnaireItem {
  std::string name;
  std::string question;
  std::array<std::string, 2> ends;
};
inline constexpr double questionnaire_step = 5.0;
inline constexpr double questionnaire_most = 100.0;

/// The table [questionnaire] of a protocol: what is asked when nothing is felt.
struct Questionnaire {
  std::string use;           ///< "nasa-tlx" [HartStaveland1988]; empty: items of the protocol's own
  bool after_blocks = true;  ///< after the trials of each tissue; else at the end
  std::vector<QuestionnaireItem> items;
  [[nodiscard]] bool is_asked() const noexcept { return !items.empty(); }
};

/// Scales that are shipped are asked in the words of `texts`.
/// @throws std::invalid_argument with file, line, found and expected.
[[nodiscard]] Questionnaire read_questionnaire(const Place& place, const toml::table& root,
                                               const SubjectTexts& texts);

}  // namespace kerf::bench
