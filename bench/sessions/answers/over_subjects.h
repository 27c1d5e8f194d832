#pragma once

#include <string>
#include <utility>
#include <vector>

#include "answers/answer_groups.h"

// What holds for the people that subjects stand for: a subject counts once, however many answers it gave.

namespace kerf::bench {

/// The counts of the subjects of a group, in order of appearance.
using SubjectCounts = std::vector<psychophysics::Count>;
[[nodiscard]] SubjectCounts counts_by_subject(const Study& study,
                                              const std::vector<const Judgement*>& judgements);

/// The main test: over subjects where there are enough of them, else exact over answers; also of an adaptive
/// design, whose rule holds every subject at much the same share. Needs p_greater, p_two_sided, chance and
/// one_sided.
void add_main_test(const Study& study, AnswerGroup& group, const SubjectCounts& subjects,
                   const AnalysisOptions& options);

/// What of a difference is excluded, and whether it lies within the margin that was set, if one was. Needs
/// chance and d_prime.
void add_equivalence(const Study& study, AnswerGroup& group, const SubjectCounts& subjects,
                     const AnalysisOptions& options);

}  // namespace kerf::bench
