#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "plot/plot.h"
#include "stability/device/travel_units.h"
#include "stability/maps.h"
#include "stability/tool_way.h"

namespace kerf::bench {

/// What was studied, by its name: empty where no device was named.
struct StudiedAxis {
  std::string device_uri;
  std::string axis;
  std::string grip;
  WayRequest way;  ///< of a law on several axes
  TravelUnits units{};
};

/// What a study leaves behind: the numbers, a table of them, pictures, a page, and lines for a terminal.
// NOLINTNEXTLINE(bugprone-exception-escape): of what moves JSON, which does not throw
struct Findings {
  nlohmann::ordered_json json;
  std::string csv;
  std::vector<Figure> figures;
  std::string
      html;  ///< of a page, below the lines; a picture stands where its name is in a comment, or above
  std::vector<std::string> lines;
};

/// A law's limits and its map together.
struct LawStudy {
  std::string model;
  AxisLaw law;
  SampledDevice device;
  ToolRange range;
  LawLimits limits;
  LawMap map;
  bool met = true;                      ///< is_met() over the range; what is below says nothing else
  bool passive = true;                  ///< over the range, at the device's own rate
  std::optional<Gain> worst;            ///< of the range, if it is not passive
  std::optional<PressVerdict> pressed;  ///< in the hand, to the range's depth; none if there is no hand
};

[[nodiscard]] nlohmann::ordered_json as_json(const SampledDevice& device);
/// The body of a page: the lines, the pictures (drawn here), and what else there is.
[[nodiscard]] std::string page_body(const Findings& findings);
[[nodiscard]] Findings findings_of(const WallMap& map, const StudiedAxis& on = {});
[[nodiscard]] Findings findings_of(const LawStudy& study, const StudiedAxis& on = {});

/// @throws std::invalid_argument if a file that write_findings() always writes stands in the folder.
void refuse_to_replace_findings(const std::filesystem::path& folder, bool replace);
/// Writes stability.json, stability.csv, stability.html and the pictures into a folder.
/// @throws std::system_error.
void write_findings(const Findings& findings, const std::filesystem::path& folder);

}  // namespace kerf::bench
