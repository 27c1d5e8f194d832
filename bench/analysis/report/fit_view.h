#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <kerf/schema/recording.h>

#include "laws/law_file.h"
#include "laws/render.h"
#include "report/charts.h"

namespace kerf::bench {

/// A law drawn along the recording.
struct FittedTrace {
  std::string model;
  nlohmann::ordered_json fit;  ///< its part of fit.json
  LawFile law;
  Colour colour = Colour::vermillion;
  std::vector<double> force;     ///< without rendering aids; NaN in rows that it is not judged by
  std::vector<double> residual;  ///< recorded less law, likewise
};

/// What the charts of a fit are drawn from: the rows that the fit saw, and the laws, the chosen one first and
/// the others by their error on held-out data.
struct FitView {
  AxisSeries series;  ///< with the rows marked that the fit was judged by
  std::vector<FittedTrace> traces;
  std::size_t shown = 0;  ///< how many of them are drawn in full, from the front
  DrawnUnit position;
  std::string force_unit;
  bool of_this_recording = true;  ///< the fit names the recording
};

/// @throws std::invalid_argument, std::system_error for a law file that is not one;
///         nlohmann::json::exception if the JSON lacks what `kerf fit` writes.
[[nodiscard]] FitView view_of_fits(const schema::Recording& recording, std::size_t axis,
                                   const nlohmann::ordered_json& fits, const std::filesystem::path& folder);

/// The stretches of rows that no law is judged by, in grey; none where there are more than can be told apart.
[[nodiscard]] std::vector<Band> bands_not_judged(const AxisSeries& series, double from_s, double to_s);

/// The error by which laws are compared: on held-out data, on the test share, or where there is neither on
/// all.
[[nodiscard]] double compared_error(const nlohmann::ordered_json& fit);

/// "0.0123", or "-" for what is not there or not determined.
[[nodiscard]] std::string number_text(const nlohmann::ordered_json& value, const char* format = "{:.4g}");

/// Charts side by side, two in a row where the page is wide enough.
[[nodiscard]] std::string figures_in_pairs(const std::vector<Chart>& charts);

}  // namespace kerf::bench
