#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/core.h>

#include <kerf/schema/recording_file.h>

#include "atlas/atlas_page.h"
#include "files/whole_file.h"
#include "files/whole_folder.h"
#include "program/verbs.h"
#include "recordings/axes.h"
#include "recordings/axis_values.h"
#include "report/page.h"
#include "study/swept_verbs.h"

namespace kerf::bench {
namespace {

struct ReportVerbArguments {
  std::string recording;
  std::vector<std::string> results;
  std::string fits;
  std::string check;
  std::string axis;
  std::string pictures;
  std::string figures;
  std::string output;
  bool force = false;
};

/// A picture of nothing is none.
void require_a_row(const ReportVerbArguments& arguments) {
  const schema::RecordingFile rows(arguments.recording);
  const std::size_t axis = find_cut_axis(rows.about(), arguments.axis);
  const BlockedValues position = axis_values(rows, schema::Column::position, axis);
  const schema::Column column = force_column(rows);
  const bool forceful = rows.width(column) > 0;
  const BlockedValues force = axis_values(rows, forceful ? column : schema::Column::position, axis);
  for (std::uint64_t row = 0; row < rows.rows(); ++row) {
    if (std::isfinite(position[row]) && std::isfinite(force[row])) return;
  }
  if (rows.rows() == 0) return;  // which is too few, and said so
  throw std::invalid_argument(
      fmt::format("{}: no row has a position and a force that are finite", arguments.recording));
}

/// Of a sweep: its pictures on a page, and each as a file of its own if that is asked for.
void report_sweep(const ReportVerbArguments& arguments, Context& context) {
  if (!arguments.results.empty() || !arguments.fits.empty() || !arguments.check.empty() ||
      !arguments.axis.empty())
    throw std::invalid_argument(
        fmt::format("{}: a sweep takes no results, fits, check or axis beside it; --pictures says "
                    "what is drawn of it",
                    arguments.recording));
  if (!arguments.figures.empty()) require_output(arguments.figures, arguments.force);
  SweepAtlas atlas(arguments.recording, swept_verbs());
  const std::vector<AtlasPicture> pictures =
      arguments.pictures.empty() ? usual_pictures(atlas) : read_pictures(arguments.pictures);
  std::vector<DrawnPicture> drawn;
  for (const AtlasPicture& picture : pictures) drawn.push_back(draw_picture(atlas, picture));
  context.result = {{"report", arguments.output}, {"pictures", nlohmann::ordered_json::array()}};
  for (std::size_t i = 0; i < pictures.size(); ++i)
    context.result["pictures"].push_back({{"name", pictures[i].name}, {"caption", drawn[i].caption}});
  if (!arguments.figures.empty()) {
    WholeFolder folder(arguments.figures, schema::existing_if(arguments.force));
    for (std::size_t i = 0; i < pictures.size(); ++i)
      write_whole_file(folder.path() / (pictures[i].name + ".svg"), drawn[i].svg, schema::Existing::keep);
    folder.commit();
  }
  write_whole_file(arguments.output, atlas_page(atlas, pictures, drawn),
                   schema::existing_if(arguments.force));
  context.say(arguments.output);
}

void run_report(const ReportVerbArguments& arguments, Context& context) {
  require_output(arguments.output, arguments.force);
  if (is_merged_sweep(arguments.recording)) {
    report_sweep(arguments, context);
    return;
  }
  if (!arguments.pictures.empty() || !arguments.figures.empty())
    throw std::invalid_argument("--pictures and --figures are for a sweep that was merged");
  ReportInput input{.recording = arguments.recording, .axis = arguments.axis};
  if (!arguments.fits.empty()) input.fits = arguments.fits;
  if (!arguments.check.empty()) input.check = arguments.check;
  input.results.assign(arguments.results.begin(), arguments.results.end());
  require_a_row(arguments);
  write_whole_file(arguments.output, report_page(input), schema::existing_if(arguments.force));
  context.result = {{"report", arguments.output}};
  context.say(arguments.output);
}

}  // namespace

void add_report(CLI::App& app, Context& context) {
  auto arguments = std::make_shared<ReportVerbArguments>();
  Verb verb = add_verb(
      app, context, "report", "Write one self-contained HTML page about a recording or a sweep",
      "kerf report punch.h5 fits choice check.json inspect.json -o punch.html\n"
      "  kerf report punch.h5 --fits fits --check check.json -o punch.html\n"
      "  kerf report walls.merged -o walls.html\n\n"
      "RESULTS are what other verbs have found, files or folders, in any number: the JSON of fit,\n"
      "choose, chart, stability, identify, replay, check and inspect. Which it is, is told by what is in "
      "it;\n"
      "of a folder only what is of this recording is taken. docs/reports.md says what is on the page.",
      [arguments, &context] { run_report(*arguments, context); });
  verb.takes_laws(context);
  verb.add_option("RECORDING", arguments->recording, "Recording, or folder that 'kerf sweep merge' wrote")
      .required();
  verb.takes_texts(context, arguments->recording);
  verb.add_option("RESULTS", arguments->results, "JSON of other verbs, or folders that hold such");
  verb.add_option("--fits", arguments->fits, "Folder that 'kerf fit' wrote");
  verb.add_option("--check", arguments->check, "JSON that 'kerf check -o' wrote");
  verb.add_option("--axis", arguments->axis, "Axis to report (default: that of the cycles, or the first)");
  verb.add_option("--pictures", arguments->pictures,
                  "Of a sweep: PICTURES.toml, what is drawn of it (docs/sweeps.md)");
  verb.add_option("--figures", arguments->figures,
                  "Of a sweep: folder for each picture as an SVG of its own");
  verb.add_option("-o,--output", arguments->output, "Page to write").required();
  verb.add_flag("--force", arguments->force, "Replace an existing page");
}

}  // namespace kerf::bench
