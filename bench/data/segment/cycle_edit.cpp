#include "segment/cycle_edit.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <set>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>
#include <pwd.h>
#include <unistd.h>

#include "inspect/flagged_cycles.h"
#include "recordings/axis_values.h"
#include "recordings/provenance.h"
#include "segment/branches.h"
#include "segment/cycle_division.h"

namespace kerf::bench {
namespace {

constexpr std::size_t longest_author = 60;

/// Cycles that are asked for, before their rows are changed.
schema::Cycles unedited(const schema::RecordedRows& rows, const CycleEdit& edit) {
  if (edit.found_by) return find_cycles(rows, *edit.found_by);
  if (!rows.about().cycles)
    throw std::invalid_argument("the recording has no cycles yet; expected settings by which they are found");
  return *rows.about().cycles;
}

/// The order of phases within a cycle.
int place_in_cycle(schema::Phase phase) noexcept {
  constexpr std::array<int, 5> places{0, 4, 1, 2, 3};
  return places.at(static_cast<std::size_t>(phase));
}

/// Cycles are counted from 1, and each has a closing and what else belongs to it, in order.
void check_division(const std::vector<schema::PhaseSpan>& phases) {
  std::uint32_t cycle = 0;
  int place = 0;
  bool has_closing = true;
  const auto refuse = [](std::uint32_t number) {
    throw std::invalid_argument(fmt::format(
        "cycle {} is not made of a wait, a closing, a hold and an opening in this order, of which "
        "only the closing has to be there; expected cycles counted from 1",
        number));
  };
  for (const schema::PhaseSpan& phase : phases) {
    if (phase.cycle != cycle) {
      if (!has_closing || phase.cycle != cycle + 1) refuse(std::max(cycle, std::uint32_t{1}));
      cycle = phase.cycle;
      place = 0;
      has_closing = false;
    }
    if (place_in_cycle(phase.phase) <= place) refuse(cycle);
    place = place_in_cycle(phase.phase);
    has_closing = has_closing || phase.phase == schema::Phase::closing;
  }
  if (!has_closing) refuse(cycle);
}

void check_phases(const std::vector<schema::PhaseSpan>& phases, const std::vector<schema::PhaseSpan>& known,
                  std::uint64_t rows) {
  const auto are_one = [](const schema::PhaseSpan& a, const schema::PhaseSpan& b) {
    return a.cycle == b.cycle && a.phase == b.phase;
  };
  if (!std::ranges::equal(phases, known, are_one)) check_division(phases);
  std::uint64_t free_from = 0;
  for (const schema::PhaseSpan& phase : phases) {
    if (phase.begin < free_from || phase.begin >= phase.end || phase.end > rows)
      throw std::invalid_argument(
          fmt::format("cycle {}: {} is of the rows {} to {}; expected one row and more, from row {} on, "
                      "within {}",
                      phase.cycle, name_of(phase.phase), phase.begin, phase.end, free_from, rows));
    free_from = phase.end;
  }
}

void check_said(const std::vector<schema::CycleFlag>& said, const schema::Cycles& cycles) {
  std::set<std::uint32_t> numbers;
  for (const schema::PhaseSpan& phase : cycles.phases) numbers.insert(phase.cycle);
  for (const schema::CycleFlag& one : said) {
    if (one.fault != "by_hand" && one.fault != "accepted")
      throw std::invalid_argument(
          fmt::format("'{}' is not said by hand; expected by_hand or accepted", one.fault));
    if (!numbers.contains(one.cycle))
      throw std::invalid_argument(
          fmt::format("there is no cycle {}; the recording has {}", one.cycle, numbers.size()));
    if (one.reason.empty())
      throw std::invalid_argument(fmt::format("cycle {} has no reason; expected one", one.cycle));
  }
}

/// Of cycles as they are counted after a step.
std::vector<schema::CycleFlag> said_after(const std::vector<schema::CycleFlag>& before,
                                          const CycleStep& step) {
  const bool splits = step.kind == CycleStep::Kind::split;
  std::vector<schema::CycleFlag> said;
  for (schema::CycleFlag flag : before) {
    const bool is_split = splits && flag.cycle == step.cycle;
    const bool is_of_second = !splits && flag.cycle == step.cycle + 1;
    const auto is_of_first = [&](const schema::CycleFlag& other) { return other.cycle == step.cycle; };
    if (is_of_second && std::ranges::any_of(before, is_of_first)) continue;
    if (flag.cycle > step.cycle) flag.cycle = splits ? flag.cycle + 1 : flag.cycle - 1;
    said.push_back(flag);
    if (!is_split) continue;
    ++flag.cycle;
    said.push_back(std::move(flag));
  }
  return said;
}

}  // namespace

std::vector<schema::CycleFlag> said_by_hand(const schema::Recording& about) {
  std::vector<schema::CycleFlag> said;
  if (!about.cycle_flags) return said;
  std::ranges::copy_if(about.cycle_flags->flags, std::back_inserter(said), [](const schema::CycleFlag& flag) {
    return flag.fault == "by_hand" || flag.fault == "accepted";
  });
  return said;
}

EditedCycles edited_cycles(const schema::RecordedRows& rows, const CycleEdit& edit, double felt) {
  EditedCycles edited{.cycles = unedited(rows, edit), .flagged = {}};
  schema::Cycles& cycles = edited.cycles;
  if (cycles.axis >= rows.about().dimensions() || cycles.grid.size() < 2)
    throw std::invalid_argument("its cycles do not hold together; find them anew");
  if (!edit.phases.empty()) check_phases(edit.phases, cycles.phases, rows.rows());
  const auto is_same = [](const schema::PhaseSpan& a, const schema::PhaseSpan& b) {
    return a.begin == b.begin && a.end == b.end;
  };
  if (!edit.phases.empty() && !std::ranges::equal(edit.phases, cycles.phases, is_same)) {
    cycles.phases = edit.phases;
    AxisMotion motion(rows, cycles.axis, cycles.filter_corner_hz);
    motion.close_along(cycles.closing_direction);
    average_branches(cycles, motion);
  }
  check_said(edit.said, cycles);
  edited.flagged = flagged_cycles(rows, cycles, felt);
  add_what_was_said(edited.flagged, {.created = {}, .software = {}, .felt = felt, .flags = edit.said});
  return edited;
}

CycleEdit with_step(const schema::RecordedRows& rows, CycleEdit edit, const CycleStep& step) {
  const schema::Cycles cycles = unedited(rows, edit);
  if (cycles.axis >= rows.about().dimensions())
    throw std::invalid_argument("its cycles do not hold together; find them anew");
  const std::vector<schema::PhaseSpan> phases = edit.phases.empty() ? cycles.phases : edit.phases;
  check_phases(phases, cycles.phases, rows.rows());
  AxisMotion motion(rows, cycles.axis, cycles.filter_corner_hz);
  motion.close_along(cycles.closing_direction);
  DivisionOptions options;
  if (edit.found_by) options.dwell = edit.found_by->dwell;
  edit.phases = step.kind == CycleStep::Kind::split
                    ? split_cycle(motion, phases, step.cycle, step.row, options)
                    : merge_cycles(motion, phases, step.cycle, options);
  edit.said = said_after(edit.said, step);
  return edit;
}

std::vector<schema::CycleChange> changes_by(const schema::RecordedRows& rows, const CycleEdit& edit,
                                            const EditedCycles& edited) {
  std::vector<schema::CycleChange> changes;
  SaidCycles before;
  if (edit.found_by) {
    changes.push_back(
        {.time = {},
         .author = {},
         .kind = "found",
         .text = fmt::format("found anew, {} of them, prominence {:g}, zero-phase low-pass {:g} Hz",
                             edited.cycles.closing.size(), edit.found_by->prominence,
                             edited.cycles.filter_corner_hz)});
    before.phases = edit.phases.empty() ? edited.cycles.phases : find_cycles(rows, *edit.found_by).phases;
  } else {
    before = {.phases = rows.about().cycles->phases, .said = said_by_hand(rows.about())};
  }
  const SaidCycles after{.phases = edited.cycles.phases, .said = edit.said};
  std::ranges::move(changes_between(rows, before, after), std::back_inserter(changes));
  return changes;
}

std::string usual_author() {
  const passwd* const user = getpwuid(geteuid());
  return user == nullptr || user->pw_name == nullptr ? "" : user->pw_name;
}

void check_author(std::string_view author) {
  const bool is_name = !author.empty() && author.size() <= longest_author &&
                       std::ranges::none_of(author, [](char c) { return c == ':' || (c >= 0 && c < ' '); });
  if (!is_name)
    throw std::invalid_argument(
        fmt::format("who edits is not said; expected a name of 1 to {} bytes without line breaks and ':'",
                    longest_author));
}

schema::Recording with_edit(const schema::RecordedRows& rows, const CycleEdit& edit,
                            const EditedCycles& edited, double felt, std::string_view author) {
  check_author(author);
  schema::Recording about = rows.about();
  about.cycles = edited.cycles;
  about.cycle_flags = stored_flags(edited.flagged, felt);
  add_edit(about, changes_by(rows, edit, edited), std::string(author));
  return about;
}

std::string cycles_sha256_of(const schema::Recording& about) {
  if (!about.cycles) return "";
  const schema::Cycles& cycles = *about.cycles;
  std::string text = fmt::format("kerf.cycles 1\n{} {}\n", cycles.axis, cycles.closing_direction);
  for (const schema::PhaseSpan& phase : cycles.phases)
    text += fmt::format("{} {} {} {}\n", phase.cycle, static_cast<int>(phase.phase), phase.begin, phase.end);
  std::set<std::uint32_t> left_out;
  std::set<std::uint32_t> accepted;
  if (about.cycle_flags) {
    for (const schema::CycleFlag& flag : about.cycle_flags->flags)
      (flag.fault == "accepted" ? accepted : left_out).insert(flag.cycle);
  }
  for (const std::uint32_t cycle : left_out) {
    if (!accepted.contains(cycle)) text += fmt::format("without {}\n", cycle);
  }
  return sha256_of(std::string_view(text));
}

}  // namespace kerf::bench
