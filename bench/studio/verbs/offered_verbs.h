#pragma once

#include <span>
#include <string_view>
#include <vector>

namespace kerf::bench {

/// A verb of the program that a page may run: a line of the table in offered_verbs.cpp. Its form is made of
/// what the verb's own --help says; here stands only what that does not tell.
struct OfferedVerb {
  std::string_view verb;   ///< "session simulate"
  std::string_view title;  ///< what a person wants who picks it
  /// Options that name what is written, and the endings of that: the first one's where none is typed; "" is a
  /// folder.
  struct Output {
    std::string_view option;
    std::vector<std::string_view> endings;
  };
  std::vector<Output> outputs = {};
  /// Options that take a text which is no file. What is named nowhere and may be a file is left out of the
  /// form: nothing comes from a page that the program might open.
  std::vector<std::string_view> texts = {};
  std::vector<std::string_view> left_out = {};
  std::vector<std::string_view> fixed = {};  ///< words that are always given
  bool needs_key = false;                    ///< opens sessions: offered where the studio has a key file
};

[[nodiscard]] std::span<const OfferedVerb> offered_verbs();

/// Options that no form has, whatever verb they are of: they load code, replace files, answer questions, run
/// by the wall clock beside a loop that a hand may be on, or name a machine.
[[nodiscard]] bool is_never_offered(std::string_view option);

}  // namespace kerf::bench
