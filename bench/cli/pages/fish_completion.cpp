#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pages/completion.h"
#include "pages/quoting.h"
#include "pages/taken.h"

namespace kerf::bench {
namespace {

constexpr std::string_view fish_frame = R"fish(
# The words before the one at the cursor, without the program and 'help'.
function __kerf_words
    set -l words (commandline -opc)
    set -e words[1]
    test "$words[1]" = help; and set -e words[1]
    string join -- \n $words
end

# __kerf_at VERB...: these words are the verb.
function __kerf_at
    set -l words (__kerf_words)
    for i in (seq (count $argv))
        test "$words[$i]" = $argv[$i]; or return 1
    end
end

# __kerf_needs VERB...: after these words a verb is to come.
function __kerf_needs
    set -l words (__kerf_words)
    test "$words" = "$argv"
end

# __kerf_value NUMBER VERB... and __kerf_more NUMBER VERB...: the word at the cursor is the value of that number, of those without a
# name, or one of those from it on.
function __kerf_value
    set -l wanted $argv[1]
    set -l verb $argv[2..]
    __kerf_at $verb; and test (__kerf_values_before $verb) -eq (math $wanted - 1)
end
function __kerf_more
    set -l wanted $argv[1]
    set -l verb $argv[2..]
    __kerf_at $verb; and test (__kerf_values_before $verb) -ge (math $wanted - 1)
end

# __kerf_values_before VERB...: how many values without a name stand before the word at the cursor.
function __kerf_values_before
    set -l words (__kerf_words)
    set -l count 0
    set -l taken no
    for word in $words[(math (count $argv) + 1)..]
        if test $taken = yes
            set taken no
        else if not string match -q -- '-*' $word
            set count (math $count + 1)
        else if not string match -q -- '*=*' $word; and contains -- "$argv $word" $__kerf_taking
            set taken yes
        end
    end
    echo $count
end

# __kerf_files ENDING...: files that end so, and folders.
function __kerf_files
    set -l ending (string join '|' (string escape --style=regex -- $argv))
    __fish_complete_path (commandline -ct | string replace -r -- '^--[^=]*=' '') | string match -r -- "^[^\t]*(?:/|$ending)(?:\t.*)?\$"
end

function __kerf_devices
    string join -- \n $__kerf_simulated
    set -l words (commandline -opc)
    $words[1] devices 2>/dev/null | string match -rg -- '^([a-z0-9]*:[^ ]*)  '
end

# Several with commas between.
function __kerf_laws
    set -l before (commandline -ct | string match -rg -- '^(?:--[^=]*=)?(.*,)')
    string join -- \n "$before"$__kerf_law_names
end

complete -c kerf -f
)fish";

std::string fish_quoted(std::string_view text) { return "'" + with_escapes(text, "\\'", "\\") + "'"; }

/// What follows -a, or nothing where there is nothing to offer.
std::string offered(const Taken& taken) {
  using enum Taken::Kind;
  switch (taken.kind) {
    case nothing:
      return "";
    case words:
      return fish_quoted(fmt::format("{}", fmt::join(taken.words, " ")));
    case laws:
      return "'(__kerf_laws)'";
    case devices:
      return "'(__kerf_devices)'";
    case folders:
      return "'(__fish_complete_directories (commandline -ct) folder)'";
    case files:
      break;
  }
  if (taken.words.empty()) return "'(__fish_complete_path (commandline -ct))'";
  return fish_quoted(fmt::format("(__kerf_files {})", fmt::join(taken.words, " ")));
}

std::string option_line(const DescribedVerb& verb, const std::string& at, const DescribedOption& option) {
  const bool has_name = option.names.back().starts_with('-');
  const std::string offers = offered(taken_by(verb, option));
  if (!has_name && offers.empty()) return "";
  std::string out = "complete -c kerf -n " + at;
  for (const std::string& name : option.names) {
    if (name.starts_with("--"))
      out += " -l " + name.substr(2);
    else if (has_name)
      out += " -s " + name.substr(1);
  }
  if (has_name && option.takes_value) out += " -x";
  if (!offers.empty()) out += " -a " + offers;
  return out + (has_name ? " -d " + fish_quoted(option.description) : "") + "\n";
}

/// 'VERB OPTION' for each option that takes a value, with a blank before.
std::string options_that_take(const std::vector<DescribedVerb>& all) {
  std::string out;
  for (const DescribedVerb& verb : all) {
    for (const DescribedOption& option : verb.options) {
      if (!option.takes_value) continue;
      for (const std::string& name : option.names)
        out += " " + fish_quoted(fmt::format("{} {}", fmt::join(verb.words, " "), name));
    }
  }
  return out;
}

}  // namespace

std::string fish_completion(const std::vector<DescribedVerb>& all, const CompletionWords& words) {
  std::string out = fmt::format(
      "# Completion of kerf for fish, made by kerf of what --help prints.\n"
      "set -g __kerf_law_names {}\nset -g __kerf_simulated {}\nset -g __kerf_taking{}\n{}",
      fmt::join(words.laws, " "), fmt::join(words.devices, " "), options_that_take(all), fish_frame);
  out += "complete -c kerf -n __kerf_needs -a help -d 'What a verb does, an example, its options'\n";
  for (const DescribedVerb& verb : all) {
    const std::string name = fmt::format("{}", fmt::join(verb.words, " "));
    if (!name.empty()) {
      const std::vector<std::string> above(verb.words.begin(), verb.words.end() - 1);
      out += fmt::format("complete -c kerf -n '__kerf_needs {}' -a {} -d {}\n", fmt::join(above, " "),
                         verb.words.back(), fish_quoted(verb.description));
    }
    const std::string at = name.empty() ? "__kerf_needs" : fish_quoted("__kerf_at " + name);
    for (const DescribedOption& option : verb.options) out += option_line(verb, at, option);
    for (std::size_t i = 0; i < verb.values.size(); ++i) {
      const DescribedOption& value = verb.values[i];
      const std::string place =
          fmt::format("{} {} {}", value.repeated ? "__kerf_more" : "__kerf_value", i + 1, name);
      out += option_line(verb, fish_quoted(place), value);
    }
  }
  return out;
}

}  // namespace kerf::bench
