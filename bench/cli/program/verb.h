#pragma once

#include <functional>
#include <initializer_list>
#include <memory>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace kerf::bench {

struct Context;

/// An option of a verb while it is declared; each call says one thing more about it. The library that reads
/// command lines is included in verb.cpp, app.cpp and described.cpp alone: it costs every file that includes
/// it seconds.
class Option {
 public:
  explicit Option(CLI::Option& option) : option_(option) {}

  Option& required();
  /// --help shows the value that the variable has now.
  Option& with_default();
  Option& within(int lower, int upper);
  Option& within(double lower, double upper);
  Option& positive();
  Option& not_negative();
  Option& one_of(std::initializer_list<std::string> values);
  Option& separated_by(char delimiter);
  /// Takes so many values at once.
  Option& taking(int values);
  /// May be repeated, with one value each time.
  Option& one_value_each();

 private:
  CLI::Option& option_;
};

/// Refuses options that were given though they say nothing to what is done; called by the verb's action.
/// @throws std::invalid_argument in a line: "--depth says nothing to virtual walls; it is for a law".
using RefuseIdle = std::function<void(const std::vector<const char*>& options, const std::string& to,
                                      const std::string& why)>;

/// A verb while its options are declared.
class Verb {
 public:
  /// What is to be done between the reading of the command line and the verb's action.
  using Before = std::vector<std::function<void()>>;

  Verb(CLI::App& verb, std::shared_ptr<Before> before) : verb_(verb), before_(std::move(before)) {}

  /// Value: std::string, double, std::size_t, a vector of strings or of doubles, or std::optional<double>.
  /// The variable has to live until the verb has run.
  template <typename Value>
  Option add_option(const std::string& name, Value& variable, const std::string& description);
  /// An option that names a device or a sensor by URI, or by its name in the bench file, in whose place its
  /// URI is put before the verb's action runs.
  Option add_uri(const std::string& name, std::string& variable, const std::string& description);
  Option add_flag(const std::string& name, bool& variable, const std::string& description);
  [[nodiscard]] RefuseIdle refuses_idle() const;
  /// No help, page or completion tells of it: a program calls it.
  Verb& hidden();
  /// Adds --plugin: laws of shared objects, which are loaded before the verb's action runs.
  Verb& takes_laws(Context& context);
  /// Adds --map: texts among the recordings that the variable names are imported before the verb's action
  /// runs.
  Verb& takes_texts(Context& context, std::string& recording);
  Verb& takes_texts(Context& context, std::vector<std::string>& recordings);
  /// Adds a --map that is refused in a line with what to do: the verb changes the recording.
  Verb& refuses_texts(Context& context, const std::string& recording);

 private:
  void add_map(Context& context, const std::string& description);

  CLI::App& verb_;
  std::shared_ptr<Before> before_;
};

/// Adds a verb with --json and --seed, its description and an example under --help; `action` runs after
/// parsing. Exceptions leave through run_program(): std::invalid_argument and schema::FormatError exit 2,
/// drivers::DeviceError 3, std::system_error and anything else 4, each with one line on standard error.
Verb add_verb(CLI::App& app, Context& context, const std::string& name, const std::string& description,
              const std::string& example, std::function<void()> action);

/// Adds a verb that has verbs of its own, one of which must be given: what it returns takes the place of
/// `app` for them.
CLI::App& add_verb_of_verbs(CLI::App& app, const std::string& name, const std::string& description,
                            const std::string& footer);

}  // namespace kerf::bench
