#pragma once

#include <nlohmann/json.hpp>

#include "protocol/plan.h"

namespace kerf::bench {

/// A trial of a plan as JSON, and back; numbers come back bit for bit, a level that is NaN is null.
/// @throws std::invalid_argument where something is missing or of another type.
[[nodiscard]] nlohmann::ordered_json to_json(const TrialPlan& trial);
[[nodiscard]] TrialPlan trial_plan_from(const nlohmann::ordered_json& json);

}  // namespace kerf::bench
