#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "atlas/atlas_question.h"
#include "atlas/sweep_atlas.h"

namespace kerf::bench {

/// A share of cells beside others in a picture of shares.
struct NamedShare {
  std::string name;  ///< what has a colour
  std::string at;    ///< its place along the axis
  AtlasQuestion question;
};

/// One picture of a sweep.
struct AtlasPicture {
  enum class Kind : std::uint8_t {
    map,       ///< question.by: x, y and then what stands beside and below each other
    lines,     ///< question.by: x and then what has a line of its own
    shares,    ///< several shares with their intervals
    parallel,  ///< a line a cell over `columns`, in the colour of question.of
  };
  Kind kind = Kind::map;
  std::string name;  ///< of its file, without ".svg"
  std::string title;
  AtlasQuestion question;
  std::vector<double> steps{};         ///< of the colours; empty: round ones
  std::vector<std::string> columns{};  ///< of parallel coordinates
  std::vector<NamedShare> shares{};
  double nominal = std::numeric_limits<double>::quiet_NaN();  ///< a line across; NaN: none
};

/// Pictures as a person describes them: docs/sweeps.md.
/// @throws std::invalid_argument with file and line.
[[nodiscard]] std::vector<AtlasPicture> read_pictures(const std::filesystem::path& file);

/// What is looked at first where nobody says what: of each table a map of what came out over the two inputs
/// that have most values, beside each other for the next ones, and parallel coordinates.
[[nodiscard]] std::vector<AtlasPicture> usual_pictures(SweepAtlas& atlas);

}  // namespace kerf::bench
