#include "segment/cycle_edit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include "inspect/flagged_cycles.h"
#include "recordings/axis_values.h"
#include "recordings/provenance.h"
#include "segment/branches.h"

namespace kerf::bench {
namespace {

constexpr std::string_view edited_by = ": cycles edited by ";
constexpr std::string_view found_anew = ": segment: ";
constexpr std::size_t longest_author = 60;
constexpr std::size_t most_sentences = 60;  // a line of the history stays one that can be read

std::string_view in_words(schema::Phase phase) noexcept {
  constexpr std::array<std::string_view, 5> names{"", "opening", "the wait before its closing", "closing",
                                                  "the hold before its opening"};
  const auto at = static_cast<std::size_t>(phase);
  return at < names.size() ? names[at] : names[0];
}

/// Cycles that are asked for, before their rows are changed.
schema::Cycles unedited(const schema::RecordedRows& rows, const CycleEdit& edit) {
  if (edit.found_by) return find_cycles(rows, *edit.found_by);
  if (!rows.about().cycles)
    throw std::invalid_argument("the recording has no cycles yet; expected settings by which they are found");
  return *rows.about().cycles;
}

void check_phases(const std::vector<schema::PhaseSpan>& phases, const std::vector<schema::PhaseSpan>& known,
                  std::uint64_t rows) {
  const auto are_one = [](const schema::PhaseSpan& a, const schema::PhaseSpan& b) {
    return a.cycle == b.cycle && a.phase == b.phase;
  };
  if (!std::ranges::equal(phases, known, are_one))
    throw std::invalid_argument(fmt::format(
        "{} phases are of other cycles than the {} there are; expected the same phases in the same order",
        phases.size(), known.size()));
  std::uint64_t free_from = 0;
  for (const schema::PhaseSpan& phase : phases) {
    if (phase.begin < free_from || phase.begin >= phase.end || phase.end > rows)
      throw std::invalid_argument(
          fmt::format("cycle {}: {} is of the rows {} to {}; expected one row and more, from row {} on, "
                      "within {}",
                      phase.cycle, in_words(phase.phase), phase.begin, phase.end, free_from, rows));
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

/// What a person has said of cycles, as it stands in a recording.
std::map<std::pair<std::uint32_t, std::string>, std::string> said_in(const schema::Recording& about) {
  std::map<std::pair<std::uint32_t, std::string>, std::string> said;
  if (!about.cycle_flags) return said;
  for (const schema::CycleFlag& flag : about.cycle_flags->flags) {
    if (flag.fault == "by_hand" || flag.fault == "accepted") said[{flag.cycle, flag.fault}] = flag.reason;
  }
  return said;
}

class Changes {
 public:
  Changes(const schema::RecordedRows& rows, const CycleEdit& edit, const EditedCycles& edited)
      : edit_(edit),
        edited_(edited),
        before_(before(rows, edit)),
        said_before_(said_in(rows.about())),
        time_s_(axis_values(rows, schema::Column::time)) {
    if (edit.found_by) said_before_.clear();
  }

  std::vector<std::string> in_sentences() {
    if (edit_.found_by)
      add(fmt::format("found anew, {} of them, prominence {:g}, zero-phase low-pass {:g} Hz",
                      edited_.cycles.closing.size(), edit_.found_by->prominence,
                      edited_.cycles.filter_corner_hz));
    for (std::size_t i = 0; i < std::min(before_.size(), edited_.cycles.phases.size()); ++i) add_moves(i);
    add_said();
    return std::move(sentences_);
  }

 private:
  static std::vector<schema::PhaseSpan> before(const schema::RecordedRows& rows, const CycleEdit& edit) {
    if (!edit.found_by) return rows.about().cycles->phases;
    return edit.phases.empty() ? std::vector<schema::PhaseSpan>() : find_cycles(rows, *edit.found_by).phases;
  }

  void add(std::string sentence) { sentences_.push_back(std::move(sentence)); }

  void add_moves(std::size_t i) {
    const schema::PhaseSpan& was = before_[i];
    const std::vector<schema::PhaseSpan>& phases = edited_.cycles.phases;
    const schema::PhaseSpan& is = phases[i];
    if (is.begin != was.begin) add(moved(is, "begins", was.begin, is.begin));
    const bool follows = i + 1 < phases.size() && phases[i + 1].begin == is.end;
    if (is.end != was.end && !follows) add(moved(is, "ends", was.end, is.end));
  }

  std::string moved(const schema::PhaseSpan& phase, std::string_view edge, std::uint64_t from,
                    std::uint64_t to) {
    return fmt::format("cycle {}: {} {} at {:.6g} s (row {}) instead of {:.6g} s (row {})", phase.cycle,
                       in_words(phase.phase), edge, time_of(to), to, time_of(from), from);
  }

  double time_of(std::uint64_t row) const { return time_s_[std::min(row, time_s_.size() - 1)]; }

  void add_said() {
    auto gone = said_before_;
    for (const schema::CycleFlag& one : edit_.said) {
      const auto known = gone.find({one.cycle, one.fault});
      const bool is_new = known == gone.end() || known->second != one.reason;
      if (known != gone.end()) gone.erase(known);
      if (!is_new) continue;
      add(fmt::format("cycle {} {}: {}", one.cycle, one.fault == "accepted" ? "taken" : "left out",
                      one.reason));
    }
    for (const auto& [which, reason] : gone)
      add(fmt::format("cycle {} no longer {}", which.first,
                      which.second == "accepted" ? "taken by hand" : "left out by hand"));
  }

  const CycleEdit& edit_;
  const EditedCycles& edited_;
  std::vector<schema::PhaseSpan> before_;
  std::map<std::pair<std::uint32_t, std::string>, std::string> said_before_;
  BlockedValues time_s_;
  std::vector<std::string> sentences_;
};

std::string joined(const std::vector<std::string>& sentences) {
  std::string text;
  for (std::size_t i = 0; i < std::min(sentences.size(), most_sentences); ++i)
    text += (text.empty() ? "" : "; ") + sentences[i];
  if (sentences.size() > most_sentences)
    text += fmt::format("; and {} more", sentences.size() - most_sentences);
  return text.empty() ? "nothing changed" : text;
}

}  // namespace

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

std::vector<std::string> changes_by(const schema::RecordedRows& rows, const CycleEdit& edit,
                                    const EditedCycles& edited) {
  return Changes(rows, edit, edited).in_sentences();
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
  add_history(about.header,
              fmt::format("{}{}: {}", edited_by.substr(2), author, joined(changes_by(rows, edit, edited))));
  return about;
}

std::vector<ToldEdit> edits_of(const schema::Header& header) {
  std::vector<ToldEdit> edits;
  std::string_view rest = header.history;
  while (!rest.empty()) {
    const std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(rest.size(), line.size() + 1));
    const std::size_t step = line.find(": ");  // after time and program
    if (step == std::string_view::npos) continue;
    const std::string_view said = line.substr(step);
    if (said.starts_with(found_anew)) edits.clear();
    if (!said.starts_with(edited_by)) continue;
    const std::string_view by = said.substr(edited_by.size());
    const std::size_t end = std::min(by.find(": "), by.size());
    edits.push_back({.time = std::string(line.substr(0, line.find(' '))),
                     .author = std::string(by.substr(0, end)),
                     .what = std::string(by.substr(std::min(end + 2, by.size())))});
  }
  return edits;
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
