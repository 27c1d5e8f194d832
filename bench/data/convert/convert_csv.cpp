#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "convert/formats.h"
#include "convert/number_text.h"
#include "convert/output_file.h"

namespace kerf::bench {
namespace {

/// A field as RFC 4180 writes it.
std::string csv_field(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string field = "\"";
  for (const char c : text) field += c == '"' ? "\"\"" : std::string(1, c);
  return field + '"';
}

/// "position.theta [rad]": `kerf import` reads the unit out of the brackets.
std::string heading_of(const RecordingColumn& column) {
  return csv_field(fmt::format("{} [{}]", column.name(), column.unit.empty() ? "1" : column.unit));
}

/// NaN as pandas, R and kerf import read it.
void append_cell(fmt::memory_buffer& text, const RecordingColumn& column, const ColumnValues& values,
                 std::size_t row) {
  if (!column.is_whole() && std::isnan(values.real[row])) {
    text.append(std::string_view("NaN"));
  } else {
    append_number(text, column, values, row);
  }
}

void write_rows_as_csv(const RecordingColumns& recording, const ConversionTarget& target, OutputFile& file) {
  std::string heading;
  for (const RecordingColumn& column : recording.columns())
    heading += (heading.empty() ? "" : ",") + heading_of(column);
  file.write(heading + "\n");
  std::vector<ColumnValues> values;
  fmt::memory_buffer text;
  for (std::uint64_t first = 0; first < recording.rows(); first += recording.rows_of_a_block()) {
    const auto count = static_cast<std::size_t>(
        std::min<std::uint64_t>(recording.rows_of_a_block(), recording.rows() - first));
    recording.read_all(first, count, values);
    for (std::size_t row = 0; row < count; ++row) {
      for (std::size_t i = 0; i < values.size(); ++i) {
        if (i > 0) text.push_back(',');
        append_cell(text, recording.columns()[i], values[i], row);
      }
      text.push_back('\n');
      if (text.size() < (std::size_t{1} << 16U) && row + 1 < count) continue;
      file.write({text.data(), text.size()});
      text.clear();
    }
    *target.rows_done += count;
  }
}

}  // namespace

std::filesystem::path dictionary_beside(std::filesystem::path csv) {
  return csv.replace_extension(".dictionary.csv");
}

std::filesystem::path events_beside(std::filesystem::path csv) {
  return csv.replace_extension(".events.csv");
}

void convert_to_csv(const RecordingColumns& recording, const ConversionTarget& target) {
  OutputFile file(target.file);
  write_rows_as_csv(recording, target, file);
  file.close();

  OutputFile dictionary(dictionary_beside(target.file));
  dictionary.write("column,unit,description,source\n");
  for (const RecordingColumn& column : recording.columns())
    dictionary.write(fmt::format("{},{},{},{}\n", heading_of(column), csv_field(column.unit),
                                 csv_field(column.meaning), csv_field(column.source)));
  dictionary.close();

  if (const std::vector<schema::Event>& events = recording.about().events; !events.empty()) {
    OutputFile table(events_beside(target.file));
    table.write("time [s],kind,text\n");
    for (const schema::Event& event : events)
      table.write(fmt::format("{},{},{}\n", event.time_s, csv_field(event.kind), csv_field(event.text)));
    table.close();
    table.commit(target.existing);
  }
  dictionary.commit(target.existing);
  file.commit(target.existing);
}

}  // namespace kerf::bench
