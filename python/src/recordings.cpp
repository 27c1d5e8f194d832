#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include <kerf/schema/recording_file.h>

#include "convert/recording_columns.h"
#include "module.h"

namespace kerf::python {
namespace {

using schema::Column;

struct Dataset {
  std::string_view name;
  Column column;
};
/// With a number an axis a row.
constexpr std::array by_axis{Dataset{"position", Column::position}, Dataset{"velocity", Column::velocity},
                             Dataset{"force_commanded", Column::force_commanded},
                             Dataset{"force_measured", Column::force_measured}};
/// The parts of a tick, in single precision.
constexpr std::array timings{
    Dataset{"wake_latency", Column::wake_latency}, Dataset{"read_time", Column::read_time},
    Dataset{"compute_time", Column::compute_time}, Dataset{"write_time", Column::write_time}};

template <std::size_t Count>
std::optional<Column> column_of(const std::array<Dataset, Count>& datasets, std::string_view name) {
  for (const auto& [known, column] : datasets)
    if (known == name) return column;
  return std::nullopt;
}

/// An open recording, whose rows are read by `kerf-reader`. A process that is forked off opens it anew: the
/// reader answers the one that started it.
class HeldRecording {
 public:
  explicit HeldRecording(std::filesystem::path file) : path_(std::filesystem::absolute(file)) { open(); }
  HeldRecording(const HeldRecording&) = delete;
  HeldRecording& operator=(const HeldRecording&) = delete;
  ~HeldRecording() { let_go(); }

  /// For as long as it may be used: one thread at a time.
  class Use {
   public:
    explicit Use(HeldRecording& of) : lock_(of.mutex_), of_(of) { of_.require_open(); }
    [[nodiscard]] const schema::RecordingFile& file() const { return *of_.file_; }

   private:
    std::scoped_lock<std::mutex> lock_;
    HeldRecording& of_;
  };

  void close() {
    const std::scoped_lock one_at_a_time(mutex_);
    let_go();
  }

 private:
  void let_go() noexcept {
    // The reader of another process is its own to end.
    if (opener_ != getpid()) static_cast<void>(file_.release());
    file_.reset();
    is_closed_ = true;
  }
  void open() {
    file_ = std::make_unique<schema::RecordingFile>(path_);
    opener_ = getpid();
  }
  void require_open() {
    if (is_closed_) throw std::invalid_argument(path_.string() + ": the recording is closed");
    if (opener_ == getpid()) return;
    const std::uint64_t rows = file_->rows();
    static_cast<void>(file_.release());
    open();
    if (file_->rows() < rows)
      throw std::invalid_argument(path_.string() +
                                  ": it has fewer rows than when it was opened; open it again");
  }

