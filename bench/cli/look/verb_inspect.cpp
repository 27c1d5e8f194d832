#include <algorithm>
#include <charconv>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/core.h>

#include <kerf/fitting/jnd.h>
#include <kerf/schema/recording_file.h>
#include <kerf/schema/stand_in.h>

#include "files/disk_room.h"
#include "files/whole_file.h"
#include "inspect/flagged_cycles.h"
#include "inspect/inspection.h"
#include "inspect/inspection_text.h"
#include "program/verbs.h"
#include "recordings/axes.h"
#include "recordings/provenance.h"

namespace kerf::bench {
namespace {

struct InspectVerbArguments {
  std::string recording;
  std::string axis;
  std::optional<double> felt;
  std::vector<std::string> flags;
  std::vector<std::string> accepted;
  std::vector<std::string> cleared;
  bool store = false;

  [[nodiscard]] bool writes() const {
    return store || !flags.empty() || !accepted.empty() || !cleared.empty();
  }
};

/// A cycle of a recording and what is said of it.
struct Remark {
  FlaggedCycle& cycle;
  std::string reason;
};

/// "5=the tissue slipped". @throws std::invalid_argument for no such cycle, or no reason.
Remark remark_of(const std::string& option, const std::string& text, std::vector<FlaggedCycle>& cycles) {
  const auto equals = text.find('=');
  std::uint32_t number = 0;
  const char* const end = text.data() + std::min(equals, text.size());
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc{} || rest != end)
    throw std::invalid_argument(
        fmt::format("{}: '{}' names no cycle; expected one like 5=the tissue slipped", option, text));
  const auto found =
      std::ranges::find(cycles, number, [](const FlaggedCycle& one) { return one.facts.number; });
  if (found == cycles.end())
    throw std::invalid_argument(
        fmt::format("{}: there is no cycle {}; the recording has {}", option, number, cycles.size()));
  return {*found, equals == std::string::npos ? std::string() : text.substr(equals + 1)};
}

Remark reasoned(const std::string& option, const std::string& text, std::vector<FlaggedCycle>& cycles) {
  Remark remark = remark_of(option, text, cycles);
  if (remark.reason.empty())
    throw std::invalid_argument(
        fmt::format("{}: '{}' gives no reason; expected one like {}=WHY", option, text, text));
  return remark;
}

void take_remarks(const InspectVerbArguments& arguments, std::vector<FlaggedCycle>& cycles) {
  for (const std::string& text : arguments.cleared) {
    FlaggedCycle& cycle = remark_of("--clear", text, cycles).cycle;
    cycle.accepted.reset();
    std::erase_if(cycle.flags, [](const CycleFlag& flag) { return flag.fault == CycleFault::by_hand; });
  }
  for (const std::string& text : arguments.flags) {
    Remark remark = reasoned("--flag", text, cycles);
    remark.cycle.accepted.reset();
    remark.cycle.flags.push_back({.fault = CycleFault::by_hand, .reason = std::move(remark.reason)});
  }
  for (const std::string& text : arguments.accepted) {
    Remark remark = reasoned("--accept", text, cycles);
    remark.cycle.accepted = std::move(remark.reason);
  }
}

/// Keeps what there is to say of the cycles in the recording; its samples stay as they are.
void store(const InspectVerbArguments& arguments, Inspection& inspection, const schema::RecordedRows& rows) {
  if (!inspection.cycles.are_stored)
    throw std::invalid_argument(fmt::format(
        "{}: flags are kept beside the cycles, and it has none along this axis; run 'kerf segment' first",
        arguments.recording));
  take_remarks(arguments, inspection.cycles.cycles);
  std::error_code absent;
  const auto bytes = std::filesystem::file_size(arguments.recording, absent);
  if (!absent) require_disk(arguments.recording, bytes, "as many rows as there are");
  schema::Recording about = rows.about();
  about.cycle_flags = stored_flags(inspection.cycles.cycles, inspection.options.felt);
  add_history(about.header,
              fmt::format("inspect: {} flags of cycles stored", about.cycle_flags->flags.size()));
  schema::write_recording(arguments.recording, about, rows, schema::Existing::replace);
}

void run_inspect(const InspectVerbArguments& arguments, Context& context) {
  const schema::RecordingFile rows(arguments.recording);
  InspectOptions options;
  options.axis = find_cut_axis(rows.about(), arguments.axis);
  const schema::Axis& axis = rows.about().axes[options.axis];
  options.felt = arguments.felt.value_or(fitting::jnd_of(axis.force_unit, axis.lever).threshold);
  if (arguments.writes()) schema::require_no_stand_in(arguments.recording);
  if (arguments.writes()) require_change(arguments.recording);
  Inspection inspection = inspect(rows, options);
  if (arguments.writes()) store(arguments, inspection, rows);
  context.result = inspection_as_json(inspection);
  for (const std::string& line : inspection_lines(inspection)) context.say(line);
  for (const auto& warning : context.result["warnings"]) warn(warning.get<std::string>());
}

}  // namespace

void add_inspect(CLI::App& app, Context& context) {
  auto arguments = std::make_shared<InspectVerbArguments>();
  Verb verb =
      add_verb(app, context, "inspect", "Say what a recording is worth: sensor, sampling, contact, cycles",
               "kerf inspect cut.h5\n"
               "  kerf inspect cut.h5 --flag '5=the tissue slipped' --accept '8=a slow one was asked for'\n\n"
               "Of every signal quantum, noise, exact zeros, clipping, single rows that stand out, drift "
               "while\n"
               "nothing is touched; of the time its true rate, jitter and gaps; rows in contact and idle "
               "ones;\n"
               "the lag of the force; of every cycle times, peak and work, and what is wrong with it.\n"
               "The recording stays as it is, unless flags of its cycles are stored: fit, choose and chart\n"
               "leave out the cycles that carry one (--cycles). docs/inspecting.md says how each is found.",
               [arguments, &context] { run_inspect(*arguments, context); });
  verb.add_option("RECORDING", arguments->recording, "The recording").required();
  verb.takes_texts(context, arguments->recording);
  verb.add_option("--axis", arguments->axis,
                  "Axis along which contact is told (default: that of the cycles, else the first)");
  verb.add_option("--felt", arguments->felt,
                  "Force from which contact is told [unit of the axis' force] (default: the JND's threshold)")
      .positive();
  verb.add_option("--flag", arguments->flags, "CYCLE=WHY: flag a cycle, and store all flags; repeatable")
      .one_value_each();
  verb.add_option("--accept", arguments->accepted,
                  "CYCLE=WHY: take a cycle as good whatever is found, and store all flags; repeatable")
      .one_value_each();
  verb.add_option("--clear", arguments->cleared,
                  "CYCLE: take back what was said of it by hand, and store all flags; repeatable")
      .one_value_each();
  verb.add_flag("--store", arguments->store, "Store the flags that are found in the recording");
}

}  // namespace kerf::bench
