#include "report/page.h"

#include <algorithm>
#include <stdexcept>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <kerf/schema/recording_file.h>

#include "clocks/time_stamp.h"
#include "files/named_file.h"
#include "html/html.h"
#include "recordings/axes.h"
#include "recordings/axis_values.h"
#include "recordings/summary.h"
#include "recordings/whole_recording.h"
#include "report/charts.h"
#include "report/fit_section.h"
#include "report/loop_section.h"

namespace kerf::bench {
namespace {

using json = nlohmann::ordered_json;

json read_json(const std::filesystem::path& file) {
  try {
    return json::parse(read_named_file(file, LargestInput::table));
  } catch (const json::exception& error) {
    throw std::invalid_argument(fmt::format("{}: not JSON: {}", file.string(), error.what()));
  }
}

std::string channel_table(const json& summary) {
  std::vector<std::vector<std::string>> rows{{"channel", "unit", "smallest", "largest"}};
  for (const auto& [name, value] : summary.at("channels").items()) {
    const json& channel = value;
    const auto number = [&](const char* key) {
      return channel.at(key).is_null() ? std::string("-")
                                       : fmt::format("{:.5g}", channel.at(key).get<double>());
    };
    rows.push_back({name, channel.at("unit").get<std::string>(), number("min"), number("max")});
  }
  return html_table(rows);
}

std::string recording_section(const schema::RecordedRows& rows, const std::filesystem::path& file,
                              std::size_t axis) {
  const json summary = recording_summary(rows);
  const schema::Recording& recording = rows.about();
  std::vector<std::vector<std::string>> facts{{"recording", file.filename().string()}};
  facts.push_back({"identifier", recording.header.uuid});
  facts.push_back({"written", recording.header.created + " by " + recording.header.software});
  if (!recording.header.source.empty()) facts.push_back({"imported from", recording.header.source});
  if (recording.header.start_ns) facts.push_back({"time 0", start_text(recording.header)});
  if (!recording.header.device_uri.empty()) facts.push_back({"device", recording.header.device_uri});
  facts.push_back({"status", recording.header.status});
  facts.push_back(
      {"samples", fmt::format("{} over {:.3f} s, {:.5g} Hz, {} gaps", rows.rows(),
                              summary.at("duration_s").get<double>(), summary.at("rate_hz").get<double>(),
                              summary.at("gaps").get<std::uint64_t>())});
  facts.push_back({"velocity", recording.header.velocity_derived.empty()
                                   ? "measured"
                                   : "derived: " + recording.header.velocity_derived});
  for (const json& warning : summary.at("warnings")) facts.push_back({"warning", warning.get<std::string>()});
  for (const schema::Event& event : recording.events) {
    facts.push_back({"event", fmt::format("{:.3f} s, {}: {}", event.time_s, event.kind, event.text)});
  }
  std::string html = "<h2>What was recorded</h2>\n" + html_table(facts) + channel_table(summary);
  if (!recording.header.scene_toml.empty()) {
    html += "<details><summary>The scene, with its known parameters</summary><pre>" +
            escaped(recording.header.scene_toml) + "</pre></details>\n";
  }
  html += html_figure(draw(position_chart(recording, rows, axis)));
  if (rows.width(force_column(rows)) > 0) {
    html += html_figure(draw(force_chart(recording, rows, axis))) +
            html_figure(draw(loop_chart(recording, rows, axis)));
  }
  return html;
}

}  // namespace

std::string report_page(const ReportInput& input) {
  const schema::RecordingFile rows(input.recording);
  if (rows.rows() < 2) {
    throw std::invalid_argument(
        fmt::format("{}: {} samples are too few for a report", input.recording.string(), rows.rows()));
  }
  const schema::Recording& recording = rows.about();
  const std::size_t axis =
      input.axis.empty() && recording.cycles ? recording.cycles->axis : find_axis(recording, input.axis);
  const std::string name = input.recording.stem().string();
  std::string body = fmt::format("<h1>{}</h1>\n<p class=\"soft\">Report of {}, axis {}</p>\n", escaped(name),
                                 escaped(recording.header.software), escaped(recording.axes[axis].name));
  json fits;
  if (input.fits) {
    fits = read_json(*input.fits / "fit.json");
    body += choice_paragraph(fits);
  }
  json check;
  if (input.check) {
    check = read_json(*input.check);
    body += verdict_paragraph(check);
  }
  body += recording_section(rows, input.recording, axis);
  body += input.fits
              ? fit_section(read_whole_recording(input.recording), axis, fits, *input.fits)
              : "<h2>Fits</h2>\n<p class=\"soft\">No fit was given: <code>kerf fit</code> makes one.</p>\n";
  body +=
      input.check
          ? loop_section(check)
          : "<h2>Closed loop</h2>\n<p class=\"soft\">No check was given: <code>kerf check -o</code> makes "
            "one.</p>\n";
  return html_page(name, body);
}

}  // namespace kerf::bench
