#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/schema/live_recording.h>
#include <kerf/schema/recording.h>
#include <kerf/schema/regression.h>
#include <kerf/schema/session.h>
#include <kerf/schema/sweep_tables.h>
#include <kerf/schema/validate.h>

/// What reads files with HDF5 in the very process that calls it. Damage can make HDF5 fall over: only
/// `kerf-reader` calls these on files that it was given; everybody else asks it (apart/).
namespace kerf::schema {
struct Inspection;
}

namespace kerf::schema::in_process {

/// The datasets of /samples that have a value or one an axis a row: those of Column in its order, then ticks
/// and flags.
inline constexpr std::array<std::string_view, 11> dataset_paths{
    "/samples/time",           "/samples/position",     "/samples/velocity",  "/samples/force_commanded",
    "/samples/force_measured", "/samples/wake_latency", "/samples/read_time", "/samples/compute_time",
    "/samples/write_time",     "/samples/tick",         "/samples/flags"};
inline constexpr std::size_t time_dataset = 0;
inline constexpr std::size_t tick_dataset = 9;
inline constexpr std::size_t flags_dataset = 10;
inline constexpr std::size_t first_channel = dataset_paths.size();  ///< /samples/channels follow

/// Bytes of a value of such a dataset.
[[nodiscard]] constexpr std::size_t value_bytes(std::size_t dataset) noexcept {
  constexpr std::size_t first_of_floats = 5;
  return dataset == flags_dataset || (dataset >= first_of_floats && dataset < tick_dataset) ? 4 : 8;
}

[[nodiscard]] constexpr bool is_per_axis(std::size_t dataset) noexcept {
  return dataset >= 1 && dataset <= 4;
}

/// Time, position, velocity and ticks.
[[nodiscard]] constexpr bool is_required(std::size_t dataset) noexcept {
  return dataset <= 2 || dataset == tick_dataset;
}

/// What an open recording says of itself.
struct RecordingFacts {
  Recording about;  ///< without a row
  std::uint64_t rows = 0;
  bool is_live = false;
  double first_time_s = std::numeric_limits<double>::quiet_NaN();
  double last_time_s = std::numeric_limits<double>::quiet_NaN();
  double period_s = 0.0;
  std::array<std::uint32_t, first_channel> widths{};  ///< values a row; 0: there is no such dataset
};

/// A recording whose rows stay in the file until they are asked for.
class OpenRecording {
 public:
  /// @throws as RecordingFile.
  OpenRecording(const std::filesystem::path& file, bool look_through_texts);
  /// One that was inspected and has nothing fatal.
  OpenRecording(const std::filesystem::path& file, Inspection&& inspection);
  ~OpenRecording();

  [[nodiscard]] const RecordingFacts& facts() const noexcept;
  /// Bytes of a row of a dataset.
  [[nodiscard]] std::size_t row_bytes(std::size_t dataset) const;
  /// @param values as many as those rows have, as they lie in memory: double, float, uint64, uint32.
  /// @throws FormatError if the file turns out to be damaged there, std::out_of_range.
  void read(std::size_t dataset, std::uint64_t first_row, std::uint64_t rows,
            std::span<std::byte> values) const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

// As the functions of the same names in namespace schema.
[[nodiscard]] Tail read_tail(const std::filesystem::path& file);
[[nodiscard]] std::vector<StoredForces> read_regression(const std::filesystem::path& file);
[[nodiscard]] Session read_session(const std::filesystem::path& file);
[[nodiscard]] Session read_session_facts(const std::filesystem::path& file);
[[nodiscard]] std::vector<std::uint8_t> read_sealed(const std::filesystem::path& file, std::size_t entry);
[[nodiscard]] SweepTablesFacts read_sweep_tables_facts(const std::filesystem::path& file);
[[nodiscard]] std::string schema_of(const std::filesystem::path& file);
[[nodiscard]] std::vector<Violation> validate(const std::filesystem::path& file);

}  // namespace kerf::schema::in_process
