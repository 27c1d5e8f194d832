#include "import/suggest/time_column.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "import/decimal.h"

namespace kerf::bench {
namespace {

constexpr std::size_t lines_looked_at = 300;  // of each stretch
constexpr std::size_t fewest_ticks = 5;
constexpr double most_out_of_place = 1.0 / 50.0;
constexpr double most_uneven = 1.0 / 20.0;
constexpr double even_within = 0.5;  // of the usual step

/// Values of a column, a list a stretch of lines that follow each other.
using Stretches = std::vector<std::vector<double>>;

std::vector<std::string_view> lines_from(std::string_view rest, bool from_within) {
  if (from_within) (void)take_line(rest);
  std::vector<std::string_view> lines;
  while (!rest.empty() && lines.size() < lines_looked_at) lines.push_back(take_line(rest));
  return lines;
}

/// Of each column; lines in which it has no number are passed over.
std::vector<Stretches> values_of(const TextLayout& layout, std::string_view text,
                                 const std::vector<std::size_t>& columns) {
  const std::string_view data = text.substr(std::min(layout.data_begin, text.size()));
  std::vector<Stretches> values(columns.size());
  std::size_t end = 0;  // of the stretch before
  for (const std::size_t begin : {std::size_t{0}, data.size() / 2, data.size() - data.size() / 8}) {
    const auto lines = lines_from(data.substr(std::max(begin, end)), begin > 0 && begin > end);
    if (lines.empty()) break;
    end = static_cast<std::size_t>(lines.back().data() + lines.back().size() - data.data());
    const std::size_t line_end = data.find('\n', end);
    end = line_end == std::string_view::npos ? data.size() : line_end + 1;
    for (Stretches& stretches : values) stretches.emplace_back();
    for (const std::string_view line : lines) {
      const auto fields = split_line(line, layout.separator);
      for (std::size_t i = 0; i < columns.size(); ++i) {
        if (columns[i] >= fields.size()) continue;
        const std::string_view field = fields[columns[i]];
        const char* const field_end = field.data() + field.size();
        double value = 0.0;
        const bool is_number = parse_decimal(field.data(), field_end, layout.point, value) == field_end;
        if (!field.empty() && is_number && std::isfinite(value)) values[i].back().push_back(value);
      }
    }
  }
  return values;
}

struct Ticking {
  double step = 0.0;
  double spread = 0.0;  ///< mean deviation from the usual step, by that step
  bool counts_lines = false;
};

std::optional<Ticking> ticking_of(const Stretches& stretches) {
  std::vector<double> steps;
  for (std::size_t k = 0; k < stretches.size(); ++k) {
    const std::vector<double>& values = stretches[k];
    if (values.empty()) continue;
    if (k > 0 && !stretches[k - 1].empty() && values.front() <= stretches[k - 1].back()) return std::nullopt;
    for (std::size_t i = 1; i < values.size(); ++i) steps.push_back(values[i] - values[i - 1]);
  }
  if (steps.size() + 1 < fewest_ticks) return std::nullopt;
  std::vector<double> sorted = steps;
  std::ranges::sort(sorted);
  const double usual = sorted[sorted.size() / 2];
  if (!(usual > 0.0)) return std::nullopt;
  double out_of_place = 0.0;
  double uneven = 0.0;
  double deviation = 0.0;
  for (const double step : steps) {
    out_of_place += step > 0.0 ? 0.0 : 1.0;
    uneven += std::abs(step - usual) > even_within * usual ? 1.0 : 0.0;
    deviation += std::min(std::abs(step - usual) / usual, 1.0);
  }
  const auto count = static_cast<double>(steps.size());
  if (out_of_place > most_out_of_place * count || uneven > most_uneven * count) return std::nullopt;
  return Ticking{
      .step = usual, .spread = deviation / count, .counts_lines = usual == 1.0 && deviation == 0.0};
}

}  // namespace

std::optional<TimeColumn> find_time_column(const TextLayout& layout, std::string_view text,
                                           const std::vector<std::size_t>& columns) {
  const std::vector<Stretches> values = values_of(layout, text, columns);
  // By evenness to a percent: less is no difference between two columns.
  std::optional<std::tuple<bool, long, std::size_t>> best;
  std::optional<TimeColumn> found;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const auto ticking = ticking_of(values[i]);
    if (!ticking) continue;
    const std::tuple worth(ticking->counts_lines, std::lround(100.0 * ticking->spread), columns[i]);
    if (best && worth >= *best) continue;
    best = worth;
    found = TimeColumn{.index = columns[i], .step = ticking->step};
  }
  return found;
}

std::string usual_unit_of_time(double step) {
  constexpr double longest_s = 0.5;
  constexpr double longest_ms = 200.0;
  constexpr double longest_us = 200e3;
  return step < longest_s ? "s" : step <= longest_ms ? "ms" : step <= longest_us ? "us" : "ns";
}

}  // namespace kerf::bench
