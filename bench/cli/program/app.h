#pragma once

#include <cstdint>
#include <string_view>

#include <nlohmann/json.hpp>

namespace kerf::bench {

/// Exit status of the program, as documented in the README.
enum class Exit : int { done = 0, check_failed = 1, bad_input = 2, device_error = 3, file_error = 4 };

/// What every verb is given beside its own options.
struct Context {
  bool json = false;              ///< print one JSON object on standard output and nothing else there
  std::uint64_t seed = 1;         ///< of every random choice
  bool seed_given = false;        ///< by --seed
  Exit exit = Exit::done;         ///< a verb sets check_failed when a check did not pass
  nlohmann::ordered_json result;  ///< printed at the end with --json
};

/// Text for people: to standard error, never mixed into the JSON.
void say(std::string_view line);
/// A warning, likewise.
void warn(std::string_view line);

/// Runs `kerf VERB ...` and returns the exit status.
int run_program(int argc, char** argv);

}  // namespace kerf::bench
