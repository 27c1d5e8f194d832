#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/core.h>

#include <kerf/schema/recording_file.h>

#include "files/whole_file.h"
#include "program/verbs.h"
#include "recordings/axes.h"
#include "recordings/axis_values.h"
#include "report/page.h"

namespace kerf::bench {
namespace {

struct ReportVerbArguments {
  std::string recording;
  std::vector<std::string> results;
  std::string fits;
  std::string check;
  std::string axis;
  std::string output;
  bool force = false;
};

/// A picture of nothing is none.
void require_a_row(const ReportVerbArguments& arguments) {
  const schema::RecordingFile rows(arguments.recording);
  const std::size_t axis = find_cut_axis(rows.about(), arguments.axis);
  const BlockedValues position = axis_values(rows, schema::Column::position, axis);
  const schema::Column column = force_column(rows);
  const bool forceful = rows.width(column) > 0;
  const BlockedValues force = axis_values(rows, forceful ? column : schema::Column::position, axis);
  for (std::uint64_t row = 0; row < rows.rows(); ++row) {
    if (std::isfinite(position[row]) && std::isfinite(force[row])) return;
  }
  if (rows.rows() == 0) return;  // which is too few, and said so
  throw std::invalid_argument(
      fmt::format("{}: no row has a position and a force that are finite", arguments.recording));
}

void run_report(const ReportVerbArguments& arguments, Context& context) {
  require_output(arguments.output, arguments.force);
  ReportInput input{.recording = arguments.recording, .axis = arguments.axis};
  if (!arguments.fits.empty()) input.fits = arguments.fits;
  if (!arguments.check.empty()) input.check = arguments.check;
  input.results.assign(arguments.results.begin(), arguments.results.end());
  require_a_row(arguments);
  write_whole_file(arguments.output, report_page(input), schema::existing_if(arguments.force));
  context.result = {{"report", arguments.output}};
  context.say(arguments.output);
}

}  // namespace

void add_report(CLI::App& app, Context& context) {
  auto arguments = std::make_shared<ReportVerbArguments>();
  Verb verb = add_verb(
      app, context, "report", "Write one self-contained HTML page about a recording",
      "kerf report punch.h5 fits choice check.json inspect.json -o punch.html\n"
      "  kerf report punch.h5 --fits fits --check check.json -o punch.html\n\n"
      "RESULTS are what other verbs have found, files or folders, in any number: the JSON of fit,\n"
      "choose, chart, stability, identify, replay, check and inspect. Which it is, is told by what is in "
      "it;\n"
      "of a folder only what is of this recording is taken. docs/reports.md says what is on the page.",
      [arguments, &context] { run_report(*arguments, context); });
  verb.takes_laws(context);
  verb.add_option("RECORDING", arguments->recording, "Recording").required();
  verb.takes_texts(context, arguments->recording);
  verb.add_option("RESULTS", arguments->results, "JSON of other verbs, or folders that hold such");
  verb.add_option("--fits", arguments->fits, "Folder that 'kerf fit' wrote");
  verb.add_option("--check", arguments->check, "JSON that 'kerf check -o' wrote");
  verb.add_option("--axis", arguments->axis, "Axis to report (default: that of the cycles, or the first)");
  verb.add_option("-o,--output", arguments->output, "Page to write").required();
  verb.add_flag("--force", arguments->force, "Replace an existing page");
}

}  // namespace kerf::bench
