#include "regress/renderers/made_with.h"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <mutex>
#include <stdexcept>
#include <string_view>
#include <vector>

#include <fmt/ranges.h>
#include <unistd.h>

#include "laws/plugin_mention.h"
#include "recordings/provenance.h"
#include "regress/renderers/child_program.h"
#include "regress/renderers/run_program.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t no_file = 0;

/// Of a file that many cases name, read once as long as it stays as it is.
std::string sha256_once(const fs::path& file) {
  struct Known {
    fs::file_time_type written;
    std::uintmax_t size = 0;
    std::string sha256;
  };
  static std::mutex guard;
  static std::map<fs::path, Known> all;
  const std::lock_guard lock(guard);
  const fs::file_time_type written = fs::last_write_time(file);
  const std::uintmax_t size = fs::file_size(file);
  Known& known = all[fs::absolute(file)];
  if (known.sha256.empty() || known.written != written || known.size != size)
    known = {written, size, sha256_of(file)};
  return known.sha256;
}

/// As posix_spawnp() finds a program; empty if it does not.
fs::path found_along_path(const std::string& program) {
  const char* const path = std::getenv("PATH");  // NOLINT(concurrency-mt-unsafe): nothing here sets it
  for (std::string_view rest = path == nullptr ? "" : path; !rest.empty();) {
    const auto colon = rest.find(':');
    const fs::path file = fs::path(rest.substr(0, colon)) / program;
    if (fs::is_regular_file(file) && ::access(file.c_str(), X_OK) == 0) return file;
    rest = colon == std::string_view::npos ? std::string_view() : rest.substr(colon + 1);
  }
  return {};
}

std::string printed_version(const OutsideRenderer& renderer) {
  const ProgramWords words = run_program({.command = renderer.version,
                                          .folder = renderer.folder,
                                          .timeout = std::chrono::duration<double>(renderer.timeout_s),
                                          .output = {},
                                          .output_at_most = no_file});
  const std::string& said = words.output.empty() ? words.errors : words.output;
  const std::string line = in_print(std::string_view(said).substr(0, said.find_first_of("\r\n")));
  if (line.empty())
    throw std::invalid_argument(fmt::format("'{}', which the suite names for the version, printed none",
                                            fmt::join(renderer.version, " ")));
  return line;
}

std::string of_renderer(const OutsideRenderer& renderer, AskedVersions& versions) {
  std::string text;
  if (!renderer.version.empty()) text += fmt::format("version: {}\n", versions.of(renderer));
  text += fmt::format("command: {}\n", sha256_of(std::string_view(called(renderer))));
  for (const std::string& word : renderer.command) {
    fs::path file = renderer.folder / word;
    if (&word == &renderer.command.front() && word.find('/') == std::string::npos)
      file = found_along_path(word);
    if (!word.empty() && fs::is_regular_file(file)) text += fmt::format("{}: {}\n", word, sha256_once(file));
  }
  return text;
}

/// Its lines by what they are about.
std::map<std::string, std::string> lines_of(const std::string& text) {
  std::map<std::string, std::string> lines;
  for (std::string_view rest = text; !rest.empty();) {
    const std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(rest.size(), line.size() + 1));
    const auto colon = line.find(": ");
    if (colon != std::string_view::npos) lines.emplace(line.substr(0, colon), line.substr(colon + 2));
  }
  return lines;
}

}  // namespace

std::string AskedVersions::of(const OutsideRenderer& renderer) {
  const std::string key = fmt::format("{}\n{}", renderer.folder.string(), fmt::join(renderer.version, "\n"));
  std::shared_future<std::string> answer;
  {
    const std::lock_guard lock(guard_);
    std::shared_future<std::string>& known = all_[key];
    // Who comes first runs it, and whoever else comes waits.
    if (!known.valid())
      known = std::async(std::launch::deferred, [renderer] { return printed_version(renderer); }).share();
    answer = known;
  }
  return answer.get();
}

std::string made_with(const RegressionCase& one, AskedVersions& versions) {
  if (one.outside) return one.outside->command.empty() ? "" : of_renderer(*one.outside, versions);
  const std::string plugin = plugin_in_words(one.law.law);
  const auto comma = plugin.rfind(", SHA-256 ");
  return plugin.empty() ? "" : fmt::format("{}: {}\n", plugin.substr(0, comma), plugin.substr(comma + 10));
}

std::string made_otherwise(const std::string& stored, const std::string& now) {
  std::vector<std::string> words;
  const auto after = lines_of(now);
  for (const auto& [what, value] : lines_of(stored)) {
    const auto found = after.find(what);
    if (found != after.end() && found->second == value) continue;
    const std::string is = found == after.end() ? "unknown" : found->second;
    words.push_back(what == "version"   ? fmt::format("its version was '{}' and is '{}'", value, is)
                    : what == "command" ? "it is called otherwise"
                                        : fmt::format("{} is another file than it was (SHA-256 {}, now {})",
                                                      what, value.substr(0, 12), is.substr(0, 12)));
  }
  return fmt::format("{}", fmt::join(words, ", "));
}

}  // namespace kerf::bench
