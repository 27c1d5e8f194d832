#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/schema/recording_file.h>

#include "views/hysteresis_loops.h"
#include "views/rows/pyramid.h"
#include "views/rows/row_index.h"
#include "views/rows/row_preparation.h"
#include "views/rows/view_cache.h"
#include "views/trace_view.h"

namespace kerf::bench {

/// Columns of a recording that are read together: the axes of a dataset, a stage's times, a channel.
struct RowSource {
  std::string name;
  std::size_t width = 1;
  /// Rows from `first_row` on, so many as `values` has room for.
  std::function<void(std::uint64_t first_row, std::span<double> values)> read;
};

/// What can be read of a recording, in the order of its traces.
[[nodiscard]] std::vector<RowSource> row_sources(const schema::RecordingFile& file);

/// A recording of any length, to be looked at. Seen from afar, its extremes come from pyramids, which are
/// made the first time that a trace of their dataset is asked for; from near, from the rows themselves.
///
/// Two lengths of time bound the work: an hour of 6 axes at 1 kHz (3.6 million rows) is opened and seen as a
/// whole in less than a second; any stretch of it in a few milliseconds. The rows of a longer one are gone
/// through beside that, and until then a stretch seen from afar is of some rows of each column, and says so.
/// May be used by several threads, which wait for one another.
class RecordingView {
 public:
  /// What is waited for when a recording is opened: of more rows nobody waits until all have been gone
  /// through, of a larger file until its texts have been looked through.
  struct WaitedFor {
    std::uint64_t rows = 8'000'000;
    std::uint64_t bytes = std::uint64_t{1} << 30U;
  };

  /// @throws as schema::RecordingFile.
  RecordingView(const std::filesystem::path& file, const ViewCache& cache, const WaitedFor& at_most);
  RecordingView(const std::filesystem::path& file, const ViewCache& cache)
      : RecordingView(file, cache, WaitedFor{}) {}

  [[nodiscard]] const schema::RecordingFile& file() const noexcept { return file_; }
  /// What the file was when it was opened.
  [[nodiscard]] const FileFacts& facts() const noexcept { return facts_; }
  /// Null while its rows are being gone through.
  [[nodiscard]] const RowIndex* rows() const;
  /// How much of that is done; 1: all.
  [[nodiscard]] double prepared() const noexcept { return preparation_.done(); }
  /// As long as what is returned lives, no more of it is done.
  [[nodiscard]] RowPreparation::Request pause() { return RowPreparation::Request(preparation_); }

  /// Of each axis position, velocity and forces ("position theta"), then the times of the stages of a tick
  /// and their sum without the wait (cycle_time), then the channels by their names.
  [[nodiscard]] const std::vector<Trace>& traces() const noexcept { return traces_; }

  /// The rows from the last one at or before `from_s` to the first one at or after `to_s`, in at most so many
  /// columns and never more than one a row. Wide columns begin and end with buckets, so that all their rows,
  /// and those of no other column, are in their extremes.
  /// @throws std::out_of_range for a trace that is not there; FormatError where the file is damaged.
  [[nodiscard]] TraceView view(std::span<const std::size_t> traces, double from_s, double to_s,
                               std::size_t columns);

  /// The cycles along an axis; sought once if the recording was not segmented. @throws FormatError.
  [[nodiscard]] const AxisCycles& cycles_along(std::size_t axis);

  /// What it is worth, as recording_inspection_json() has it; looked at once. @throws FormatError.
  [[nodiscard]] const std::string& inspection();

  /// Memory that the pyramids take.
  [[nodiscard]] std::size_t bytes() const noexcept { return bytes_; }

 private:
  struct Place {
    std::size_t source = 0;
    std::size_t column = 0;
  };

  void list_traces();
  void add_axis_traces(std::size_t axis);
  [[nodiscard]] std::optional<RowIndex> kept_index() const;
  void keep_index() const;
  void prepare_beside();
  void prepare(const RowPreparation::GoOn& go_on);
  [[nodiscard]] std::optional<Pyramids> kept_pyramids(const RowSource& source) const;
  [[nodiscard]] Pyramids built_pyramids(const RowSource& source, const RowPreparation::GoOn& go_on) const;
  void take_pyramids(std::size_t source, Pyramids pyramids);
  const Pyramids& pyramids_of(std::size_t source);
  [[nodiscard]] bool are_prepared(std::span<const std::size_t> traces) const;
  [[nodiscard]] std::uint64_t row_at(double time_s) const;
  TraceView view_from_afar(std::span<const std::size_t> traces, std::uint64_t first, std::uint64_t end,
                           std::size_t columns);
  [[nodiscard]] TraceView view_from_near(std::span<const std::size_t> traces, std::uint64_t first,
                                         std::uint64_t end, std::size_t columns) const;
  [[nodiscard]] TraceView view_of_some_rows(std::span<const std::size_t> traces, std::uint64_t first,
                                            std::uint64_t end, std::size_t columns) const;

  std::filesystem::path path_;
  FileFacts facts_;
  ViewCache cache_;
  std::optional<ViewCache::Part> kept_rows_;  ///< tells that the file was sound when it was opened before
  schema::RecordingFile::Texts texts_;
  schema::RecordingFile file_;
  std::vector<RowSource> sources_;
  std::vector<Trace> traces_;
  std::vector<Place> places_;  ///< of each trace
  bool is_waited_for_;         ///< its rows are gone through when they are asked for
  mutable std::mutex mutex_;   ///< of all below
  std::optional<RowIndex> rows_;
  std::map<std::size_t, AxisCycles> cycles_;
  std::string inspection_;                         ///< empty: nobody has asked
  std::vector<std::optional<Pyramids>> pyramids_;  ///< of each source
  std::atomic<std::size_t> bytes_ = 0;
  RowPreparation preparation_;  ///< ends before what it works on
};

}  // namespace kerf::bench
