#include "import/import.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <functional>
#include <future>
#include <span>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include "files/memory_room.h"
#include "formats/file_text.h"
#include "import/mapped_rows.h"
#include "import/resample.h"
#include "import/suggest/suggested_map.h"
#include "import/text/irregular_lines.h"
#include "import/text/text_table.h"
#include "import/text/thousands.h"
#include "import/trials.h"
#include "import/unit_doubts.h"
#include "recordings/provenance.h"
#include "recordings/row_figures.h"
#include "signal/quantiles.h"
#include "signal/signal.h"

namespace kerf::bench {
namespace {

constexpr double ns_of_second = 1e9;

const MappedColumn* find_channel(const std::vector<MappedColumn>& columns, std::string_view channel) {
  const auto place =
      std::find_if(columns.begin(), columns.end(), [&](const auto& c) { return c.channel == channel; });
  return place == columns.end() ? nullptr : &*place;
}

/// Numbers the rows, with a jump at every gap.
void number_ticks(Imported& imported, double period_s) {
  schema::Recording& recording = imported.recording;
  std::uint64_t tick = 0;
  std::size_t gaps = 0;
  double longest_s = 0.0;
  recording.tick.reserve(recording.rows());
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    const double step = row > 0 ? recording.time[row] - recording.time[row - 1] : 0.0;
    const bool gap = step > gap_in_periods * period_s;
    tick += row == 0 ? 0 : gap ? static_cast<std::uint64_t>(std::llround(step / period_s)) : 1;
    gaps += gap ? 1U : 0U;
    if (gap) longest_s = std::max(longest_s, step);
    recording.tick.push_back(tick);
  }
  if (gaps > 0) {
    imported.warnings.push_back(fmt::format("{} gaps of more than {} periods, the longest {:.4g} s", gaps,
                                            gap_in_periods, longest_s));
  }
}

/// By the length of the lines in the middle. A row takes its mapped columns, the velocity, tick and flags.
void require_memory_for_rows(const std::filesystem::path& file, std::string_view text, std::size_t columns,
                             bool spatial) {
  const std::size_t further = spatial ? 22 : 3;  // six positions, velocities and forces, and two at work
  const std::string_view middle = text.substr(text.size() / 2, std::size_t{1} << 16U);
  const auto lines = static_cast<std::size_t>(std::count(middle.begin(), middle.end(), '\n')) + 1;
  const auto rows = static_cast<std::uintmax_t>(
      static_cast<double>(text.size()) / static_cast<double>(middle.size()) * static_cast<double>(lines));
  require_memory(file, rows * (columns + further) * sizeof(double), fmt::format("about {} rows", rows));
}

/// @throws std::invalid_argument for a place that nothing is counted from.
void require_places_that_fit(const std::optional<SpatialMap>& map, const SpatialPlaces& places) {
  if (!map && (places.point_m || places.origin_m != std::array<double, 3>{}))
    throw std::invalid_argument("--origin and --point need a --map with position.x, position.y, position.z");
  if (places.sensor_rotation_rad && (!map || map->frame != "sensor"))
    throw std::invalid_argument(
        "--sensor-rotation turns a wrench that --map maps in the frame of the sensor, and there is none");
  if (places.point_m && !map->has_torque)
    throw std::invalid_argument("--point says where torques are counted from, and --map maps none");
}

/// Stamps are moments: they have no unit, and say when, not how much.
/// @throws std::invalid_argument for stamps that are mapped to anything but the time, or with another unit.
void require_stamps_for_time(const TextLayout& layout, const std::vector<MappedColumn>& columns,
                             const std::string& name) {
  for (const MappedColumn& column : columns) {
    if (!layout.columns[column.index].stamps) continue;
    if (column.channel == "time" && column.unit.factor == 1.0) continue;
    throw std::invalid_argument(
        fmt::format("{}: column {} holds time stamps, mapped to {}[{}]; expected time={}, without a unit",
                    name, column.index + 1, column.channel, column.unit_text, column.index + 1));
  }
}

/// Times that count since 1970 say when the first row was; `start` is its time less the origin.
void take_moment(Imported& imported, std::int64_t origin, double start, double unit_s) {
  constexpr double begin_of_2000_s = 946'684'800.0;
  constexpr double begin_of_2050_s = 2'524'608'000.0;
  constexpr double longest_clock_s = 10.0 * 365.25 * 86400.0;
  const double units_ns = unit_s * ns_of_second;
  const auto whole_ns = units_ns < 2.0 * ns_of_second ? std::llround(units_ns) : 0;
  const bool is_whole = whole_ns >= 1 && std::abs(units_ns - static_cast<double>(whole_ns)) < 1e-6 * units_ns;
  const double first_row_s = imported.first_time_s;
  if (origin != 0 && is_whole && first_row_s >= begin_of_2000_s && first_row_s < begin_of_2050_s) {
    imported.recording.header.start_ns =
        origin * whole_ns + std::llround(start * static_cast<double>(whole_ns));
    imported.recording.header.start_clock = "UTC";
  } else if (std::abs(first_row_s) > longest_clock_s) {
    imported.warnings.push_back(fmt::format(
        "the time begins at {:.6g} s, which is no moment of 2000 to 2050 as counted since 1970: when "
        "this was is not known; is the unit of time right?",
        first_row_s));
  }
}

void take_time(Imported& imported, MappedRows& rows, const std::string& name, const ImportOptions& options) {
  auto& time = imported.recording.time;
  const MappedColumn* column = find_channel(imported.columns, "time");
  if (column != nullptr && options.rate_hz > 0.0)
    throw std::invalid_argument("--rate counts the time that --map takes from a column; give one of them");
  if (column == nullptr) {
    if (!(options.rate_hz > 0.0)) {
      throw std::invalid_argument(fmt::format(
          "{}: --map maps no time; map one, or give --rate HZ for samples at a uniform rate", name));
    }
    if (!std::isfinite(options.rate_hz))
      throw std::invalid_argument(
          "--rate is infinite; expected how many rows are a second, as in --rate 1000");
    if (options.stretch > 0)
      throw std::invalid_argument("--stretch is of a time that --map takes from a column");
    for (std::size_t row = 0; row < rows.size(); ++row)
      time.push_back(static_cast<double>(row) / options.rate_hz);
    return;
  }
  const auto index = static_cast<std::size_t>(column - imported.columns.data());
  rows.keep_stretch(index, options.stretch, name);
  imported.misplaced_lines = rows.leave_out_misplaced(index);
  time = std::move(rows.column(index));
  if (time.empty()) {
    throw std::invalid_argument(
        fmt::format("{}: no line has a finite time in column {}", name, column->index + 1));
  }
  // Stamps are subtracted as they were written, where whole milliseconds are exact, and scaled after that.
  const double start = time.front();
  if (const auto& stamps = imported.layout.columns[column->index].stamps) {
    imported.recording.header.start_ns = stamps->ns + std::llround(start);
    imported.recording.header.start_clock = stamps->has_zone ? "UTC" : "local";
    for (double& t : time) t = (t - start) / ns_of_second;
    return;
  }
  const std::int64_t origin = imported.layout.columns[column->index].origin;
  imported.first_time_s = (static_cast<double>(origin) + start) * column->unit.factor;
  take_moment(imported, origin, start, column->unit.factor);
  for (double& t : time) t = (t - start) * column->unit.factor;
}

double velocity_window(const ImportOptions& options, double period_s) {
  constexpr double usual_s = 0.02;
  if (options.velocity_window_s > 0.0) return options.velocity_window_s;
  return period_s > 0.0 ? std::clamp(usual_s, 4.0 * period_s, 400.0 * period_s) : usual_s;
}

void take_channels(Imported& imported, MappedRows& rows, const ImportOptions& options, double period_s) {
  schema::Recording& recording = imported.recording;
  for (std::size_t i = 0; i < imported.columns.size(); ++i) {
    const MappedColumn& column = imported.columns[i];
    if (column.channel == "time" || is_spatial(column.channel)) continue;
    std::vector<double>& values = rows.column(i);
    if (column.channel == "position") {
      recording.axes[0].position_unit = column.unit.si;
      recording.position = std::move(values);
    } else if (column.channel == "velocity") {
      recording.velocity = std::move(values);
    } else if (column.channel == "force_measured" || column.channel == "force_commanded") {
      recording.axes[0].force_unit = column.unit.si;
      (column.channel == "force_measured" ? recording.force_measured : recording.force_commanded) =
          std::move(values);
    } else {
      recording.channels.push_back(
          {.name = column.channel, .unit = column.unit.si, .values = std::move(values)});
    }
  }
  if (imported.spatial) {
    for (std::string& warning :
         take_spatial_axes(recording, *imported.spatial, imported.columns, rows.columns(), options.places))
      imported.warnings.push_back(std::move(warning));
  }
  if (recording.velocity.empty()) {
    const double window_s = velocity_window(options, period_s);
    derive_velocities(recording, window_s);
    recording.header.velocity_derived =
        fmt::format("slope of a parabola fitted to the positions within {:.4g} s, zero phase", window_s);
  }
}

/// A file of numbers as it was read, before it becomes a recording or several.
struct ReadFile {
  ReadFile(const std::filesystem::path& named, const ImportOptions& options)
      : path(named),
        file(named, {.max_bytes = options.max_bytes, .sheet = options.sheet}),
        layout(find_layout(file.text(), file.name())),
        columns(match_columns(options.map, layout, file.name())),
        spatial(spatial_map_of(options.map, columns)) {
    require_stamps_for_time(layout, columns, file.name());
    require_places_that_fit(spatial, options.places);
    require_memory_for_rows(path, file.text(), columns.size(), spatial.has_value());
    if (const MappedColumn* time = find_channel(columns, "time"))
      count_from_first(layout, time->index, file.text());
    std::vector<std::size_t> indices;
    for (const MappedColumn& column : columns) indices.push_back(column.index);
    const auto begin = std::chrono::steady_clock::now();
    options.progress("importing", file.text().size(), [&](std::atomic<std::size_t>& done) {
      table = parse_table(file.text(), layout, indices, done);
    });
    file.require_whole();
    require_no_groups(file.text(), layout, columns, table, file.name());
    seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    hash = std::async(std::launch::async, [this] { return sha256_of(file.bytes()); }).share();
  }
  ReadFile(const ReadFile&) = delete;
  ReadFile& operator=(const ReadFile&) = delete;
  ~ReadFile() = default;

