#include "cases/cases.h"

#include <algorithm>
#include <array>
#include <stdexcept>

#include <fmt/format.h>

#include "cases/each_case.h"

namespace kerf::bench {
namespace {

struct Entry {
  std::string_view name;
  NamedCase (*run)(std::uint64_t seed);
};
constexpr std::array all{
    Entry{"velocity_sign", cases::velocity_sign},
    Entry{"equal_thresholds", cases::equal_thresholds},
    Entry{"euler_maxwell", cases::euler_maxwell},
    Entry{"euler_lattice", cases::euler_lattice},
    Entry{"fracture_at_low_rate", cases::fracture_at_low_rate},
    Entry{"quantised_velocity", cases::quantised_velocity},
    Entry{"delay", cases::delay},
    Entry{"fast_contact", cases::fast_contact},
    Entry{"stiff_grip", cases::stiff_grip},
    Entry{"exponential_depth", cases::exponential_depth},
    Entry{"passivity_control", cases::passivity_control},
};

}  // namespace

std::vector<std::string_view> case_names() {
  std::vector<std::string_view> names;
  for (const Entry& entry : all) names.push_back(entry.name);
  return names;
}

std::vector<NamedCase> run_cases(const std::vector<std::string>& names, std::uint64_t seed) {
  for (const std::string& name : names) {
    if (std::ranges::find(all, name, &Entry::name) == all.end()) {
      throw std::invalid_argument(
          fmt::format("there is no case '{}'; there are {}", name, fmt::join(case_names(), ", ")));
    }
  }
  std::vector<NamedCase> run;
  for (const Entry& entry : all) {
    if (!names.empty() && std::ranges::find(names, entry.name) == names.end()) continue;
    run.push_back(entry.run(seed));
    run.back().name = entry.name;
  }
  return run;
}

}  // namespace kerf::bench
