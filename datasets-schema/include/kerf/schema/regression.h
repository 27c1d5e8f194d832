#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/schema/recording.h>

namespace kerf::schema {

inline constexpr std::string_view regression_schema_name = "kerf.regression";
inline constexpr std::uint32_t regression_schema_version = 1;

/// One column of stored forces.
struct ForceChannel {
  std::string name;        ///< "theta", "rx", ...
  std::string unit = "N";  ///< "N" or "N·m"
  friend bool operator==(const ForceChannel&, const ForceChannel&) = default;
};

/// What forces were rendered for: one row a tick, as a recording or a table gave it.
struct StoredTrajectory {
  std::vector<ForceChannel> axes;  ///< in "m" or "rad"
  std::vector<double> time_s;
  std::vector<double> position;  ///< N x D, row-major

  [[nodiscard]] bool empty() const noexcept { return time_s.empty(); }
  friend bool operator==(const StoredTrajectory&, const StoredTrajectory&) = default;
};

/// The forces that a law rendered along a trajectory, tick by tick, and how they came to be stored.
struct StoredForces {
  std::string name;        ///< of the case, unique in its file, without '/'
  std::string model;       ///< the law's; empty of a renderer that is no law of Kerf
  std::string renderer{};  ///< how such a renderer was called; else empty, and not in the file
  std::string law_sha256;
  std::string trajectory_sha256;
  std::string reason;    ///< why these forces were stored
  std::string date;      ///< ISO 8601, UTC
  std::string software;  ///< "kerf 0.1.0"
  std::string history;   ///< those that stood before: one line each, oldest first
  std::vector<ForceChannel> channels;
  std::vector<double> force;  ///< N x D, row-major
  /// What `trajectory_sha256` is of; empty if it is not kept. Cases of one trajectory have it once in the
  /// file.
  StoredTrajectory trajectory{};
  std::uint64_t faults = 0;              ///< ticks in which the law faulted
  std::optional<double> tick_cost;       ///< of a tick, in rounds of the calibration loop
  std::string tick_cost_build;           ///< what kind of build it was measured with
  std::vector<double> compute_time_s{};  ///< of every tick of a renderer; empty: it was not measured
  std::string compute_time_of{};         ///< "renderer", which told it, or "round trip"
  std::string made_with{};               ///< version and SHA-256 of programs, a line each; may be empty

  [[nodiscard]] std::size_t rows() const noexcept {
    return channels.empty() ? 0 : force.size() / channels.size();
  }
  friend bool operator==(const StoredForces&, const StoredForces&) = default;
};

/// Reads the stored forces of a suite, in the order in which they were written.
/// @throws FormatError in one line; std::invalid_argument (the caller named it wrongly: there is no such
/// file, or it may not be read).
[[nodiscard]] std::vector<StoredForces> read_regression(const std::filesystem::path& file);

/// Writes the stored forces of a suite, compressed without loss: to a temporary name beside `file`, then
/// renamed, so that a half-written file never stands under the final name. An existing file is replaced.
/// @throws std::invalid_argument (a name twice or with '/', forces or positions that do not fill their
/// rows),
/// std::system_error.
void write_regression(const std::filesystem::path& file, const std::vector<StoredForces>& cases);

}  // namespace kerf::schema
