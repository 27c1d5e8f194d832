#include "import/import.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <future>
#include <span>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include "files/memory_room.h"
#include "formats/file_text.h"
#include "import/resample.h"
#include "import/text_table.h"
#include "import/time_order.h"
#include "import/unit_doubts.h"
#include "recordings/provenance.h"
#include "recordings/row_figures.h"
#include "signal/quantiles.h"
#include "signal/signal.h"

namespace kerf::bench {
namespace {

constexpr std::size_t max_lines_named = 10;
constexpr double ns_of_second = 1e9;

/// "3, 7, 9 and 12 more"
std::string named_lines(const std::vector<std::size_t>& lines) {
  const std::size_t shown = std::min(lines.size(), max_lines_named);
  const std::string text =
      fmt::format("{}", fmt::join(lines.begin(), lines.begin() + static_cast<std::ptrdiff_t>(shown), ", "));
  return shown == lines.size() ? text : fmt::format("{} and {} more", text, lines.size() - shown);
}

const MappedColumn* find_channel(const std::vector<MappedColumn>& columns, std::string_view channel) {
  const auto place =
      std::find_if(columns.begin(), columns.end(), [&](const auto& c) { return c.channel == channel; });
  return place == columns.end() ? nullptr : &*place;
}

/// The table's numbers in the order of the mapped columns, in SI but for the time, and the lines they came
/// from.
class Rows {
 public:
  Rows(TextTable table, const std::vector<MappedColumn>& columns) : table_(std::move(table)) {
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (columns[i].unit.factor == 1.0 || columns[i].channel == "time") continue;
      for (double& value : table_.columns[i]) value *= columns[i].unit.factor;
    }
  }

  [[nodiscard]] std::size_t size() const { return table_.columns.front().size(); }
  [[nodiscard]] std::vector<double>& column(std::size_t i) { return table_.columns[i]; }
  [[nodiscard]] const std::vector<std::size_t>& bad_lines() const { return table_.bad_lines; }

  /// Infinity is what a logger writes that divided by zero or overflowed: no chart, filter or fit can use it.
  /// @throws std::invalid_argument that names the first.
  void require_finite(const std::vector<MappedColumn>& columns, const std::string& name) const {
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const auto& values = table_.columns[i];
      const auto found = std::find_if(values.begin(), values.end(), [](double v) { return std::isinf(v); });
      if (found == values.end()) continue;
      throw std::invalid_argument(fmt::format(
          "{}:{}: column {}, mapped to {}, is infinite; expected a finite number, or nan where there is none",
          name, table_.line_of(static_cast<std::size_t>(found - values.begin())), columns[i].index + 1,
          columns[i].channel));
    }
  }

  /// Keeps the stretch of a clock that starts anew which was asked for. @throws std::invalid_argument if none
  /// was, or it is not there.
  void keep_stretch(std::size_t time_column, std::size_t asked, const std::string& name) {
    std::vector<std::size_t> begins = clock_restarts(table_.columns[time_column]);
    if (begins.empty() && asked <= 1) return;
    if (asked == 0)
      throw std::invalid_argument(fmt::format(
          "{}:{}: the clock starts anew here, and at {} places in all: take one of its {} stretches by "
          "--stretch 1 to {}, or map "
          "no time and give --rate HZ for one recording of all",
          name, table_.line_of(begins.front()), begins.size(), begins.size() + 1, begins.size() + 1));
    if (asked > begins.size() + 1)
      throw std::invalid_argument(
          fmt::format("{}: --stretch {}: its clock starts {} times", name, asked, begins.size() + 1));
    begins.insert(begins.begin(), 0);
    begins.push_back(size());
    first_ = begins[asked - 1];
    for (auto& column : table_.columns) {
      column.resize(begins[asked]);
      column.erase(column.begin(), column.begin() + static_cast<std::ptrdiff_t>(first_));
    }
  }

