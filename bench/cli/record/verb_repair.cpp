#include <memory>
#include <string>

#include <fmt/core.h>

#include <kerf/schema/repair.h>

#include "program/verbs.h"

namespace kerf::bench {
namespace {

struct RepairVerbArguments {
  std::string recording;
  std::string output;
  bool force = false;
};

void run_repair(const RepairVerbArguments& arguments, Context& context) {
  const schema::Repaired repaired =
      schema::repair(arguments.recording, {.output = arguments.output, .replace = arguments.force});
  context.result = {
      {"recording", repaired.file.string()}, {"samples", repaired.rows}, {"duration_s", repaired.duration_s}};
  context.say(fmt::format("{}: closed with {} samples over {:.3f} s", repaired.file.string(), repaired.rows,
                          repaired.duration_s));
}

}  // namespace

void add_repair(CLI::App& app, Context& context) {
  auto arguments = std::make_shared<RepairVerbArguments>();
  Verb verb =
      add_verb(app, context, "repair", "Close a recording that a crash left open",
               "kerf repair cut.h5\n\n"
               "Takes NAME or NAME.partial. Every row that reached the file is written to NAME; only\n"
               "then is NAME.partial removed.",
               [arguments, &context] { run_repair(*arguments, context); });
  verb.add_option("recording", arguments->recording, "The recording, or its NAME.partial").required();
  verb.refuses_texts(context, arguments->recording);
  verb.add_option("-o,--output", arguments->output,
                  "Write it here instead, and keep the partial file (on a full disk, say)");
  verb.add_flag("--force", arguments->force, "Replace an existing output");
}

}  // namespace kerf::bench
