#include "views/recording_view.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include "views/recording_inspection.h"

namespace kerf::bench {
namespace {

using schema::Column;

/// Columns of fewer rows are made from the rows themselves.
constexpr std::uint64_t near_rows = 2 * bucket;
constexpr const char* index_name = "rows";

/// The numbers in a part of the cache; none if they do not fit.
template <typename Number>
std::span<const Number> numbers_in(const ViewCache::Part& part) {
  if (part.bytes.size() % sizeof(Number) != 0) return {};
  return {reinterpret_cast<const Number*>(part.bytes.data()), part.bytes.size() / sizeof(Number)};
}

schema::RecordingFile::Texts trust_in(const std::optional<ViewCache::Part>& kept, bool is_waited_for) {
  using Texts = schema::RecordingFile::Texts;
  if (kept) return Texts::known_to_be_sound;
  return is_waited_for ? Texts::looked_through : Texts::looked_through_later;
}

/// Columns of whole buckets, as equal as they can be.
std::vector<std::uint64_t> wide_boundaries(std::uint64_t first, std::uint64_t end, std::size_t columns,
                                           std::uint64_t rows) {
  auto boundaries = column_boundaries(first / bucket, (end + bucket - 1) / bucket, columns);
  for (std::uint64_t& boundary : boundaries) boundary = std::min(boundary * bucket, rows);
  return boundaries;
}

double rows_per_column(const std::vector<std::uint64_t>& boundaries) {
  if (boundaries.size() < 2) return 1.0;
  return static_cast<double>(boundaries.back() - boundaries.front()) /
         static_cast<double>(boundaries.size() - 1);
}

void append(const TraceView::Extremes& more, TraceView::Extremes& to) {
  to.smallest.insert(to.smallest.end(), more.smallest.begin(), more.smallest.end());
  to.largest.insert(to.largest.end(), more.largest.begin(), more.largest.end());
}

}  // namespace

RecordingView::RecordingView(const std::filesystem::path& file, const ViewCache& cache,
                             const WaitedFor& at_most)
    : path_(file),
      facts_(FileFacts::of(file)),
      cache_(cache),
      kept_rows_(cache.find(facts_, index_name)),
      texts_(trust_in(kept_rows_, facts_.size <= at_most.bytes)),
      file_(file, texts_),
      sources_(row_sources(file_)),
      is_waited_for_(file_.rows() <= at_most.rows) {
  // What is still written is another file the next time.
  if (file_.is_live()) cache_ = ViewCache({});
  list_traces();
  pyramids_.resize(sources_.size());
  rows_ = kept_index();
  if (!is_waited_for_) {
    prepare_beside();
  } else if (!rows_) {
    rows_ = RowIndex::of(file_);
    keep_index();
  }
}

const RowIndex* RecordingView::rows() const {
  const std::lock_guard lock(mutex_);
  return rows_ ? &*rows_ : nullptr;
}

void RecordingView::list_traces() {
  for (std::size_t axis = 0; axis < file_.about().axes.size(); ++axis) add_axis_traces(axis);
  for (std::size_t at = 0; at < sources_.size(); ++at) {
    const std::string& name = sources_[at].name;
    const bool is_timing = name.ends_with("_time") || name == "wake_latency";
    if (!is_timing) continue;
    traces_.push_back({.name = name, .unit = "s", .group = "timing"});
    places_.push_back({.source = at, .column = 0});
  }
  const auto& channels = file_.about().channels;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    traces_.push_back({.name = channels[i].name, .unit = channels[i].unit, .group = "channel"});
    places_.push_back({.source = sources_.size() - channels.size() + i, .column = 0});
  }
}

void RecordingView::add_axis_traces(std::size_t axis) {
  const schema::Axis& about = file_.about().axes[axis];
  for (std::size_t at = 0; at < sources_.size(); ++at) {
    const std::string& name = sources_[at].name;
    Trace trace{.name = fmt::format("{} {}", name, about.name), .unit = about.position_unit, .group = name};
    if (name == "velocity") trace.unit += "/s";
    if (name.starts_with("force_")) {
      trace.unit = about.force_unit;
      trace.group = "force";
    } else if (name != "position" && name != "velocity") {
      return;
    }
    traces_.push_back(std::move(trace));
    places_.push_back({.source = at, .column = axis});
  }
}

std::optional<RowIndex> RecordingView::kept_index() const {
  if (!kept_rows_ || kept_rows_->uuid != file_.about().header.uuid || kept_rows_->rows != file_.rows())
    return std::nullopt;
  try {
    return RowIndex(file_.rows(), numbers_in<double>(*kept_rows_), kept_rows_->owner);
  } catch (const std::invalid_argument&) {
    return std::nullopt;  // it is made anew
  }
}

/// Which says that its texts are sound, too. @throws FormatError if they are not.
void RecordingView::keep_index() const {
  using Texts = schema::RecordingFile::Texts;
  if (texts_ == Texts::looked_through_later) (void)schema::RecordingFile(path_, Texts::looked_through);
  cache_.keep(facts_, index_name,
              {.uuid = file_.about().header.uuid,
               .rows = file_.rows(),
               .bytes = std::as_bytes(rows_->numbers()),
               .owner = {}});
}

