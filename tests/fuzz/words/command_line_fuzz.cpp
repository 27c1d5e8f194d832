#include <stdexcept>
#include <string>
#include <vector>

#include "files/for_terminal.h"
#include "fuzz/target.h"
#include "program/app.h"

namespace kerf::fuzz {
namespace {

/// A zero ends a word too: none can hold one.
std::vector<std::string> lines_of(std::string_view text) {
  constexpr std::string_view ends("\n\0", 2);
  std::vector<std::string> lines;
  while (!text.empty()) {
    const auto end = text.find_first_of(ends);
    lines.emplace_back(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return lines;
}

/// A word a line: a command line of some verb, a question for help, or refused in one line.
void fuzz_command_line(Bytes bytes) {
  const std::vector<std::string> words = lines_of(text_of(bytes));
  try {
    (void)bench::read_command_line(words);
  } catch (const std::invalid_argument& error) {
    const std::string said = bench::for_terminal(error.what());
    promise(!said.empty() && said.find('\n') == std::string::npos,
            "a command line is refused in one line: " + said);
    promise(said.find("kerf help") != std::string::npos, "who refuses says where help is: " + said);
  }
}

const Registered registered("command_line", fuzz_command_line);

}  // namespace
}  // namespace kerf::fuzz
