#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include <kerf/schema/validate.h>

#include "fuzz/scratch_folder.h"
#include "fuzz/target.h"
#include "import/column_map.h"
#include "import/import.h"
#include "import/suggest/suggested_map.h"
#include "import/text/text_layout.h"
#include "import/text/text_table.h"

namespace kerf::fuzz {
namespace {

using bench::ImportOptions;
using bench::TextLayout;
using bench::TextTable;

std::size_t lines_in(std::string_view rest) {
  std::size_t lines = 0;
  for (; !rest.empty(); ++lines) (void)bench::take_line(rest);
  return lines;
}

/// Every line from the data on is a row, bad or empty; a column that is asked for twice comes twice.
void fuzz_table(std::string_view text, const TextLayout& layout) {
  std::vector<std::size_t> columns(layout.columns.size());
  std::iota(columns.rbegin(), columns.rend(), std::size_t{0});
  columns.push_back(0);
  std::atomic<std::size_t> bytes_done{0};
  const TextTable table = bench::parse_table(text, layout, columns, bytes_done);
  promise(bytes_done == text.size() - layout.data_begin, "progress ends with the text");
  promise(table.columns.size() == columns.size(), "as many columns as were asked for");
  const std::size_t rows = table.columns.front().size();
  for (const auto& column : table.columns) promise(column.size() == rows, "columns are of one length");
  promise(
      rows + table.bad_lines.size() + table.empty_lines.size() == lines_in(text.substr(layout.data_begin)),
      "every line is a row, bad or empty");
  for (std::size_t row = 0; row < rows; ++row) {
    const double first = table.columns.back()[row];
    const double again = table.columns[columns.size() - 2][row];
    promise(first == again || (std::isnan(first) && std::isnan(again)), "a column read twice is the same");
    promise(!std::ranges::binary_search(table.bad_lines, table.line_of(row)), "no row is of a bad line");
  }
}

/// The map that is suggested is one, where nothing is left to be told, and the options beside it.
ImportOptions suggested(const TextLayout& layout, std::string_view text) {
  const bench::SuggestedMap suggestion = bench::suggest_map(layout, text);
  ImportOptions options;
  const bool is_whole = !suggestion.map.empty() && suggestion.map.find('?') == std::string::npos;
  options.map = bench::parse_map(is_whole ? suggestion.map : "position=1[mm]");
  if (!suggestion.rate.empty()) options.rate_hz = 100.0;
  return options;
}

void check_imported(const schema::Recording& recording) {
  promise(recording.rows() > 0, "an import has rows");
  const std::size_t values = recording.rows() * recording.dimensions();
  promise(recording.position.size() == values && recording.velocity.size() == values,
          "a position and a velocity a row and axis");
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    promise(std::isfinite(recording.time[row]), "times are finite");
    promise(row == 0 || (recording.time[row] > recording.time[row - 1] &&
                         recording.tick[row] > recording.tick[row - 1]),
            "times and ticks increase strictly");
  }
}

/// In a file, which takes its time.
void check_kept(const schema::Recording& recording, const std::filesystem::path& file) {
  schema::write_recording(file, recording);
  const auto violations = schema::validate(file);
  std::filesystem::remove(file);
  if (violations.empty()) return;
  const auto& [where, found, expected] = violations.front();
  promise(false,
          "what is imported is a valid recording: " + where + ": found " + found + ", expected " + expected);
}

/// The first line says how: a digit whose bits are strict, resampled, a map follows, kept in a file; then
/// comes the text.
void fuzz_import(Bytes bytes) {
  static const ScratchFolder folder;
  std::string_view text = text_of(bytes);
  std::string_view how = bench::take_line(text);
  const unsigned bits = how.empty() ? 0U : static_cast<unsigned char>(how.front()) - unsigned{'0'};
  how.remove_prefix(std::min<std::size_t>(how.size(), 1));

  TextLayout layout;
  if (!is_taken<std::invalid_argument>([&] { layout = bench::find_layout(text, "fuzz"); })) return;
  promise(!layout.columns.empty() && layout.data_begin < text.size(), "a layout has columns and data");
  for (const bench::TextColumn& column : layout.columns)
    promise(bench::to_utf8(column.heading) == column.heading, "headings are UTF-8");
  (void)bench::describe_columns(layout, text);
  fuzz_table(text, layout);

  ImportOptions options = suggested(layout, text);
  const bool has_map = is_taken<std::invalid_argument>([&] {
    if ((bits & 4U) != 0) options.map = bench::parse_map(how);
  });
  if (!has_map) return;
  options.strict = (bits & 1U) != 0;
  const auto file = folder.write("fuzz.txt", text);
  bench::Imported imported;
  if (!is_taken<std::invalid_argument>([&] { imported = bench::import_text(file, options); })) return;
  check_imported(imported.recording);
  if ((bits & 8U) != 0) check_kept(imported.recording, folder.path() / "imported.h5");
  const auto& time = imported.recording.time;
  if ((bits & 2U) == 0 || time.size() < 3) return;
  options.resample_hz = 1.5 * static_cast<double>(time.size()) / (time.back() - time.front());
  if (is_taken<std::invalid_argument>([&] { imported = bench::import_text(file, options); }))
    check_imported(imported.recording);
}

const Registered registered("import", fuzz_import);

}  // namespace
}  // namespace kerf::fuzz
