#include "own_code/build_law.h"

#include <stdexcept>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <kerf/plugins/load.h>

#include "files/named_file.h"
#include "files/whole_file.h"
#include "laws/plugin_laws.h"
#include "own_code/compiler.h"

namespace kerf::bench {

namespace fs = std::filesystem;

fs::path headers_for_laws() { return headers_with("kerf/plugin.h", "models/include"); }

BuiltLaw build_law(const fs::path& header, const fs::path& plugin, schema::Existing existing) {
  (void)NamedFile(header);  // says what is wrong with one that cannot be opened
  if (!is_plugin(plugin.string()))
    throw std::invalid_argument(fmt::format("{}: a plug-in is named NAME.so", plugin.string()));
  require_output(plugin, existing == schema::Existing::replace);
  const BuiltFile built(plugin);
  std::vector<std::string> words = compiler_named("CXX", "c++");
  const std::string name = fmt::format("{}", fmt::join(words, " "));
  // As Kerf itself is compiled: no product is joined with a sum, so that numbers are the same.
  for (const char* const option : {"-std=c++20", "-O3", "-Wall", "-ffp-contract=off", "-fPIC", "-shared",
                                   "-fvisibility=hidden", "-DKERF_BUILD_LAW", "-I"})
    words.emplace_back(option);
  words.push_back(headers_for_laws().string());
  for (const std::string& option :
       {std::string("-include"), fs::absolute(header).string(), std::string("-x"), std::string("c++"),
        std::string("/dev/null"), std::string("-o"), built.path().string()})
    words.push_back(option);
  std::string said = compile(words, header, name);
  plugins::Trial trial;
  try {
    trial = plugins::try_law(built.path());
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(built.of_source(error.what(), header));
  }
  schema::take_name(built.path(), plugin, existing);
  return {.law = &load_plugin(plugin), .step_s = trial.step_s, .compiler = name, .said = std::move(said)};
}

}  // namespace kerf::bench
