#include "segment/cycle_changes.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include <fmt/core.h>

#include "recordings/axis_values.h"
#include "recordings/provenance.h"
#include "recordings/row_span.h"

namespace kerf::bench {
namespace {

using schema::CycleChange;
using schema::PhaseSpan;

constexpr std::string_view edited_by = ": cycles edited by ";
constexpr std::string_view found_anew = ": segment: ";
constexpr std::size_t most_sentences = 60;  // an edit stays one that can be read

std::string_view in_words(schema::Phase phase) noexcept {
  constexpr std::array<std::string_view, 5> names{"", "opening", "the wait before its closing", "closing",
                                                  "the hold before its opening"};
  const auto at = static_cast<std::size_t>(phase);
  return at < names.size() ? names[at] : names[0];
}

struct OneCycle {
  std::uint32_t number = 0;
  RowSpan rows;
  std::size_t first = 0;  ///< of its phases, which are those to `last`
  std::size_t last = 0;
};

std::vector<OneCycle> cycles_in(const std::vector<PhaseSpan>& phases) {
  std::vector<OneCycle> cycles;
  for (std::size_t i = 0; i < phases.size(); ++i) {
    const PhaseSpan& phase = phases[i];
    if (cycles.empty() || cycles.back().number != phase.cycle)
      cycles.push_back({.number = phase.cycle, .rows = {.begin = phase.begin, .end = phase.end}, .first = i});
    cycles.back().rows.end = phase.end;
    cycles.back().last = i + 1;
  }
  return cycles;
}

bool are_the_same(const OneCycle& a, const OneCycle& b) {
  const std::size_t begin = std::max(a.rows.begin, b.rows.begin);
  const std::size_t end = std::min(a.rows.end, b.rows.end);
  const std::size_t shorter = std::min(a.rows.end - a.rows.begin, b.rows.end - b.rows.begin);
  return end > begin && 2 * (end - begin) > shorter;
}

/// Cycles before, and what they are after; one of both may be none.
struct CyclesGroup {
  std::vector<OneCycle> before;
  std::vector<OneCycle> after;
  [[nodiscard]] bool is_one() const { return before.size() == 1 && after.size() == 1; }
};

/// In the order of their rows.
std::vector<CyclesGroup> groups_of(const std::vector<OneCycle>& before, const std::vector<OneCycle>& after) {
  std::vector<CyclesGroup> groups;
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < before.size() || j < after.size()) {
    CyclesGroup group;
    if (i < before.size() && j < after.size() && are_the_same(before[i], after[j])) {
      group.before.push_back(before[i++]);
      group.after.push_back(after[j++]);
      while (true) {
        if (i < before.size() && are_the_same(before[i], group.after.back())) {
          group.before.push_back(before[i++]);
        } else if (j < after.size() && are_the_same(group.before.back(), after[j])) {
          group.after.push_back(after[j++]);
        } else {
          break;
        }
      }
    } else if (j == after.size() || (i < before.size() && before[i].rows.begin <= after[j].rows.begin)) {
      group.before.push_back(before[i++]);
    } else {
      group.after.push_back(after[j++]);
    }
    groups.push_back(std::move(group));
  }
  return groups;
}

class Comparison {
 public:
  Comparison(const schema::RecordedRows& rows, const SaidCycles& before, const SaidCycles& after)
      : before_(before),
        after_(after),
        time_s_(axis_values(rows, schema::Column::time)),
        groups_(groups_of(cycles_in(before.phases), cycles_in(after.phases))) {
    for (const CyclesGroup& group : groups_) {
      if (group.is_one()) stayed_one_.insert(group.after.front().number);
    }
  }

  std::vector<CycleChange> changes() {
    for (const CyclesGroup& group : groups_) add(group);
    add_said();
    return std::move(changes_);
  }

 private:
  void add(const CyclesGroup& group) {
    if (group.is_one()) return add_moves(group.before.front(), group.after.front());
    if (group.before.size() == 1 && group.after.size() > 1) return add_split(group);
    if (group.after.size() == 1 && group.before.size() > 1) return add_merged(group);
    const std::string was = numbers_of(group.before);
    const std::string is = numbers_of(group.after);
    const std::uint32_t cycle = (group.after.empty() ? group.before : group.after).front().number;
    changes_.push_back({.cycle = cycle,
                        .time = {},
                        .author = {},
                        .kind = "divided",
                        .text = is.empty()    ? was + " no longer a cycle"
                                : was.empty() ? is + " a cycle anew"
                                              : fmt::format("{} divided anew into {}", was, is)});
  }

