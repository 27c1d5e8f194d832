#include "views/recording_view.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>

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

schema::RecordingFile::Texts trust_in(const std::optional<ViewCache::Part>& kept) {
  using Texts = schema::RecordingFile::Texts;
  return kept ? Texts::known_to_be_sound : Texts::looked_through;
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

RecordingView::RecordingView(const std::filesystem::path& file, const ViewCache& cache)
    : facts_(FileFacts::of(file)),
      cache_(cache),
      kept_rows_(cache.find(facts_, index_name)),
      file_(file, trust_in(kept_rows_)),
      sources_(row_sources(file_)) {
  // What is still written is another file the next time.
  if (file_.is_live()) cache_ = ViewCache({});
  list_traces();
  pyramids_.resize(sources_.size());
  index_rows();
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

void RecordingView::index_rows() {
  const std::string& uuid = file_.about().header.uuid;
  if (kept_rows_ && kept_rows_->uuid == uuid && kept_rows_->rows == file_.rows()) {
    try {
      rows_.emplace(file_.rows(), numbers_in<double>(*kept_rows_), kept_rows_->owner);
      return;
    } catch (const std::invalid_argument&) {
      // It is made anew.
    }
  }
  rows_.emplace(RowIndex::of(file_));
  cache_.keep(facts_, index_name,
              {.uuid = uuid, .rows = file_.rows(), .bytes = std::as_bytes(rows_->numbers()), .owner = {}});
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

Pyramids RecordingView::built_pyramids(const RowSource& source) const {
  PyramidBuilder builder(file_.rows(), source.width);
  std::vector<double> block;
  for (std::uint64_t first = 0; first < file_.rows(); first += PyramidBuilder::rows_at_once) {
    const auto rows = std::min<std::uint64_t>(PyramidBuilder::rows_at_once, file_.rows() - first);
    block.resize(static_cast<std::size_t>(rows) * source.width);
    source.read(first, block);
    builder.add(block);
  }
  return std::move(builder).finish();
}

const Pyramids& RecordingView::pyramids_of(std::size_t at) {
  auto& pyramids = pyramids_[at];
  if (pyramids) return *pyramids;
  const RowSource& source = sources_[at];
  pyramids = kept_pyramids(source);
  if (!pyramids) {
    pyramids = built_pyramids(source);
    cache_.keep(facts_, source.name,
                {.uuid = file_.about().header.uuid,
                 .rows = file_.rows(),
                 .bytes = std::as_bytes(pyramids->numbers()),
                 .owner = {}});
    // Of a kept one only what is looked at has to be in memory.
    if (auto kept = kept_pyramids(source)) pyramids = std::move(kept);
  }
  bytes_ += pyramids->numbers().size_bytes();
  return *pyramids;
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
  const auto read_times = [this](std::uint64_t first, std::span<double> time_s) {
    file_.read(Column::time, first, time_s.size(), time_s);
  };
  TraceView nothing;
  nothing.traces.resize(traces.size());
  if (file_.rows() == 0 || columns == 0 || !(from_s <= to_s)) return nothing;
  if (to_s < file_.first_time_s()) return nothing;
  std::uint64_t first = rows_->row_at(from_s, read_times);
  if (first == file_.rows()) return nothing;
  const std::uint64_t end = std::min(rows_->row_at(to_s, read_times) + 1, file_.rows());
  if (first > 0) --first;
  const std::lock_guard lock(mutex_);
  return end - first >= near_rows * columns ? view_from_afar(traces, first, end, columns)
                                            : view_from_near(traces, first, end, columns);
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

}  // namespace kerf::bench
