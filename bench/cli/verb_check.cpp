#include <memory>
#include <string>

#include <fmt/core.h>

#include "cli/verbs.h"
#include "files/whole_file.h"
#include "loop/check.h"

namespace kerf::bench {
namespace {

struct Arguments {
  RunOptions options;
  std::string law;
  std::string record;
  std::string output;
  std::string direction;
  double contact = 0.0;
  bool has_contact = false;
};

void print_table(const nlohmann::ordered_json& json) {
  say(fmt::format("  {:8} {:>9} {:>9} {:>9} {:>9} {:>9}  {:>7}", "us", "mean", "p50", "p99", "p99.9", "max",
                  "missed"));
  for (const auto* stage : {"wake", "read", "compute", "write", "record", "cycle"}) {
    const auto& row = json[std::string(stage) + "_us"];
    const std::string missed = json["missed_by"].contains(stage)
                                   ? fmt::format("{}", json["missed_by"][stage].get<std::uint64_t>())
                                   : "";
    say(fmt::format("  {:8} {:9.2f} {:9.2f} {:9.2f} {:9.2f} {:9.2f}  {:>7}", stage, row["mean"].get<double>(),
                    row["p50"].get<double>(), row["p99"].get<double>(), row["p999"].get<double>(),
                    row["max"].get<double>(), missed));
  }
}

void run_check(const Arguments& arguments, Context& context) {
  if (!arguments.output.empty()) refuse_to_replace(arguments.output, arguments.options.replace);
  RunOptions options = arguments.options;
  options.law = read_law_file(arguments.law);
  if (!arguments.record.empty()) options.record = arguments.record;
  if (arguments.has_contact) options.law->contact.position = arguments.contact;
  if (!arguments.direction.empty())
    options.law->contact.direction = arguments.direction == "increasing" ? 1.0 : -1.0;
  const StopOnSignal signals;
  const RunResult result = run_on_device(options, signals.requested());
  const Verdict verdict = judge(result);
  context.result = check_as_json(result, verdict);
  context.result["law"] = std::string(options.law->law.model());
  if (!arguments.output.empty()) write_whole_file(arguments.output, context.result.dump(2) + "\n");
  if (!verdict.passed) context.exit = Exit::check_failed;

  for (const RealtimeMeasure& measure : result.realtime) {
    say(fmt::format("  {} {}: {}", measure.obtained ? "+" : "-", measure.name, measure.detail));
  }
  print_table(context.result);
  for (const std::string& reason : verdict.reasons) say("  " + reason);
  say(fmt::format("{}: {} at {:.0f} Hz on {}, {} ticks", verdict.passed ? "pass" : "FAIL",
                  options.law->law.model(), options.rate_hz, result.device.uri, result.report.ticks()));
}

}  // namespace

void add_check(CLI::App& app, Context& context) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App& verb =
      add_verb(app, context, "check", "Run a law in closed loop with a device and judge its timing",
               "kerf check fits/kelvin.law.toml --device sim:scissors --seconds 10\n\n"
               "Exit status 1 if the law is too slow, more than 1 % of the deadlines were missed, or\n"
               "law or device failed. The energy is what the rendering took out of the hand.",
               [arguments, &context] { run_check(*arguments, context); });
  verb.add_option("LAW", arguments->law, "Law file")->required();
  verb.add_option("--device", arguments->options.device_uri, "Device URI; 'kerf devices' lists them")
      ->capture_default_str();
  verb.add_option("--seconds", arguments->options.seconds, "Duration [s]")
      ->check(CLI::Range(0.01, 1e6))
      ->capture_default_str();
  verb.add_option("--rate", arguments->options.rate_hz, "Rate of the loop [Hz]")->capture_default_str();
  verb.add_flag("--virtual", arguments->options.virtual_time, "In virtual time: every duration is zero");
  verb.add_option_function<double>(
      "--contact",
      [arguments](const double& value) {
        arguments->contact = value;
        arguments->has_contact = true;
      },
      "Position of first contact instead of the law file's, in its unit");
  verb.add_option("--direction", arguments->direction, "Direction of engagement instead of the law file's")
      ->check(CLI::IsMember({"increasing", "decreasing"}));
  verb.add_option("--record", arguments->record, "Record the closed loop to this file");
  verb.add_option("-o,--output", arguments->output, "Write the JSON to this file");
  verb.add_flag("--force", arguments->options.replace, "Replace existing files");
}

}  // namespace kerf::bench
