#include "own_code/compiler.h"

#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/wait.h>
#include <unistd.h>

#include <kerf/processes/program.h>

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

struct Compiled {
  int status = 0;
  std::string said;
};

Compiled run_compiler(const std::vector<std::string>& words) {
  const processes::Descriptor said = processes::file_in_memory();
  pid_t process = 0;
  const int error =
      processes::start({.words = words, .output = said.number(), .errors = said.number()}, process);
  if (error != 0)
    throw std::system_error(error, std::generic_category(),
                            words[0] + ", a compiler (CC or CXX names another)");
  const int status = processes::wait_for(process);
  return {.status = status, .said = processes::content_of(said)};
}

/// The line of a compiler's words that says what is wrong.
std::string first_error(const std::string& said) {
  std::istringstream lines(said);
  std::string first;
  for (std::string line; std::getline(lines, line);) {
    if (first.empty()) first = line;
    if (line.find("error") != std::string::npos) return line;
  }
  return first;
}

}  // namespace

BuiltFile::BuiltFile(const fs::path& plugin)
    : path_(fs::path(plugin).concat(fmt::format(".writing-{}", getpid()))) {
  if (plugin.has_parent_path()) fs::create_directories(plugin.parent_path());
}

BuiltFile::~BuiltFile() {
  std::error_code ignored;
  fs::remove(path_, ignored);
}

std::string BuiltFile::of_source(std::string why, const fs::path& source) const {
  if (const std::string file = path_.string() + ": "; why.starts_with(file)) why.erase(0, file.size());
  return fmt::format("{}: {}", source.string(), why);
}

std::vector<std::string> compiler_named(const char* variable, const char* usual) {
  const char* const named = std::getenv(variable);  // NOLINT(concurrency-mt-unsafe): at set-up
  // "ccache g++" is two words.
  std::istringstream words(named == nullptr || *named == '\0' ? usual : named);
  std::vector<std::string> all;
  for (std::string word; words >> word;) all.push_back(word);
  return all;
}

std::string compile(const std::vector<std::string>& words, const fs::path& source, const std::string& name) {
  Compiled compiled = run_compiler(words);
  if (!WIFEXITED(compiled.status) || WEXITSTATUS(compiled.status) != 0) {
    throw std::invalid_argument(
        fmt::format("{}: {} does not compile it: {}", source.string(), name, first_error(compiled.said)));
  }
  return std::move(compiled.said);
}

fs::path headers_with(const char* header, const char* of_tree) {
  std::error_code error;
  for (fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path(); folder.has_relative_path();
       folder = folder.parent_path()) {
    for (const char* const below : {"include", of_tree}) {
      if (fs::exists(folder / below / header)) return folder / below;
    }
  }
  throw std::invalid_argument(fmt::format(
      "there is no {} in an 'include' beside this program: install Kerf's headers (libkerf-dev)", header));
}

void require_name(std::string_view name, std::string_view what) {
  const auto is_letter = [](char c) { return c >= 'a' && c <= 'z'; };
  const bool is_name =
      !name.empty() && name.size() <= 60 && is_letter(name.front()) &&
      std::ranges::all_of(name, [&](char c) { return is_letter(c) || c == '_' || (c >= '0' && c <= '9'); });
  if (!is_name)
    throw std::invalid_argument(
        fmt::format("'{}' is no name for {}; expected a to z, 0 to 9 and _, first a letter", name, what));
}

std::string filled_in(std::string_view text,
                      const std::vector<std::pair<std::string_view, std::string>>& values) {
  std::string result(text);
  for (const auto& [key, to] : values) {
    const std::string from = fmt::format("%{}%", key);
    for (auto at = result.find(from); at != std::string::npos; at = result.find(from, at + to.size()))
      result.replace(at, from.size(), to);
  }
  return result;
}

}  // namespace kerf::bench
