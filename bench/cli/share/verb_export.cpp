#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "export_law.h"
#include "files/whole_file.h"
#include "files/whole_folder.h"
#include "program/verbs.h"
#include "verify/verify.h"

namespace kerf::bench {
namespace {

struct ExportArguments {
  std::string law;
  std::string host;
  std::string name;
  std::string output;
  std::size_t samples = 100'000;
  bool verify = false;
  bool force = false;
};

/// What the comparison gave; the verdict is the exit status.
void tell(const Verified& verified, const ExportedLaw& law, Context& context) {
  context.result["verified"] = {{"samples", verified.samples},
                                {"largest_difference_ulp", verified.largest_ulp},
                                {"largest_difference", verified.largest},
                                {"largest_force", verified.most_force},
                                {"faults_of_one_alone", verified.faults},
                                {"holds", verified.holds()}};
  context.say(fmt::format("{} samples, forces up to {:.4g} {}: largest difference {:g} ulp, {:.3g} {}",
                          verified.samples, verified.most_force, law.file.force_unit, verified.largest_ulp,
                          verified.largest, law.file.force_unit));
  if (verified.faults > 0)
    context.say(
        fmt::format("at {} samples one of the two tells a fault and the other none", verified.faults));
  if (verified.holds()) return;
  context.say(fmt::format("not the same law: more than 1 ulp, largest at sample {}", verified.at + 1));
  context.exit = Exit::check_failed;
}

void run_export(const ExportArguments& arguments, Context& context) {
  const Host& host = host_named(arguments.host);
  const ExportedLaw law = read_for(host, arguments.law, arguments.name);
  const std::string output =
      arguments.output.empty() ? fmt::format("{}-{}", law.name, host.name) : arguments.output;
  require_output(output, arguments.force);
  WholeFolder folder(output, schema::existing_if(arguments.force));
  const auto names = write_for(host, law, folder.path());
  context.result["host"] = host.name;
  context.result["law"] = {{"file", arguments.law}, {"sha256", law.sha256}, {"model", law.file.law.model()}};
  context.result["folder"] = output;
  context.result["files"] = names;
  if (arguments.verify) {
    if (!host.in_its_place.empty()) {
      context.result["ran"] = host.in_its_place;
      context.say(fmt::format("what ran is not {} itself: {}", host.name, host.in_its_place));
    }
    tell(verify(host, law, folder.path(), arguments.samples), law, context);
  }
  folder.commit();
  for (const std::string& name : names) context.say(fmt::format("{}/{}", output, name));
}

}  // namespace

void add_export(CLI::App& app, Context& context) {
  auto arguments = std::make_shared<ExportArguments>();
  std::string known;
  for (const Host& host : hosts()) known += fmt::format("\n  {:8}{}", host.name, host.what);
  Verb verb =
      add_verb(app, context, "export", "Write a law for another program: C, FMU, CHAI3D, SOFA, Unity, ...",
               "kerf export fits/kelvin.law.toml --as c\n"
               "  kerf export fits/kelvin.law.toml --as fmu -o liver --verify\n\n"
               "The hosts:" +
                   known +
                   "\nEach file carries the law's SHA-256, its fit, where it was fitted, and the version. "
                   "What cannot be\ncarried is refused with the reason. How each is built and used: "
                   "docs/export.md.",
               [arguments, &context] { run_export(*arguments, context); });
  verb.add_option("LAW", arguments->law, "Law file").required();
  verb.add_option("--as", arguments->host, "Host that it is for").required();
  verb.add_option("-o,--output", arguments->output, "Folder to make; else NAME-HOST");
  verb.add_option("--name", arguments->name,
                  "Name of files and functions, a to z, 0 to 9 and _; else that of the law file");
  verb.add_flag(
      "--verify", arguments->verify,
      "Run the same ticks through the host and the law; exits with 1 if they differ by more than 1 ulp");
  verb.add_option("--samples", arguments->samples, "Ticks of --verify").with_default().within(1, 10'000'000);
  verb.add_flag("--force", arguments->force, "Replace an existing folder's files");
}

}  // namespace kerf::bench