void RecordingView::prepare_beside() {
  std::uint64_t passes = rows_ ? 0 : 1;
  for (std::size_t at = 0; at < sources_.size(); ++at) {
    if (auto kept = kept_pyramids(sources_[at])) {
      take_pyramids(at, std::move(*kept));
    } else {
      ++passes;
    }
  }
  if (passes > 0) preparation_.start(passes * file_.rows(), [this](const auto& go_on) { prepare(go_on); });
}

/// On its own thread: nobody else adds to what it looks at without the lock.
void RecordingView::prepare(const RowPreparation::GoOn& go_on) {
  const bool is_new = !rows_;
  if (is_new) {
    RowIndex built = RowIndex::of(file_, go_on);
    const std::lock_guard lock(mutex_);
    rows_ = std::move(built);
  }
  for (std::size_t at = 0; at < sources_.size(); ++at) {
    if (pyramids_[at]) continue;
    Pyramids built = built_pyramids(sources_[at], go_on);
    const std::lock_guard lock(mutex_);
    take_pyramids(at, std::move(built));
  }
  if (is_new) keep_index();  // when the file has been read, which to look through it takes as long as
}

std::optional<Pyramids> RecordingView::kept_pyramids(const RowSource& source) const {
  const auto kept = cache_.find(facts_, source.name);
  if (!kept || kept->uuid != file_.about().header.uuid || kept->rows != file_.rows()) return std::nullopt;
  try {
    return Pyramids(file_.rows(), source.width, numbers_in<float>(*kept), kept->owner);
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
}

/// Also keeps them.
Pyramids RecordingView::built_pyramids(const RowSource& source, const RowPreparation::GoOn& go_on) const {
  PyramidBuilder builder(file_.rows(), source.width);
  std::vector<double> block;
  for (std::uint64_t first = 0; first < file_.rows(); first += PyramidBuilder::rows_at_once) {
    const auto rows = std::min<std::uint64_t>(PyramidBuilder::rows_at_once, file_.rows() - first);
    block.resize(static_cast<std::size_t>(rows) * source.width);
    source.read(first, block);
    builder.add(block);
    if (go_on) go_on(rows);
  }
  Pyramids built = std::move(builder).finish();
  cache_.keep(facts_, source.name,
              {.uuid = file_.about().header.uuid,
               .rows = file_.rows(),
               .bytes = std::as_bytes(built.numbers()),
               .owner = {}});
  // Of a kept one only what is looked at has to be in memory.
  auto kept = kept_pyramids(source);
  return kept ? std::move(*kept) : std::move(built);
}

void RecordingView::take_pyramids(std::size_t at, Pyramids pyramids) {
  bytes_ += pyramids.numbers().size_bytes();
  pyramids_[at] = std::move(pyramids);
}

const Pyramids& RecordingView::pyramids_of(std::size_t at) {
  auto& pyramids = pyramids_[at];
  if (!pyramids) {
    auto kept = kept_pyramids(sources_[at]);
    take_pyramids(at, kept ? std::move(*kept) : built_pyramids(sources_[at], {}));
  }
  return *pyramids;
}

bool RecordingView::are_prepared(std::span<const std::size_t> traces) const {
  return rows_ && std::ranges::all_of(traces, [&](std::size_t trace) {
           return is_waited_for_ || pyramids_[places_[trace].source];
         });
}

/// The first row at that time or later. Without an index, of times that do not go back.
std::uint64_t RecordingView::row_at(double time_s) const {
  const auto read_times = [this](std::uint64_t first, std::span<double> times_s) {
    file_.read(Column::time, first, times_s.size(), times_s);
  };
  if (rows_) return rows_->row_at(time_s, read_times);
  std::uint64_t first = 0;
  for (std::uint64_t end = file_.rows(); first < end;) {
    const std::uint64_t middle = first + (end - first) / 2;
    double at_s = 0.0;
    read_times(middle, {&at_s, 1});
    if (at_s < time_s) {
      first = middle + 1;
    } else {
      end = middle;
    }
  }
  return first;
}

const std::string& RecordingView::inspection() {
  const std::lock_guard lock(mutex_);
  if (inspection_.empty()) inspection_ = recording_inspection_json(file_);
  return inspection_;
}

const AxisCycles& RecordingView::cycles_along(std::size_t axis) {
  const std::lock_guard lock(mutex_);
  const auto found = cycles_.find(axis);
  return found != cycles_.end() ? found->second
                                : cycles_.emplace(axis, axis_cycles(file_, axis)).first->second;
}

TraceView RecordingView::view(std::span<const std::size_t> traces, double from_s, double to_s,
                              std::size_t columns) {
  for (const std::size_t trace : traces) {
    if (trace >= traces_.size()) {
      throw std::out_of_range(
          fmt::format("there are {} traces, there is no trace {}", traces_.size(), trace));
    }
  }
  TraceView nothing;
  nothing.traces.resize(traces.size());
  if (file_.rows() == 0 || columns == 0 || !(from_s <= to_s)) return nothing;
  if (to_s < file_.first_time_s()) return nothing;
  const RowPreparation::Request request(preparation_);
  preparation_.rethrow_failure();
  const std::lock_guard lock(mutex_);
  const double prepared = preparation_.done();  // before what it is said of
  std::uint64_t first = row_at(from_s);
  if (first == file_.rows()) return nothing;
  const std::uint64_t end = std::min(row_at(to_s) + 1, file_.rows());
  if (first > 0) --first;
  const bool is_near = end - first < near_rows * columns;
  const bool is_exact = is_near ? rows_.has_value() : are_prepared(traces);
  TraceView view = is_near    ? view_from_near(traces, first, end, columns)
                   : is_exact ? view_from_afar(traces, first, end, columns)
                              : view_of_some_rows(traces, first, end, columns);
  view.prepared = is_exact ? 1.0 : prepared;
  return view;
}

TraceView RecordingView::view_from_afar(std::span<const std::size_t> traces, std::uint64_t first,
                                        std::uint64_t end, std::size_t columns) {
  const auto boundaries = wide_boundaries(first, end, columns, file_.rows());
  TraceView view;
  view.rows_per_column = rows_per_column(boundaries);
  for (std::size_t i = 0; i + 1 < boundaries.size(); ++i) {
    view.time_s.push_back(rows_->time_of_bucket(boundaries[i]));
  }
  for (const std::size_t trace : traces) {
    const MinMaxPyramid& pyramid = pyramids_of(places_[trace].source)[places_[trace].column];
    view.traces.push_back(pyramid.view(boundaries, {}));  // boundaries of buckets: nothing to read
  }
  return view;
}

TraceView RecordingView::view_from_near(std::span<const std::size_t> traces, std::uint64_t first,
                                        std::uint64_t end, std::size_t columns) const {
  const auto boundaries = column_boundaries(first, end, columns);
  TraceView view;
  view.rows_per_column = rows_per_column(boundaries);
  view.traces.resize(traces.size());
  std::vector<std::size_t> by_source(traces.size());  // so that each is read once
  std::iota(by_source.begin(), by_source.end(), std::size_t{0});
  std::stable_sort(by_source.begin(), by_source.end(), [&](std::size_t a, std::size_t b) {
    return places_[traces[a]].source < places_[traces[b]].source;
  });
  std::vector<double> rows;
  // So many columns at a time that their rows stay in the processor's cache.
  constexpr std::size_t columns_at_once = 8192 / near_rows;
  for (std::size_t at = 0; at + 1 < boundaries.size(); at += columns_at_once) {
    const auto some =
        std::span(boundaries).subspan(at, std::min(columns_at_once + 1, boundaries.size() - at));
    const auto count = static_cast<std::size_t>(some.back() - some.front());
    rows.resize(count);
    file_.read(Column::time, some.front(), count, rows);
    for (std::size_t i = 0; i + 1 < some.size(); ++i) view.time_s.push_back(rows[some[i] - some.front()]);
    std::optional<std::size_t> in_rows;  // the source that was read last
    for (const std::size_t i : by_source) {
      const Place& place = places_[traces[i]];
      const RowSource& source = sources_[place.source];
      if (in_rows != place.source) {
        rows.resize(count * source.width);
        source.read(some.front(), rows);
        in_rows = place.source;
      }
      append(extremes_of_rows(rows, source.width, place.column, some.front(), some), view.traces[i]);
    }
  }
  return view;
}

TraceView RecordingView::view_of_some_rows(std::span<const std::size_t> traces, std::uint64_t first,
                                           std::uint64_t end, std::size_t columns) const {
  const auto boundaries = wide_boundaries(first, end, columns, file_.rows());
  TraceView view;
  view.rows_per_column = rows_per_column(boundaries);
  view.rows_looked_at = bucket;
  view.traces.resize(traces.size());
  std::vector<std::vector<double>> rows(sources_.size());  // of the column that is being looked at
  for (std::size_t i = 0; i + 1 < boundaries.size(); ++i) {
    // The first of a column, so that its time is theirs.
    const std::array some{boundaries[i], std::min(boundaries[i] + bucket, boundaries[i + 1])};
    const auto count = static_cast<std::size_t>(some[1] - some[0]);
    double time_s = 0.0;
    file_.read(Column::time, some[0], 1, {&time_s, 1});
    view.time_s.push_back(time_s);
    for (auto& of_source : rows) of_source.clear();
    for (std::size_t k = 0; k < traces.size(); ++k) {
      const Place& place = places_[traces[k]];
      const RowSource& source = sources_[place.source];
      auto& values = rows[place.source];
      if (values.empty()) {
        values.resize(count * source.width);
        source.read(some[0], values);
      }
      append(extremes_of_rows(values, source.width, place.column, some[0], some), view.traces[k]);
    }
  }
  return view;
}

}  // namespace kerf::bench