  static std::string numbers_of(const std::vector<OneCycle>& cycles) {
    if (cycles.empty()) return "";
    if (cycles.size() == 1) return fmt::format("cycle {}", cycles.front().number);
    return fmt::format("cycles {} to {}", cycles.front().number, cycles.back().number);
  }

  void add_split(const CyclesGroup& group) {
    const std::uint32_t cycle = group.before.front().number;
    for (std::size_t k = 1; k < group.after.size(); ++k) {
      const std::uint64_t row = group.after[k].rows.begin;
      changes_.push_back({.cycle = cycle,
                          .row_after = static_cast<std::int64_t>(row),
                          .time = {},
                          .author = {},
                          .kind = "split",
                          .text = fmt::format("cycle {} split at {} into {} and {}", cycle, place(row),
                                              group.after[k - 1].number, group.after[k].number)});
    }
  }

  void add_merged(const CyclesGroup& group) {
    const std::uint32_t cycle = group.after.front().number;
    for (std::size_t k = 1; k < group.before.size(); ++k) {
      const std::uint64_t row = group.before[k].rows.begin;
      changes_.push_back(
          {.cycle = cycle,
           .row_before = static_cast<std::int64_t>(row),
           .time = {},
           .author = {},
           .kind = "merged",
           .text = fmt::format("cycles {} and {}, which met at {}, merged into {}",
                               group.before[k - 1].number, group.before[k].number, place(row), cycle)});
    }
  }

  void add_moves(const OneCycle& cycle_before, const OneCycle& cycle_after) {
    const std::vector<PhaseSpan>& phases = after_.phases;
    std::map<schema::Phase, PhaseSpan> was;
    for (std::size_t i = cycle_before.first; i < cycle_before.last; ++i)
      was[before_.phases[i].phase] = before_.phases[i];
    for (std::size_t i = cycle_after.first; i < cycle_after.last; ++i) {
      const PhaseSpan& is = phases[i];
      const auto found = was.find(is.phase);
      if (found == was.end()) {
        changes_.push_back(boundary(is, "begin", std::nullopt, is.begin));
        continue;
      }
      if (is.begin != found->second.begin)
        changes_.push_back(boundary(is, "begin", found->second.begin, is.begin));
      // Where a phase ends, the next one begins, which says it.
      const bool is_told =
          i + 1 < phases.size() && phases[i + 1].begin == is.end && stayed_one_.contains(phases[i + 1].cycle);
      if (is.end != found->second.end && !is_told)
        changes_.push_back(boundary(is, "end", found->second.end, is.end));
      was.erase(found);
    }
    for (const auto& [phase, span] : was)
      changes_.push_back(
          {.cycle = cycle_after.number,
           .phase = static_cast<std::uint8_t>(phase),
           .row_before = static_cast<std::int64_t>(span.begin),
           .time = {},
           .author = {},
           .kind = "begin",
           .text = fmt::format("cycle {}: {} is no more", cycle_after.number, in_words(phase))});
  }

  [[nodiscard]] CycleChange boundary(const PhaseSpan& phase, std::string_view edge,
                                     std::optional<std::uint64_t> from, std::uint64_t to) const {
    std::string text =
        fmt::format("cycle {}: {} {}s at {}", phase.cycle, in_words(phase.phase), edge, place(to));
    if (from) text += " instead of " + place(*from);
    return {.cycle = phase.cycle,
            .phase = static_cast<std::uint8_t>(phase.phase),
            .row_before = from ? static_cast<std::int64_t>(*from) : -1,
            .row_after = static_cast<std::int64_t>(to),
            .time = {},
            .author = {},
            .kind = std::string(edge),
            .text = std::move(text)};
  }

  /// A row beyond the last has the time of the last.
  [[nodiscard]] std::string place(std::uint64_t row) const {
    return fmt::format("{:.6g} s (row {})", time_s_[std::min<std::uint64_t>(row, time_s_.size() - 1)], row);
  }

  /// What was said before, of the cycles as they are counted now.
  [[nodiscard]] std::map<std::pair<std::uint32_t, std::string>, std::string> said_before() const {
    std::multimap<std::uint32_t, std::uint32_t> became;
    for (const CyclesGroup& group : groups_) {
      for (const OneCycle& was : group.before) {
        for (const OneCycle& is : group.after) became.emplace(was.number, is.number);
      }
    }
    std::map<std::pair<std::uint32_t, std::string>, std::string> said;
    for (const schema::CycleFlag& flag : before_.said) {
      const auto [first, last] = became.equal_range(flag.cycle);
      for (auto it = first; it != last; ++it) said.try_emplace({it->second, flag.fault}, flag.reason);
    }
    return said;
  }

