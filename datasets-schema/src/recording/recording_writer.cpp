#include <algorithm>
#include <exception>
#include <limits>
#include <stdexcept>
#include <system_error>
#include <type_traits>
#include <utility>
#include <variant>

#include <kerf/schema/recording_writer.h>

#include "hdf5/files.h"
#include "names/new_name.h"
#include "recording/build.h"

namespace kerf::schema {
namespace {

constexpr double missing_double = std::numeric_limits<double>::quiet_NaN();
constexpr float missing_float = std::numeric_limits<float>::quiet_NaN();

constexpr std::size_t room_for_status = 65536;

struct Column {
  const layout::Dataset* rule;
  h5::Handle dataset;
};

std::vector<double> values_of(std::span<const Row> rows, std::array<double, max_axes> Row::*member,
                              std::size_t width) {
  std::vector<double> values;
  values.reserve(rows.size() * width);
  for (const auto& row : rows) {
    const auto first = (row.*member).begin();
    values.insert(values.end(), first, first + static_cast<std::ptrdiff_t>(width));
  }
  return values;
}

template <typename T>
std::vector<T> values_of(std::span<const Row> rows, T Row::*member, std::size_t /*width*/) {
  std::vector<T> values;
  values.reserve(rows.size());
  for (const auto& row : rows) values.push_back(row.*member);
  return values;
}

void append_column(const Column& column, std::uint64_t rows_before, std::span<const Row> rows,
                   std::size_t width) {
  std::visit(
      [&](auto member) {
        if constexpr (!std::is_same_v<decltype(member), std::monostate>) {
          const auto values = values_of(rows, member, width);
          using T = typename decltype(values)::value_type;
          h5::append(column.dataset.id(), h5::native<T>(), rows_before, rows.size(), values.data());
        }
      },
      column.rule->row_member);
}

[[noreturn]] void refuse(const std::filesystem::path& partial) {
  throw std::invalid_argument(
      partial.string() +
      (is_marked(partial)
           ? ": is being recorded by another process; give another name, or stop that one"
           : ": exists already, from a recording that was not closed; 'kerf repair' closes it"));
}

void require_new(const std::filesystem::path& target, const std::filesystem::path& partial, bool replace) {
  if (!replace && std::filesystem::exists(target)) {
    throw std::invalid_argument(target.string() +
                                ": exists already; give another name, or --force to replace it");
  }
  if (std::filesystem::exists(partial)) refuse(partial);
}

void require_axes(const std::vector<Axis>& axes, const std::vector<Channel>& channels) {
  if (axes.empty() || axes.size() > max_axes) {
    throw std::invalid_argument("recording: found " + std::to_string(axes.size()) + " axes, expected 1 to " +
                                std::to_string(max_axes));
  }
  if (channels.size() > max_channels) {
    throw std::invalid_argument("recording: found " + std::to_string(channels.size()) +
                                " channels, expected at most " + std::to_string(max_channels));
  }
}

}  // namespace

struct RecordingWriter::Implementation {
  Implementation(std::filesystem::path final_name, Header recording_header, std::vector<Axis> recording_axes,
                 const Options& writer_options)
      : target(std::move(final_name)),
        partial(partial_name(target)),
        path(unfinished_name(partial)),
        header(std::move(recording_header)),
        axes(std::move(recording_axes)),
        options(writer_options) {
    require_axes(axes, options.channels);
    require_new(target, partial, options.replace);
    header.status = "recording";
    options.chunk_rows = std::max<std::size_t>(options.chunk_rows, 1);
    pending.reserve(options.chunk_rows);
    try {
      create();
    } catch (...) {
      release();
      remove_partial();
      throw;
    }
  }

  ~Implementation() {
    if (closed) return;
    try {
      flush();
    } catch (...) {
      failure = std::current_exception();  // As after a crash: the rows up to the last flush are there.
    }
    release();
    if (rows == 0) remove_partial();
  }

