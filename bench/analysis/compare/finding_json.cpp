#include "compare/finding_json.h"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "files/json_number.h"

namespace kerf::bench {
namespace {

using json = nlohmann::ordered_json;

struct NumberUnit {
  std::string_view number;
  std::string_view unit;
};
constexpr std::array<NumberUnit, 12> units_of_numbers{{{"row", "tick"},
                                                       {"first_row", "tick"},
                                                       {"end", "tick"},
                                                       {"count", "ticks"},
                                                       {"places", "1"},
                                                       {"ticks", "ticks"},
                                                       {"std_error_ticks", "ticks"},
                                                       {"ms", "ms"},
                                                       {"hz", "Hz"},
                                                       {"deg", "deg"},
                                                       {"factor", "1"},
                                                       {"speed", "1"}}};

/// Of the others the unit is that of the force.
std::string unit_of_number(std::string_view number, const std::string& force_unit) {
  if (number.starts_with("from_")) return "channel";
  if (number == "per_s") return force_unit + "/s";
  const auto found = std::ranges::find(units_of_numbers, number, &NumberUnit::number);
  return found == units_of_numbers.end() ? force_unit : std::string(found->unit);
}

json finding_as_json(const compare::Finding& one, const std::vector<compare::Channel>& channels) {
  json names = json::array();
  for (const std::size_t channel : one.channels) names.push_back(channels[channel].name);
  json numbers = json::object();
  for (const auto& [name, value] : one.numbers) numbers[name] = json_number(value);
  json finding{{"kind", compare::name_of(one.change)},
               {"change", compare::name_of(one.change)},
               {"channel", names.size() == 1 ? names.front() : json(nullptr)},
               {"channels", names},
               {"value", nullptr},
               {"unit", nullptr},
               {"remainder", json_number(one.remainder)},
               {"sentence", one.sentence},
               {"numbers", numbers}};
  if (!one.numbers.empty() && !one.channels.empty()) {
    finding["value"] = json_number(one.numbers.front().second);
    finding["unit"] = unit_of_number(one.numbers.front().first, channels[one.channels.front()].unit);
  }
  return finding;
}

}  // namespace

json findings_as_json(const std::vector<compare::Finding>& all,
                      const std::vector<compare::Channel>& channels) {
  json list = json::array();
  for (const compare::Finding& one : all) list.push_back(finding_as_json(one, channels));
  return list;
}

}  // namespace kerf::bench
