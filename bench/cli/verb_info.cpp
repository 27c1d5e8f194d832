#include <iostream>
#include <memory>
#include <stdexcept>

#include <kerf/schema/recording.h>
#include <kerf/schema/validate.h>

#include "cli/verbs.h"
#include "recordings/summary.h"

namespace kerf::bench {
namespace {

struct Arguments {
  std::string recording;
  bool schema = false;
};

void print_schema(Context& context) {
  const std::string markdown = schema::schema_as_markdown();
  if (context.json) {
    context.result = {
        {"schema", schema::schema_name}, {"schema_version", schema::schema_version}, {"markdown", markdown}};
  } else {
    std::cout << markdown << std::flush;
  }
}

void run_info(const Arguments& arguments, Context& context) {
  if (arguments.schema) return print_schema(context);
  if (arguments.recording.empty()) {
    throw std::invalid_argument("a recording is needed, for example 'kerf info cut.h5'; or --schema");
  }
  context.result = recording_summary(schema::read_recording(arguments.recording));
  say(summary_table(context.result));
  for (const auto& warning : context.result["warnings"]) warn(warning.get<std::string>());
}

}  // namespace

void add_info(CLI::App& app, Context& context) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App& verb =
      add_verb(app, context, "info", "Say what is in a recording, also in one that is still written",
               "kerf info cut.h5\n  kerf info cut.h5.partial --json\n  kerf info --schema",
               [arguments, &context] { run_info(*arguments, context); });
  verb.add_option("recording", arguments->recording, "The recording, or the NAME.partial of one not closed");
  verb.add_flag("--schema", arguments->schema, "Print the schema's tables instead, as Markdown");
}

}  // namespace kerf::bench