  std::filesystem::path path_;
  std::mutex mutex_;
  std::unique_ptr<schema::RecordingFile> file_;
  pid_t opener_ = 0;
  bool is_closed_ = false;
};

template <typename Number>
py::array_t<Number> rows_by(std::uint64_t count, std::size_t width = 0) {
  std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(count)};
  if (width > 0) shape.push_back(static_cast<py::ssize_t>(width));
  return py::array_t<Number>(shape);
}

/// Lets other threads run while the rows are read.
template <typename Number, typename Read>
py::array filled(HeldRecording& recording, py::array_t<Number> array, const Read& read) {
  const std::span<Number> values(array.mutable_data(), static_cast<std::size_t>(array.size()));
  {
    const py::gil_scoped_release others_may_run;
    const HeldRecording::Use use(recording);
    read(use.file(), values);
  }
  return array;
}

std::optional<std::size_t> channel_of(const schema::RecordingFile& file, std::string_view name) {
  constexpr std::string_view of_channels = "channel.";
  if (!name.starts_with(of_channels)) return std::nullopt;
  const auto& channels = file.about().channels;
  for (std::size_t i = 0; i < channels.size(); ++i)
    if (channels[i].name == name.substr(of_channels.size())) return i;
  return std::nullopt;
}

/// Rows of a dataset: (count,), or (count, axes) of what has a number an axis.
py::array read_rows(HeldRecording& recording, const std::string& name, std::uint64_t first,
                    std::uint64_t count) {
  if (const auto column = column_of(by_axis, name)) {
    const std::size_t width = HeldRecording::Use(recording).file().width(*column);
    if (width > 0)
      return filled(recording, rows_by<double>(count, width),
                    [&](const auto& file, auto values) { file.read(*column, first, count, values); });
  }
  if (const auto column = column_of(timings, name))
    return filled(recording, rows_by<float>(count),
                  [&](const auto& file, auto values) { file.read_timing(*column, first, values); });
  if (name == "time")
    return filled(recording, rows_by<double>(count),
                  [&](const auto& file, auto values) { file.read(Column::time, first, count, values); });
  if (name == "tick")
    return filled(recording, rows_by<std::uint64_t>(count),
                  [&](const auto& file, auto values) { file.read_ticks(first, values); });
  if (name == "flags")
    return filled(recording, rows_by<std::uint32_t>(count),
                  [&](const auto& file, auto values) { file.read_flags(first, values); });
  const auto channel = channel_of(HeldRecording::Use(recording).file(), name);
  if (!channel) throw py::key_error(name);
  return filled(recording, rows_by<double>(count),
                [&](const auto& file, auto values) { file.read_channel(*channel, first, values); });
}

py::dict properties_of(const schema::Properties& properties) {
  py::dict all;
  for (const auto& [name, value] : properties) {
    if (const double* const number = std::get_if<double>(&value))
      all[text_of(name)] = *number;
    else
      all[text_of(name)] = text_of(std::get<std::string>(value));
  }
  return all;
}

py::dict header_of(const schema::Header& header) {
  py::dict all;
  all["created"] = text_of(header.created);
  all["software"] = text_of(header.software);
  all["uuid"] = text_of(header.uuid);
  all["status"] = text_of(header.status);
  all["velocity_derived"] = text_of(header.velocity_derived);
  all["source"] = text_of(header.source);
  all["start_ns"] = header.start_ns ? py::cast(*header.start_ns) : py::none();
  all["start_clock"] = text_of(header.start_clock);
  all["history"] = text_of(header.history);
  all["device_uri"] = text_of(header.device_uri);
  all["device_toml"] = text_of(header.device_toml);
  all["scene_toml"] = text_of(header.scene_toml);
  all["device"] = properties_of(header.device_properties);
  all["scene"] = properties_of(header.scene_properties);
  return all;
}

Numbers array_of(const std::vector<double>& values) {
  return Numbers(static_cast<py::ssize_t>(values.size()), values.data());
}

/// Cycles x grid.
Numbers table_of(const std::vector<std::vector<double>>& rows, std::size_t width) {
  Numbers table = rows_by<double>(rows.size(), width);
  for (std::size_t row = 0; row < rows.size(); ++row)
    std::copy_n(rows[row].begin(), width, table.mutable_data(static_cast<py::ssize_t>(row)));
  return table;
}

py::object cycles_of(const schema::Recording& about) {
  if (!about.cycles) return py::none();
  const schema::Cycles& cycles = *about.cycles;
  py::list phases;
  for (const schema::PhaseSpan& one : cycles.phases)
    phases.append(py::make_tuple(one.cycle, static_cast<int>(one.phase), one.begin, one.end));
  py::dict all;
  all["axis"] = text_of(about.axes.at(cycles.axis).name);
  all["closing_direction"] = cycles.closing_direction;
  all["contact_position"] = cycles.contact_position;
  all["filter_corner_hz"] = cycles.filter_corner_hz;
  all["phases"] = phases;
  all["grid"] = array_of(cycles.grid);
  all["closing"] = table_of(cycles.closing, cycles.grid.size());
  all["opening"] = table_of(cycles.opening, cycles.grid.size());
  all["closing_mean"] = array_of(cycles.closing_mean);
  all["opening_mean"] = array_of(cycles.opening_mean);
  return all;
}

/// All that a recording says but its rows.
py::dict about_of(HeldRecording& recording) {
  const HeldRecording::Use use(recording);
  const schema::Recording& about = use.file().about();
  py::list axes;
  for (const schema::Axis& one : about.axes)
    axes.append(py::make_tuple(text_of(one.name), text_of(one.position_unit), text_of(one.force_unit),
                               one.lever, one.contact_position, one.contact_direction, one.contact_error));
  py::list events;
  for (const schema::Event& one : about.events)
    events.append(py::make_tuple(one.time_s, text_of(one.kind), text_of(one.text)));
  py::list columns;
  const bench::RecordingColumns named(use.file());
  for (const bench::RecordingColumn& one : named.columns())
    columns.append(py::make_tuple(text_of(one.quantity), text_of(one.part), text_of(one.name()),
                                  text_of(one.unit), text_of(one.meaning)));
  py::list cycle_flags;
  if (about.cycle_flags) {
    for (const schema::CycleFlag& one : about.cycle_flags->flags)
      cycle_flags.append(py::make_tuple(one.cycle, text_of(one.fault), text_of(one.reason)));
  }
  py::list cycle_edits;
  for (const schema::CycleChange& one : about.cycle_edits)
    cycle_edits.append(py::make_tuple(one.edit, one.cycle, static_cast<int>(one.phase), one.row_before,
                                      one.row_after, text_of(one.time), text_of(one.author),
                                      text_of(one.kind), text_of(one.text)));
  py::dict all;
  all["rows"] = use.file().rows();
  all["is_live"] = use.file().is_live();
  all["period_s"] = use.file().period_s();
  all["header"] = header_of(about.header);
  all["axes"] = axes;
  all["events"] = events;
  all["columns"] = columns;
  all["cycles"] = cycles_of(about);
  all["cycle_flags"] = cycle_flags;
  all["cycle_edits"] = cycle_edits;
  return all;
}

}  // namespace

void add_recordings(py::module_& module) {
  py::class_<HeldRecording>(module, "HeldRecording")
      .def(py::init([](const std::filesystem::path& file) {
        const py::gil_scoped_release others_may_run;
        return std::make_unique<HeldRecording>(file);
      }))
      .def("about", &about_of)
      .def("read", &read_rows)
      .def("close", &HeldRecording::close);
  py::list flags;
  for (const schema::FlagInfo& one : schema::flag_table)
    flags.append(py::make_tuple(std::string(one.name), static_cast<std::uint32_t>(one.flag),
                                std::string(one.meaning)));
  module.attr("flags") = flags;
}

}  // namespace kerf::python
