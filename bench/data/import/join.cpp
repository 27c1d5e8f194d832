#include "import/join.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include "clocks/marker_fit.h"
#include "recordings/provenance.h"
#include "recordings/row_figures.h"
#include "signal/quantiles.h"
#include "signal/signal.h"

namespace kerf::bench {
namespace {

constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

bool names(const std::vector<MapEntry>& map, const std::string& channel) {
  return std::ranges::find(map, channel, &MapEntry::channel) != map.end();
}

std::string channel_called(const std::string& name) { return name == "force" ? "force_measured" : name; }

/// The values of a channel of a recording with one axis; empty if it has none.
std::vector<double>* channel_of(schema::Recording& recording, const std::string& channel) {
  if (channel == "position") return &recording.position;
  if (channel == "velocity") return &recording.velocity;
  if (channel == "force_measured") return &recording.force_measured;
  if (channel == "force_commanded") return &recording.force_commanded;
  const auto found = std::ranges::find(recording.channels, channel, &schema::Channel::name);
  return found == recording.channels.end() ? nullptr : &found->values;
}

std::string unit_of(const schema::Recording& recording, const std::string& channel) {
  const schema::Axis& axis = recording.axes.front();
  if (channel == "position") return axis.position_unit;
  if (channel == "velocity") return axis.position_unit + "/s";
  if (channel.starts_with("force_")) return axis.force_unit;
  const auto found = std::ranges::find(recording.channels, channel, &schema::Channel::name);
  return found == recording.channels.end() ? "" : found->unit;
}

/// @throws std::invalid_argument for a recording in space, whose values lie six in a row.
void require_one_axis(const Imported& imported, const std::string& name) {
  if (imported.spatial)
    throw std::invalid_argument(fmt::format(
        "{}: --join brings two files of one axis together, not axes in space; join first, or import apart",
        name));
}

/// Read by options of its own. A recording has a position, which a file of forces need not have: any of its
/// columns stands for one until it is read.
Imported read_other(const JoinOptions& join_options, const ImportOptions& options) {
  ImportOptions other = options;
  other.map = join_options.map;
  const bool has_position = names(other.map, "position");
  if (!has_position) {
    const auto any =
        std::ranges::find_if(other.map, [](const MapEntry& entry) { return entry.channel != "time"; });
    if (any == other.map.end())
      throw std::invalid_argument("--join-map maps nothing but a time; expected what is to be joined");
    other.map.push_back({.channel = "position", .column = any->column, .unit = "m"});
  }
  Imported imported = import_text(join_options.file, other);
  if (!has_position) {
    imported.recording.position.clear();
    std::erase_if(imported.warnings,
                  [](const std::string& warning) { return warning.find("position") != std::string::npos; });
  }
  if (!names(other.map, "velocity")) imported.recording.velocity.clear();
  return imported;
}

ClockedSeries series_of(schema::Recording& recording, const std::string& channel, const std::string& file) {
  const std::vector<double>* values = channel_of(recording, channel);
  if (values == nullptr || values->empty())
    throw std::invalid_argument(fmt::format(
        "{}: --join-on {} names a channel that its map does not; expected one of both", file, channel));
  ClockedSeries series;
  for (std::size_t row = 0; row < values->size(); ++row) {
    if (!std::isfinite((*values)[row])) continue;
    series.time_s.push_back(recording.time[row]);
    series.values.push_back((*values)[row]);
  }
  return series;
}

/// The clocks by markers: each file's own are found in the channel that is named for it.
ClockFit fit_by_markers(schema::Recording& recording, schema::Recording& other, const JoinOptions& options) {
  const std::vector<MarkerRule> rules = parse_markers(options.marker);
  const auto markers_in = [&](schema::Recording& in, const MarkerRule& rule, const std::string& file) {
    try {
      return markers_of(series_of(in, channel_called(rule.channel), file), rule);
    } catch (const std::invalid_argument& refused) {
      throw std::invalid_argument(fmt::format("{}: --join-marker: {}", file, refused.what()));
    }
  };
  const Markers first = markers_in(recording, rules.front(), "--map");
  const Markers second = markers_in(other, rules.back(), options.file.string());
  try {
    return fit_markers(first, second);
  } catch (const std::invalid_argument& refused) {
    throw std::invalid_argument(fmt::format("{}: --join-marker: {}", options.file.string(), refused.what()));
  }
}

/// The shift of two files whose times are of one clock.
double shared_shift(const Imported& first, const Imported& other, const std::string& file) {
  const schema::Header& one = first.recording.header;
  const schema::Header& two = other.recording.header;
  if (one.start_ns.has_value() != two.start_ns.has_value() || one.start_clock != two.start_clock)
    throw std::invalid_argument(fmt::format(
        "{}: --join-on time: one file has time stamps{} and the other has not; expected times of one clock",
        file, one.start_ns && two.start_ns ? " with a zone" : ""));
  if (one.start_ns) return static_cast<double>(*two.start_ns - *one.start_ns) / 1e9;
  return other.first_time_s - first.first_time_s;
}

/// The other's values at the recording's times.
class Resampler {
 public:
  Resampler(const schema::Recording& to, const schema::Recording& from, const ClockFit& clock)
      : from_(from.time) {
    for (const double t : to.time) times_.push_back((t - clock.shift_s) / (1.0 + clock.skew));
    period_s_ = median_period(from.time);
    const double to_period_s = median_period(to.time);
    if (period_s_ < 0.8 * to_period_s) corner_hz_ = 0.4 / to_period_s;
  }

