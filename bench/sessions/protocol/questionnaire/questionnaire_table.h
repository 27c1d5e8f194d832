#pragma once

#include <string>

#include "protocol/judgement.h"

namespace kerf::bench {

/// A row an answer: subject, number of the session, tissue, item, score, time; above them what each means.
[[nodiscard]] std::string questionnaire_csv(const Study& study);

}  // namespace kerf::bench
