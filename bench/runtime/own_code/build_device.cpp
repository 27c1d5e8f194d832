#include "own_code/build_device.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "files/named_file.h"
#include "files/whole_file.h"
#include "own_code/compiler.h"

namespace kerf::bench {

namespace fs = std::filesystem;

BuiltDevice build_device(const fs::path& source, const fs::path& plugin, schema::Existing existing) {
  (void)NamedFile(source);  // says what is wrong with one that cannot be opened
  if (plugin.extension() != ".so")
    throw std::invalid_argument(fmt::format("{}: a plug-in is named NAME.so", plugin.string()));
  require_output(plugin, existing == schema::Existing::replace);
  constexpr std::array of_cpp{".cpp", ".cc", ".cxx"};
  const bool is_cpp = std::ranges::find(of_cpp, source.extension().string()) != of_cpp.end();
  const BuiltFile built(plugin);
  std::vector<std::string> words = is_cpp ? compiler_named("CXX", "c++") : compiler_named("CC", "cc");
  const std::string name = fmt::format("{}", fmt::join(words, " "));
  for (const char* const option :
       {is_cpp ? "-std=c++20" : "-std=c99", "-O2", "-Wall", "-fPIC", "-shared", "-fvisibility=hidden", "-I"})
    words.emplace_back(option);
  words.push_back(headers_with("kerf/device.h", "drivers/include").string());
  for (const std::string& option :
       {fs::absolute(source).string(), std::string("-o"), built.path().string(), std::string("-lm")})
    words.push_back(option);
  BuiltDevice made{.device = {}, .compiler = name, .said = compile(words, source, name)};
  try {
    made.device = drivers::look_at_plugin(built.path().string());
  } catch (const drivers::DeviceError& error) {
    throw std::invalid_argument(built.of_source(error.what(), source));
  }
  schema::take_name(built.path(), plugin, existing);
  return made;
}

}  // namespace kerf::bench
