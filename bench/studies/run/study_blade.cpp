#include "run/study_blade.h"

#include <cmath>
#include <stdexcept>

#include <fmt/ranges.h>

#include "fits/blade_recording.h"
#include "recordings/provenance.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t axes_of_a_blade = 6;

StudiedBlade studied(const fitting::BladeFit& fit) {
  StudiedBlade blade{.why_none = "",
                     .rows_in_tissue = fit.rows_in_tissue,
                     .rmse = std::hypot(fit.rmse[0], fit.rmse[1], fit.rmse[2]),
                     .rms = std::hypot(fit.rms[0], fit.rms[1], fit.rms[2])};
  for (const fitting::Estimate& estimate : fit.parameters)
    blade.parameters.push_back({.name = estimate.info.name,
                                .unit = models::unit_of(estimate.info.quantity, "N", "m"),
                                .value = estimate.value,
                                .std_error = estimate.std_error,
                                .is_positive = estimate.info.lower >= 0.0});
  return blade;
}

StudiedBlade no_blade(const std::string& why) {
  StudiedBlade blade;
  blade.why_none = why;
  return blade;
}

}  // namespace

std::string why_no_axis(const schema::Recording& recording, const std::string& named) {
  if (recording.dimensions() == 1 || recording.cycles) return "";
  if (!named.empty()) return fmt::format("it has no cycles along its axis {}", named);
  std::vector<std::string> names;
  for (const schema::Axis& axis : recording.axes) names.push_back(axis.name);
  return fmt::format(
      "it has the axes {}, and the study's laws act along one: axis = \"{}\" in its [[file]] names it",
      fmt::join(names, ", "), names.front());
}

std::optional<StudiedBlade> fit_blade_in_study(const schema::Recording& recording, const fs::path& shape,
                                               const fs::path& folder, std::vector<std::string>& warnings) {
  if (recording.dimensions() != axes_of_a_blade) return std::nullopt;
  if (shape.empty())
    return no_blade("study.toml names no shape, blade = \"FILE.law.toml\" as 'kerf blade --shape' takes");
  try {
    fitting::BladeFitOptions options;
    options.law_options = blade_shape_of(read_law_file(shape), shape.filename().string());
    BladeRecordingFit all = fit_blade_recording(recording, options);
    for (const std::string& warning : all.warnings) warnings.push_back("blade: " + warning);
    name_recording(all.file.fit, folder / "recording.h5");
    fs::create_directory(folder / "fits");
    write_law_file(folder / "fits" / "blade.law.toml", all.file, schema::Existing::replace);
    return studied(all.fit);
  } catch (const std::invalid_argument& error) {
    return no_blade(error.what());
  }
}

}  // namespace kerf::bench
