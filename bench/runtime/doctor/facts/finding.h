#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

namespace kerf::bench::doctor {

/// What something about a machine does to a loop. What could not be looked at is unknown, never good.
enum class State : std::uint8_t { good, costs, unknown };
inline constexpr std::array<const char*, 3> state_names{"good", "costs", "unknown"};

/// What something costs a tick at worst, as far as it could be measured here.
struct Cost {
  std::optional<double> us;  ///< [us]; none: it was not measured
  std::string why;           ///< how it was measured, or why it was not
};

/// One thing that was looked at.
struct Finding {
  std::string name;  ///< a key that stays: "frequency_governor"
  State state = State::unknown;
  std::string seen;   ///< in words, with the value
  std::string where;  ///< the path, or the call, that told it
  Cost cost;
  std::string mend;  ///< the command that changes it, or why none does; empty where there is nothing to mend
};

/// Something that could not be looked at, and why.
[[nodiscard]] Finding unknown(std::string_view name, std::string_view where, std::string_view why);

/// What costs comes first, by its cost, the unmeasured last of it; then what is unknown; then what is good.
/// Within that in the order in which they came.
void sort_by_cost(std::vector<Finding>& findings);

[[nodiscard]] nlohmann::ordered_json to_json(const Finding& finding);

}  // namespace kerf::bench::doctor
