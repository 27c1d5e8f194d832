#include <filesystem>
#include <memory>
#include <string>

#include <fmt/core.h>

#include "files/whole_file.h"
#include "files/whole_folder.h"
#include "own_code/build_law.h"
#include "own_code/new_law.h"
#include "program/verbs.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

struct NewLawArguments {
  std::string name;
  std::string output;
  bool force = false;
};

struct BuildLawArguments {
  std::string header;
  std::string output;
  bool force = false;
};

void write_new_law(const NewLawArguments& arguments, Context& context) {
  const NewLaw law = new_law(arguments.name);
  const fs::path folder = arguments.output.empty() ? fs::path(arguments.name) : fs::path(arguments.output);
  const std::string header = arguments.name + ".h";
  require_output(folder / header, arguments.force);
  WholeFolder whole(folder, schema::existing_if(arguments.force));
  write_whole_file(whole.path() / header, law.header);
  write_whole_file(whole.path() / (arguments.name + "_test.cpp"), law.test);
  write_whole_file(whole.path() / "CMakeLists.txt", law.cmake);
  whole.commit();
  context.result = {{"folder", folder.string()}, {"header", (folder / header).string()}};
  context.say(
      fmt::format("{}, its test and a CMake file are in {}; change it, then 'kerf law build {} -o {}.so'",
                  header, folder.string(), (folder / header).string(), arguments.name));
}

void build_own_law(const BuildLawArguments& arguments, Context& context) {
  const BuiltLaw built = build_law(arguments.header, arguments.output, schema::existing_if(arguments.force));
  if (!built.said.empty()) warn(built.said);
  const models::ForeignLaw& law = *built.law;
  context.result = {{"plugin", arguments.output},
                    {"law", std::string(law.info().name)},
                    {"sha256", law.plugin().sha256},
                    {"parameters", law.parameters().size()},
                    {"derivatives", law.has_derivatives()},
                    {"step_s", built.step_s},
                    {"compiler", built.compiler}};
  context.say(fmt::format("{}: law '{}' with {} parameters{}; a step takes {:.2g} us", arguments.output,
                          law.info().name, law.parameters().size(),
                          law.has_derivatives() ? " and its derivatives by them" : "", 1e6 * built.step_s));
}

void add_law_new(CLI::App& law, Context& context) {
  auto arguments = std::make_shared<NewLawArguments>();
  Verb verb =
      add_verb(law, context, "new", "Write the header of a law to begin with, its test and a CMake file",
               "kerf law new mylaw", [arguments, &context] { write_new_law(*arguments, context); });
  verb.add_option("NAME", arguments->name, "Name of the law: a to z, 0 to 9 and _").required();
  verb.add_option("-o,--output", arguments->output, "Folder to write (default: NAME)");
  verb.add_flag("--force", arguments->force, "Replace a header that is there");
}

void add_law_build(CLI::App& law, Context& context) {
  auto arguments = std::make_shared<BuildLawArguments>();
  Verb verb = add_verb(
      law, context, "build", "Compile the header of a law to a plug-in, and try it",
      "kerf law build mylaw/mylaw.h -o mylaw.so\n\n"
      "By the compiler that the environment names as CXX, else c++. What it cannot compile, and what does\n"
      "not stand its trial, is bad input.",
      [arguments, &context] { build_own_law(*arguments, context); });
  verb.add_option("HEADER", arguments->header, "Header of the law, which ends with KERF_LAW(...)").required();
  verb.add_option("-o,--output", arguments->output, "Plug-in to write, NAME.so").required();
  verb.add_flag("--force", arguments->force, "Replace a plug-in that is there");
}

}  // namespace

void add_law(CLI::App& app, Context& context) {
  CLI::App& law = add_verb_of_verbs(app, "law", "Begin a law of your own, and make a plug-in of it",
                                    "Example:\n"
                                    "  kerf law new mylaw\n"
                                    "  kerf law build mylaw/mylaw.h -o mylaw.so\n"
                                    "  kerf fit punch.h5 --plugin ./mylaw.so -o fits\n\n"
                                    "docs/own-law.md walks through it.");
  add_law_new(law, context);
  add_law_build(law, context);
}

}  // namespace kerf::bench
