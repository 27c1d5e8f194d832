#include "inspect/flagged_cycles.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <string_view>

#include "inspect/clipping.h"
#include "inspect/sampling.h"
#include "inspect/signal_facts.h"
#include "recordings/axis_values.h"
#include "recordings/contact_rows.h"
#include "recordings/provenance.h"
#include "segment/segment.h"

namespace kerf::bench {
namespace {

using schema::Column;

constexpr std::string_view accepted = "accepted";

std::vector<CycleVerdict> as_stored(const schema::Recording& about) {
  std::map<std::uint32_t, CycleVerdict> verdicts;
  for (const schema::PhaseSpan& phase : about.cycles->phases)
    verdicts.try_emplace(phase.cycle, CycleVerdict{.cycle = phase.cycle, .reason = {}});
  std::vector<std::uint32_t> taken;
  for (const schema::CycleFlag& flag : about.cycle_flags->flags) {
    const auto found = verdicts.find(flag.cycle);
    if (found == verdicts.end()) continue;
    if (flag.fault == accepted) {
      taken.push_back(flag.cycle);
    } else {
      found->second.reason += (found->second.reason.empty() ? "" : "; ") + flag.reason;
    }
  }
  for (const std::uint32_t cycle : taken) verdicts.at(cycle).reason.clear();
  std::vector<CycleVerdict> all;
  for (auto& [cycle, verdict] : verdicts) all.push_back(std::move(verdict));
  return all;
}

}  // namespace

std::vector<FlaggedCycle> flagged_cycles(const schema::RecordedRows& rows, const schema::Cycles& cycles,
                                         double felt) {
  const BlockedValues time_s = axis_values(rows, Column::time);
  const BlockedValues force = axis_values(rows, force_column(rows), cycles.axis);
  if (force.size() == 0) throw std::invalid_argument("without a force nothing is known of cycles");
  const ContactRows contact = contact_rows(time_s, force, felt);
  const EndsOfRange ends = ends_of_force(force, axis_values(rows, Column::position, cycles.axis));
  CycleContext context{.contact = contact, .period_s = sampling_of(rows).period_s};
  if (ends.least.is_clipped == true) context.clipped_low = ends.least.value;
  if (ends.most.is_clipped == true) context.clipped_high = ends.most.value;
  return flag_cycles(cycle_facts(rows, cycles, context), contact.least,
                     rows.about().axes.at(cycles.axis).force_unit);
}

void add_what_was_said(std::vector<FlaggedCycle>& cycles, const schema::CycleFlags& stored) {
  for (FlaggedCycle& cycle : cycles) {
    for (const schema::CycleFlag& flag : stored.flags) {
      if (flag.cycle != cycle.facts.number) continue;
      if (flag.fault == accepted) cycle.accepted = flag.reason;
      if (flag.fault == name_of(CycleFault::by_hand))
        cycle.flags.push_back({.fault = CycleFault::by_hand, .reason = flag.reason});
    }
  }
}

schema::CycleFlags stored_flags(const std::vector<FlaggedCycle>& cycles, double felt) {
  const schema::Header now = schema::new_header(software());
  schema::CycleFlags stored{.created = now.created, .software = now.software, .felt = felt, .flags = {}};
  for (const FlaggedCycle& cycle : cycles) {
    const std::uint32_t number = cycle.facts.number;
    for (const CycleFlag& flag : cycle.flags)
      stored.flags.push_back(
          {.cycle = number, .fault = std::string(name_of(flag.fault)), .reason = flag.reason});
    if (cycle.accepted)
      stored.flags.push_back({.cycle = number, .fault = std::string(accepted), .reason = *cycle.accepted});
  }
  return stored;
}

std::vector<CycleVerdict> verdicts_on_cycles(const schema::RecordedRows& rows, double felt) {
  const schema::Recording& about = rows.about();
  if (!about.cycles || about.cycles->axis >= about.dimensions()) return {};
  if (about.cycle_flags) return as_stored(about);
  std::vector<CycleVerdict> verdicts;
  for (const FlaggedCycle& cycle : flagged_cycles(rows, *about.cycles, felt))
    verdicts.push_back({.cycle = cycle.facts.number, .reason = reasons_of(cycle)});
  return verdicts;
}

CycleMeans means_of_good_cycles(const schema::Cycles& cycles, const std::vector<bool>& is_good) {
  const std::size_t all = cycles.closing.size();
  const auto good = static_cast<std::size_t>(std::ranges::count(is_good, true));
  if (is_good.size() != all || cycles.opening.size() != all || good == 0 || good == all)
    return {.closing = cycles.closing_mean, .opening = cycles.opening_mean, .cycles = all};
  std::vector<std::vector<double>> closing;
  std::vector<std::vector<double>> opening;
  for (std::size_t i = 0; i < all; ++i) {
    if (!is_good[i]) continue;
    closing.push_back(cycles.closing[i]);
    opening.push_back(cycles.opening[i]);
  }
  return {.closing = mean_branch(closing, cycles.grid.size()),
          .opening = mean_branch(opening, cycles.grid.size()),
          .cycles = good};
}

CycleMeans means_of_good_cycles(const schema::Recording& about, const schema::Cycles& cycles) {
  std::vector<bool> is_good;
  if (about.cycles && about.cycle_flags && about.cycles->axis == cycles.axis) {
    for (const CycleVerdict& verdict : as_stored(about)) is_good.push_back(verdict.reason.empty());
  }
  return means_of_good_cycles(cycles, is_good);
}

CycleMeans means_of_good_cycles(const schema::RecordedRows& rows, const schema::Cycles& cycles, double felt) {
  const schema::Recording& about = rows.about();
  if (about.cycles && about.cycle_flags && about.cycles->axis == cycles.axis)
    return means_of_good_cycles(about, cycles);
  std::vector<bool> is_good;
  try {
    for (const FlaggedCycle& cycle : flagged_cycles(rows, cycles, felt)) is_good.push_back(cycle.is_good());
  } catch (const schema::FormatError&) {
    is_good.clear();  // phases whose rows are not there: of what is there all count, as it is stored
  } catch (const std::invalid_argument&) {
    is_good.clear();
  }
  return means_of_good_cycles(cycles, is_good);
}

}  // namespace kerf::bench