  void add_said() {
    auto gone = said_before();
    const auto say = [&](std::uint32_t cycle, std::string_view kind, const std::string& what) {
      changes_.push_back({.cycle = cycle,
                          .time = {},
                          .author = {},
                          .kind = std::string(kind),
                          .text = fmt::format("cycle {} {}", cycle, what)});
    };
    for (const schema::CycleFlag& one : after_.said) {
      const auto known = gone.find({one.cycle, one.fault});
      const bool is_new = known == gone.end() || known->second != one.reason;
      if (known != gone.end()) gone.erase(known);
      if (!is_new) continue;
      const bool taken = one.fault == "accepted";
      say(one.cycle, taken ? "taken" : "left_out", (taken ? "taken: " : "left out: ") + one.reason);
    }
    for (const auto& [which, reason] : gone)
      say(which.first, "as_found",
          which.second == "accepted" ? "no longer taken by hand" : "no longer left out by hand");
  }

  const SaidCycles& before_;
  const SaidCycles& after_;
  BlockedValues time_s_;
  std::vector<CyclesGroup> groups_;
  std::set<std::uint32_t> stayed_one_;
  std::vector<CycleChange> changes_;
};

/// Edits of `/cycle_edits`; the sentences of each together.
std::vector<ToldEdit> edits_in(const std::vector<CycleChange>& changes) {
  std::vector<ToldEdit> edits;
  std::size_t sentences = 0;
  for (auto change = changes.begin(); change != changes.end(); ++change) {
    if (change == changes.begin() || change->edit != std::prev(change)->edit) {
      edits.push_back({.time = change->time, .author = change->author, .what = {}});
      sentences = 0;
    }
    std::string& what = edits.back().what;
    if (++sentences <= most_sentences) what += (what.empty() ? "" : "; ") + change->text;
    const bool is_last = std::next(change) == changes.end() || std::next(change)->edit != change->edit;
    if (is_last && sentences > most_sentences)
      what += fmt::format("; and {} more", sentences - most_sentences);
  }
  return edits;
}

/// Whether a line of the history tells an edit; as far as the line says it.
bool tells_an_edit(std::string_view line, ToldEdit& edit) {
  const std::size_t step = std::min(line.find(": "), line.size());  // after time and program
  std::string_view by = line.substr(step);
  if (!by.starts_with(edited_by)) return false;
  by.remove_prefix(edited_by.size());
  const std::size_t end = std::min(by.find(": "), by.size());
  edit = {.time = std::string(line.substr(0, line.find(' '))),
          .author = std::string(by.substr(0, end)),
          .what = std::string(by.substr(std::min(end + 2, by.size())))};
  return true;
}

bool tells_a_segmentation(std::string_view line) {
  return line.substr(std::min(line.find(": "), line.size())).starts_with(found_anew);
}

}  // namespace

std::vector<CycleChange> changes_between(const schema::RecordedRows& rows, const SaidCycles& before,
                                         const SaidCycles& after) {
  return Comparison(rows, before, after).changes();
}

std::vector<ToldEdit> edits_of(const schema::Recording& about) {
  std::vector<ToldEdit> kept = edits_in(about.cycle_edits);
  std::vector<ToldEdit> edits;
  std::string_view rest = about.header.history;
  while (!rest.empty()) {
    const std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(rest.size(), line.size() + 1));
    if (tells_a_segmentation(line)) edits.clear();
    ToldEdit edit;
    if (!tells_an_edit(line, edit)) continue;
    const auto in_full = std::ranges::find_if(
        kept, [&](const ToldEdit& one) { return one.time == edit.time && one.author == edit.author; });
    if (in_full != kept.end()) {
      edit = *in_full;
      kept.erase(in_full);
    }
    edits.push_back(std::move(edit));
  }
  edits.insert(edits.end(), kept.begin(), kept.end());  // of which the history has no line
  return edits;
}

void add_edit(schema::Recording& about, std::vector<CycleChange> changes, const std::string& author) {
  const std::string what = changes.empty()       ? "nothing changed"
                           : changes.size() == 1 ? "one change, in /cycle_edits"
                                                 : fmt::format("{} changes, in /cycle_edits", changes.size());
  add_history(about.header, fmt::format("{}{}: {}", edited_by.substr(2), author, what));
  std::string_view line = about.header.history;
  if (line.ends_with('\n')) line.remove_suffix(1);
  line = line.substr(line.rfind('\n') + 1);  // of one line: from its begin
  const std::uint32_t number = about.cycle_edits.empty() ? 1 : about.cycle_edits.back().edit + 1;
  for (CycleChange& change : changes) {
    change.edit = number;
    change.time = line.substr(0, line.find(' '));
    change.author = author;
    about.cycle_edits.push_back(std::move(change));
  }
}

}  // namespace kerf::bench
