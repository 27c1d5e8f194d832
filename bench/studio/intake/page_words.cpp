#include "intake/page_words.h"

#include <array>
#include <string_view>

namespace kerf::bench {
namespace {

/// What the program says, and what the page says instead.
struct PageWords {
  std::string_view said;
  std::string_view here;
};

constexpr std::array sentences{
    PageWords{
        "--map maps no time; map one, or give --rate HZ for samples at a uniform rate",
        "no column is the time: choose 'time' above one, or fill in 'Rate, without a time column [Hz]'"},
    PageWords{
        "--rate counts the time that --map takes from a column; give one of them",
        "a column is the time, and 'Rate, without a time column [Hz]' is filled in: empty that field, or "
        "leave the column out"},
    PageWords{"map no time and give --rate HZ",
              "leave the column of the time out, and fill in 'Rate, without a time column [Hz]'"},
    PageWords{"take one of its ", "take, under 'More', one of its "},
    PageWords{" by --stretch 1 to ", " as 'Stretch, where the clock starts anew', from 1 to "},
    PageWords{"; without --strict they are left out",
              "; without the tick at 'Refuse a file with lines that are no data' they are left out"},
    PageWords{"--sheet takes another", "'Sheet of a workbook' under 'More' takes another"},
    PageWords{"--sheet: there is", "'Sheet of a workbook': there is"},
    PageWords{"--resample needs", "'Resample to [Hz]' needs"},
    PageWords{"import without it", "empty that field"},
    PageWords{" (--max-bytes)", ""},
    PageWords{"; expected CHANNEL=COLUMN[unit], for example ", "; it is written as in "},
    PageWords{"--map: ", "The mapping: "},
    PageWords{"--map asks for", "the mapping asks for"},
};

/// Whatever else names an option.
constexpr std::array options{
    PageWords{"--rate HZ", "'Rate, without a time column [Hz]'"},
    PageWords{"--rate", "'Rate, without a time column [Hz]'"},
    PageWords{"--resample", "'Resample to [Hz]'"},
    PageWords{"--velocity-window", "'Window of the velocity [s]'"},
    PageWords{"--stretch", "'Stretch, where the clock starts anew'"},
    PageWords{"--sheet", "'Sheet of a workbook'"},
    PageWords{"--origin", "'Origin x, y, z [m]'"},
    PageWords{"--point", "'Point of the torques x, y, z [m]'"},
    PageWords{"--sensor-rotation", "'Rotation of the sensor x, y, z [deg]'"},
    PageWords{"--strict", "'Refuse a file with lines that are no data'"},
    PageWords{"--map", "the mapping"},
};

void replace_all(std::string& text, const PageWords& words) {
  for (auto at = text.find(words.said); at != std::string::npos;
       at = text.find(words.said, at + words.here.size()))
    text.replace(at, words.said.size(), words.here);
}

/// What begins with `begin` and reaches to the next `end`.
void replace_to(std::string& text, std::string_view begin, std::string_view end, std::string_view here) {
  const auto from = text.find(begin);
  if (from == std::string::npos) return;
  const auto to = text.find(end, from + begin.size());
  text.replace(from, to == std::string::npos ? to : to + end.size() - from, here);
}

}  // namespace

std::string in_page_words(std::string message) {
  replace_to(message, " has no unit in the file; give one in brackets: ", "]",
             " has no unit in the file: choose one below its name");
  replace_to(message, "--map maps no position; for example ", "[N]",
             "no column is the position: choose 'position' above one");
  for (const PageWords& words : sentences) replace_all(message, words);
  for (const PageWords& words : options) replace_all(message, words);
  return message;
}

}  // namespace kerf::bench
