#include "intake/preview_json.h"

#include <string>

#include "files/json_number.h"
#include "import/column_map.h"
#include "intake/page_words.h"

namespace kerf::bench {
namespace {

using Json = nlohmann::ordered_json;

std::string separator_in_words(char separator) {
  if (separator == '\t') return "tab";
  return separator == ' ' ? "blanks" : std::string(1, separator);
}

Json lines_as_json(const std::vector<PreviewLine>& lines) {
  Json list = Json::array();
  for (const PreviewLine& line : lines)
    list.push_back({{"number", line.number}, {"kind", name_of(line.kind)}, {"fields", line.fields}});
  return list;
}

Json columns_as_json(const TextLayout& layout) {
  Json list = Json::array();
  for (const TextColumn& column : layout.columns)
    list.push_back({{"number", list.size() + 1},
                    {"heading", column.heading},
                    {"name", column.name},
                    {"unit", column.unit},
                    {"unknown_unit", column.unknown_unit},
                    {"stamps", column.stamps.has_value()}});
  return list;
}

/// To choose from, by channel; "own" of a channel of one's own. Of a force in space with its frame, of an
/// orientation how it is written.
Json units_as_json() {
  Json units = Json::object();
  for (const char* const channel :
       {"time", "position", "velocity", "force", "force_commanded", "own", "position.x"})
    units[channel] = usual_units_of(channel);
  for (const char* const channel : {"force.x", "torque.x"}) {
    for (const char* const frame : {"sensor", "world"}) {
      for (const std::string& unit : usual_units_of(channel)) units[channel].push_back(unit + ' ' + frame);
    }
  }
  units["orientation"] = {"quaternion xyzw", "quaternion wxyz", "rotvec rad",
                          "rotvec deg",      "euler xyz deg",   "euler XYZ deg",
                          "euler ZYX deg",   "matrix rows",     "matrix columns"};
  return units;
}

Json mapped_as_json(const ImportPreview& preview) {
  Json list = Json::array();
  if (!preview.imported) return list;
  for (const MappedColumn& column : preview.imported->columns)
    list.push_back({{"channel", column.channel},
                    {"column", column.index + 1},
                    {"unit", column.unit_text},
                    {"unit_from_file", column.unit_from_file},
                    {"si", column.unit.si}});
  return list;
}

}  // namespace

Json preview_as_json(const ImportPreview& preview, const ImportHead& head, const Upload& upload) {
  const TextLayout& layout = preview.layout;
  Json json{{"columns", columns_as_json(layout)},
            {"lines", lines_as_json(preview.first)},
            {"irregular", lines_as_json(preview.irregular)},
            {"layout",
             {{"separator", separator_in_words(layout.separator)},
              {"decimal", std::string(1, layout.point)},
              {"header_line", layout.header_line},
              {"units_line", layout.units_line},
              {"preamble_lines", layout.preamble_lines}}},
            {"suggested", {{"map", preview.suggested}, {"has_time", preview.suggests_time}}},
            {"mapped", mapped_as_json(preview)},
            {"units", units_as_json()},
            {"problem", in_page_words(as_named(preview.problem, upload))},
            {"warnings", Json::array()},
            {"notes", Json::array()},
            {"rows", 0},
            {"seconds", 0.0},
            {"is_whole", head.is_whole}};
  for (const std::string& note : head.notes) json["notes"].push_back(in_page_words(note));
  if (!preview.imported) return json;
  for (const std::string& warning : preview.imported->warnings)
    json["warnings"].push_back(in_page_words(as_named(warning, upload)));
  const auto& time_s = preview.imported->recording.time;
  json["rows"] = time_s.size();
  json["seconds"] = time_s.empty() ? Json(0.0) : json_number(time_s.back());
  return json;
}

}  // namespace kerf::bench