  std::filesystem::path path;
  FileText file;
  TextLayout layout;
  std::vector<MappedColumn> columns;
  std::optional<SpatialMap> spatial;
  TextTable table;
  double seconds = 0.0;
  std::shared_future<std::string> hash;  ///< last: it reads the file until it ends
};

/// Where the file says beside its times from when on they count: in the column that it calls so.
void take_begin(Imported& imported, const ReadFile& read) {
  const MappedColumn* time = find_channel(imported.columns, "time");
  if (!read.file.begin() || time == nullptr || imported.recording.header.start_ns) return;
  const std::string& name = imported.layout.columns[time->index].name;
  if (!name.starts_with(read.file.time_column())) return;
  const TimeStamp& begin = *read.file.begin();
  imported.recording.header.start_ns = begin.ns + std::llround(imported.first_time_s * ns_of_second);
  imported.recording.header.start_clock = begin.has_zone ? "UTC" : "local";
}

void write_header(schema::Recording& recording, const ReadFile& read, const std::string& trial,
                  const ImportOptions& options) {
  const schema::Header found = std::exchange(recording.header, schema::new_header(software()));
  recording.header.velocity_derived = found.velocity_derived;
  recording.header.start_ns = found.start_ns;
  recording.header.start_clock = found.start_clock;
  recording.header.device_properties = found.device_properties;
  const std::string file = read.path.filename().string();
  recording.header.source = fmt::format("{} sha256:{}", file, read.hash.get());
  read.file.require_whole();
  std::string how;
  if (!trial.empty()) how += fmt::format(", trial '{}'", trial);
  if (options.stretch > 0) how += fmt::format(", stretch {}", options.stretch);
  if (options.resample_hz > 0.0) how += fmt::format(", resampled to {:g} Hz", options.resample_hz);
  if (read.spatial) how += ", " + spatial_text(*read.spatial, options.places);
  add_history(recording.header, fmt::format("import: {} rows of {}{}", recording.rows(), file, how));
}

/// What no tool was recorded in. One row is kept: it is a measurement, if not of a motion.
void require_motion(Imported& imported, const std::string& name) {
  const schema::Recording& recording = imported.recording;
  if (std::ranges::none_of(recording.position, [](double one) { return std::isfinite(one); }))
    throw std::invalid_argument(
        fmt::format("{}: no line has a position that is a number; map another column to it", name));
  if (recording.rows() == 1) imported.warnings.emplace_back("there is one row alone, in which nothing moves");
}

/// Rows of a file as a recording; `name` stands for them in messages.
Imported recording_of(const ReadFile& read, TextTable table, const std::string& name,
                      const std::string& trial, const ImportOptions& options) {
  Imported imported;
  imported.layout = read.layout;
  imported.columns = read.columns;
  imported.spatial = read.spatial;
  imported.parse_seconds = read.seconds;
  MappedRows rows(std::move(table), imported.columns, imported.layout);
  imported.bad_lines = rows.bad_lines();
  if (rows.size() == 0) refuse_without_rows(read.file.text(), imported.layout, imported.columns, name);
  if (options.strict && !imported.bad_lines.empty()) {
    throw std::invalid_argument(
        fmt::format("{}: {} lines are not data: {}; without --strict they are left out", name,
                    imported.bad_lines.size(), named_lines(imported.bad_lines)));
  }

  rows.require_finite(imported.columns, name);
  if (imported.spatial) {
    require_rotations(*imported.spatial, imported.columns, rows.columns(), name,
                      [&](std::size_t row) { return rows.line_of(row); });
  }
  schema::Recording& recording = imported.recording;
  recording.axes.resize(1);
  take_time(imported, rows, name, options);
  if (options.strict && !imported.misplaced_lines.empty()) {
    throw std::invalid_argument(
        fmt::format("{}: lines {} have a time that repeats, goes back or is not finite; without --strict "
                    "they are left out",
                    name, named_lines(imported.misplaced_lines)));
  }
  require_most_lines(imported, name);
  take_begin(imported, read);
  const double period_s = median_period(recording.time);
  take_channels(imported, rows, options, period_s);
  require_motion(imported, name);
  report_irregular_lines(imported);
  number_ticks(imported, period_s);
  recording.flags.assign(recording.rows(), 0);
  if (period_s > 0.0 && (period_s > 10.0 || period_s < 1e-5)) {
    imported.warnings.push_back(
        fmt::format("the rate is {:.4g} Hz; is the unit of time right?", 1.0 / period_s));
  }
  if (recording.header.start_clock == "local")
    imported.warnings.emplace_back(
        "the time stamps name no zone: the start is kept as it stands, of a local clock that nobody named");
  for (std::string& doubt : unit_doubts(imported)) imported.warnings.push_back(std::move(doubt));
  if (options.resample_hz > 0.0) resample(recording, options.resample_hz, period_s);
  write_header(recording, read, trial, options);
  return imported;
}

}  // namespace

