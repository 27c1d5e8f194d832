#include "plot/gnuplot.h"

#include <cstdlib>
#include <deque>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <system_error>

#include <fmt/core.h>
#include <fmt/format.h>
#include <stdio.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <kerf/version.h>

#include "files/whole_file.h"
#include "html/html.h"

namespace kerf::bench {
namespace {

/// With title and maker in place of gnuplot's, which a browser would show beside the pointer.
std::string named(std::string svg, const std::string& title) {
  const auto begin = svg.find("<title>");
  const auto end = svg.find("</desc>");
  if (begin == std::string::npos || end == std::string::npos) return svg;
  return svg.replace(begin, end - begin,
                     fmt::format("<title>{}</title>\n<desc>{}, by gnuplot", escaped(title), software()));
}

/// A file in memory that another program can write by its name; whoever is killed leaves nothing behind.
class NamedMemory {
 public:
  NamedMemory() : descriptor_(memfd_create("kerf-chart", MFD_CLOEXEC)) {
    if (descriptor_ < 0) throw std::system_error(errno, std::generic_category(), "no memory for a chart");
    path_ = fmt::format("/proc/{}/fd/{}", getpid(), descriptor_);
  }
  NamedMemory(const NamedMemory&) = delete;
  NamedMemory& operator=(const NamedMemory&) = delete;
  ~NamedMemory() { close(descriptor_); }
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  int descriptor_;
  std::string path_;
};

}  // namespace

std::string gnuplot_text(std::string_view text) {
  std::string result = "'";
  for (const char c : text) {
    if (c == '\'') result += '\'';
    result += c == '\n' || c == '\r' ? ' ' : c;
  }
  return result + "'";
}

std::vector<std::string> run_gnuplot(std::span<const GnuplotScript> scripts) {
  std::deque<NamedMemory> outputs;
  std::string script;
  for (const GnuplotScript& one : scripts) script += one.text(outputs.emplace_back().path());
  const NamedMemory errors;
  // From a file: of its standard input it reads every character by a call of its own.
  const NamedMemory commands;
  std::ofstream(commands.path()) << script;
  const std::string command = "gnuplot " + commands.path() + " 2>" + errors.path();
  FILE* pipe = popen(command.c_str(), "w");
  if (pipe == nullptr) throw std::system_error(errno, std::generic_category(), "cannot start gnuplot");
  const int status = pclose(pipe);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 127) {
    throw std::runtime_error("gnuplot is not installed; charts need it: apt-get install gnuplot-nox");
  }
  std::vector<std::string> drawings;
  for (std::size_t i = 0; i < scripts.size(); ++i) {
    const std::string svg = read_whole_file(outputs[i].path());
    const auto begin = svg.find("<svg");
    if (begin == std::string::npos || svg.rfind("</svg>") == std::string::npos) {
      throw std::runtime_error(
          fmt::format("gnuplot could not draw '{}': {}", scripts[i].title, read_whole_file(errors.path())));
    }
    drawings.push_back(named(svg.substr(begin), scripts[i].title));
  }
  if (status != 0) throw std::runtime_error("gnuplot failed: " + read_whole_file(errors.path()));
  return drawings;
}

}  // namespace kerf::bench
