#include <memory>
#include <optional>
#include <string>

#include <kerf/fitting/jnd.h>
#include <kerf/schema/recording_file.h>

#include "inspect/inspection.h"
#include "inspect/inspection_text.h"
#include "program/verbs.h"
#include "recordings/axes.h"

namespace kerf::bench {
namespace {

struct InspectVerbArguments {
  std::string recording;
  std::string axis;
  std::optional<double> felt;
};

void run_inspect(const InspectVerbArguments& arguments, Context& context) {
  const schema::RecordingFile rows(arguments.recording);
  InspectOptions options;
  options.axis = find_cut_axis(rows.about(), arguments.axis);
  const schema::Axis& axis = rows.about().axes[options.axis];
  options.felt = arguments.felt.value_or(fitting::jnd_of(axis.force_unit, axis.lever).threshold);
  const Inspection inspection = inspect(rows, options);
  context.result = inspection_as_json(inspection);
  for (const std::string& line : inspection_lines(inspection)) context.say(line);
  for (const auto& warning : context.result["warnings"]) warn(warning.get<std::string>());
}

}  // namespace

void add_inspect(CLI::App& app, Context& context) {
  auto arguments = std::make_shared<InspectVerbArguments>();
  Verb verb =
      add_verb(app, context, "inspect", "Say what a recording is worth: sensor, sampling, contact, cycles",
               "kerf inspect cut.h5\n\n"
               "Of every signal quantum, noise, exact zeros, clipping, single rows that stand out, drift "
               "while\n"
               "nothing is touched; of the time its true rate, jitter and gaps; rows in contact and idle "
               "ones;\n"
               "the lag of the force; of every cycle times, peak and work, and what is wrong with it.\n"
               "The recording stays as it is. docs/inspecting.md says how each is found.",
               [arguments, &context] { run_inspect(*arguments, context); });
  verb.add_option("RECORDING", arguments->recording, "The recording").required();
  verb.add_option("--axis", arguments->axis,
                  "Axis along which contact is told (default: that of the cycles, else the first)");
  verb.add_option("--felt", arguments->felt,
                  "Force from which contact is told [unit of the axis' force] (default: the JND's threshold)")
      .positive();
}

}  // namespace kerf::bench