Imported import_text(const std::filesystem::path& file, const ImportOptions& options) {
  ReadFile read(file, options);
  Imported imported = recording_of(read, std::move(read.table), read.file.name(), "", options);
  const std::vector<std::string>& notes = read.file.notes();
  imported.warnings.insert(imported.warnings.begin(), notes.begin(), notes.end());
  return imported;
}

std::vector<std::string> import_trials(const std::filesystem::path& file, const std::string& column,
                                       const ImportOptions& options, const TakeTrial& take) {
  ReadFile read(file, options);
  const std::string& name = read.file.name();
  Trials trials = divided_by_trial(read.file.text(), read.layout,
                                   find_trial_column(read.layout, column, name), std::move(read.table), name);
  for (Trial& trial : trials.all) {
    take(trial.name, [&] {
      return recording_of(read, std::move(trial.table), fmt::format("{}, trial '{}'", name, trial.name),
                          trial.name, options);
    });
  }
  std::vector<std::string> warnings = read.file.notes();
  if (!trials.lines_of_none.empty())
    warnings.push_back(fmt::format("{} lines name no trial and are left out: {}", trials.lines_of_none.size(),
                                   named_lines(trials.lines_of_none)));
  return warnings;
}

std::string explain_columns(const std::filesystem::path& file, const ImportOptions& options) {
  const FileText mapped(file, {.max_bytes = options.max_bytes, .sheet = options.sheet});
  const TextLayout layout = find_layout(mapped.text(), mapped.name());
  const SuggestedMap suggested = suggest_map(layout, mapped.text());
  std::string text = fmt::format("its columns are\n{}", describe_columns(layout, mapped.text()));
  for (const std::string& remark : suggested.remarks) text += "\n" + remark;
  if (!suggested.map.empty()) text += "\nfor example " + suggested.in_words();
  return text;
}

}  // namespace kerf::bench
