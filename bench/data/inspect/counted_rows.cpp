#include "inspect/counted_rows.h"

#include <algorithm>
#include <map>
#include <stdexcept>

#include <fmt/format.h>

#include <kerf/schema/recorded_rows.h>

#include "inspect/flagged_cycles.h"
#include "prepare/rows.h"

namespace kerf::bench {
namespace {

std::vector<CycleVerdict> cycles_without_verdict(const schema::Cycles& cycles) {
  std::map<std::uint32_t, CycleVerdict> all;
  for (const schema::PhaseSpan& phase : cycles.phases)
    all.try_emplace(phase.cycle, CycleVerdict{.cycle = phase.cycle, .reason = {}});
  std::vector<CycleVerdict> list;
  for (auto& [number, cycle] : all) list.push_back(std::move(cycle));
  return list;
}

bool has_cycles(const schema::Recording& recording, std::size_t axis) {
  return recording.cycles && recording.cycles->axis == axis;
}

/// Every cycle, with the reason for which a choice leaves it out.
std::vector<CycleVerdict> chosen(const CycleChoice& choice, const schema::Recording& recording, double felt) {
  if (choice.by == CycleChoice::By::good) return verdicts_on_cycles(schema::RowsInMemory(recording), felt);
  std::vector<CycleVerdict> all = cycles_without_verdict(*recording.cycles);
  if (choice.by == CycleChoice::By::all) return all;
  for (const std::uint32_t number : choice.listed) {
    if (std::ranges::find(all, number, &CycleVerdict::cycle) == all.end())
      throw std::invalid_argument(
          fmt::format("--cycles: there is no cycle {}; the recording has {}", number, all.size()));
  }
  for (CycleVerdict& one : all) {
    if (std::ranges::find(choice.listed, one.cycle) == choice.listed.end())
      one.reason = "it is not among those that were asked for";
  }
  return all;
}

/// The new number of each cycle, 0 for one that is left out.
std::map<std::uint32_t, std::uint32_t> numbered_anew(const std::vector<CycleVerdict>& cycles) {
  std::map<std::uint32_t, std::uint32_t> numbers;
  std::uint32_t next = 1;
  for (const CycleVerdict& cycle : cycles) numbers[cycle.cycle] = cycle.reason.empty() ? next++ : 0;
  return numbers;
}

/// Takes cycles out of a series; false, and nothing changed, where too little would be left, or no cycle:
/// what lies outside of them all is not to decide.
bool leave_out(AxisSeries& series, const std::vector<CycleVerdict>& cycles) {
  if (std::ranges::none_of(cycles, [](const CycleVerdict& one) { return one.reason.empty(); })) return false;
  const auto numbers = numbered_anew(cycles);
  std::vector<std::uint8_t> counts = series.counts;
  counts.resize(series.force.size(), 1);
  for (std::size_t row = 0; row < counts.size(); ++row) {
    const std::uint32_t cycle = series.cycle[row];
    if (cycle > 0 && numbers.at(cycle) == 0) counts[row] = 0;
  }
  if (static_cast<std::size_t>(std::ranges::count(counts, 1)) < fewest_counted) return false;
  series.counts = std::move(counts);
  for (std::uint32_t& cycle : series.cycle) {
    if (cycle > 0) cycle = numbers.at(cycle);
  }
  return true;
}

}  // namespace

CycleChoice parse_cycle_choice(std::string_view text) {
  if (text == "good") return {.by = CycleChoice::By::good};
  if (text == "all") return {.by = CycleChoice::By::all};
  try {
    return {.by = CycleChoice::By::listed, .listed = parse_cycles(text)};
  } catch (const std::invalid_argument&) {
    throw std::invalid_argument(
        fmt::format("--cycles: '{}' is neither good nor all nor a list of cycles like 2-8,10", text));
  }
}

std::string in_words(const CycleChoice& choice) {
  if (choice.by == CycleChoice::By::good) return "good";
  if (choice.by == CycleChoice::By::all) return "all";
  return fmt::format("{}", fmt::join(choice.listed, ","));
}

CountedRows mark_counted(AxisSeries& series, const schema::Recording& recording, std::size_t axis,
                         const RowChoice& choice, double felt) {
  CountedRows counted{.left_out = {}};
  const std::size_t rows = series.force.size();
  counted.contact = choice.rows == Counted::contact ? mark_contact(series, felt) : rows;
  counted.rows = counted.contact;
  if (!has_cycles(recording, axis)) {
    if (choice.cycles.by == CycleChoice::By::listed)
      throw std::invalid_argument(
          fmt::format("--cycles: no cycles are kept along axis '{}' to take {} of; 'kerf segment' finds them",
                      recording.axes.at(axis).name, in_words(choice.cycles)));
    return counted;
  }
  const std::vector<CycleVerdict> cycles = chosen(choice.cycles, recording, felt);
  counted.cycles = cycles.size();
  for (const CycleVerdict& cycle : cycles) {
    if (!cycle.reason.empty()) counted.left_out.push_back({.number = cycle.cycle, .reason = cycle.reason});
  }
  if (counted.left_out.empty()) return counted;
  if (leave_out(series, cycles)) {
    counted.rows = static_cast<std::size_t>(std::ranges::count(series.counts, 1));
  } else {
    if (choice.cycles.by == CycleChoice::By::listed)
      throw std::invalid_argument(
          fmt::format("--cycles: with {} fewer than {} rows are left to fit; take more of the {} cycles, or "
                      "'--rows all'",
                      in_words(choice.cycles), fewest_counted, cycles.size()));
    counted.left_out.clear();
    counted.none_is_good = true;
  }
  return counted;
}

CycleChoice settled(const CycleChoice& choice, const schema::Recording& recording, std::size_t axis,
                    double felt) {
  if (choice.by != CycleChoice::By::good || !has_cycles(recording, axis)) return choice;
  CycleChoice settled{.by = CycleChoice::By::listed};
  for (const CycleVerdict& cycle : chosen(choice, recording, felt)) {
    if (cycle.reason.empty()) settled.listed.push_back(cycle.cycle);
  }
  return settled;
}

nlohmann::ordered_json as_json(const std::vector<LeftOutCycle>& left_out) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const LeftOutCycle& cycle : left_out)
    list.push_back({{"number", cycle.number}, {"reason", cycle.reason}});
  return list;
}

std::string cycles_left_out(const CountedRows& counted) {
  if (counted.none_is_good)
    return "none of the cycles is without a flag ('kerf inspect' says why): all are taken, and what follows "
           "is "
           "of such cycles";
  if (counted.left_out.empty()) return "";
  constexpr std::size_t most_reasons = 4;
  std::vector<std::string> reasons;
  for (const LeftOutCycle& cycle : counted.left_out) {
    if (reasons.size() == most_reasons) {
      reasons.push_back(
          fmt::format("and {} more ('kerf inspect' says why)", counted.left_out.size() - most_reasons));
      break;
    }
    reasons.push_back(fmt::format("cycle {}: {}", cycle.number, cycle.reason));
  }
  return fmt::format("{} of {} cycles are left out (--cycles all takes them): {}", counted.left_out.size(),
                     counted.cycles, fmt::join(reasons, "; "));
}

}  // namespace kerf::bench
