#include "sealed/trials/trial_counts.h"

#include <fmt/core.h>

#include "protocol/trial_sequence.h"

namespace kerf::bench {

TrialCounts counts_of(const SessionStore& session) {
  TrialCounts counts;
  TrialSequence sequence(session.protocol(), session.plan());
  for (const RecordedTrial& trial : session.trials()) {
    ++counts.given;
    counts.practice += trial.what.practice ? 1 : 0;
    if (!trial.is_void()) {
      counts.counted += trial.what.practice ? 0 : 1;
      sequence.answer(trial.answer);
      continue;
    }
    ++counts.voided;
    for (const VoidReason reason : trial.void_reasons) ++counts.by_reason[static_cast<std::size_t>(reason)];
    counts.left_out += sequence.repeat() ? 0 : 1;
  }
  counts.practised = sequence.practised();
  return counts;
}

std::string in_words(const TrialCounts& counts) {
  std::string words = fmt::format("{} {} answered", counts.given, counts.given == 1 ? "trial" : "trials");
  if (counts.practice > 0) words += fmt::format(" ({} of practice)", counts.practice);
  words += fmt::format(", {} count, {} void", counts.counted, counts.voided);
  std::string why;
  for (std::size_t reason = 0; reason < void_reasons; ++reason) {
    if (counts.by_reason[reason] == 0) continue;
    why += fmt::format("{}{} {}", why.empty() ? "" : ", ", name_of(static_cast<VoidReason>(reason)),
                       counts.by_reason[reason]);
  }
  if (!why.empty()) words += fmt::format(" ({})", why);
  if (counts.left_out > 0) words += fmt::format(", {} of them left out", counts.left_out);
  if (counts.practised)
    words +=
        *counts.practised ? "; practice came to its criterion" : "; practice did not come to its criterion";
  return words;
}

}  // namespace kerf::bench
