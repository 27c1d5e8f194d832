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
    Entry{"velocity_sign", cases::velocity_sign::run},
    Entry{"equal_thresholds", cases::equal_thresholds::run},
    Entry{"euler_maxwell", cases::euler::run_maxwell},
    Entry{"euler_lattice", cases::euler::run_lattice},
    Entry{"fracture_at_low_rate", cases::fracture_at_low_rate::run},
    Entry{"quantised_velocity", cases::quantised_velocity::run},
    Entry{"delay", cases::delay::run},
    Entry{"fast_contact", cases::fast_contact::run},
    Entry{"stiff_grip", cases::stiff_grip::run},
    Entry{"exponential_depth", cases::exponential_depth::run},
    Entry{"passivity_control", cases::passivity_control::run},
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
