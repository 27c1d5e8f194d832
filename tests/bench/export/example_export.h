#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include <kerf/models/law.h>

#include "exported_law.h"
#include "support/program.h"

namespace kerf::test {

/// A law on its way, with a C file that was written by hand: liver.c beside this.
inline bench::ExportedLaw liver() {
  const std::filesystem::path examples = KERF_SOURCE_DIR "/examples";
  bench::ExportedLaw law{.name = "liver",
                         .file = bench::read_law_file(examples / "kelvin.law.toml"),
                         .text = read_text(examples / "kelvin.law.toml"),
                         .sha256 = "0123456789abcdef0123456789abcdef0123456789abcdef0123456789abcdef",
                         .plain_c = read_text(KERF_SOURCE_DIR "/tests/bench/export/liver.c")};
  return law;
}

inline void write_files(const std::vector<bench::HostFile>& files, const std::filesystem::path& folder) {
  for (const bench::HostFile& file : files) {
    std::filesystem::create_directories((folder / file.name).parent_path());
    write_text(folder / file.name, file.content);
  }
}

/// A tool that goes in and out, at steps of several lengths.
inline std::vector<bench::HostSample> wandering(std::size_t count) {
  std::vector<bench::HostSample> samples;
  double time = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const double elapsed = i % 7 == 3 ? 0.0025 : 0.001;
    time += elapsed;
    samples.push_back({.position = 0.45 + 0.1 * std::sin(9.0 * time),
                       .velocity = 0.9 * std::cos(9.0 * time),
                       .elapsed_s = elapsed});
  }
  return samples;
}

/// The forces of liver.c itself, compiled into the test.
[[nodiscard]] std::vector<double> forces_of_liver(const std::vector<bench::HostSample>& samples);

/// Where two are not the same to the bit; every not-a-number is the same.
inline std::vector<std::size_t> differing(const std::vector<double>& left, const std::vector<double>& right) {
  std::vector<std::size_t> where;
  for (std::size_t i = 0; i < std::max(left.size(), right.size()); ++i) {
    if (i >= left.size() || i >= right.size() ||
        (std::isnan(left[i])
             ? !std::isnan(right[i])
             : std::bit_cast<std::uint64_t>(left[i]) != std::bit_cast<std::uint64_t>(right[i])))
      where.push_back(i);
  }
  return where;
}

}  // namespace kerf::test
