#pragma once

#include <optional>
#include <string>
#include <vector>

#include "html/html.h"
#include "report/cycle_section.h"
#include "report/results/found_results.h"

namespace kerf::bench {

/// What one result says in a sentence, and whether that is good.
struct SummaryLine {
  Answer answer = Answer::partly;  ///< never better than that of its section
  bool is_known = true;            ///< it was judged at all, and of this recording
  std::string text;                ///< not escaped
};

/// `cycles` are those of the recording now, of which an inspection may count others.
/// @throws nlohmann::json::exception if the JSON lacks what its verb writes.
[[nodiscard]] SummaryLine summary_of(const FoundResult& result, const std::optional<CycleCount>& cycles = {});

/// What holds, what does not, and what is not known, beside one bar: good only if everything was looked at
/// and holds, bad if anything is, else in between. Names the kinds that nobody has looked at.
[[nodiscard]] std::string summary_paragraph(const std::vector<FoundResult>& results,
                                            const std::optional<CycleCount>& cycles = {});

}  // namespace kerf::bench
