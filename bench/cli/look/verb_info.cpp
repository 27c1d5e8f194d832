#include <chrono>
#include <memory>
#include <stdexcept>
#include <thread>

#include <fmt/core.h>
#include <unistd.h>

#include <kerf/schema/live_recording.h>
#include <kerf/schema/recording_file.h>
#include <kerf/schema/regression.h>
#include <kerf/schema/session.h>
#include <kerf/schema/sweep_tables_file.h>
#include <kerf/schema/validate.h>

#include "files/for_terminal.h"
#include "merge/merged_facts.h"
#include "plan/file_of_sweep.h"
#include "program/standard_streams.h"
#include "program/verbs.h"
#include "recordings/summary.h"
#include "regress/stored_facts.h"
#include "run/run.h"
#include "sealed/session_facts.h"

namespace kerf::bench {
namespace {

constexpr auto refresh = std::chrono::milliseconds(200);

struct InfoVerbArguments {
  std::string recording;
  bool follow = false;
  bool schema = false;
};

void print_schema(Context& context) {
  const std::string markdown = schema::schema_as_markdown();
  if (context.json) {
    context.result = {{"schema", schema::schema_name},
                      {"schema_version", schema::schema_version},
                      {"markdown", markdown},
                      {"markdown_of_sessions", schema::session_schema_as_markdown()}};
  } else {
    print(for_terminal(markdown));
  }
}

std::string in_one_line(const schema::Tail& tail) {
  std::string line =
      fmt::format("{:10.3f} s {:9} samples", tail.rows > 0 ? tail.last.time_s : 0.0, tail.rows);
  for (std::size_t axis = 0; tail.rows > 0 && axis < tail.axes.size(); ++axis) {
    const schema::Axis& about = tail.axes[axis];
    const double force =
        tail.measures_force ? tail.last.force_measured[axis] : tail.last.force_commanded[axis];
    line += fmt::format("  {} {:9.5f} {} {:7.3f} {}", about.name, tail.last.position[axis],
                        about.position_unit, force, about.force_unit);
  }
  if (tail.last_event) {
    line += fmt::format("  {} events, last {} at {:.3f} s", tail.events, tail.last_event->kind,
                        tail.last_event->time_s);
  }
  return line;
}

/// Shows the end of a recording again and again, until it is closed, its writer is gone or a signal comes.
void follow(const std::string& name) {
  const StopOnSignal signals;
  const bool terminal = isatty(STDERR_FILENO) != 0;
  std::uint64_t shown = 0;
  while (!signals.requested()) {
    const schema::Place place = schema::find_recording(name);
    if (!place.partial) break;
    try {
      const schema::Tail tail = schema::read_tail(place.file);
      if (terminal) {
        draw_error_text(fmt::format("\r{}\033[K", for_terminal(in_one_line(tail))));
      } else if (tail.rows != shown) {
        note(in_one_line(tail));
      }
      shown = tail.rows;
    } catch (const std::exception&) {
      // Closed between one look and the next; the next one says.
      if (std::filesystem::exists(place.file) && !place.being_written) throw;
    }
    if (!place.being_written) {
      if (terminal) note("");
      warn(fmt::format("{}: nobody writes it any more; 'kerf repair' closes it", place.file.string()));
      return;
    }
    std::this_thread::sleep_for(refresh);
  }
  if (terminal) note("");
}

void run_info(const InfoVerbArguments& arguments, Context& context) {
  if (arguments.schema) return print_schema(context);
  if (arguments.recording.empty()) {
    throw std::invalid_argument("a recording is needed, for example 'kerf info cut.h5'; or --schema");
  }
  if (arguments.follow) follow(arguments.recording);
  const std::filesystem::path file = arguments.follow ? schema::find_recording(arguments.recording).file
                                                      : std::filesystem::path(arguments.recording);
  refuse_file_of_sweep(file);
  const std::string schema = schema::schema_of(file);
  if (schema == schema::session_schema_name) {
    context.result = session_facts(file);
    context.say(session_facts_table(context.result));
  } else if (schema == schema::regression_schema_name) {
    context.result = stored_facts(schema::read_regression(file));
    context.say(stored_facts_table(context.result));
  } else if (schema == schema::sweep_tables_name) {
    context.result = merged_facts(schema::SweepTablesFile(file).facts());
    context.say(merged_facts_table(context.result));
  } else {
    context.result = recording_summary(schema::RecordingFile(file));
    context.say(summary_table(context.result));
  }
  for (const auto& warning : context.result["warnings"]) warn(warning.get<std::string>());
}

}  // namespace

void add_info(CLI::App& app, Context& context) {
  auto arguments = std::make_shared<InfoVerbArguments>();
  Verb verb = add_verb(
      app, context, "info", "Say what is in a recording, also while it is made, a session or stored forces",
      "kerf info cut.h5\n  kerf info --follow cut.h5\n  kerf info cut.h5.partial --json\n  kerf "
      "info --schema",
      [arguments, &context] { run_info(*arguments, context); });
  verb.add_option("recording", arguments->recording,
                  "The recording, or the NAME.partial of one not closed; a session, stored forces, sweep.h5");
  verb.takes_texts(context, arguments->recording);
  verb.add_flag("--follow", arguments->follow,
                "Show a recording while it is made, from another terminal, until it is closed");
  verb.add_flag("--schema", arguments->schema, "Print the schema's tables instead, as Markdown");
}

}  // namespace kerf::bench
