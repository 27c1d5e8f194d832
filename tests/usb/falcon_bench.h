#pragma once

#include <array>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <kerf/drivers/protocols/c2000_image.h>

#include "csv.h"
#include "support/program.h"

namespace kerf::test {

/// An image of so many words that no Falcon ever saw, and that the emulated one takes; its path.
inline std::string firmware_file(const TemporaryFolder& folder, std::size_t words = 60) {
  drivers::c2000::Block block{.destination = 0x3F8002, .words = {}};
  for (std::size_t i = 0; i < words; ++i) block.words.push_back(static_cast<std::uint16_t>(40503 * (i + 1)));
  const auto image = drivers::c2000::make_image(0x3F8002, std::array{block});
  std::string path = folder / ("firmware-" + std::to_string(words) + ".bin");
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(image.data()), static_cast<std::streamsize>(image.size()));
  return path;
}

/// A line of the emulator's trace: one frame.
struct TraceRow {
  double time_s = 0.0;
  std::array<int, 3> raw{};
  std::array<int, 3> motor{};
  std::array<int, 3> encoder{};
  std::array<double, 3> knob{};
  bool homing = false;
  std::string led;
};
inline std::vector<TraceRow> read_trace(const std::filesystem::path& path) {
  std::vector<TraceRow> rows;
  for_each_row(path, [&](std::istream& words) {
    TraceRow row;
    words >> row.time_s;
    for (auto* numbers : {&row.raw, &row.motor, &row.encoder}) {
      for (int& number : *numbers) words >> number;
    }
    for (double& number : row.knob) words >> number;
    words >> row.homing >> row.led;
    if (words) rows.push_back(row);
  });
  return rows;
}

}  // namespace kerf::test