  Implementation(const Implementation&) = delete;
  Implementation& operator=(const Implementation&) = delete;

  void create() {
    std::error_code none;
    std::filesystem::remove(path, none);  // of a process of the same number that was killed here
    guarded([&] {
      file = h5::WritableFile::create(path, h5::WritableFile::Format::live_readers);
      const Sources sources{header, axes};
      write_head(file.id(), sources);
      for (const auto& rule : layout::datasets()) {
        if (!std::holds_alternative<std::monostate>(rule.row_member)) create_column(rule, sources);
      }
      if (!options.channels.empty()) {
        static_cast<void>(h5::create_group(file.id(), std::string(layout::channels)));
      }
      for (const auto& channel : options.channels) {
        channels.push_back(make_channel(
            file.id(), channel, {.extent = {0}, .chunk_rows = options.chunk_rows, .fill = &missing_double}));
        attach_time(channels.back(), columns.front().dataset);
      }
      const auto type = h5::packed(event_type({}));
      events = make_dataset(file.id(), layout::dataset("/events"), type.id(), sources,
                            {.extent = {0}, .chunk_rows = 64});
      file.start_live();
      mark = WriteMark(path);
    });
    // From here on it can be read, whenever its writer is killed. Before, it would be a damaged file.
    if (!rename_new(path, partial)) refuse(partial);
    path = partial;
  }

  void create_column(const layout::Dataset& rule, const Sources& sources) {
    if (rule.path == "/samples/force_measured" && !options.measures_force) return;
    h5::DatasetOptions shape{.extent = {0}, .chunk_rows = options.chunk_rows};
    if (rule.shape == "ND") shape.extent.push_back(axes.size());
    hid_t type = h5::native<double>();
    if (rule.type == "float64") {
      shape.fill = &missing_double;
    } else if (rule.type == "float32") {
      type = h5::native<float>();
      shape.fill = &missing_float;
    } else {
      type = rule.type == "uint64" ? h5::native<std::uint64_t>() : h5::native<std::uint32_t>();
    }
    columns.push_back({&rule, make_dataset(file.id(), rule, type, sources, shape)});
    if (columns.size() == 1) {
      h5::make_scale(columns.front().dataset.id(), "time");
    } else {
      attach_time(columns.back().dataset, columns.front().dataset);
    }
  }

  /// Runs what writes; after a failure nothing more is written, so that what is in the file stays readable.
  template <typename Action>
  void guarded(Action action) {
    if (closed) throw std::logic_error(target.string() + ": the recording was closed before");
    if (failure) std::rethrow_exception(failure);
    try {
      action();
      file.check();
    } catch (const h5::Error& error) {
      failure = std::make_exception_ptr(write_error(path, file.cause_of(error)));
      std::rethrow_exception(failure);
    } catch (const std::system_error&) {
      failure = std::current_exception();
      throw;
    }
  }

  // `time` comes last, so that a reader who sees a row there finds it in every other dataset.
  void write_pending() {
    if (pending.empty()) return;
    for (std::size_t at = 0; at < channels.size(); ++at) {
      std::vector<double> values;
      values.reserve(pending.size());
      for (const auto& row : pending) values.push_back(row.channels[at]);
      h5::append(channels[at].id(), h5::native<double>(), rows - pending.size(), values.size(),
                 values.data());
    }
    for (auto column = columns.rbegin(); column != columns.rend(); ++column) {
      append_column(*column, rows - pending.size(), pending, axes.size());
    }
    pending.clear();
  }

  void flush() {
    guarded([&] {
      write_pending();
      h5::flush(events.id());
      for (const auto& channel : channels) h5::flush(channel.id());
      for (auto column = columns.rbegin(); column != columns.rend(); ++column) {
        h5::flush(column->dataset.id());
      }
    });
  }

  void release() {
    columns.clear();
    channels.clear();
    events = {};
    file = {};
  }

