#include "own_law/build_law.h"

#include <array>
#include <cerrno>
#include <cstdlib>
#include <sstream>
#include <stdexcept>
#include <system_error>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <kerf/plugins/load.h>

#include "files/named_file.h"
#include "files/whole_file.h"
#include "laws/plugin_laws.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

/// Removed with its scope.
class BuiltFile {
 public:
  explicit BuiltFile(fs::path path) : path_(std::move(path)) {}
  BuiltFile(const BuiltFile&) = delete;
  BuiltFile& operator=(const BuiltFile&) = delete;
  ~BuiltFile() {
    std::error_code ignored;
    fs::remove(path_, ignored);
  }
  [[nodiscard]] const fs::path& path() const noexcept { return path_; }

 private:
  fs::path path_;
};

/// "ccache g++" is two words.
std::vector<std::string> compiler() {
  const char* const named = std::getenv("CXX");  // NOLINT(concurrency-mt-unsafe): at set-up
  std::istringstream words(named == nullptr || *named == '\0' ? "c++" : named);
  std::vector<std::string> all;
  for (std::string word; words >> word;) all.push_back(word);
  return all;
}

struct Compiled {
  int status = 0;
  std::string said;
};

Compiled run_compiler(std::vector<std::string> words) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "a pipe");
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDERR_FILENO);
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t process = 0;
  const int error = posix_spawnp(&process, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  Compiled result;
  std::array<char, 4096> buffer{};
  for (ssize_t count = 0; error == 0 && (count = read(ends[0], buffer.data(), buffer.size())) > 0;)
    result.said.append(buffer.data(), static_cast<std::size_t>(count));
  close(ends[0]);
  if (error != 0)
    throw std::system_error(error, std::generic_category(), words[0] + ", a compiler (CXX names another)");
  while (waitpid(process, &result.status, 0) < 0 && errno == EINTR) {
  }
  return result;
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

fs::path headers_for_laws() {
  std::error_code error;
  for (fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path(); folder.has_relative_path();
       folder = folder.parent_path()) {
    for (const char* const below : {"include", "models/include"}) {
      if (fs::exists(folder / below / "kerf/plugin.h")) return folder / below;
    }
  }
  throw std::invalid_argument(
      "there is no kerf/plugin.h in an 'include' beside this program: install Kerf's headers (libkerf-dev)");
}

BuiltLaw build_law(const fs::path& header, const fs::path& plugin, schema::Existing existing) {
  (void)NamedFile(header);  // says what is wrong with one that cannot be opened
  if (!is_plugin(plugin.string()))
    throw std::invalid_argument(fmt::format("{}: a plug-in is named NAME.so", plugin.string()));
  require_output(plugin, existing == schema::Existing::replace);
  if (plugin.has_parent_path()) fs::create_directories(plugin.parent_path());
  const BuiltFile built(fs::path(plugin).concat(fmt::format(".writing-{}", getpid())));
  std::vector<std::string> words = compiler();
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
  const Compiled compiled = run_compiler(std::move(words));
  if (!WIFEXITED(compiled.status) || WEXITSTATUS(compiled.status) != 0) {
    throw std::invalid_argument(
        fmt::format("{}: {} does not compile it: {}", header.string(), name, first_error(compiled.said)));
  }
  plugins::Trial trial;
  try {
    trial = plugins::try_law(built.path());
  } catch (const std::invalid_argument& error) {
    std::string why = error.what();
    if (const std::string file = built.path().string() + ": "; why.starts_with(file))
      why.erase(0, file.size());
    throw std::invalid_argument(fmt::format("{}: {}", header.string(), why));
  }
  schema::take_name(built.path(), plugin, existing);
  return {.law = &load_plugin(plugin), .step_s = trial.step_s, .compiler = name, .said = compiled.said};
}

}  // namespace kerf::bench
