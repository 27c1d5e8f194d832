#include "program/app.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <new>
#include <sstream>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <kerf/drivers/device.h>
#include <kerf/drivers/device_notes.h>
#include <kerf/schema/recording.h>
#include <kerf/version.h>

#include "devices/verb_calibrate.h"
#include "files/for_terminal.h"
#include "files/json_file.h"
#include "files/whole_file.h"
#include "laws/plugin_laws.h"
#include "program/nearest_word.h"
#include "program/standard_streams.h"
#include "program/verbs.h"

namespace kerf::bench {
namespace {

/// The verbs of one thing that a person wants to do; bench/cli has a folder for each.
struct Group {
  const char* name;
  std::vector<void (*)(CLI::App&, Context&)> add;
};

std::vector<Group> groups() {
  return {{"start", {add_demo}},
          {"devices", {add_devices, add_device, add_doctor, add_identify, add_calibrate}},
          {"record", {add_record, add_import, add_repair, add_prepare, add_segment}},
          {"look",
           {add_info, add_inspect, add_validate,
#ifdef KERF_STUDIO
            add_studio
#endif
           }},
          {"fit", {add_laws, add_law, add_fit, add_blade, add_train}},
          {"judge", {add_choose, add_check, add_chart, add_stability, add_reproduce}},
          {"replay", {add_replay, add_regress, add_compare}},
          {"experiment", {add_session}},
          {"study", {add_study, add_sweep}},
          {"share", {add_report, add_convert, add_export}},
          {"", {add_pages}}};  // hidden: for the build
}

/// The verbs of an app that people are told of.
std::vector<const CLI::App*> shown_verbs(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App* verb) { return !verb->get_group().empty(); });
}

/// `kerf --help`: every verb in a line, by group.
std::string overview(const CLI::App& app) {
  std::string text = fmt::format("{}\nUsage: kerf VERB [OPTIONS]\n", app.get_description());
  std::string group;
  for (const CLI::App* const verb : shown_verbs(app)) {
    text += fmt::format("{:12}{:11}{}\n", verb->get_group() == group ? "" : verb->get_group(),
                        verb->get_name(), verb->get_description());
    group = verb->get_group();
  }
  return text +
         "'kerf help VERB' says more of a verb; all have --json. 'kerf --version' names version and "
         "commit.\n";
}

void add_verbs(CLI::App& app, Context& context) {
  for (const Group& group : groups()) {
    for (const auto add : group.add) {
      add(app, context);
      app.get_subcommands([](CLI::App*) { return true; }).back()->group(group.name);
    }
  }
  // Now, since verbs take over the formatter that is there when they are added.
  app.formatter_fn(
      [](const CLI::App* all, const std::string&, CLI::AppFormatMode) { return overview(*all); });
}

std::vector<std::string> verbs_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* const verb : shown_verbs(app)) names.push_back(verb->get_name());
  return names;
}

std::string did_you_mean(const std::string& typed, const std::vector<std::string>& words) {
  const auto nearest = nearest_word(typed, words);
  return nearest ? fmt::format("; did you mean '{}'?", *nearest) : ";";
}

/// A verb that was typed.
struct Typed {
  const CLI::App* verb;
  std::string name;  ///< with the verbs that it belongs to, and a blank before each: " session new"
};

/// Follows the words down to a verb that has none of its own, or to the first option.
/// @throws std::invalid_argument for a word that is no verb, and where one is missing.
Typed typed_verb(const CLI::App& app, const std::vector<std::string>& words) {
  Typed typed{.verb = &app, .name = ""};
  for (const std::string& word : words) {
    if (word.starts_with('-') || typed.verb->get_subcommands({}).empty()) return typed;
    const auto same = [&](const CLI::App* verb) { return verb->get_name() == word; };
    const auto found = typed.verb->get_subcommands(same);
    if (found.empty())
      throw std::invalid_argument(fmt::format("there is no verb '{}'{} 'kerf help{}' lists them", word,
                                              did_you_mean(word, verbs_of(*typed.verb)), typed.name));
    typed = {.verb = found.front(), .name = typed.name + " " + word};
  }
  if (!typed.verb->get_subcommands({}).empty())
    throw std::invalid_argument(fmt::format("'kerf{0}' needs a verb; 'kerf help{0}' lists them", typed.name));
  return typed;
}

std::vector<std::string> options_of(const CLI::App& verb) {
  std::vector<std::string> options;
  for (const CLI::Option* const option : verb.get_options()) {
    for (const std::string& name : option->get_lnames()) options.push_back("--" + name);
  }
  return options;
}

/// Whoever gives --map to another verb may well want the other options of `kerf import` there.
bool is_of_import_alone(const CLI::App& verb, const std::string& option,
                        const std::vector<std::string>& options) {
  const CLI::App* const all = verb.get_parent();
  const bool takes_map = std::ranges::find(options, "--map") != options.end();
  if (!takes_map || all == nullptr || all->get_parent() != nullptr) return false;
  const std::vector<std::string> of_import = options_of(*all->get_subcommand("import"));
  return std::ranges::find(of_import, option) != of_import.end();
}

