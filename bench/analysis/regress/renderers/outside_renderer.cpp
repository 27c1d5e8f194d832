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
#include "regress/renderers/number_table.h"
#include "regress/renderers/run_program.h"

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

std::string force_column(const models::LawAxis& axis) {
  return fmt::format("{}{}[{}]", axis.force_unit == "N" ? "f" : "t", axis.name, axis.force_unit);
}

/// Of a table of so many rows.
std::uintmax_t largest_table(std::size_t rows, std::size_t axes) {
  return (rows + 16) * (2 * axes + 4) * number_bytes;
}

void require_declared(const NumberTable& table, const OutsideRenderer& renderer) {
  for (const auto& [what, value] : table.declared) {
    const std::string* const expected = what == "sign"    ? &renderer.sign
                                        : what == "frame" ? &renderer.frame
                                                          : nullptr;
    if (expected == nullptr || *expected == value) continue;
    throw std::invalid_argument(
        fmt::format("the forces are of {} '{}', and the suite says '{}'", what, value, *expected));
  }
}

std::vector<std::size_t> force_columns(const NumberTable& table, const OutsideRenderer& renderer) {
  std::vector<std::string> known{"tick", "time[s]", "compute_time[s]", "fault"};
  std::vector<std::size_t> columns;
  for (const models::LawAxis& axis : renderer.axes) {
    known.push_back(force_column(axis));
    columns.push_back(table.column(known.back()));
    if (columns.back() < table.names.size()) continue;
    throw std::invalid_argument(fmt::format("the forces have the columns {}, expected also {}",
                                            fmt::join(table.names, ","), known.back()));
  }
  for (const std::string& name : table.names) {
    if (std::ranges::count(known, name) == 0 || std::ranges::count(table.names, name) > 1)
      throw std::invalid_argument(fmt::format(
          "the forces have a column '{}', expected each of {} at most once", name, fmt::join(known, ",")));
  }
  if (table.column("time[s]") == table.names.size())
    throw std::invalid_argument("the forces have no column time[s], which says which tick a row is of");
  return columns;
}

/// A row a tick, each of the tick's time: a row that is lost or doubled is told here, where it is.
void require_ticks(const NumberTable& table, const SampledMotion& motion) {
  const std::size_t time = table.column("time[s]");
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
  require_declared(table, renderer);
  const std::vector<std::size_t> columns = force_columns(table, renderer);
  require_ticks(table, motion);
  RenderedForces got;
  for (const models::LawAxis& axis : renderer.axes) got.channels.push_back({axis.name, axis.force_unit});
  const std::size_t fault = table.column("fault");
  for (std::size_t row = 0; row < table.rows(); ++row) {
    for (const std::size_t column : columns) got.force.push_back(table.at(row, column));
    if (fault == table.names.size() || table.at(row, fault) == 0.0) continue;
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
    return forces_of(read_number_table(renderer.forces, at_most), renderer, motion);
  const RunFolder folder;
  const fs::path trajectory = folder / "trajectory.csv";
  ProgramRun run{.folder = renderer.folder,
                 .timeout = std::chrono::duration<double>(renderer.timeout_s),
                 .output = folder / "forces.csv",
                 .output_at_most = at_most};
  for (const std::string& word : renderer.command)
    run.command.push_back(
        with(with(with(word, "{trajectory}", trajectory.string()), "{forces}", run.output.string()), "{seed}",
             fmt::format("{}", renderer.seed)));
  write_whole_file(trajectory, trajectory_csv(motion, renderer.axes));
  const ProgramWords words = run_program(run);
  if (!fs::exists(run.output)) {
    throw std::invalid_argument(
        fmt::format("the renderer ended well and wrote no {{forces}}{}",
                    words.output.empty()
                        ? ""
                        : "; it printed '" + words.output.substr(0, words.output.find('\n')).substr(0, 60) +
                              "' on standard output"));
  }
  try {
    return forces_of(read_number_table(run.output, at_most), renderer, motion);
  } catch (const std::invalid_argument& error) {
    // The file is gone when this is read: its name says nothing.
    throw std::invalid_argument(with(error.what(), run.output.string(), "the forces"));
  }
}

std::string trajectory_csv(const SampledMotion& motion, const std::vector<models::LawAxis>& axes) {
  std::string text = "tick,time[s]";
  for (const models::LawAxis& axis : axes)
    text += fmt::format(",{0}[{1}],v{0}[{1}/s]", axis.name, axis.position_unit);
  text += ",period[s]\n";
  for (std::size_t tick = 0; tick < motion.ticks(); ++tick) {
    text += fmt::format("{},{:.17g}", tick, motion.time_s[tick]);
    for (std::size_t i = 0; i < axes.size(); ++i)
      text +=
          fmt::format(",{:.17g},{:.17g}", motion.sample[tick].position[i], motion.sample[tick].velocity[i]);
    text += fmt::format(",{:.17g}\n", motion.period_s[tick]);
  }
  return text;
}

SampledMotion read_trajectory_csv(const fs::path& file, const std::vector<models::LawAxis>& axes) {
  const NumberTable table = read_number_table(file, LargestInput::table);
  const auto column = [&](const std::string& name) {
    const std::size_t found = table.column(name);
    if (found < table.names.size()) return found;
    throw std::invalid_argument(fmt::format("{}: found the columns {}, expected also {}", file.string(),
                                            fmt::join(table.names, ","), name));
  };
  SampledMotion motion;
  const std::size_t time = column("time[s]");
  for (std::size_t row = 0; row < table.rows(); ++row) {
    models::SpatialMotion sample;
    motion.time_s.push_back(table.at(row, time));
    bool sound =
        std::isfinite(motion.time_s.back()) && (row == 0 || motion.time_s[row] > motion.time_s[row - 1]);
    for (std::size_t i = 0; i < axes.size(); ++i) {
      const auto& [name, unit, force] = axes[i];
      sample.position[i] = table.at(row, column(fmt::format("{}[{}]", name, unit)));
      sample.velocity[i] = table.at(row, column(fmt::format("v{}[{}/s]", name, unit)));
      sound = sound && std::isfinite(sample.position[i]) && std::isfinite(sample.velocity[i]);
    }
    if (!sound)
      throw std::invalid_argument(
          fmt::format("{}: row {} is not finite, or its time does not grow", file.string(), row));
    motion.sample.push_back(sample);
  }
  motion.period_s = periods_of(motion.time_s);
  const std::size_t period = table.column("period[s]");
  for (std::size_t row = 0; row < table.rows() && period < table.names.size(); ++row) {
    motion.period_s[row] = table.at(row, period);
    if (motion.period_s[row] > 0.0 && std::isfinite(motion.period_s[row])) continue;
    throw std::invalid_argument(fmt::format("{}: the period of row {} is no time", file.string(), row));
  }
  return motion;
}

}  // namespace kerf::bench
