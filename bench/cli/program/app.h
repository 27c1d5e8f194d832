#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

namespace kerf::bench {

/// Exit status of the program; docs/command-line.md has the table.
enum class Exit : int {
  done = 0,
  check_failed = 1,
  bad_input = 2,
  device_error = 3,
  file_error = 4,
  to_be_continued = 75  ///< EX_TEMPFAIL, which queues of clusters know
};

/// What every verb is given beside its own options.
// NOLINTNEXTLINE(bugprone-exception-escape): of what moves JSON, which does not throw
struct Context {
  bool runs = true;                  ///< false: command lines are read, and no verb does anything
  bool json = false;                 ///< print one JSON object on standard output and nothing else there
  std::uint64_t seed = 1;            ///< of every random choice
  bool seed_given = false;           ///< by --seed
  std::vector<std::string> plugins;  ///< laws of shared objects, by --plugin
  std::vector<std::string> maps;     ///< how texts are imported on the way, by --map
  /// Of each text that was: see tell_imported_on_the_way().
  nlohmann::ordered_json imported = nlohmann::ordered_json::array();
  Exit exit = Exit::done;         ///< a verb sets check_failed when a check did not pass
  nlohmann::ordered_json result;  ///< printed at the end with --json
  /// What could not be written though the result stands: said after it, and the exit status is file_error.
  std::string not_written;

  /// A line of the result for people, to standard output; nothing with --json.
  void say(std::string_view line);
};

/// To standard output. Nobody waits for it, and nothing here fails: run_program() says at the end if it could
/// not be written.
void print(std::string_view text);

/// A line on standard error about what goes on.
void note(std::string_view line);
/// A warning, likewise.
void warn(std::string_view line);

/// Warns of what is to be told of laws of shared objects, once.
void say_plugin_notes();

/// Reads the words of a command line as run_program() does, and runs no verb. What it would print before any:
/// of --help and --version. @throws std::invalid_argument in one line for what is no command line.
[[nodiscard]] std::string read_command_line(const std::vector<std::string>& words);

/// Runs `kerf VERB ...` and returns the exit status. If whoever read standard output is gone, the process
/// ends as any other at a closed pipe does: by SIGPIPE, but not before the verb is done.
int run_program(int argc, char** argv);

}  // namespace kerf::bench