/// What is wrong with the options: one that does not exist is said before one that is missing.
std::string wrong_options(const Typed& typed, const CLI::ParseError& error) {
  const std::string more = fmt::format("'kerf help{}' says more", typed.name);
  const std::vector<std::string> options = options_of(*typed.verb);
  for (const std::string& word : typed.verb->remaining()) {
    const std::string option = word.substr(0, word.find('='));
    if (is_of_import_alone(*typed.verb, option, options))
      return fmt::format(
          "{0} is an option of 'kerf import', and{1} has --map alone; run 'kerf import ... {0} "
          "... -o R.h5' first, then 'kerf{1} R.h5' (sheet, stretch and rate may also stand in "
          "a file that --map names)",
          option, typed.name);
    if (option.starts_with('-'))
      return fmt::format("there is no option {}{} {}", option, did_you_mean(option, options), more);
  }
  return fmt::format("{}; {}", error.what(), more);
}

int fail(Exit status, std::string_view message) {
  write_error_text(fmt::format("kerf: {}\n", for_terminal(message)));
  return static_cast<int>(status);
}

/// What is said where memory ran out, made ready while there is some: the command names verb and files.
std::string without_memory(const std::vector<std::string>& words) {
  return for_terminal(fmt::format("kerf: there was not enough memory for '{}'\n", fmt::join(words, " ")));
}

/// After a verb has run to its end.
int finish(const Context& context) {
  const int output_error = finish_standard_streams();
  if (output_error == EPIPE) end_by_closed_pipe();
  if (output_error != 0)
    return fail(Exit::file_error,
                fmt::format("standard output: cannot write: {}", std::strerror(output_error)));
  if (!context.not_written.empty()) return fail(Exit::file_error, context.not_written);
  return static_cast<int>(context.exit);
}

/// The program as command lines know it.
class Program {
 public:
  explicit Program(bool runs) : context_{.runs = runs} {
    app_.set_version_flag("--version", software());
    app_.require_subcommand(1);
    add_verbs(app_, context_);
  }

  /// Runs the verb, if any is to be run, or says what --help and --version give.
  /// @throws std::invalid_argument for words that are no command line; as the verb does.
  [[nodiscard]] std::string take(std::vector<std::string> words) {
    if (!words.empty() && words.front() == "help") {
      words.erase(words.begin());
      words.emplace_back("--help");
    }
    const Typed typed = typed_verb(app_, words);
    try {
      std::reverse(words.begin(), words.end());  // as CLI11 takes them
      app_.parse(words);
      return "";
    } catch (const CLI::Success& help) {
      std::ostringstream text;
      app_.exit(help, text, text);
      return text.str();
    } catch (const CLI::ParseError& error) {
      throw std::invalid_argument(wrong_options(typed, error));
    }
  }

  [[nodiscard]] const Context& context() const noexcept { return context_; }

 private:
  Context context_;
  CLI::App app_{"Kerf: a hardware-in-the-loop test bench for haptic rendering of cutting", "kerf"};
};

int run_words(const std::vector<std::string>& words) {
  Program program(true);
  const std::string help = program.take(words);
  const Context& context = program.context();
  if (!help.empty()) {
    print(help);
  } else if (context.json) {
    print(json_text(context.result));
  }
  return finish(context);
}

int run_caught(const std::vector<std::string>& words) {
  const std::string no_memory = without_memory(words);
  try {
    return run_words(words);
  } catch (const drivers::DeviceError& error) {
    return fail(Exit::device_error, error.what());
  } catch (const std::system_error& error) {
    return fail(Exit::file_error, error.what());
  } catch (const std::invalid_argument& error) {
    return fail(Exit::bad_input, error.what());
  } catch (const schema::FormatError& error) {
    return fail(Exit::bad_input, error.what());
  } catch (const std::bad_alloc&) {
    write_error_text(no_memory);
    return static_cast<int>(Exit::file_error);
  } catch (const std::exception& error) {
    return fail(Exit::file_error, error.what());  // a program that is missing
  }
}

}  // namespace

void Context::say(std::string_view line) {
  if (!json) print(fmt::format("{}\n", for_terminal(line)));
}

void print(std::string_view text) { write_output_text(text); }

void note(std::string_view line) { write_error_text(fmt::format("{}\n", for_terminal(line))); }

void warn(std::string_view line) { write_error_text(fmt::format("warning: {}\n", for_terminal(line))); }

void say_plugin_notes() {
  for (const std::string& line : take_plugin_notes()) warn(line);
}

std::string read_command_line(const std::vector<std::string>& words) { return Program(false).take(words); }

int run_program(int argc, char** argv) {
  keep_standard_streams();
  drivers::tell_waits_to(note);
  const int status = run_caught({argv + 1, argv + argc});
  say_plugin_notes();
  for (const std::string& line : drivers::take_device_notes()) warn(line);
  for (const auto& left : take_removed_leftovers())
    note(fmt::format("{}: removed; a run that was killed had left it unfinished", left.string()));
  finish_standard_streams();
  return status;
}

}  // namespace kerf::bench
