#include "prepare/rows.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>
#include <stdexcept>

#include <fmt/core.h>

#include "segment/segment.h"

namespace kerf::bench {
namespace {

template <typename T>
void keep(std::vector<T>& values, const std::vector<bool>& rows, std::size_t width = 1) {
  if (values.empty()) return;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (rows[i / width]) values[kept++] = values[i];
  }
  values.resize(kept);
}

/// The pieces of a list separated by commas.
std::vector<std::string_view> pieces_of(std::string_view text) {
  std::vector<std::string_view> pieces;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    pieces.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return pieces;
}

template <typename Number>
bool read_number(std::string_view text, Number& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc{} && end == text.data() + text.size();
}

}  // namespace

void keep_rows(schema::Recording& recording, const std::vector<bool>& rows) {
  std::erase_if(recording.events, [&](const schema::Event& event) {
    const auto after = std::upper_bound(recording.time.begin(), recording.time.end(), event.time_s);
    return after != recording.time.begin() &&
           !rows[static_cast<std::size_t>(after - recording.time.begin()) - 1];
  });
  if (recording.cycles) {
    std::vector<std::uint64_t> kept_before{0};
    for (const bool kept : rows) kept_before.push_back(kept_before.back() + (kept ? 1 : 0));
    auto& phases = recording.cycles->phases;
    for (schema::PhaseSpan& phase : phases) {
      phase.begin = kept_before[phase.begin];
      phase.end = kept_before[phase.end];
    }
    std::erase_if(phases, [](const schema::PhaseSpan& phase) { return phase.begin == phase.end; });
  }
  const std::size_t axes = recording.dimensions();
  for (auto* column :
       {&recording.position, &recording.velocity, &recording.force_commanded, &recording.force_measured}) {
    keep(*column, rows, axes);
  }
  for (auto* column :
       {&recording.wake_latency, &recording.read_time, &recording.compute_time, &recording.write_time}) {
    keep(*column, rows);
  }
  for (schema::Channel& channel : recording.channels) keep(channel.values, rows);
  keep(recording.flags, rows);
  keep(recording.tick, rows);
  keep(recording.time, rows);
}

std::vector<bool> finite_rows(const schema::Recording& recording) {
  const std::size_t axes = recording.dimensions();
  std::vector<bool> finite;
  for (const double time : recording.time) finite.push_back(std::isfinite(time));
  for (const auto* column :
       {&recording.position, &recording.velocity, &recording.force_commanded, &recording.force_measured}) {
    for (std::size_t axis = 0; axis < axes && !column->empty(); ++axis) {
      bool any = false;
      for (std::size_t i = axis; i < column->size() && !any; i += axes) any = std::isfinite((*column)[i]);
      for (std::size_t row = 0; row < finite.size() && any; ++row) {
        if (!std::isfinite((*column)[row * axes + axis])) finite[row] = false;
      }
    }
  }
  return finite;
}

void keep_cycles(schema::Recording& recording, const std::vector<std::uint32_t>& chosen) {
  if (!recording.cycles) throw std::invalid_argument("--cycles needs cycles; run 'kerf segment' first");
  schema::Cycles& cycles = *recording.cycles;
  for (const std::uint32_t cycle : chosen) {
    if (cycle >= 1 && cycle <= cycles.closing.size()) continue;
    throw std::invalid_argument(
        fmt::format("--cycles: there is no cycle {}; the recording has {}", cycle, cycles.closing.size()));
  }
  const auto place = [&](std::uint32_t cycle) {
    const auto found = std::find(chosen.begin(), chosen.end(), cycle);
    return found == chosen.end() ? 0U : static_cast<std::uint32_t>(found - chosen.begin() + 1);
  };
  std::vector<bool> rows(recording.rows(), false);
  for (schema::PhaseSpan& phase : cycles.phases) {
    phase.cycle = place(phase.cycle);
    if (phase.cycle == 0) continue;
    std::fill(rows.begin() + static_cast<std::ptrdiff_t>(phase.begin),
              rows.begin() + static_cast<std::ptrdiff_t>(phase.end), true);
  }
  std::erase_if(cycles.phases, [](const schema::PhaseSpan& phase) { return phase.cycle == 0; });
  if (recording.cycle_flags) {
    auto& flags = recording.cycle_flags->flags;
    for (schema::CycleFlag& flag : flags) flag.cycle = place(flag.cycle);
    std::erase_if(flags, [](const schema::CycleFlag& flag) { return flag.cycle == 0; });
  }
  for (auto* branches : {&cycles.closing, &cycles.opening}) {
    std::vector<std::vector<double>> kept;
    for (const std::uint32_t cycle : chosen) kept.push_back((*branches)[cycle - 1]);
    *branches = std::move(kept);
  }
  cycles.closing_mean = mean_branch(cycles.closing, cycles.grid.size());
  cycles.opening_mean = mean_branch(cycles.opening, cycles.grid.size());
  keep_rows(recording, rows);
}

std::vector<std::uint32_t> parse_cycles(std::string_view text) {
  std::set<std::uint32_t> cycles;
  for (const std::string_view piece : pieces_of(text)) {
    const auto dash = piece.find('-');
    std::uint32_t first = 0;
    std::uint32_t last = 0;
    const bool reads = read_number(piece.substr(0, dash), first) &&
                       (dash == std::string_view::npos || read_number(piece.substr(dash + 1), last));
    if (dash == std::string_view::npos) last = first;
    if (!reads || first < 1 || last < first || last > 1'000'000) {
      throw std::invalid_argument(
          fmt::format("--cycles: '{}' is no list of cycles; expected one like 2-8,10", text));
    }
    for (std::uint32_t cycle = first; cycle <= last; ++cycle) cycles.insert(cycle);
  }
  return {cycles.begin(), cycles.end()};
}

std::vector<TimeSpan> parse_spans(std::string_view text) {
  std::vector<TimeSpan> spans;
  for (const std::string_view piece : pieces_of(text)) {
    const auto colon = piece.find(':');
    TimeSpan span;
    if (colon == std::string_view::npos || !read_number(piece.substr(0, colon), span.begin_s) ||
        !read_number(piece.substr(colon + 1), span.end_s) || !(span.begin_s < span.end_s)) {
      throw std::invalid_argument(
          fmt::format("--free: '{}' is no list of times; expected seconds like 0:1.5,30:32", text));
    }
    spans.push_back(span);
  }
  return spans;
}

}  // namespace kerf::bench
