#include "hosts/by_c/c_compiler.h"

#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <stdexcept>
#include <system_error>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <kerf/version.h>

#include "hosts/by_c/c_host_texts.h"
#include "law_in_words.h"
#include "own_code/compiler.h"

namespace kerf::bench {
namespace {

/// "liver" as its macros begin: "LIVER"
std::string upper_case(std::string name) {
  std::ranges::transform(name, name.begin(),
                         [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; });
  return name;
}

/// What a law file says, within a comment of C and Octave and the text that a module of Python begins with.
std::string within_comments(std::string_view text) {
  std::string line = in_comment(text);
  std::ranges::replace(line, '"', '\'');
  return line;
}

}  // namespace

void compile_c(const std::filesystem::path& source, const std::filesystem::path& output,
               const std::vector<std::string>& options, const std::vector<std::string>& libraries) {
  std::vector<std::string> words = compiler_named("CC", "cc");
  const std::string name = fmt::format("{}", fmt::join(words, " "));
  words.insert(words.end(), {"-std=c99", "-O2", "-ffp-contract=off"});
  words.insert(words.end(), options.begin(), options.end());
  words.insert(words.end(), {"-o", output.string(), source.string()});
  words.insert(words.end(), libraries.begin(), libraries.end());
  static_cast<void>(compile(words, source, name));
}

std::string axis_in_words(const LawFile& file) {
  return file.axis.empty() ? "an axis without a name" : "the axis " + within_comments(file.axis);
}

std::vector<std::pair<std::string_view, std::string>> law_keys(const ExportedLaw& law) {
  const LawFile& file = law.file;
  return {{"NAME", law.name},
          {"UPPER", upper_case(law.name)},
          {"SHA256", law.sha256},
          {"SOFTWARE", software()},
          {"MODEL", std::string(file.law.model())},
          {"AXIS", axis_in_words(file)},
          {"FIT", within_comments(fit_in_words(file))},
          {"RANGE", within_comments(range_in_words(file))},
          {"POSITION_UNIT", file.position_unit},
          {"FORCE_UNIT", file.force_unit}};
}

void require_no_word_of(const std::string& name, std::string_view language, std::string_view words) {
  if (fmt::format(" {} ", words).find(fmt::format(" {} ", name)) != std::string::npos)
    throw std::invalid_argument(
        fmt::format("'{}' is a word of {} itself; give the law file another name", name, language));
}

void require_program(const std::string& program, const std::string& package) {
  const char* const path = std::getenv("PATH");  // NOLINT(concurrency-mt-unsafe): at set-up
  std::istringstream folders(path == nullptr ? "/usr/bin:/bin" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (access((std::filesystem::path(folder) / program).c_str(), X_OK) == 0) return;
  }
  throw std::system_error(std::make_error_code(std::errc::no_such_file_or_directory),
                          fmt::format("{} (Debian's package {})", program, package));
}

std::string_view c_host_text(std::string_view name) {
  for (const EmbeddedFile& file : c_host_texts())
    if (file.name == name) return file.content;
  throw std::logic_error(fmt::format("no text of a host is named {}", name));
}

}  // namespace kerf::bench
