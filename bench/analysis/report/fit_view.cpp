#include "report/fit_view.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include <fmt/core.h>

#include "fits/judged_rows.h"
#include "html/html.h"
#include "recordings/axis_series.h"

namespace kerf::bench {
namespace {

using json = nlohmann::ordered_json;

constexpr std::size_t max_shown = 4;
constexpr std::array law_colours{Colour::vermillion, Colour::blue, Colour::green, Colour::purple};

/// The recording's place in the fit; 0 also if the fit does not name it.
std::pair<std::size_t, bool> place_of(const schema::Recording& recording, const json& fits) {
  if (!fits.contains("recordings")) return {0, fits.at("recording") == recording.header.uuid};
  const json& all = fits.at("recordings");
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].at("uuid") == recording.header.uuid) return {i, true};
  }
  return {0, false};
}

std::string law_file_of(const json& fit, std::size_t place) {
  std::string shared = fit.at("model").get<std::string>() + ".law.toml";
  if (!fit.contains("law_files") || place >= fit.at("law_files").size()) return shared;
  return fit.at("law_files")[place].get<std::string>();
}

}  // namespace

double compared_error(const json& fit) {
  for (const auto* name : {"cv_rmse_rendered", "cv_rmse", "test_rmse_rendered", "test_rmse", "rmse"}) {
    if (fit.contains(name) && fit.at(name).is_number()) return fit.at(name).get<double>();
  }
  return std::numeric_limits<double>::infinity();
}

FitView view_of_fits(const schema::Recording& recording, std::size_t axis, const json& fits,
                     const std::filesystem::path& folder) {
  FitView view{.series = {},
               .traces = {},
               .position = drawn_position(recording.axes[axis]),
               .force_unit = recording.axes[axis].force_unit};
  const auto [place, named] = place_of(recording, fits);
  view.of_this_recording = named;
  for (const json& fit : fits.at("fits")) {
    view.traces.push_back({.model = fit.at("model").get<std::string>(),
                           .fit = fit,
                           .law = read_law_file(folder / law_file_of(fit, place)),
                           .force = {},
                           .residual = {}});
  }
  const std::string chosen = fits.at("choice").at("model").get<std::string>();
  std::stable_sort(view.traces.begin(), view.traces.end(), [&](const FittedTrace& a, const FittedTrace& b) {
    if ((a.model == chosen) != (b.model == chosen)) return a.model == chosen;
    return compared_error(a.fit) < compared_error(b.fit);
  });
  view.shown = std::min(max_shown, view.traces.size());
  if (view.traces.empty()) return view;
  view.series = fit_series(recording, axis, view.traces.front().law.contact);
  mark_judged(view.series, recording, axis, fits);
  for (std::size_t i = 0; i < view.traces.size(); ++i) {
    FittedTrace& trace = view.traces[i];
    trace.colour = i < law_colours.size() ? law_colours[i] : Colour::black;
    trace.force = render(without_rendering_aids(trace.law.law), view.series);
    for (std::size_t row = 0; row < trace.force.size(); ++row) {
      if (!is_judged(view.series, row)) trace.force[row] = line_break;
      trace.residual.push_back(view.series.force[row] - trace.force[row]);
    }
  }
  return view;
}

std::vector<Band> bands_not_judged(const AxisSeries& series, double from_s, double to_s) {
  constexpr std::size_t told_apart = 300;
  std::vector<Band> bands;
  for (std::size_t row = 0; row < series.time_s.size();) {
    const std::size_t begin = row++;
    if (is_judged(series, begin)) continue;
    while (row < series.time_s.size() && !is_judged(series, row)) ++row;
    const Band band{.begin = std::max(from_s, series.time_s[begin]),
                    .end = std::min(to_s, series.time_s[std::min(row, series.time_s.size() - 1)]),
                    .colour = Colour::grey};
    if (band.begin < band.end) bands.push_back(band);
  }
  return bands.size() <= told_apart ? bands : std::vector<Band>();
}

std::string number_text(const json& value, const char* format) {
  return value.is_number() ? fmt::format(fmt::runtime(format), value.get<double>()) : "-";
}

std::string figures_in_pairs(const std::vector<Chart>& charts) {
  if (charts.empty()) return {};
  std::string html = "<div class=\"pair\">\n";
  for (const std::string& drawing : draw_all(charts)) html += html_figure(drawing);
  return html + "</div>\n";
}

}  // namespace kerf::bench