  [[nodiscard]] std::vector<double> run(const std::vector<double>& values) const {
    const bool is_whole = std::ranges::all_of(values, [](double value) { return std::isfinite(value); });
    std::vector<double> result =
        corner_hz_ > 0.0 && is_whole ? smoothed(values) : interpolate(from_, values, times_);
    for (std::size_t row = 0; row < result.size(); ++row)
      if (!is_covered(times_[row])) result[row] = no_value;
    return result;
  }

  [[nodiscard]] std::size_t rows_without() const {
    return static_cast<std::size_t>(
        std::ranges::count_if(times_, [&](double time_s) { return !is_covered(time_s); }));
  }

 private:
  [[nodiscard]] bool is_covered(double time_s) const {
    const double rounding = 1e-9 * period_s_;
    if (time_s < from_.front() - rounding || time_s > from_.back() + rounding) return false;
    const auto after = std::ranges::lower_bound(from_, time_s);
    if (after == from_.begin() || after == from_.end()) return true;
    return *after - *std::prev(after) <= gap_in_periods * period_s_ || *after == time_s;
  }

  [[nodiscard]] std::vector<double> smoothed(const std::vector<double>& values) const {
    constexpr double most_grid_rows = 1e8;
    if (!(from_.back() / period_s_ < most_grid_rows))
      throw std::invalid_argument(fmt::format(
          "the other file takes {:.4g} s with a row every {:.3g} s where it has any, too many to be "
          "smoothed; expected no such gaps: cut it first",
          from_.back(), period_s_));
    std::vector<double> grid;
    for (std::size_t i = 0; static_cast<double>(i) * period_s_ <= from_.back(); ++i)
      grid.push_back(static_cast<double>(i) * period_s_);
    return interpolate(
        grid, low_pass_zero_phase(interpolate(from_, values, grid), 1.0 / period_s_, corner_hz_), times_);
  }

