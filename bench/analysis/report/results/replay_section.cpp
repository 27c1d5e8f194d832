#include <array>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/core.h>

#include <kerf/schema/recording_file.h>

#include "html/html.h"
#include "recordings/axes.h"
#include "recordings/axis_values.h"
#include "report/charts.h"
#include "report/fit_view.h"
#include "report/results/sections.h"

namespace kerf::bench {
namespace {

using json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr std::array replay_colours{Colour::vermillion, Colour::blue, Colour::green, Colour::purple,
                                    Colour::orange,     Colour::sky,  Colour::black};

/// What a law's command is times to be in the sense of the force that it was compared with: that of the
/// recording. Unknown for a result of an earlier version.
std::optional<double> sense_of_command(const json& law, const json& axis) {
  if (axis.at("against") == "commanded") return 1.0;
  if (!law.contains("direction")) return std::nullopt;
  const json& direction = law.at("direction");
  return direction.is_null() ? 1.0 : -direction.get<double>();
}

/// The force that was recorded and that of a law, as the recording beside the result has them.
void add_rendered(Chart& chart, const fs::path& file, const json& law, const json& axis, Colour colour) {
  const std::optional<double> sense = sense_of_command(law, axis);
  std::error_code absent;
  if (!sense || !fs::is_regular_file(file, absent)) return;
  const schema::RecordingFile rows(file);
  const schema::Recording& about = rows.about();
  const auto along = axis.at("axis").get<std::string>();
  const auto channel = std::ranges::find(about.channels, along + "_force_recorded", &schema::Channel::name);
  if (channel == about.channels.end() || rows.width(schema::Column::force_commanded) == 0) return;
  const auto place = static_cast<std::size_t>(channel - about.channels.begin());
  const BlockedValues time_s = axis_values(rows, schema::Column::time);
  const BlockedValues recorded(rows.rows(), [&](std::uint64_t first, std::span<double> values) {
    rows.read_channel(place, first, values);
  });
  const BlockedValues rendered = axis_values(rows, schema::Column::force_commanded, find_axis(about, along));
  if (chart.curves.empty()) {
    Curve& curve = chart.curves.emplace_back(drawn_curve(time_s, 1.0, recorded, 1.0));
    curve.label = "recorded";
    curve.colour = Colour::grey;
    curve.width = 3.0;
  }
  Curve& curve = chart.curves.emplace_back(drawn_curve(time_s, 1.0, rendered, *sense));
  curve.label = law.at("name").get<std::string>();
  curve.colour = colour;
  curve.width = 1.2;
}

Chart replayed_chart(const json& replay, const fs::path& folder, const std::string& axis_name) {
  Chart chart{.title = fmt::format("Force along {}, recorded and rendered on the same ticks", axis_name),
              .x_label = "time [s]",
              .legend_below = true};
  align_times(chart, replay.at("from_s").get<double>(), replay.at("to_s").get<double>());
  std::size_t laws = 0;
  for (const json& law : replay.at("laws")) {
    const Colour colour = replay_colours[laws++ % replay_colours.size()];
    for (const json& axis : law.at("axes")) {
      if (axis.at("axis") != axis_name) continue;
      chart.y_label = fmt::format("force [{}]", axis.at("unit").get<std::string>());
      const fs::path name = fs::path(law.at("name").get<std::string>() + ".h5").filename();
      add_rendered(chart, folder / name, law, axis, colour);
    }
  }
  return chart;
}

std::string error_table(const json& laws) {
  std::vector<std::vector<std::string>> rows{
      {"law", "axis", "against", "rms", "rms [JND]", "worst", "at [s]", "faults"}};
  for (const json& law : laws) {
    for (const json& axis : law.at("axes")) {
      const std::string unit = " " + axis.at("unit").get<std::string>();
      rows.push_back({law.at("name").get<std::string>(), axis.at("axis").get<std::string>(),
                      axis.at("against").get<std::string>(), number_text(axis.at("rms")) + unit,
                      number_text(axis.at("rms_jnd")), number_text(axis.at("worst")) + unit,
                      number_text(axis.at("worst_at_s")), number_text(law.at("faults"), "{:.0f}")});
    }
  }
  return html_table(rows);
}

std::string events_of_laws(const json& laws) {
  std::vector<std::vector<std::string>> rows{
      {"law", "axis", "event", "recorded", "rendered", "matched", "late, mean [ms]"}};
  for (const json& law : laws) {
    for (const json& axis : law.at("axes")) {
      for (const auto& [kind, value] : axis.at("events").items()) {
        const json& count = value;
        const auto number = [&](const char* key) { return number_text(count.at(key), "{:.0f}"); };
        rows.push_back({law.at("name").get<std::string>(), axis.at("axis").get<std::string>(), kind,
                        number("recorded"), number("rendered"), number("matched"),
                        number_text(count.at("mean_late_ms"), "{:.3g}")});
      }
    }
  }
  return html_table(rows);
}

}  // namespace

std::string replay_section(const FoundResult& result) {
  const json& replay = result.json;
  std::string html = "<h2>Replayed through laws</h2>\n" + whose(result);
  std::set<std::string> axes;
  for (const json& law : replay.at("laws")) {
    for (const json& axis : law.at("axes")) axes.insert(axis.at("axis").get<std::string>());
  }
  for (const std::string& axis : axes) {
    const Chart chart = replayed_chart(replay, result.file.parent_path(), axis);
    if (!chart.curves.empty()) html += html_figure(draw(chart));
  }
  return html + error_table(replay.at("laws")) + events_of_laws(replay.at("laws"));
}

}  // namespace kerf::bench