  /// Leaves out the rows whose times do not increase; returns their lines.
  std::vector<std::size_t> leave_out_misplaced(std::size_t time_column) {
    const auto& time = table_.columns[time_column];
    const auto follows = [](double before, double after) { return before < after && std::isfinite(after); };
    if (std::isfinite(time.front()) &&
        std::adjacent_find(time.begin(), time.end(), std::not_fn(follows)) == time.end()) {
      return {};
    }
    const std::vector<std::size_t> kept = rows_in_order(time);
    std::vector<std::size_t> lines;
    auto next = kept.begin();
    for (std::size_t row = 0; row < time.size(); ++row) {
      if (next != kept.end() && *next == row) {
        ++next;
      } else {
        lines.push_back(table_.line_of(first_ + row));
      }
    }
    for (auto& column : table_.columns) {
      for (std::size_t i = 0; i < kept.size(); ++i) column[i] = column[kept[i]];
      column.resize(kept.size());
    }
    return lines;
  }

 private:
  TextTable table_;
  std::size_t first_ = 0;  ///< row of the table that comes first
};

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

/// What is left of a file that was misread, with the wrong column for the time or the wrong decimal sign,
/// looks like data.
/// @throws std::invalid_argument if more lines are left out than kept.
void require_most_lines(const Imported& imported, const std::string& name) {
  const std::vector<std::size_t>& bad = imported.bad_lines;
  const std::vector<std::size_t>& misplaced = imported.misplaced_lines;
  const std::size_t lost = bad.size() + misplaced.size();
  const std::size_t kept = imported.recording.time.size();
  if (lost <= kept) return;
  const std::size_t first = std::min(bad.empty() ? misplaced.front() : bad.front(),
                                     misplaced.empty() ? bad.front() : misplaced.front());
  throw std::invalid_argument(fmt::format(
      "{}:{}: the first of {} lines in {} that would be left out: {} are not data, and of {} the time "
      "repeats, "
      "goes back or is not finite; expected fewer than are kept: are columns and decimal sign right? If its "
      "clock restarts or is coarse, map no time and give --rate HZ",
      name, first, lost, lost + kept, bad.size(), misplaced.size()));
}

void report_irregular_lines(Imported& imported) {
  auto& events = imported.recording.events;
  if (!imported.bad_lines.empty()) {
    const std::string text =
        fmt::format("{} lines are not data: {}", imported.bad_lines.size(), named_lines(imported.bad_lines));
    imported.warnings.push_back(text);
    events.push_back({.time_s = 0.0, .kind = "bad_lines", .text = text});
  }
  if (!imported.misplaced_lines.empty()) {
    const std::string text =
        fmt::format("{} lines are left out, whose time repeats, goes back or is not finite: {}",
                    imported.misplaced_lines.size(), named_lines(imported.misplaced_lines));
    imported.warnings.push_back(text);
    events.push_back({.time_s = 0.0, .kind = "misplaced_lines", .text = text});
    if (imported.misplaced_lines.size() * 10 > imported.recording.rows()) {
      imported.warnings.emplace_back(
          "that is much of the file; if its clock restarts or is coarse, map no time and give --rate HZ");
    }
  }
}

/// By the length of the lines in the middle. A row takes its mapped columns, the velocity, tick and flags.
void require_memory_for_rows(const std::filesystem::path& file, std::string_view text, std::size_t columns) {
  constexpr std::size_t further = 3;
  const std::string_view middle = text.substr(text.size() / 2, std::size_t{1} << 16U);
  const auto lines = static_cast<std::size_t>(std::count(middle.begin(), middle.end(), '\n')) + 1;
  const auto rows = static_cast<std::uintmax_t>(
      static_cast<double>(text.size()) / static_cast<double>(middle.size()) * static_cast<double>(lines));
  require_memory(file, rows * (columns + further) * sizeof(double), fmt::format("about {} rows", rows));
}

/// Stamps are moments: they have no unit, and say when, not how much.
/// @throws std::invalid_argument for stamps that are mapped to anything but the time, or with another unit.
void require_stamps_for_time(const Imported& imported, const std::string& name) {
  for (const MappedColumn& column : imported.columns) {
    if (!imported.layout.columns[column.index].stamps) continue;
    if (column.channel == "time" && column.unit.factor == 1.0) continue;
    throw std::invalid_argument(
        fmt::format("{}: column {} holds time stamps, mapped to {}[{}]; expected time={}, without a unit",
                    name, column.index + 1, column.channel, column.unit_text, column.index + 1));
  }
}