  const std::vector<double>& from_;
  std::vector<double> times_;
  double period_s_ = 0.0;
  double corner_hz_ = 0.0;
};

void take_channel(schema::Recording& recording, schema::Recording& other, const std::string& channel,
                  const Resampler& resampler) {
  std::vector<double> values = resampler.run(*channel_of(other, channel));
  if (channel.starts_with("force_")) {
    std::string& unit = recording.axes.front().force_unit;
    const bool has_forces = !recording.force_measured.empty() || !recording.force_commanded.empty();
    if (has_forces && unit != unit_of(other, channel))
      throw std::invalid_argument(
          fmt::format("--join-map: one force is in {} and the other in {}; expected the same", unit,
                      unit_of(other, channel)));
    unit = unit_of(other, channel);
    *channel_of(recording, channel) = std::move(values);
  } else if (channel == "position" || channel == "velocity") {
    throw std::invalid_argument(
        fmt::format("--join-map: {} is of the first file; name it otherwise, or join on it", channel));
  } else {
    recording.channels.push_back(
        {.name = channel, .unit = unit_of(other, channel), .values = std::move(values)});
  }
}

}  // namespace

Joined join(Imported& imported, const JoinOptions& join_options, const ImportOptions& options) {
  const std::string file = join_options.file.string();
  const bool by_marker = !join_options.marker.empty();
  if (by_marker && !join_options.on.empty())
    throw std::invalid_argument("--join-on and --join-marker are two ways; give one of them");
  const std::string on =
      channel_called(by_marker ? parse_markers(join_options.marker).front().channel : join_options.on);
  if (on.empty())
    throw std::invalid_argument(
        "--join-on is needed: a channel that both maps name and both files measured, or time for one clock");
  require_one_axis(imported, "--map");
  Imported other = read_other(join_options, options);
  require_one_axis(other, file);
  schema::Recording& recording = imported.recording;
  Joined joined{
      .file = file, .on = on, .is_one_clock = on == "time" && !by_marker, .warnings = other.warnings};
  if (by_marker) {
    joined.clock = fit_by_markers(recording, other.recording, join_options);
    if (joined.clock.markers == 1)
      joined.warnings.emplace_back(
          "one marker tells the shift and nothing of the skew: clocks that differ by 100 ppm are 6 ms apart "
          "after a minute");
    const auto tell_alone = [&](const char* which, const char* elsewhere,
                                const std::vector<double>& times_s) {
      if (!times_s.empty())
        joined.warnings.push_back(fmt::format(
            "{} of the {} file's markers, at {:.6g} s after its first row, {} not in the {}: left out, as "
            "spurious "
            "or missed there",
            times_s.size(), which, fmt::join(times_s, ", "), times_s.size() == 1 ? "is" : "are", elsewhere));
    };
    tell_alone("first", "other", joined.clock.first_alone_s);
    tell_alone("other", "first", joined.clock.other_alone_s);
  } else if (joined.is_one_clock) {
    joined.clock.shift_s = shared_shift(imported, other, file);
  } else {
    const ClockedSeries first = series_of(recording, on, "--map");
    const ClockedSeries second = series_of(other.recording, on, file);
    try {
      joined.clock = fit_clock(first, second);
    } catch (const std::invalid_argument& refused) {
      throw std::invalid_argument(fmt::format("{}: --join-on {}: {}", file, join_options.on, refused.what()));
    }
  }
  const Resampler resampler(recording, other.recording, joined.clock);
  joined.rows_without = resampler.rows_without();
  if (joined.rows_without == recording.rows())
    throw std::invalid_argument(fmt::format(
        "{}: shifted by {:.3f} s it has nothing at the times of the first file", file, joined.clock.shift_s));
  for (const MapEntry& entry : join_options.map) {
    if (entry.channel == "time" || entry.channel == on) continue;
    const std::vector<double>* there = channel_of(recording, entry.channel);
    if (there != nullptr && !there->empty() && entry.channel != "velocity")
      throw std::invalid_argument(
          fmt::format("--join-map: {} is mapped in both files; expected one, or "
                      "--join-on it",
                      entry.channel));
    take_channel(recording, other.recording, entry.channel, resampler);
    joined.channels.push_back(entry.channel);
  }
  if (joined.rows_without > 0)
    joined.warnings.push_back(fmt::format("{} of {} rows lie where it has nothing: {} are nan there",
                                          joined.rows_without, recording.rows(),
                                          fmt::join(joined.channels, ", ")));
  add_history(recording.header,
              fmt::format("join: {} ({})", joined_line(joined), other.recording.header.source));
  return joined;
}

nlohmann::ordered_json joined_as_json(const Joined& joined) {
  const auto known = [&](double value) {
    return joined.is_one_clock || std::isnan(value) ? nlohmann::ordered_json()
                                                    : nlohmann::ordered_json(value);
  };
  nlohmann::ordered_json markers;
  if (joined.clock.markers > 0) markers = joined.clock.markers;
  nlohmann::ordered_json all{{"file", joined.file},
                             {"on", joined.on},
                             {"shift_s", joined.clock.shift_s},
                             {"shift_std_error_s", known(joined.clock.shift_error_s)},
                             {"skew", joined.clock.skew},
                             {"skew_std_error", known(joined.clock.skew_error)},
                             {"correlation", known(joined.clock.correlation)},
                             {"markers", markers},
                             {"channels", joined.channels},
                             {"rows_without", joined.rows_without}};
  if (!joined.clock.first_alone_s.empty()) all["markers_of_first_alone_s"] = joined.clock.first_alone_s;
  if (!joined.clock.other_alone_s.empty()) all["markers_of_other_alone_s"] = joined.clock.other_alone_s;
  return all;
}

std::string joined_line(const Joined& joined) {
  const std::string name = std::filesystem::path(joined.file).filename().string();
  const std::string what = fmt::format("{} of {}", fmt::join(joined.channels, ", "), name);
  if (joined.is_one_clock)
    return fmt::format("{}, by the time of both: it begins {:.6g} s after the first", what,
                       joined.clock.shift_s);
  const ClockFit& clock = joined.clock;
  if (clock.markers == 1)
    return fmt::format("{}, by one marker of {}: its clock is shifted by {:.6g} +- {:.2g} s (95 %)", what,
                       joined.on, clock.shift_s, clock.t95 * clock.shift_error_s);
  if (clock.markers > 1)
    return fmt::format(
        "{}, by {} markers of {}: its clock is shifted by {:.6g} +- {:.2g} s and skewed by {:.4g} +- {:.2g} "
        "ppm "
        "(95 %)",
        what, clock.markers, joined.on, clock.shift_s, clock.t95 * clock.shift_error_s, 1e6 * clock.skew,
        1e6 * clock.t95 * clock.skew_error);
  return fmt::format(
      "{}, by {}: its clock is shifted by {:.6g} +- {:.2g} s and skewed by {:.4g} +- {:.2g} ppm (95 %), "
      "correlation "
      "{:.4f}",
      what, joined.on, joined.clock.shift_s, clock_t95 * joined.clock.shift_error_s, 1e6 * joined.clock.skew,
      1e6 * clock_t95 * joined.clock.skew_error, joined.clock.correlation);
}

}  // namespace kerf::bench