  void remove_partial() const {
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
  }

  void finish(const std::string& status, const Properties& device) {
    guarded([&] {
      columns.clear();
      channels.clear();
      events.close();
      file.close();
      // A text of variable length cannot be changed while others follow the file. Changed in place, the file
      // would not survive a disk that is full halfway.
      reserve(path, room_for_status);
      file = h5::WritableFile::open(path);
      const auto root = h5::open(file.id(), "/");
      h5::delete_attribute(root.id(), "status");
      h5::write_attribute(root.id(), "status", status);
      if (!device.empty()) add_to_origin(file.id(), "/device", device);
    });
    guarded([&] { file.close(); });
  }

  std::filesystem::path target;
  std::filesystem::path partial;
  std::filesystem::path path;
  Header header;
  std::vector<Axis> axes;
  Options options;
  h5::WritableFile file;
  WriteMark mark;
  std::vector<Column> columns;  ///< `time` first
  std::vector<h5::Handle> channels;
  h5::Handle events;
  std::vector<Row> pending;
  std::uint64_t rows = 0;
  std::uint64_t event_rows = 0;
  bool closed = false;
  bool has_durable_name = false;  ///< the folder that names the partial file is on the disk
  std::exception_ptr failure;     ///< the first; nothing is written after it
};

RecordingWriter::RecordingWriter(std::filesystem::path file, Header header, std::vector<Axis> axes,
                                 const Options& options)
    : implementation_(
          std::make_unique<Implementation>(std::move(file), std::move(header), std::move(axes), options)) {}

RecordingWriter::RecordingWriter(RecordingWriter&&) noexcept = default;
RecordingWriter& RecordingWriter::operator=(RecordingWriter&&) noexcept = default;
RecordingWriter::~RecordingWriter() = default;

void RecordingWriter::append(std::span<const Row> rows) {
  auto& self = *implementation_;
  self.guarded([&] {
    while (!rows.empty()) {
      const auto count = std::min(rows.size(), self.options.chunk_rows - self.pending.size());
      const auto next = rows.first(count);
      self.pending.insert(self.pending.end(), next.begin(), next.end());
      self.rows += count;
      rows = rows.subspan(count);
      if (self.pending.size() == self.options.chunk_rows) self.write_pending();
    }
  });
}

void RecordingWriter::append_event(const Event& event) {
  auto& self = *implementation_;
  self.guarded([&] {
    const TextRoom room;
    h5::append(self.events.id(), event_type(room).id(), self.event_rows, 1, pack({&event, 1}, room).data());
    ++self.event_rows;
  });
}

void RecordingWriter::flush() { implementation_->flush(); }

void RecordingWriter::synchronise() {
  auto& self = *implementation_;
  self.guarded([&] {
    synchronise_data(self.path);
    if (!std::exchange(self.has_durable_name, true)) schema::synchronise(folder_of(self.path));
  });
}

void RecordingWriter::close(std::string_view status, const Properties& device) {
  auto& self = *implementation_;
  if (status != "complete" && !status.starts_with("aborted: ")) {
    throw std::invalid_argument("recording: found the status '" + std::string(status) +
                                "', expected 'complete' or 'aborted: WHY'");
  }
  for (const auto& property : device) check_property("/device", property.first);
  self.flush();
  self.finish(std::string(status), device);
  schema::synchronise(self.path);
  self.closed = true;
  try {
    take_name(self.path, self.target, existing_if(self.options.replace));
    self.path = self.target;
  } catch (const NameTaken& taken) {
    self.path = taken.kept();
    throw;
  }
  schema::synchronise(folder_of(self.target));
  self.mark = {};
}

std::uint64_t RecordingWriter::rows() const noexcept { return implementation_->rows; }

const std::filesystem::path& RecordingWriter::path() const noexcept { return implementation_->path; }

}  // namespace kerf::schema
