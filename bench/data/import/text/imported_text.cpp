#include "import/text/imported_text.h"

#include <fmt/core.h>

#include "clocks/time_stamp.h"
#include "recordings/summary.h"

namespace kerf::bench {
namespace {

std::string name_of(char separator) {
  switch (separator) {
    case '\t':
      return "tab";
    case ' ':
      return "blanks";
    default:
      return {separator};
  }
}

}  // namespace

nlohmann::ordered_json imported_as_json(const Imported& imported) {
  nlohmann::ordered_json result = recording_summary(imported.recording);
  for (const std::string& warning : imported.warnings) result["warnings"].push_back(warning);
  result["bad_lines"] = imported.bad_lines.size();
  result["bad_line_numbers"] = imported.bad_lines;
  result["misplaced_lines"] = imported.misplaced_lines.size();
  result["misplaced_line_numbers"] = imported.misplaced_lines;
  for (const MappedColumn& column : imported.columns) {
    result["columns"][column.channel] = {{"number", column.index + 1},
                                         {"heading", imported.layout.columns[column.index].heading},
                                         {"unit", column.unit_text},
                                         {"unit_from_file", column.unit_from_file}};
  }
  if (imported.spatial) {
    const SpatialMap& map = *imported.spatial;
    if (map.orientation) result["orientation"] = map.orientation->text();
    if (map.has_force) result["wrench_frame"] = map.frame;
  }
  result["layout"] = {{"separator", name_of(imported.layout.separator)},
                      {"decimal", std::string(1, imported.layout.point)},
                      {"preamble_lines", imported.layout.preamble_lines},
                      {"header_line", imported.layout.header_line},
                      {"units_line", imported.layout.units_line}};
  result["parse_seconds"] = imported.parse_seconds;
  return result;
}

std::vector<std::string> imported_lines(const Imported& imported) {
  const TextLayout& layout = imported.layout;
  std::string about = fmt::format("{} columns separated by {}", layout.columns.size(),
                                  layout.separator == '\t' ? "tabs" : name_of(layout.separator));
  if (layout.point != '.') about += fmt::format(", decimal {}", layout.point);
  if (layout.header_line > 0) about += fmt::format(", named in line {}", layout.header_line);
  if (layout.units_line > 0) about += fmt::format(", their units in line {}", layout.units_line);
  std::vector<std::string> lines{about};
  for (const MappedColumn& column : imported.columns) {
    const std::string& heading = layout.columns[column.index].heading;
    if (layout.columns[column.index].stamps) {
      lines.push_back(fmt::format("{}: column {}{}, time stamps; time 0 is {}", column.channel,
                                  column.index + 1, heading.empty() ? "" : fmt::format(" '{}'", heading),
                                  start_text(imported.recording.header)));
      continue;
    }
    const bool says_start = column.channel == "time" && imported.recording.header.start_ns;
    lines.push_back(fmt::format("{}: column {}{}, in {}{}{}", column.channel, column.index + 1,
                                heading.empty() ? "" : fmt::format(" '{}'", heading), column.unit_text,
                                column.unit_from_file ? " as the file says" : "",
                                says_start ? "; time 0 is " + start_text(imported.recording.header) : ""));
  }
  if (imported.spatial) lines.push_back(spatial_text(*imported.spatial, {}));
  return lines;
}

}  // namespace kerf::bench
