#include "results/error_places.h"

#include <algorithm>
#include <cmath>

#include "segment/segment.h"

namespace kerf::bench {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t most_places = 6;
constexpr std::size_t equal_parts = 20;
constexpr double least_share = 0.02;  // what is less is nowhere in particular

struct ErrorStretch {
  double from_s = 0.0;
  double to_s = 0.0;
  ordered_json of = ordered_json::object();
  double squares = 0.0;
  std::size_t rows = 0;
};

std::vector<ErrorStretch> phases_of(const schema::Recording& recording) {
  std::vector<ErrorStretch> places;
  for (const schema::PhaseSpan& span : recording.cycles->phases) {
    if (span.begin >= span.end || span.end > recording.time.size()) continue;
    places.push_back({.from_s = recording.time[span.begin],
                      .to_s = recording.time[span.end - 1],
                      .of = {{"cycle", span.cycle}, {"phase", name_of(span.phase)}}});
  }
  return places;
}

std::vector<ErrorStretch> twentieths_of(const std::vector<double>& time_s) {
  std::vector<ErrorStretch> places;
  const double length = (time_s.back() - time_s.front()) / static_cast<double>(equal_parts);
  for (std::size_t part = 0; part < equal_parts; ++part) {
    const double from = time_s.front() + length * static_cast<double>(part);
    places.push_back({.from_s = from, .to_s = part + 1 == equal_parts ? time_s.back() : from + length});
  }
  return places;
}

}  // namespace

ordered_json error_places(const schema::Recording& recording, std::size_t axis, const AxisSeries& series,
                          const std::vector<double>& residual) {
  if (series.time_s.empty()) return ordered_json::array();
  std::vector<ErrorStretch> places;
  if (recording.cycles && recording.cycles->axis == axis) places = phases_of(recording);
  if (places.empty()) places = twentieths_of(series.time_s);
  std::ranges::sort(places, {}, &ErrorStretch::from_s);
  double squares = 0.0;
  auto place = places.begin();
  for (std::size_t row = 0; row < residual.size(); ++row) {
    if (!series.counts.empty() && series.counts[row] == 0) continue;
    const double square = residual[row] * residual[row];
    squares += square;
    while (place != places.end() && place->to_s < series.time_s[row]) ++place;
    if (place == places.end() || series.time_s[row] < place->from_s) continue;
    place->squares += square;
    ++place->rows;
  }
  std::ranges::stable_sort(places, std::greater<>{}, &ErrorStretch::squares);
  ordered_json list = ordered_json::array();
  for (const ErrorStretch& one : places) {
    if (list.size() == most_places || !(one.squares > least_share * squares)) break;
    ordered_json entry{{"from_s", one.from_s}, {"to_s", one.to_s}};
    entry.update(one.of);
    entry["rmse"] = std::sqrt(one.squares / static_cast<double>(one.rows));
    entry["share"] = one.squares / squares;
    list.push_back(std::move(entry));
  }
  return list;
}

}  // namespace kerf::bench
