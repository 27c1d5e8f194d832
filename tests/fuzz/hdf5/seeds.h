#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <kerf/schema/recording.h>
#include <kerf/schema/regression.h>
#include <kerf/schema/session.h>
#include <kerf/schema/sweep_tables.h>

#include "datasets-schema/recording/sample_recording.h"
#include "datasets-schema/sample_sweep.h"
#include "files/whole_file.h"
#include "fuzz/scratch_folder.h"

namespace kerf::fuzz {

/// One sound file of each schema, as Kerf writes it: what is then put out of order.
class SeedFiles {
 public:
  static constexpr std::size_t count = 4;

  SeedFiles() {
    const auto file = folder_.path() / "seed.h5";
    schema::write_recording(file, test::sample_recording());
    bytes_[0] = bench::read_whole_file(file);
    schema::write_regression(file, stored_forces());
    bytes_[1] = bench::read_whole_file(file);
    schema::write_session(file, session());
    bytes_[2] = bench::read_whole_file(file);
    test::write_sample_sweep(file);
    bytes_[3] = bench::read_whole_file(file);
  }

  [[nodiscard]] const std::string& bytes(std::size_t seed) const { return bytes_.at(seed); }

  /// The file anew, as sound as it was.
  [[nodiscard]] std::filesystem::path write(std::size_t seed) const {
    return folder_.write("fuzz.h5", bytes_.at(seed));
  }
  [[nodiscard]] const ScratchFolder& folder() const { return folder_; }

 private:
  static std::vector<schema::StoredForces> stored_forces() {
    schema::StoredForces one{.name = "kelvin",
                             .model = "kelvin",
                             .law_sha256 = "00ff",
                             .trajectory_sha256 = "ff00",
                             .reason = "first",
                             .date = "2026-01-31T12:00:00Z",
                             .software = "kerf 0.1.0",
                             .history = "",
                             .channels = {{.name = "theta", .unit = "N"}, {.name = "rx", .unit = "N·m"}},
                             .force = {0.0, 1.0, 2.0, 3.0, 4.0, 5.0},
                             .tick_cost = 2.5,
                             .tick_cost_build = "optimised"};
    schema::StoredForces other = one;
    other.name = "other";
    other.tick_cost.reset();
    return {one, other};
  }

  static schema::Session session() {
    const std::vector<std::uint8_t> box(48, 7);
    return {.uuid = "0b5f1e0a-54bb-4c5e-9d55-6cf3f4d33c11",
            .created = "2026-01-31T12:00:00Z",
            .software = "kerf 0.1.0",
            .subject = "S01",
            .protocol = "name = \"a study\"\n",
            .laws = {{.name = "a.law.toml", .toml = "model = \"kelvin\"\n"}},
            .key = {.kind = "passphrase", .operations = 3, .memory_bytes = 1U << 20U},
            .entries = {{.kind = "plan", .time = "2026-01-31T12:00:00Z", .text = "", .sealed = box},
                        {.kind = "trial", .time = "2026-01-31T12:01:00Z", .text = "1", .sealed = box}}};
  }

  ScratchFolder folder_;
  std::array<std::string, count> bytes_;
};

[[nodiscard]] inline const SeedFiles& seed_files() {
  static const SeedFiles files;
  return files;
}

}  // namespace kerf::fuzz
