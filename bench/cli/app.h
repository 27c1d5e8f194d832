#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

namespace kerf::bench {

/// Exit status of the program, as documented in the README.
enum class Exit : int { done = 0, check_failed = 1, bad_input = 2, device_error = 3, file_error = 4 };

/// What every verb is given beside its own options.
struct Context {
  bool json = false;              ///< print one JSON object on standard output and nothing else there
  std::uint64_t seed = 1;         ///< of every random choice
  Exit exit = Exit::done;         ///< a verb sets check_failed when a check did not pass
  nlohmann::ordered_json result;  ///< printed at the end with --json
};

/// Adds a verb with --json and --seed, its description and an example under --help; `action` runs after
/// parsing. Exceptions leave through run_program(): std::invalid_argument and schema::FormatError exit 2,
/// drivers::DeviceError 3, std::system_error and anything else 4, each with one line on standard error.
CLI::App& add_verb(CLI::App& app, Context& context, const std::string& name, const std::string& description,
                   const std::string& example, std::function<void()> action);

/// Text for people: to standard error, never mixed into the JSON.
void say(std::string_view line);
/// A warning, likewise.
void warn(std::string_view line);

/// Runs `kerf VERB ...` and returns the exit status.
int run_program(int argc, char** argv);

}  // namespace kerf::bench
