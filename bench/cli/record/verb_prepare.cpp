#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include <kerf/fitting/jnd.h>
#include <kerf/schema/recording_file.h>

#include "files/disk_room.h"
#include "files/whole_file.h"
#include "inspect/inspection.h"
#include "prepare/prepare_file.h"
#include "prepare/prepared_text.h"
#include "prepare/rows.h"
#include "program/verbs.h"
#include "report/filter_charts.h"

namespace kerf::bench {
namespace {

/// The word for the cycles that `kerf inspect` does not flag.
constexpr const char* good = "good";

struct PrepareVerbArguments {
  std::string recording;
  std::string output;
  std::string blank;
  std::string uncovered;
  std::optional<double> blank_speeds;
  std::string free;
  std::string cycles;
  std::string filter;
  std::string filter_chart;
  std::string frame = "sensor";
  std::string labels;
  std::vector<double> centre;
  bool causal = false;
  bool force = false;
  PrepareOptions options;
};

PrepareOptions options_of(const PrepareVerbArguments& arguments) {
  PrepareOptions options = arguments.options;
  WeightOptions& weight = options.weight_options;
  if (!arguments.free.empty()) options.contact.free = parse_spans(arguments.free);
  if (!arguments.cycles.empty() && arguments.cycles != good) options.cycles = parse_cycles(arguments.cycles);
  if (!arguments.filter.empty()) options.filter = parse_filter(arguments.filter, arguments.causal);
  if (!arguments.labels.empty()) options.labels = parse_labels(arguments.labels);
  if (!arguments.filter_chart.empty() || options.filter_position || arguments.causal) {
    if (!options.filter) {
      throw std::invalid_argument("--causal, --filter-position and --filter-chart need --filter");
    }
  }
  if (arguments.blank.empty() && (!arguments.uncovered.empty() || arguments.blank_speeds))
    throw std::invalid_argument("--uncovered and --blank-speeds need --blank");
  if (arguments.blank_speeds && *arguments.blank_speeds < 1.0)
    throw std::invalid_argument("--blank-speeds: it is a factor of 1 or more");
  if (options.drift && !options.bias) throw std::invalid_argument("--drift needs --bias");
  weight.base_frame = arguments.frame == "base";
  if (weight.mass_kg || !arguments.centre.empty()) {
    if (!options.weight) throw std::invalid_argument("--mass and --centre need --weight");
    if (!weight.mass_kg) throw std::invalid_argument("--centre needs --mass; without it both are estimated");
  }
  if (arguments.centre.size() == 3) std::copy_n(arguments.centre.begin(), 3, weight.centre_m.begin());
  return options;
}

/// The cycles of a recording as `kerf inspect` sees them. @throws std::invalid_argument if none is without a
/// flag.
std::vector<FlaggedCycle> cycles_flagged_in(const std::string& file) {
  const schema::RecordingFile rows(file);
  const auto& stored = rows.about().cycles;
  if (!stored)
    throw std::invalid_argument(fmt::format("{}: it has no cycles; run 'kerf segment' first", file));
  if (stored->axis >= rows.about().dimensions())
    throw std::invalid_argument(fmt::format("{}: its cycles are of an axis that it does not have", file));
  const schema::Axis& axis = rows.about().axes[stored->axis];
  Inspection inspection =
      inspect(rows, {.axis = stored->axis, .felt = fitting::jnd_of(axis.force_unit, axis.lever).threshold});
  if (good_cycles(inspection.cycles.cycles).empty()) {
    throw std::invalid_argument(
        fmt::format("{}: none of its cycles is without a flag; 'kerf inspect' says why", file));
  }
  return std::move(inspection.cycles.cycles);
}

void say_left_out(const std::vector<FlaggedCycle>& cycles, Context& context) {
  context.result["cycles_left_out"] = nlohmann::ordered_json::array();
  for (const FlaggedCycle& cycle : cycles) {
    if (cycle.is_good()) continue;
    context.result["cycles_left_out"].push_back(
        {{"number", cycle.facts.number}, {"reason", reasons_of(cycle)}});
    context.say(fmt::format("cycle {} left out: {}", cycle.facts.number, reasons_of(cycle)));
  }
}

void run_prepare(const PrepareVerbArguments& arguments, Context& context) {
  PrepareOptions options = options_of(arguments);
  std::error_code absent;
  if (std::filesystem::equivalent(arguments.recording, arguments.output, absent)) {
    throw std::invalid_argument(
        fmt::format("{}: -o names the recording itself; give another name", arguments.recording));
  }
  require_output(arguments.output, arguments.force);
  const auto bytes = std::filesystem::file_size(arguments.recording, absent);
  if (!absent) require_disk(arguments.output, bytes, "as many rows as there are");
  if (!arguments.filter_chart.empty()) require_output(arguments.filter_chart, arguments.force);
  std::vector<FlaggedCycle> cycles;
  if (arguments.cycles == good) {
    cycles = cycles_flagged_in(arguments.recording);
    options.cycles = parse_cycles(good_cycles(cycles));
  }
  if (!arguments.blank.empty()) {
    options.blank = read_blank(arguments.blank);
    options.blank->drop = arguments.uncovered == "drop";
    if (arguments.blank_speeds) options.blank->speed_factor = *arguments.blank_speeds;
  }
  const Prepared prepared = prepare_file(arguments.recording, options);
  if (!arguments.filter_chart.empty())
    write_whole_file(arguments.filter_chart, filter_response_svg(*prepared.filter),
                     schema::existing_if(arguments.force));
  schema::write_recording(arguments.output, prepared.recording, schema::existing_if(arguments.force));
  context.result = prepared_as_json(prepared);
  for (const std::string& warning : prepared.warnings) warn(warning);
  for (const std::string& line : prepared_lines(prepared)) context.say(line);
  if (arguments.cycles == good) say_left_out(cycles, context);
  context.say(
      fmt::format("{}: {} of {} rows", arguments.output, prepared.recording.rows(), prepared.rows_before));
}

void add_onset_options(Verb& verb, PrepareVerbArguments& arguments) {
  PrepareOptions& options = arguments.options;
  verb.add_flag("--onset", options.onset, "Find contacts; events, and the contact position of the axis");
  verb.add_option("--axis", options.axis,
                  "Axis along which contact is told (default: the only one, or none)");
  verb.add_option("--signal", options.signal,
                  "Axes or channels whose vector tells a contact (default: --axis, or every axis in N)")
      .separated_by(',');
  verb.add_option("--free", arguments.free,
                  "Times without contact, 0:1.5,30:32 (default: what --onset finds)");
  verb.add_option("--sigmas", options.contact.sigmas, "Threshold of contact, in sigmas of the free noise")
      .positive()
      .with_default();
  verb.add_option("--least", options.contact.least, "Smallest threshold of contact, in the signal's unit")
      .not_negative()
      .with_default();
  verb.add_option("--shortest", options.contact.shortest_s, "Shortest contact, and shortest release [s]")
      .positive()
      .with_default();
  verb.add_option("--level-time", options.contact.baseline_s, "Time constant of the free level [s]")
      .positive()
      .with_default();
  verb.add_option("--score-labels", arguments.labels, "CHANNEL=VALUE: score the contacts against labels");
}

void add_blank_options(Verb& verb, PrepareVerbArguments& arguments) {
  verb.add_option("--blank", arguments.blank,
                  "Recording of the same tool that cuts nothing: what it meets by itself, by position and "
                  "direction, and its inertia "
                  "where the blank tells it, is taken off the force");
  verb.add_option(
          "--uncovered", arguments.uncovered,
          "With --blank: rows where it has not been stay as they are (keep, the default) or go (drop)")
      .one_of({"keep", "drop"});
  verb.add_option("--blank-speeds", arguments.blank_speeds,
                  "With --blank: a stroke more times faster or slower than all of the blank's is not covered "
                  "by it (default: 2)");
}

void add_filter_options(Verb& verb, PrepareVerbArguments& arguments) {
  verb.add_option(
      "--filter", arguments.filter,
      "butterworth2:HZ, butterworth4:HZ, critically-damped:HZ, first-order:10rad/s, moving-mean:S, "
      "savitzky-golay:S");
  verb.add_flag("--causal", arguments.causal, "Run the filter forward only (default: zero phase)");
  verb.add_flag("--filter-position", arguments.options.filter_position,
                "Filter position and velocity as well");
  verb.add_option("--filter-chart", arguments.filter_chart, "Chart of gain and phase to write, an SVG");
}

}  // namespace

void add_prepare(CLI::App& app, Context& context) {
  auto arguments = std::make_shared<PrepareVerbArguments>();
  PrepareOptions& options = arguments->options;
  Verb verb = add_verb(
      app, context, "prepare", "Prepare a recording for a fit: bias, weight, blank, contacts, filter, rows",
      "kerf prepare cut.h5 -o clean.h5 --drop-gaps --bias --drift --onset --filter butterworth2:20\n\n"
      "Steps run in this order, whatever the order of the options: gaps, weight, blank, bias and drift, "
      "onset, "
      "filter,\n"
      "time span, cycles. Each is noted in the history of the new recording ('kerf info').",
      [arguments, &context] { run_prepare(*arguments, context); });
  verb.add_option("RECORDING", arguments->recording, "Recording; it stays as it is").required();
  verb.takes_texts(context, arguments->recording);
  verb.add_option("-o,--output", arguments->output, "Recording to write").required();
  verb.add_flag("--drop-gaps", options.drop_gaps, "Leave out rows that are not finite");
  verb.add_flag("--weight", options.weight, "Take the tool's weight off a sensor with six axes");
  verb.add_option("--mass", options.weight_options.mass_kg, "Its mass [kg] (default: estimated)");
  verb.add_option("--centre", arguments->centre, "Its centre of mass x,y,z [m], in the sensor's frame")
      .separated_by(',')
      .taking(3);
  verb.add_option("--frame", arguments->frame,
                  "Axes in which the forces stand (an import in space says it itself)")
      .one_of({"sensor", "base"})
      .with_default();
  add_blank_options(verb, *arguments);
  verb.add_flag("--bias", options.bias, "Take off the force's mean without contact");
  verb.add_flag("--drift", options.drift, "With --bias: a straight line in time");
  add_onset_options(verb, *arguments);
  add_filter_options(verb, *arguments);
  verb.add_option("--from", options.from_s, "Keep rows from this time on [s]");
  verb.add_option("--to", options.to_s, "Keep rows up to this time [s]");
  verb.add_option(
      "--cycles", arguments->cycles,
      "Keep these cycles, 2-8,10, or good: those that 'kerf inspect' does not flag; they are numbered anew");
  verb.add_flag("--force", arguments->force, "Replace an existing output");
}

}  // namespace kerf::bench
