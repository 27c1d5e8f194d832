#include "import/text/reading.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <tuple>

#include "clocks/time_stamp.h"
#include "files/trimmed.h"
#include "import/decimal.h"
#include "import/text/text_layout.h"

namespace kerf::bench {
namespace {

bool is_stamp(std::string_view field) noexcept {
  TimeStamp stamp;
  return is_time_stamp(field, stamp);
}

Reading best_reading(const std::vector<std::string_view>& lines, bool half_will_do) {
  // In order of preference between equals: a comma separates before it is a decimal comma.
  std::array readings{Reading{'\t', '.'}, Reading{';', '.'}, Reading{',', '.'}, Reading{' ', '.'},
                      Reading{'\t', ','}, Reading{';', ','}, Reading{' ', ','}, Reading{',', ','}};
  Reading best = readings[0];
  for (Reading& reading : readings) {
    reading.half_will_do = half_will_do;
    std::size_t numbers = 0;
    for (const auto line : lines) {
      if (!reading.reads(line)) continue;
      ++reading.lines;
      for (const auto field : split_line(line, reading.separator)) {
        if (is_decimal(field, reading.point) || is_stamp(field)) {
          ++numbers;
        } else if (!field.empty()) {
          ++reading.strangers;
        }
      }
    }
    reading.columns = reading.lines > 0 ? (numbers + reading.lines / 2) / reading.lines : 0;
    const auto worth = [](const Reading& r) {
      return std::tuple(r.lines, std::numeric_limits<std::size_t>::max() - r.strangers, r.columns);
    };
    if (worth(reading) > worth(best)) best = reading;
  }
  return best;
}

/// Of most of the lines that are numbers; 0 if there are none.
std::size_t usual_fields(const Reading& reading, const std::vector<std::string_view>& lines) {
  std::map<std::size_t, std::size_t> counts;
  for (const auto line : lines) {
    if (reading.reads(line)) ++counts[split_line(line, reading.separator).size()];
  }
  const auto most = std::ranges::max_element(counts, {}, [](const auto& one) { return one.second; });
  return most == counts.end() ? 0 : most->first;
}

/// A name a column, none of them a number, as headers have it.
bool names_all(const Reading& reading, std::string_view line, std::size_t columns) {
  const auto fields = split_line(line, reading.separator);
  return fields.size() == columns && std::ranges::none_of(fields, [&](std::string_view field) {
           return trimmed(field).empty() || is_decimal(field, reading.point);
         });
}

}  // namespace

bool Reading::reads(std::string_view line) const {
  if (trimmed(line).empty()) return false;
  const auto fields = split_line(line, separator);
  const auto numbers =
      std::count_if(fields.begin(), fields.end(), [&](auto f) { return is_decimal(f, point); });
  const auto filled = std::count_if(fields.begin(), fields.end(), [](auto f) { return !f.empty(); });
  // A stamp alone is a remark: when something began.
  const auto values = numbers >= 1 ? numbers + std::count_if(fields.begin(), fields.end(), is_stamp) : 0;
  const bool are_enough = 2 * values > filled || (half_will_do && values >= 2 && 2 * values == filled);
  return values >= 1 && are_enough && 2 * static_cast<std::size_t>(values) >= columns;
}

Reading best_reading(const std::vector<std::string_view>& lines) {
  const Reading strict = best_reading(lines, false);
  const Reading lenient = best_reading(lines, true);
  return lenient.lines > 2 * strict.lines ? lenient : strict;
}

std::size_t first_line_of_data(const Reading& reading, const std::vector<std::string_view>& lines,
                               const std::vector<std::string_view>& middle) {
  constexpr std::size_t most_passed_over = 20;  // of lines of numbers: constants of channels, a protocol
  const auto reads = [&](std::string_view line) { return reading.reads(line); };
  const auto first = static_cast<std::size_t>(std::ranges::find_if(lines, reads) - lines.begin());
  const std::size_t fields = usual_fields(reading, middle);
  if (first == lines.size() || fields < 2 || split_line(lines[first], reading.separator).size() == fields)
    return first;
  std::size_t passed_over = 0;
  for (std::size_t i = first; i + 1 < lines.size() && passed_over <= most_passed_over; ++i) {
    if (reads(lines[i])) ++passed_over;
    const bool begins_data =
        reads(lines[i + 1]) && split_line(lines[i + 1], reading.separator).size() == fields;
    if (begins_data && names_all(reading, lines[i], fields)) return i + 1;
  }
  return first;
}

}  // namespace kerf::bench