void take_time(Imported& imported, Rows& rows, const std::string& name, const ImportOptions& options) {
  auto& time = imported.recording.time;
  const MappedColumn* column = find_channel(imported.columns, "time");
  if (column != nullptr && options.rate_hz > 0.0)
    throw std::invalid_argument("--rate counts the time that --map takes from a column; give one of them");
  if (column == nullptr) {
    if (!(options.rate_hz > 0.0)) {
      throw std::invalid_argument(fmt::format(
          "{}: --map maps no time; map one, or give --rate HZ for samples at a uniform rate", name));
    }
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
  for (double& t : time) t = (t - start) * column->unit.factor;
}

double velocity_window(const ImportOptions& options, double period_s) {
  constexpr double usual_s = 0.02;
  if (options.velocity_window_s > 0.0) return options.velocity_window_s;
  return period_s > 0.0 ? std::clamp(usual_s, 4.0 * period_s, 400.0 * period_s) : usual_s;
}

void take_channels(Imported& imported, Rows& rows, const ImportOptions& options, double period_s) {
  schema::Recording& recording = imported.recording;
  for (std::size_t i = 0; i < imported.columns.size(); ++i) {
    const MappedColumn& column = imported.columns[i];
    if (column.channel == "time") continue;
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
  if (recording.velocity.empty()) {
    const double window_s = velocity_window(options, period_s);
    recording.velocity = differentiate(recording.time, recording.position, window_s);
    recording.header.velocity_derived =
        fmt::format("slope of a parabola fitted to the positions within {:.4g} s, zero phase", window_s);
  }
}

}  // namespace

Imported import_text(const std::filesystem::path& file, const ImportOptions& options) {
  const FileText mapped(file, {.max_bytes = options.max_bytes, .sheet = options.sheet});
  const std::string& name = mapped.name();
  Imported imported;
  imported.warnings = mapped.notes();
  imported.layout = find_layout(mapped.text(), name);
  imported.columns = match_columns(options.map, imported.layout, name);
  require_stamps_for_time(imported, name);

  require_memory_for_rows(file, mapped.text(), imported.columns.size());
  std::vector<std::size_t> indices;
  for (const MappedColumn& column : imported.columns) indices.push_back(column.index);
  const auto begin = std::chrono::steady_clock::now();
  TextTable table;
  options.progress("importing", mapped.text().size(), [&](std::atomic<std::size_t>& done) {
    table = parse_table(mapped.text(), imported.layout, indices, done);
  });
  Rows rows(std::move(table), imported.columns);
  imported.parse_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  auto hash = std::async(std::launch::async, [&] { return sha256_of(mapped.bytes()); });
  imported.bad_lines = rows.bad_lines();
  if (rows.size() == 0) {
    throw std::invalid_argument(
        fmt::format("{}: no line has a number in every mapped column; its columns are\n{}", name,
                    describe_columns(imported.layout, mapped.text())));
  }
  if (options.strict && !imported.bad_lines.empty()) {
    throw std::invalid_argument(
        fmt::format("{}: {} lines are not data: {}; without --strict they are left out", name,
                    imported.bad_lines.size(), named_lines(imported.bad_lines)));
  }

  rows.require_finite(imported.columns, name);
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
  const double period_s = median_period(recording.time);
  take_channels(imported, rows, options, period_s);
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

  const schema::Header found = std::exchange(recording.header, schema::new_header(software()));
  recording.header.velocity_derived = found.velocity_derived;
  recording.header.start_ns = found.start_ns;
  recording.header.start_clock = found.start_clock;
  recording.header.source = fmt::format("{} sha256:{}", file.filename().string(), hash.get());
  add_history(
      recording.header,
      fmt::format("import: {} rows of {}{}{}", recording.rows(), file.filename().string(),
                  options.stretch > 0 ? fmt::format(", stretch {}", options.stretch) : std::string(),
                  options.resample_hz > 0.0 ? fmt::format(", resampled to {:g} Hz", options.resample_hz)
                                            : std::string()));
  return imported;
}

std::string explain_columns(const std::filesystem::path& file, const ImportOptions& options) {
  const FileText mapped(file, {.max_bytes = options.max_bytes, .sheet = options.sheet});
  const TextLayout layout = find_layout(mapped.text(), mapped.name());
  return fmt::format("its columns are\n{}\nfor example {}", describe_columns(layout, mapped.text()),
                     suggest_map(layout));
}

}  // namespace kerf::bench
