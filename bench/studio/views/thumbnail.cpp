#include "views/thumbnail.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <kerf/schema/recording_file.h>

#include "files/for_terminal.h"

namespace kerf::bench {
namespace {

using nlohmann::ordered_json;
using schema::Column;

constexpr std::size_t most_kept = 5000;
constexpr int nothing_known = -1;

struct Extremes {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void take(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

std::pair<Column, const char*> signal_of(const schema::RecordingFile& file) {
  if (file.width(Column::force_measured) > 0) return {Column::force_measured, "force measured"};
  if (file.width(Column::force_commanded) > 0) return {Column::force_commanded, "force commanded"};
  return {Column::position, "position"};
}

std::vector<Extremes> extremes_of(const schema::RecordingFile& file, Column column, std::size_t axis) {
  const std::uint64_t rows = file.rows();
  const std::size_t width = file.width(column);
  if (rows == 0 || width <= axis) return {};
  const std::uint64_t count = std::min<std::uint64_t>(Thumbnails::columns, rows);
  std::vector<Extremes> found(static_cast<std::size_t>(count));
  std::vector<double> values;
  for (std::uint64_t k = 0; k < count; ++k) {
    const std::uint64_t first = rows * k / count;
    const std::uint64_t end = rows * (k + 1) / count;
    values.resize(static_cast<std::size_t>(std::min<std::uint64_t>(end - first, Thumbnails::rows_a_column)) *
                  width);
    file.read(column, first, values.size() / width, values);
    for (std::size_t i = axis; i < values.size(); i += width)
      found[static_cast<std::size_t>(k)].take(values[i]);
  }
  return found;
}

/// 0 to 100 from the smallest to the largest of all.
void put_levels(const std::vector<Extremes>& columns, ordered_json& json) {
  Extremes all;
  for (const Extremes& it : columns) {
    all.take(it.low);
    all.take(it.high);
  }
  const double range = all.high - all.low;
  const auto level = [&](double value) {
    if (!std::isfinite(value)) return nothing_known;
    return range > 0.0 ? static_cast<int>(std::lround(100.0 * ((value - all.low) / range))) : 50;
  };
  json["low"] = ordered_json::array();
  json["high"] = ordered_json::array();
  for (const Extremes& it : columns) {
    json["low"].push_back(level(it.low));
    json["high"].push_back(level(it.high));
  }
}

void put_cycles(const schema::Recording& about, ordered_json& json) {
  if (!about.cycles) {
    json["cycles"] = nothing_known;
    json["flagged"] = 0;
    return;
  }
  std::set<std::size_t> cycles;
  for (const schema::PhaseSpan& span : about.cycles->phases) cycles.insert(span.cycle);
  std::set<std::size_t> flagged;
  std::set<std::size_t> accepted;
  if (about.cycle_flags) {
    for (const schema::CycleFlag& flag : about.cycle_flags->flags)
      (flag.fault == "accepted" ? accepted : flagged).insert(flag.cycle);
  }
  for (const std::size_t cycle : accepted) flagged.erase(cycle);
  json["cycles"] = cycles.size();
  json["flagged"] = flagged.size();
}

/// Whether HDF5 falls over damaged texts is not looked at, which takes as long as reading the file: the
/// process that reads it is another, and its end is an error like any other.
std::string drawn(const std::filesystem::path& path) {
  const schema::RecordingFile file(path, schema::RecordingFile::Texts::known_to_be_sound);
  const schema::Recording& about = file.about();
  const auto [column, name] = signal_of(file);
  const std::size_t axis = about.cycles ? about.cycles->axis : 0;
  ordered_json json{{"signal", name}};
  put_levels(extremes_of(file, column, axis), json);
  put_cycles(about, json);
  json["status"] = about.header.status;
  return json_for_page(json.dump(-1, ' ', false, ordered_json::error_handler_t::replace));
}

}  // namespace

std::string Thumbnails::of(const std::filesystem::path& file) {
  const FileFacts facts = FileFacts::of(file);
  {
    const std::lock_guard lock(mutex_);
    const auto kept = kept_.find(file);
    if (kept != kept_.end() && kept->second.facts == facts) return kept->second.json;
  }
  std::string json = drawn(file);
  const std::lock_guard lock(mutex_);
  if (kept_.size() >= most_kept) kept_.clear();
  kept_.insert_or_assign(file, Kept{.facts = facts, .json = json});
  return json;
}

}  // namespace kerf::bench
