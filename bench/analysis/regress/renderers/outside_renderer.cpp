#include "regress/renderers/outside_renderer.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <system_error>

#include <fmt/ranges.h>

#include "files/named_file.h"
#include "files/whole_file.h"
#include "recordings/provenance.h"
#include "regress/renderers/child_program.h"
#include "regress/renderers/force_columns.h"
#include "regress/renderers/lockstep.h"
#include "regress/renderers/number_table.h"
#include "regress/renderers/recorded_table.h"
#include "regress/renderers/run_program.h"
#include "regress/renderers/trajectory_table.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

constexpr double same_time_s = 1e-6;         ///< what six digits of a time leave
constexpr std::uintmax_t number_bytes = 64;  ///< what a number may take in a file

/// A folder for the files of one run, removed with them.
class RunFolder {
 public:
  RunFolder() {
    std::string name = (fs::temp_directory_path() / "kerf-renderer-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr)
      throw std::system_error(errno, std::generic_category(), "a folder for a renderer's files");
    path_ = name;
  }
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;
  ~RunFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  [[nodiscard]] fs::path operator/(const char* name) const { return path_ / name; }

 private:
  fs::path path_;
};

std::string with(std::string word, const std::string& place, const std::string& value) {
  for (auto at = word.find(place); at != std::string::npos; at = word.find(place, at + value.size()))
    word.replace(at, place.size(), value);
  return word;
}

/// Of a table of so many rows.
std::uintmax_t largest_table(std::size_t rows, std::size_t axes) {
  return (rows + 16) * (2 * axes + 4) * number_bytes;
}

/// A row a tick, each of the tick's time: a row that is lost or doubled is told here, where it is.
void require_ticks(const NumberTable& table, std::size_t time, const SampledMotion& motion) {
  const std::size_t both = std::min(table.rows(), motion.ticks());
  std::size_t row = 0;
  while (row < both && std::abs(table.at(row, time) - motion.time_s[row]) <= same_time_s) ++row;
  const std::string counts =
      table.rows() == motion.ticks()
          ? ""
          : fmt::format("the renderer gave {} rows for {} ticks", table.rows(), motion.ticks());
  if (row < both) {
    throw std::invalid_argument(
        fmt::format("{}{}the row of tick {} has the time {:.9g} s, expected {:.9g} s: rows are lost, doubled "
                    "or of another rate from there on",
                    counts, counts.empty() ? "" : "; ", row, table.at(row, time), motion.time_s[row]));
  }
  if (!counts.empty()) throw std::invalid_argument(counts + "; the times of those that are there are right");
}

RenderedForces forces_of(const NumberTable& table, const OutsideRenderer& renderer,
                         const SampledMotion& motion) {
  for (const auto& [what, value] : table.declared) require_declared(what, value, renderer);
  const ForceColumns columns = force_columns(table.names, renderer, "time[s]");
  require_ticks(table, columns.key, motion);
  RenderedForces got;
  for (const models::LawAxis& axis : renderer.axes) got.channels.push_back({axis.name, axis.force_unit});
  if (columns.compute_time < table.names.size()) got.compute_time_of = "renderer";
  for (std::size_t row = 0; row < table.rows(); ++row) {
    for (const std::size_t column : columns.forces) got.force.push_back(table.at(row, column));
    if (!got.compute_time_of.empty()) got.compute_time_s.push_back(table.at(row, columns.compute_time));
    if (columns.fault == table.names.size() || table.at(row, columns.fault) == 0.0) continue;
    if (!got.first_fault) got.first_fault = row;
    ++got.faults;
  }
  return got;
}

}  // namespace

std::string called(const OutsideRenderer& renderer) {
  return renderer.command.empty() ? "forces of " + renderer.forces.filename().string()
                                  : fmt::format("{}", fmt::join(renderer.command, " "));
}

std::string checksum(const OutsideRenderer& renderer) {
  std::string text = fmt::format("{}\n{}\n{}\n", renderer.sign, renderer.frame, renderer.seed);
  if (!renderer.quaternion.empty()) text += renderer.quaternion + '\n';
  for (const models::LawAxis& axis : renderer.axes)
    text += fmt::format("{} {} {}\n", axis.name, axis.position_unit, axis.force_unit);
  for (const std::string& word : renderer.command) {
    text += word + '\n';
    const fs::path file = renderer.folder / word;
    if (!word.empty() && fs::is_regular_file(file)) text += sha256_of(file) + '\n';
  }
  return sha256_of(std::string_view(text));
}

RenderedForces render_forces(const OutsideRenderer& renderer, const SampledMotion& motion) {
  const std::uintmax_t at_most = largest_table(motion.ticks(), renderer.axes.size());
  if (renderer.command.empty())
    return forces_of(is_recording(renderer.forces) ? read_force_recording(renderer.forces, renderer.axes)
                                                   : read_number_table(renderer.forces, at_most),
                     renderer, motion);
  const RunFolder folder;
  const fs::path trajectory = folder / "trajectory.csv";
  ProgramRun run{.folder = renderer.folder,
                 .timeout = std::chrono::duration<double>(renderer.timeout_s),
                 .output = folder / "forces.csv",
                 .output_at_most = at_most};
  const fs::path socket = folder / "socket";
  for (const std::string& word : renderer.command) {
    run.command.push_back(
        with(with(with(with(word, "{trajectory}", trajectory.string()), "{forces}", run.output.string()),
                  "{seed}", fmt::format("{}", renderer.seed)),
             "{socket}", socket.string()));
  }
  if (renderer.lockstep)
    return render_in_lockstep(renderer, motion, run.command, renderer.lockstep->socket ? socket : fs::path());
  write_whole_file(trajectory, trajectory_csv(motion, {renderer.axes, renderer.quaternion}));
  const ProgramWords words = run_program(run);
  if (!fs::exists(run.output)) {
    const std::string what = fmt::format(
        "the renderer ended well and wrote no {{forces}}{}",
        words.output.empty() ? ""
                             : "; it printed '" + in_print(words.output.substr(0, words.output.find('\n'))) +
                                   "' on standard output");
    throw RendererError(what, last_lines(words.errors));
  }
  try {
    return forces_of(read_number_table(run.output, at_most), renderer, motion);
  } catch (const std::invalid_argument& error) {
    // The file is gone when this is read: its name says nothing.
    throw RendererError(with(error.what(), run.output.string(), "the forces"), last_lines(words.errors));
  }
}

}  // namespace kerf::bench
