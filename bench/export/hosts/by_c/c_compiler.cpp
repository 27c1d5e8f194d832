#include "hosts/by_c/c_compiler.h"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <kerf/version.h>

#include "hosts/by_c/c_host_texts.h"
#include "own_code/compiler.h"

namespace kerf::bench {
namespace {

/// "liver" as its macros begin: "LIVER"
std::string upper_case(std::string name) {
  std::ranges::transform(name, name.begin(),
                         [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; });
  return name;
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
  static_cast<void>(compile(std::move(words), source, name));
}

std::vector<std::pair<std::string_view, std::string>> names_of(const ExportedLaw& law) {
  return {{"NAME", law.name}, {"UPPER", upper_case(law.name)}, {"SOFTWARE", software()}};
}

std::string_view c_host_text(std::string_view name) {
  for (const PageFile& file : c_host_texts())
    if (file.name == name) return file.content;
  throw std::logic_error(fmt::format("no text of a host is named {}", name));
}

}  // namespace kerf::bench
