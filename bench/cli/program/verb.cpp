#include "program/verb.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include <kerf/drivers/bench_file.h>

#include "files/whole_file.h"
#include "laws/plugin_laws.h"
#include "program/app.h"
#include "program/import_on_the_way.h"

namespace kerf::bench {

namespace {

/// What is wrong with a number that has to be greater than zero, or not less; nothing if nothing is.
std::string wrong_with(const std::string& text, bool may_be_zero) {
  double value = 0.0;
  if (!CLI::detail::lexical_cast(text, value)) return "'" + text + "' is not a number";
  if (value > 0.0 || (may_be_zero && value == 0.0)) return "";
  return text + (may_be_zero ? " is negative" : " is not greater than 0");
}

/// Files that the command line names, but as an output or as what an earlier run has written.
void protect_inputs(const CLI::App& verb) {
  constexpr std::array<std::string_view, 5> outputs{"--output", "--record", "--junit", "--filter-chart",
                                                    "--resume"};
  for (const CLI::Option* const option : verb.get_options()) {
    if (std::ranges::find(outputs, option->get_name()) != outputs.end()) continue;
    for (const std::string& named : option->results()) {
      std::error_code ignored;
      if (std::filesystem::is_regular_file(named, ignored)) protect_input(named);
    }
  }
}

std::string is_named(const std::string& output) {
  return output.empty() ? "'' is no name for an output" : "";
}

}  // namespace

Option& Option::required() {
  option_.required();
  return *this;
}

Option& Option::with_default() {
  option_.capture_default_str();
  return *this;
}

Option& Option::within(int lower, int upper) {
  option_.check(CLI::Range(lower, upper));
  return *this;
}

Option& Option::within(double lower, double upper) {
  option_.check(CLI::Range(lower, upper));
  return *this;
}

Option& Option::positive() {
  option_.check(CLI::Validator([](std::string& text) { return wrong_with(text, false); }, "POSITIVE"));
  return *this;
}

Option& Option::not_negative() {
  option_.check(CLI::Validator([](std::string& text) { return wrong_with(text, true); }, "NOT NEGATIVE"));
  return *this;
}

Option& Option::one_of(std::initializer_list<std::string> values) {
  option_.check(CLI::IsMember(std::vector<std::string>(values)));
  return *this;
}

Option& Option::separated_by(char delimiter) {
  option_.delimiter(delimiter);
  return *this;
}

Option& Option::taking(int values) {
  option_.expected(values);
  return *this;
}

Option& Option::one_value_each() {
  option_.allow_extra_args(false);
  return *this;
}

template <typename Value>
Option Verb::add_option(const std::string& name, Value& variable, const std::string& description) {
  CLI::Option* const option = verb_.add_option(name, variable, description);
  if (name.starts_with("-o,")) option->check(is_named);
  return Option(*option);
}

template Option Verb::add_option(const std::string&, std::string&, const std::string&);
template Option Verb::add_option(const std::string&, double&, const std::string&);
template Option Verb::add_option(const std::string&, std::size_t&, const std::string&);
template Option Verb::add_option(const std::string&, std::vector<std::string>&, const std::string&);
template Option Verb::add_option(const std::string&, std::vector<double>&, const std::string&);
template Option Verb::add_option(const std::string&, std::vector<std::size_t>&, const std::string&);
template Option Verb::add_option(const std::string&, std::optional<double>&, const std::string&);

Option Verb::add_uri(const std::string& name, std::string& variable, const std::string& description) {
  before_->push_back([&variable] { variable = drivers::named_uri(variable); });
  return add_option(name, variable, description);
}

Option Verb::add_flag(const std::string& name, bool& variable, const std::string& description) {
  return Option(*verb_.add_flag(name, variable, description));
}

RefuseIdle Verb::refuses_idle() const {
  return [&verb = verb_](const std::vector<const char*>& options, const std::string& to,
                         const std::string& why) {
    for (const char* const option : options) {
      if (verb.count(option) > 0)
        throw std::invalid_argument(std::string(option) + " says nothing to " + to + "; " + why);
    }
  };
}

Verb& Verb::hidden() {
  verb_.group("");
  return *this;
}

Verb& Verb::takes_laws(Context& context) {
  add_option("--plugin", context.plugins,
             "MYLAW.so: a law of your own, from now on known by its name; may be repeated (docs/own-law.md)")
      .one_value_each();
  return *this;
}

void Verb::add_map(Context& context, const std::string& description) {
  add_option("--map", context.maps, description).one_value_each();
}

Verb& Verb::takes_texts(Context& context, std::string& recording) {
  add_map(
      context,
      "CHANNEL=COLUMN[unit],... or FILE.toml: take a text instead of a recording, imported on the way as by "
      "kerf import --map");
  before_->push_back([&context, &recording] { import_on_the_way({&recording, 1}, context); });
  return *this;
}

Verb& Verb::takes_texts(Context& context, std::vector<std::string>& recordings) {
  add_map(context,
          "CHANNEL=COLUMN[unit],... or FILE.toml: take texts among the recordings, imported on the way as by "
          "kerf "
          "import --map");
  before_->push_back([&context, &recordings] { import_on_the_way(recordings, context); });
  return *this;
}

Verb& Verb::refuses_texts(Context& context, const std::string& recording) {
  add_map(context, "Refused: a text is imported first, since this changes the recording");
  before_->push_back([this_verb = verb_.get_name(), &context, &recording] {
    refuse_import_on_the_way(this_verb, recording, context);
  });
  return *this;
}

Verb add_verb(CLI::App& app, Context& context, const std::string& name, const std::string& description,
              const std::string& example, std::function<void()> action) {
  CLI::App* const subcommand = app.add_subcommand(name, description);
  subcommand->footer("Example:\n  " + example);
  const auto before = std::make_shared<Verb::Before>();
  Verb verb(*subcommand, before);
  verb.add_flag("--json", context.json, "Print one JSON object on standard output and nothing else there");
  const CLI::Option* const seed =
      subcommand->add_option("--seed", context.seed, "Seed of every random choice")->capture_default_str();
  subcommand->callback([&context, subcommand, seed, before, run = std::move(action)] {
    context.seed_given = seed->count() > 0;
    if (!context.runs) return;
    for (const std::string& file : context.plugins) (void)load_plugin(file);
    say_plugin_notes();  // before a device moves
    protect_inputs(*subcommand);
    for (const auto& first : *before) first();
    run();
    tell_imported_on_the_way(context);
  });
  return verb;
}

CLI::App& add_verb_of_verbs(CLI::App& app, const std::string& name, const std::string& description,
                            const std::string& footer) {
  CLI::App* const group = app.add_subcommand(name, description);
  group->require_subcommand(1);
  group->footer(footer);
  return *group;
}

}  // namespace kerf::bench
