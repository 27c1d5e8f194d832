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

/// Of most of the lines that are numbers; 0 if there are none.
std::size_t usual_fields(const Reading& reading, const std::vector<std::string_view>& lines) {
  std::map<std::size_t, std::size_t> counts;
  for (const auto line : lines) {
    if (reading.reads(line)) ++counts[split_line(line, reading.separator).size()];
  }
  const auto most = std::ranges::max_element(counts, {}, [](const auto& one) { return one.second; });
  return most == counts.end() ? 0 : most->first;
}

/// Whether a line above the first line of numbers names all columns.
bool has_names(const Reading& reading, const std::vector<std::string_view>& lines) {
  const std::size_t fields = usual_fields(reading, lines);
  const auto reads = [&](std::string_view line) { return reading.reads(line); };
  return std::any_of(lines.begin(), std::ranges::find_if(lines, reads), [&](std::string_view line) {
    return names_all(split_line(line, reading.separator), fields);
  });
}

Reading best_reading(const std::vector<std::string_view>& lines, Texts beside) {
  // In order of preference between equals: a comma separates before it is a decimal comma.
  std::array readings{Reading{'\t', '.'}, Reading{';', '.'}, Reading{',', '.'}, Reading{' ', '.'},
                      Reading{'\t', ','}, Reading{';', ','}, Reading{' ', ','}, Reading{',', ','}};
  Reading best = readings[0];
  for (Reading& reading : readings) {
    reading.beside = beside;
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
    if (beside == Texts::any && !has_names(reading, lines)) continue;
    if (worth(reading) > worth(best)) best = reading;
  }
  return best;
}

std::size_t numbers_in(const Reading& reading, std::string_view line) {
  const auto fields = split_line(line, reading.separator);
  return static_cast<std::size_t>(std::ranges::count_if(
      fields, [&](std::string_view field) { return is_decimal(field, reading.point); }));
}

}  // namespace

bool Reading::reads(std::string_view line) const {
  if (trimmed(line).empty() || is_comment(line)) return false;
  const auto fields = split_line(line, separator);
  const auto numbers =
      std::count_if(fields.begin(), fields.end(), [&](auto f) { return is_decimal(f, point); });
  const auto filled = std::count_if(fields.begin(), fields.end(), [](auto f) { return !f.empty(); });
  // A stamp alone is a remark: when something began.
  const auto values = numbers >= 1 ? numbers + std::count_if(fields.begin(), fields.end(), is_stamp) : 0;
  const bool are_enough = 2 * values > filled ||
                          (beside != Texts::fewer && values >= 2 && 2 * values == filled) ||
                          (beside == Texts::any && fields.size() > 1 && separator != ' ');
  return values >= 1 && are_enough && 2 * static_cast<std::size_t>(values) >= columns;
}

Reading best_reading(const std::vector<std::string_view>& lines) {
  Reading best = best_reading(lines, Texts::fewer);
  for (const Texts beside : {Texts::as_many, Texts::any}) {
    const Reading lenient = best_reading(lines, beside);
    if (lenient.lines > 2 * best.lines) best = lenient;
  }
  return best;
}

std::size_t first_line_of_data(const Reading& reading, const std::vector<std::string_view>& lines,
                               const std::vector<std::string_view>& middle) {
  constexpr std::size_t most_passed_over = 20;  // of lines of numbers: constants of channels, a protocol
  constexpr std::size_t most_of_channels = 2;
  const auto reads = [&](std::string_view line) { return reading.reads(line); };
  const auto first = static_cast<std::size_t>(std::ranges::find_if(lines, reads) - lines.begin());
  const std::size_t fields = usual_fields(reading, middle);
  if (first == lines.size() || fields < 2) return first;
  const auto names = [&](std::string_view line) {
    return names_all(split_line(line, reading.separator), fields);
  };
  const bool is_named =
      std::ranges::any_of(lines.begin(), lines.begin() + static_cast<std::ptrdiff_t>(first), names);
  const bool is_other = split_line(lines[first], reading.separator).size() != fields;
  std::size_t passed_over = 0;
  std::size_t most_numbers = 0;
  for (std::size_t i = first; i + 1 < lines.size() && passed_over <= most_passed_over; ++i) {
    if (reads(lines[i])) {
      ++passed_over;
      most_numbers = std::max(most_numbers, numbers_in(reading, lines[i]));
    }
    const bool begins_data =
        reads(lines[i + 1]) && split_line(lines[i + 1], reading.separator).size() == fields;
    if (!begins_data || !names(lines[i])) continue;
    // "run,5,2024" above a table of three numbers, or "1,2,3" of its channels.
    const bool says_of_file =
        most_numbers < numbers_in(reading, lines[i + 1]) || passed_over <= most_of_channels;
    if (is_other || (!is_named && says_of_file)) return i + 1;
  }
  return first;
}

}  // namespace kerf::bench
