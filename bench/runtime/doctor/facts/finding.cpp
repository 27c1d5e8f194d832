#include "doctor/facts/finding.h"

#include <algorithm>
#include <tuple>

namespace kerf::bench::doctor {

Finding unknown(std::string_view name, std::string_view where, std::string_view why) {
  return {.name = std::string(name),
          .state = State::unknown,
          .seen = std::string(why),
          .where = std::string(where),
          .cost = {.us = std::nullopt, .why = "it could not be looked at"},
          .mend = {}};
}

void sort_by_cost(std::vector<Finding>& findings) {
  const auto rank = [](const Finding& finding) {
    const int group = finding.state == State::costs ? 0 : finding.state == State::unknown ? 1 : 2;
    const bool unmeasured = !finding.cost.us;
    return std::tuple(group, unmeasured, -finding.cost.us.value_or(0.0));
  };
  std::ranges::stable_sort(findings, {}, rank);
}

nlohmann::ordered_json to_json(const Finding& finding) {
  nlohmann::ordered_json json{
      {"name", finding.name}, {"state", state_names[static_cast<std::size_t>(finding.state)]},
      {"seen", finding.seen}, {"where", finding.where},
      {"cost_us", nullptr},   {"cost_why", finding.cost.why},
      {"mend", finding.mend}};
  if (finding.cost.us) json["cost_us"] = *finding.cost.us;
  return json;
}

}  // namespace kerf::bench::doctor
