#include "program/app.h"

#include <iostream>
#include <stdexcept>
#include <system_error>

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include <kerf/drivers/device.h>
#include <kerf/schema/recording.h>

#include "program/verbs.h"

namespace kerf::bench {
namespace {

int fail(Exit status, std::string_view message) {
  fmt::print(stderr, "kerf: {}\n", message);
  return static_cast<int>(status);
}

}  // namespace

void say(std::string_view line) { fmt::print(stderr, "{}\n", line); }

void warn(std::string_view line) { fmt::print(stderr, "warning: {}\n", line); }

int run_program(int argc, char** argv) {
  CLI::App app{"Kerf: a hardware-in-the-loop test bench for haptic rendering of cutting", "kerf"};
  app.set_version_flag("--version", std::string("kerf " KERF_VERSION));
  app.require_subcommand(1);
  Context context;
  for (const auto add :
       {add_blade,  add_chart,   add_check,     add_choose,  add_demo,    add_devices,   add_fit,
        add_import, add_info,    add_laws,      add_prepare, add_record,  add_regress,   add_repair,
        add_replay, add_report,  add_reproduce, add_segment, add_session, add_stability,
#ifdef KERF_STUDIO
        add_studio,
#endif
        add_train,  add_validate}) {
    add(app, context);
  }
  try {
    app.parse(argc, argv);
    if (context.json) std::cout << context.result.dump(2) << '\n' << std::flush;
    if (!std::cout) return fail(Exit::file_error, "standard output: could not write the JSON");
    return static_cast<int>(context.exit);
  } catch (const CLI::Success& help) {
    return app.exit(help);
  } catch (const CLI::ParseError& error) {
    return fail(Exit::bad_input,
                fmt::format("{}; 'kerf --help' and 'kerf VERB --help' say more", error.what()));
  } catch (const drivers::DeviceError& error) {
    return fail(Exit::device_error, error.what());
  } catch (const std::system_error& error) {
    return fail(Exit::file_error, error.what());
  } catch (const std::invalid_argument& error) {
    return fail(Exit::bad_input, error.what());
  } catch (const schema::FormatError& error) {
    return fail(Exit::bad_input, error.what());
  } catch (const std::exception& error) {
    return fail(Exit::file_error, error.what());  // no memory, a program that is missing
  }
}

}  // namespace kerf::bench
