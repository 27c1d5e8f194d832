#include "views/recording_inspection.h"

#include <span>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <kerf/fitting/jnd.h>

#include "files/for_terminal.h"
#include "files/json_number.h"
#include "inspect/inspection.h"
#include "inspect/inspection_text.h"
#include "recordings/axes.h"

namespace kerf::bench {
namespace {

using nlohmann::ordered_json;

double time_of_row(const schema::RecordingFile& file, std::uint64_t row) {
  double time_s = 0.0;
  file.read(schema::Column::time, row, 1, std::span(&time_s, 1));
  return time_s;
}

void add_clipped_runs(const schema::RecordingFile& file, const InspectedSignal& signal, const EndOfRange& end,
                      ordered_json& runs) {
  if (end.is_clipped != true) return;
  for (const RowSpan& run : end.first_runs)
    runs.push_back({{"signal", signal.name},
                    {"unit", signal.unit},
                    {"value", json_number(end.value)},
                    {"rows", run.end - run.begin},
                    {"from_s", json_number(time_of_row(file, run.begin))},
                    {"to_s", json_number(time_of_row(file, run.end - 1))}});
}

std::string why_not_inspected(const schema::RecordingFile& file) {
  if (file.is_live())
    return "It is still written, or was left by a crash: it is inspected once it is closed.";
  if (file.rows() > max_rows_inspected)
    return fmt::format("It has {} rows; more than {} are inspected by 'kerf inspect'.", file.rows(),
                       max_rows_inspected);
  return "";
}

}  // namespace

std::string recording_inspection_json(const schema::RecordingFile& file) {
  ordered_json json{{"inspection", nullptr}, {"why_none", why_not_inspected(file)}, {"clipped", nullptr}};
  if (json["why_none"] == "") {
    const std::size_t axis = find_cut_axis(file.about(), "");
    const schema::Axis& along = file.about().axes[axis];
    const Inspection inspection =
        inspect(file, {.axis = axis, .felt = fitting::jnd_of(along.force_unit, along.lever).threshold});
    ordered_json clipped = ordered_json::array();
    for (const InspectedSignal& signal : inspection.signals) {
      add_clipped_runs(file, signal, signal.ends.least, clipped);
      add_clipped_runs(file, signal, signal.ends.most, clipped);
    }
    json["inspection"] = inspection_as_json(inspection);
    json["clipped"] = std::move(clipped);
  }
  return json_for_page(json.dump(-1, ' ', false, ordered_json::error_handler_t::replace));
}

}  // namespace kerf::bench
