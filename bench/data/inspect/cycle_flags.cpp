#include "inspect/cycle_flags.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/core.h>

#include "signal/quantiles.h"
#include "signal/row_noise.h"

namespace kerf::bench {
namespace {

constexpr double put_down_s = 1.0;
constexpr double put_down_holds = 3.0;
constexpr double share_of_usual_peak = 1.0 / 3.0;
constexpr std::size_t fewest_others = 6;
constexpr double least_scatter = 0.05;  // of a logarithm

double farthest_allowed(std::size_t others) { return 3.5 * (1.0 + 6.0 / static_cast<double>(others)); }

template <typename Quantity>
double usual(const std::vector<FlaggedCycle>& cycles, const Quantity& quantity) {
  std::vector<double> values;
  for (const FlaggedCycle& cycle : cycles) values.push_back(quantity(cycle.facts));
  return median(std::move(values));
}

/// What cycles are told apart by; only positive values have a logarithm.
struct Quantity {
  std::string_view name;
  double (*of)(const CycleFacts&);
};
constexpr std::array<Quantity, 3> told_apart_by{
    {{.name = "closing time", .of = [](const CycleFacts& facts) { return facts.closing_s; }},
     {.name = "peak", .of = [](const CycleFacts& facts) { return facts.peak; }},
     {.name = "closing work", .of = [](const CycleFacts& facts) { return facts.closing_work; }}}};

/// Adds to each cycle how far it is by one quantity, if that is farther than what is there.
void add_distances(std::vector<FlaggedCycle>& cycles, const Quantity& quantity) {
  std::vector<double> logarithms;
  for (const FlaggedCycle& cycle : cycles) {
    const double value = quantity.of(cycle.facts);
    if (cycle.is_good() && value > 0.0) logarithms.push_back(std::log(value));
  }
  if (logarithms.size() < fewest_others) return;
  const double middle = median(logarithms);
  for (double& value : logarithms) value = std::abs(value - middle);
  const double scatter = std::max(least_scatter, deviation_of_mad * median(std::move(logarithms)));
  for (FlaggedCycle& cycle : cycles) {
    const double value = quantity.of(cycle.facts);
    if (!(value > 0.0)) continue;
    const double distance = (std::log(value) - middle) / scatter;
    if (cycle.farthest && std::abs(cycle.farthest->distance) >= std::abs(distance)) continue;
    cycle.farthest = {.quantity = std::string(quantity.name), .distance = distance};
  }
}

void flag_by_itself(FlaggedCycle& cycle, double usual_hold_s, double usual_peak, double least_felt,
                    std::string_view unit) {
  const CycleFacts& facts = cycle.facts;
  const auto add = [&](CycleFault fault, std::string reason) {
    cycle.flags.push_back({.fault = fault, .reason = std::move(reason)});
  };
  if (facts.idle_hold_s >= std::max(put_down_s, put_down_holds * usual_hold_s)) {
    add(CycleFault::put_down,
        fmt::format("closed for {:.1f} s, {:.1f} s of it out of contact; usual is {:.2f} s: "
                    "the tool was put down",
                    facts.hold_s, facts.idle_hold_s, usual_hold_s));
  }
  if (!(facts.peak > least_felt)) {
    add(CycleFault::under_force,
        fmt::format("its peak of {:.3g} {} is not felt ({:.3g} {})", facts.peak, unit, least_felt, unit));
  } else if (facts.peak < share_of_usual_peak * usual_peak) {
    add(CycleFault::under_force,
        fmt::format("its peak of {:.3g} {} is less than a third of the usual {:.3g} {}", facts.peak, unit,
                    usual_peak, unit));
  }
  if (facts.clipped_rows > 0)
    add(CycleFault::clipped, fmt::format("the sensor is clipped in {} rows", facts.clipped_rows));
  if (facts.gaps > 0) add(CycleFault::interrupted, fmt::format("rows are missing at {} places", facts.gaps));
  if (!facts.opening_s) add(CycleFault::interrupted, "the recording ends before it opens again");
}

}  // namespace

std::string_view name_of(CycleFault fault) noexcept {
  constexpr std::array<std::string_view, 6> names{"put_down",    "under_force", "clipped",
                                                  "interrupted", "outlier",     "by_hand"};
  return names.at(static_cast<std::size_t>(fault));
}

std::vector<FlaggedCycle> flag_cycles(std::span<const CycleFacts> cycles, double least_felt,
                                      std::string_view force_unit) {
  std::vector<FlaggedCycle> flagged;
  for (const CycleFacts& facts : cycles) flagged.push_back({.facts = facts});
  if (flagged.empty()) return flagged;
  const double usual_hold_s = usual(flagged, [](const CycleFacts& facts) { return facts.hold_s; });
  const double usual_peak = usual(flagged, [](const CycleFacts& facts) { return facts.peak; });
  for (FlaggedCycle& cycle : flagged) flag_by_itself(cycle, usual_hold_s, usual_peak, least_felt, force_unit);
  for (const Quantity& quantity : told_apart_by) add_distances(flagged, quantity);
  const auto others = static_cast<std::size_t>(std::ranges::count_if(flagged, &FlaggedCycle::is_good));
  for (FlaggedCycle& cycle : flagged) {
    if (!cycle.farthest || std::abs(cycle.farthest->distance) <= farthest_allowed(others)) continue;
    if (!cycle.is_good()) continue;  // that it differs is no news
    cycle.flags.push_back({.fault = CycleFault::outlier,
                           .reason = fmt::format("its {} is {:.1f} robust deviations from the others'",
                                                 cycle.farthest->quantity, cycle.farthest->distance)});
  }
  return flagged;
}

std::string reasons_of(const FlaggedCycle& cycle) {
  std::string reasons;
  for (const CycleFlag& flag : cycle.flags) reasons += (reasons.empty() ? "" : "; ") + flag.reason;
  return reasons;
}

std::string good_cycles(std::span<const FlaggedCycle> cycles) {
  std::string text;
  for (std::size_t i = 0; i < cycles.size(); ++i) {
    if (!cycles[i].is_good()) continue;
    std::size_t last = i;
    while (last + 1 < cycles.size() && cycles[last + 1].is_good() &&
           cycles[last + 1].facts.number == cycles[last].facts.number + 1)
      ++last;
    text += text.empty() ? "" : ",";
    text += std::to_string(cycles[i].facts.number);
    if (last > i) text += fmt::format("-{}", cycles[last].facts.number);
    i = last;
  }
  return text;
}

}  // namespace kerf::bench
