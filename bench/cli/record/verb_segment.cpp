#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include <kerf/fitting/jnd.h>
#include <kerf/schema/recording_file.h>

#include "files/whole_file.h"
#include "files/whole_folder.h"
#include "inspect/flagged_cycles.h"
#include "program/verbs.h"
#include "recordings/axes.h"
#include "recordings/axis_values.h"
#include "report/charts.h"
#include "segment/cycle_edit.h"
#include "segment/segment.h"

namespace kerf::bench {
namespace {

struct SegmentVerbArguments {
  std::string recording;
  std::string axis;
  std::string closing;
  std::string charts;
  SegmentOptions options;
  std::vector<double> splits;
  std::vector<std::size_t> merges;
  std::string author;

  [[nodiscard]] bool edits() const { return !splits.empty() || !merges.empty(); }
};

nlohmann::ordered_json to_json(const schema::Recording& recording, const schema::RecordedRows& rows) {
  const BlockedValues time_s = axis_values(rows, schema::Column::time);
  const schema::Cycles& cycles = *recording.cycles;
  const schema::Axis& axis = recording.axes[cycles.axis];
  std::map<schema::Phase, std::size_t> counts;
  nlohmann::ordered_json phases = nlohmann::ordered_json::array();
  for (const schema::PhaseSpan& span : cycles.phases) {
    ++counts[span.phase];
    phases.push_back({{"cycle", span.cycle},
                      {"phase", name_of(span.phase)},
                      {"begin_s", time_s[span.begin]},
                      {"end_s", time_s[span.end - 1]}});
  }
  return {{"recording", recording.header.uuid},
          {"axis", axis.name},
          {"closings", counts[schema::Phase::closing]},
          {"openings", counts[schema::Phase::opening]},
          {"closing_direction", cycles.closing_direction},
          {"contact_position", {{"value", cycles.contact_position}, {"unit", axis.position_unit}}},
          {"filter_corner_hz", cycles.filter_corner_hz},
          {"phases", phases}};
}

/// Which stroke is the closing one is told by its work; where both cost the same it is a guess.
void warn_of_a_guess(const schema::Recording& recording) {
  const schema::Cycles& cycles = *recording.cycles;
  const schema::Axis& axis = recording.axes[cycles.axis];
  double difference = 0.0;
  double places = 0.0;
  for (std::size_t i = 0; i < cycles.grid.size(); ++i) {
    const double at = cycles.closing_mean[i] - cycles.opening_mean[i];
    if (!std::isfinite(at)) continue;
    difference += at;
    places += 1.0;
  }
  if (places == 0.0) return;
  const double apart = std::abs(difference) / places;
  if (apart > fitting::jnd_of(axis.force_unit, axis.lever).threshold) return;
  warn(fmt::format(
      "closing and opening differ by {:.2g} {}, which nobody feels: which of them is closing is a guess "
      "(--closing says it)",
      apart, axis.force_unit));
}

/// What a sensor gives that failed once would decide which stroke costs more work, and spoil the mean
/// branches.
void require_no_row_beyond_all(const schema::RecordedRows& rows, std::size_t axis, const std::string& name) {
  constexpr std::uint64_t enough = 20;  // of which one has no business to be more than all others
  const schema::Column column = force_column(rows);
  if (rows.width(column) == 0 || rows.rows() < enough) return;
  const BlockedValues force = axis_values(rows, column, axis);
  double squares = 0.0;
  std::uint64_t largest = 0;
  for (std::uint64_t row = 0; row < rows.rows(); ++row) {
    squares += force[row] * force[row];
    if (std::abs(force[row]) > std::abs(force[largest])) largest = row;
  }
  if (!(2.0 * force[largest] * force[largest] > squares)) return;
  throw std::invalid_argument(
      fmt::format("{}: the force of row {}, {:g}, has more squares than all others together: leave it out",
                  name, largest, force[largest]));
}

/// Looks at the cycles that were found, and keeps what is wrong with them beside them.
std::vector<FlaggedCycle> flag_and_store(schema::Recording& recording, const schema::RecordedRows& rows) {
  const schema::Axis& axis = recording.axes[recording.cycles->axis];
  const double felt = fitting::jnd_of(axis.force_unit, axis.lever).threshold;
  std::vector<FlaggedCycle> cycles = flagged_cycles(rows, *recording.cycles, felt);
  recording.cycle_flags = stored_flags(cycles, felt);
  return cycles;
}

/// Flags that a person set or took away, and boundaries that a person moved, are of cycles that are no more.
void warn_of_what_was_said(const schema::Recording& recording, const std::string& name) {
  if (const std::vector<ToldEdit> edits = edits_of(recording); recording.cycles && !edits.empty())
    warn(fmt::format(
        "{}: its cycles were edited by {} at {}, which is gone with them; the file keeps what it was", name,
        edits.back().author, edits.back().time));
  if (!recording.cycle_flags) return;
  const auto said = std::ranges::count_if(recording.cycle_flags->flags, [](const schema::CycleFlag& flag) {
    return flag.fault == "by_hand" || flag.fault == "accepted";
  });
  if (said > 0)
    warn(fmt::format("{}: what was said by hand of its cycles, {} remarks, is gone with them", name, said));
}

/// The row at a time, and the cycle that has it.
CycleStep split_at(const schema::RecordedRows& rows, const std::vector<schema::PhaseSpan>& phases,
                   double at_s) {
  const BlockedValues time_s = axis_values(rows, schema::Column::time);
  for (const schema::PhaseSpan& phase : phases) {
    if (phase.end > rows.rows() || time_s[phase.end - 1] < at_s) continue;
    std::uint64_t row = phase.begin;
    while (row + 1 < phase.end && time_s[row] < at_s) ++row;
    return {.kind = CycleStep::Kind::split, .cycle = phase.cycle, .row = row};
  }
  throw std::invalid_argument(fmt::format("--split: no cycle lies at {:g} s", at_s));
}

/// Merges first, the last one before the others, so that cycles are counted as they are stored.
CycleEdit asked_edit(const SegmentVerbArguments& arguments, const schema::RecordedRows& rows) {
  const schema::Recording& about = rows.about();
  if (!about.cycles)
    throw std::invalid_argument(
        fmt::format("{}: it has no cycles to split or merge; find them first", arguments.recording));
  CycleEdit edit{.found_by = {}, .phases = about.cycles->phases, .said = said_by_hand(about)};
  std::vector<std::size_t> merges = arguments.merges;
  std::ranges::sort(merges, std::greater<>());
  for (const std::size_t cycle : merges)
    edit = with_step(rows, std::move(edit),
                     {.kind = CycleStep::Kind::merge, .cycle = static_cast<std::uint32_t>(cycle), .row = 0});
  for (const double at_s : arguments.splits) {
    const CycleStep split = split_at(rows, edit.phases, at_s);
    edit = with_step(rows, std::move(edit), split);
  }
  return edit;
}

void run_edit(const SegmentVerbArguments& arguments, Context& context) {
  const std::string author = arguments.author.empty() ? usual_author() : arguments.author;
  check_author(author);
  require_change(arguments.recording);
  const schema::RecordingFile rows(arguments.recording);
  const CycleEdit edit = asked_edit(arguments, rows);
  const schema::Axis& axis = rows.about().axes.at(rows.about().cycles->axis);
  const double felt = fitting::jnd_of(axis.force_unit, axis.lever).threshold;
  const EditedCycles edited = edited_cycles(rows, edit, felt);
  const schema::Recording recording = with_edit(rows, edit, edited, felt, author);
  schema::write_recording(arguments.recording, recording, rows, schema::Existing::replace);
  context.result = to_json(recording, rows);
  for (const schema::CycleChange& change : changes_by(rows, edit, edited)) context.say(change.text);
}

void run_segment(const SegmentVerbArguments& arguments, Context& context) {
  if (arguments.edits()) return run_edit(arguments, context);
  const std::filesystem::path charts = arguments.charts;
  if (!arguments.charts.empty()) require_output(charts / "cycles.svg", true);
  const schema::RecordingFile rows(arguments.recording);
  schema::Recording recording = rows.about();
  SegmentOptions options = arguments.options;
  options.axis = find_axis(recording, arguments.axis);
  if (!arguments.closing.empty()) options.closing_direction = arguments.closing == "increasing" ? 1.0 : -1.0;
  require_no_row_beyond_all(rows, options.axis, arguments.recording);
  warn_of_what_was_said(recording, arguments.recording);
  segment_recording(recording, rows, options, arguments.recording);
  if (!options.closing_direction) warn_of_a_guess(recording);
  const std::vector<FlaggedCycle> cycles = flag_and_store(recording, rows);
  schema::write_recording(arguments.recording, recording, rows, schema::Existing::replace);
  if (!arguments.charts.empty()) {
    WholeFolder whole(charts, schema::Existing::replace);
    write_whole_file(whole.path() / "cycles.svg", draw(position_chart(recording, rows, options.axis)));
    write_whole_file(whole.path() / "loops.svg", draw(loop_chart(recording, rows, options.axis)));
    whole.commit();
  }
  context.result = to_json(recording, rows);
  context.say(fmt::format(
      "{}: {} closings and {} openings; closing {}", arguments.recording,
      context.result["closings"].get<int>(), context.result["openings"].get<int>(),
      recording.cycles->closing_direction > 0.0 ? "increases the position" : "decreases the position"));
  context.result["flagged"] = nlohmann::ordered_json::array();
  for (const FlaggedCycle& cycle : cycles) {
    if (cycle.is_good()) continue;
    context.result["flagged"].push_back({{"cycle", cycle.facts.number}, {"reason", reasons_of(cycle)}});
    context.say(fmt::format("cycle {} is flagged: {}", cycle.facts.number, reasons_of(cycle)));
  }
}

}  // namespace

void add_segment(CLI::App& app, Context& context) {
  auto arguments = std::make_shared<SegmentVerbArguments>();
  Verb verb = add_verb(
      app, context, "segment", "Find the cycles of opening and closing in a recording and store them in it",
      "kerf segment punch.h5 -o charts", [arguments, &context] { run_segment(*arguments, context); });
  verb.add_option("RECORDING", arguments->recording, "Recording; its cycles are added or replaced")
      .required();
  verb.refuses_texts(context, arguments->recording);
  verb.add_option("--axis", arguments->axis, "Axis that opens and closes (default: the first)");
  verb.add_option("--prominence", arguments->options.prominence,
                  "Share of the range that a stroke must cover")
      .within(0.01, 0.99)
      .with_default();
  verb.add_option("--corner", arguments->options.corner_hz, "Corner of the zero-phase low-pass [Hz]")
      .positive()
      .with_default();
  verb.add_option("--points", arguments->options.points, "Points of the grid of the averaged cycle")
      .within(2, 4096)
      .with_default();
  verb.add_option("--closing", arguments->closing,
                  "Direction of closing (default: the one that costs more work)")
      .one_of({"increasing", "decreasing"});
  verb.add_option("--split", arguments->splits,
                  "Split the cycle at this time there, instead of finding cycles [s]; repeatable")
      .one_value_each();
  verb.add_option("--merge", arguments->merges,
                  "CYCLE: make it and the next one one, instead of finding cycles; repeatable")
      .one_value_each();
  verb.add_option("--by", arguments->author, "Who splits and merges, kept in the recording (default: you)");
  verb.add_option("-o,--output", arguments->charts, "Folder for charts: cycles.svg and loops.svg");
}

}  // namespace kerf::bench
