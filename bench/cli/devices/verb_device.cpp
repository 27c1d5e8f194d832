#include <filesystem>
#include <memory>
#include <string>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include "files/whole_file.h"
#include "files/whole_folder.h"
#include "own_code/build_device.h"
#include "own_code/new_device.h"
#include "program/verbs.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

struct NewDeviceArguments {
  std::string name;
  std::string output;
  bool sensor = false;
  bool force = false;
};

struct BuildDeviceArguments {
  std::string source;
  std::string output;
  bool force = false;
};

void write_new_device(const NewDeviceArguments& arguments, Context& context) {
  const NewDevice device = new_device(arguments.name, arguments.sensor);
  const fs::path folder = arguments.output.empty() ? fs::path(arguments.name) : fs::path(arguments.output);
  const std::string source = arguments.name + ".c";
  require_output(folder / source, arguments.force);
  WholeFolder whole(folder, schema::existing_if(arguments.force));
  write_whole_file(whole.path() / source, device.source);
  write_whole_file(whole.path() / "CMakeLists.txt", device.cmake);
  whole.commit();
  context.result = {{"folder", folder.string()}, {"source", (folder / source).string()}};
  context.say(fmt::format("{} and a CMake file are in {}; change it, then 'kerf device build {} -o {}.so'",
                          source, folder.string(), (folder / source).string(), arguments.name));
}

void build_own_device(const BuildDeviceArguments& arguments, Context& context) {
  const BuiltDevice built =
      build_device(arguments.source, arguments.output, schema::existing_if(arguments.force));
  if (!built.said.empty()) warn(built.said);
  context.result = {{"plugin", arguments.output},
                    {"device", built.device.name},
                    {"about", built.device.about},
                    {"options", built.device.options},
                    {"compiler", built.compiler}};
  context.say(fmt::format(
      "{}: device '{}' ({}); options: {}", arguments.output, built.device.name, built.device.about,
      built.device.options.empty() ? "none" : fmt::format("{}", fmt::join(built.device.options, ", "))));
}

void add_device_new(CLI::App& device, Context& context) {
  auto arguments = std::make_shared<NewDeviceArguments>();
  Verb verb =
      add_verb(device, context, "new", "Write the source of a device to begin with, and a CMake file",
               "kerf device new mydevice", [arguments, &context] { write_new_device(*arguments, context); });
  verb.add_option("NAME", arguments->name, "Name of the device: a to z, 0 to 9 and _").required();
  verb.add_flag("--sensor", arguments->sensor, "A force sensor, which has no motor");
  verb.add_option("-o,--output", arguments->output, "Folder to write (default: NAME)");
  verb.add_flag("--force", arguments->force, "Replace a source that is there");
}

void add_device_build(CLI::App& device, Context& context) {
  auto arguments = std::make_shared<BuildDeviceArguments>();
  Verb verb = add_verb(
      device, context, "build", "Compile the source of a device to a plug-in",
      "kerf device build mydevice/mydevice.c -o mydevice.so\n\n"
      "C by the compiler that the environment names as CC, else cc; C++ by CXX, else c++. What it cannot\n"
      "compile, and what then is no device, is bad input. Nothing is opened.",
      [arguments, &context] { build_own_device(*arguments, context); });
  verb.add_option("SOURCE", arguments->source, "Source that exports kerf_plugin_device()").required();
  verb.add_option("-o,--output", arguments->output, "Plug-in to write, NAME.so").required();
  verb.add_flag("--force", arguments->force, "Replace a plug-in that is there");
}

}  // namespace

void add_device(CLI::App& app, Context& context) {
  CLI::App& device =
      add_verb_of_verbs(app, "device", "Begin a device of your own, and make a plug-in of it",
                        "Example:\n"
                        "  kerf device new mydevice\n"
                        "  kerf device build mydevice/mydevice.c -o mydevice.so\n"
                        "  kerf record --device 'plugin:./mydevice.so?port=/dev/ttyACM0' -o a.h5\n\n"
                        "docs/own-device.md walks through it.");
  add_device_new(device, context);
  add_device_build(device, context);
}

}  // namespace kerf::bench
