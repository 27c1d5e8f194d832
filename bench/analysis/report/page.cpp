#include "report/page.h"

#include <algorithm>
#include <stdexcept>
#include <system_error>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <kerf/schema/recording_file.h>

#include "clocks/time_stamp.h"
#include "html/html.h"
#include "recordings/axes.h"
#include "recordings/axis_values.h"
#include "recordings/summary.h"
#include "recordings/whole_recording.h"
#include "report/charts.h"
#include "report/cycle_section.h"
#include "report/fit_section.h"
#include "report/loop_section.h"
#include "report/results/found_results.h"
#include "report/results/sections.h"
#include "report/results/states.h"
#include "report/results/summary.h"

namespace kerf::bench {
namespace {

using json = nlohmann::ordered_json;

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

/// Runs what reads a result. @throws std::invalid_argument that names its file and its verb.
template <typename Read>
std::string read_with_care(const FoundResult& result, const Read& read) {
  try {
    return read();
  } catch (const json::exception& error) {
    throw std::invalid_argument(fmt::format("{} is not what '{}' writes: {}", result.file.string(),
                                            verb_of(result.kind), error.what()));
  }
}

/// A file in the recording's folder, or below it, by its way from there: the folder may have another name
/// later.
void name_beside(const std::filesystem::path& recording, FoundResult& result) {
  const auto folder = std::filesystem::absolute(recording).parent_path();
  const auto way = std::filesystem::absolute(result.file).lexically_relative(folder);
  if (!way.empty() && *way.begin() != "..") result.name = way.string();
}

/// Those that were named as fits and check, and those that were found.
std::vector<FoundResult> results_of(const ReportInput& input, const schema::RecordedRows& rows) {
  std::vector<std::filesystem::path> paths;
  if (input.fits) paths.push_back(*input.fits / "fit.json");
  if (input.check) paths.push_back(*input.check);
  paths.insert(paths.end(), input.results.begin(), input.results.end());
  std::vector<FoundResult> results = find_results(paths, rows.about().header.uuid);
  const auto same = [](const FoundResult& a, const FoundResult& b) {
    std::error_code absent;
    return std::filesystem::equivalent(a.file, b.file, absent);
  };
  for (std::size_t i = 0; i < results.size(); ++i) {
    const auto next = results.begin() + static_cast<std::ptrdiff_t>(i) + 1;
    results.erase(std::remove_if(next, results.end(),
                                 [&](const FoundResult& other) { return same(results[i], other); }),
                  results.end());
  }
  for (FoundResult& result : results) name_beside(input.recording, result);
  tell_states(results, rows);
  return results;
}

std::string summary_of_results(const std::vector<FoundResult>& results, const schema::RecordedRows& rows,
                               std::size_t axis) {
  for (const FoundResult& result : results)
    (void)read_with_care(result, [&] { return summary_of(result).text; });
  std::string html = summary_paragraph(results, count_cycles(rows, axis));
  if (const std::string contacts = contacts_apart(results, rows.about(), axis); !contacts.empty())
    html += "<p>" + escaped(contacts) + ".</p>\n";
  for (const FoundResult& result : results) {
    if (result.kind == ResultKind::fits) html += choice_paragraph(result.json, is_outdated(result.state));
    if (result.kind == ResultKind::check) html += verdict_paragraph(result.json);
  }
  return html;
}

std::string section_of(const FoundResult& result, const std::filesystem::path& recording, std::size_t axis) {
  return read_with_care(result, [&]() -> std::string {
    switch (result.kind) {
      case ResultKind::inspection:
        return inspection_section(result);
      case ResultKind::fits:
        return fit_section(read_whole_recording(recording), axis, result.json, result.file.parent_path()) +
               whose(result);
      case ResultKind::choice:
        return choice_section(result);
      case ResultKind::chart:
        return chart_section(result);
      case ResultKind::stability:
        return stability_section(result);
      case ResultKind::device:
        return device_section(result);
      case ResultKind::replay:
        return replay_section(result);
      case ResultKind::check:
        return loop_section(result.json) + whose(result);
    }
    return "";
  });
}

std::string without_fits_or_check(const std::vector<FoundResult>& results) {
  const auto has = [&](ResultKind kind) {
    return std::ranges::any_of(results, [&](const FoundResult& one) { return one.kind == kind; });
  };
  std::string html;
  if (!has(ResultKind::fits))
    html += "<h2>Fits</h2>\n<p class=\"soft\">No fit was given: <code>kerf fit</code> makes one.</p>\n";
  if (!has(ResultKind::check))
    html +=
        "<h2>Closed loop</h2>\n<p class=\"soft\">No check was given: <code>kerf check -o</code> makes "
        "one.</p>\n";
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
  const std::vector<FoundResult> results = results_of(input, rows);
  body += summary_of_results(results, rows, axis);
  body += recording_section(rows, input.recording, axis) + cycle_section(rows, axis);
  for (const FoundResult& result : results) body += section_of(result, input.recording, axis);
  body += without_fits_or_check(results) + missing_section(results, input.recording.filename().string());
  return html_page(name, body);
}

}  // namespace kerf::bench
