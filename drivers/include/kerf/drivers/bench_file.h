#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/drivers/sensor_frame.h>

namespace kerf::drivers {

/// A device or a sensor of a lab, by the name that the lab gave it.
struct BenchEntry {
  enum class Kind : std::uint8_t { device, sensor };
  Kind kind = Kind::device;
  std::string name;
  std::string uri;       ///< with the options of the file; paths in it are absolute
  std::string sensor{};  ///< of a device: the name of the sensor that stands beside it; empty: none
  std::optional<SensorFrame> frame{};  ///< of a sensor
};

/// The devices and sensors of a lab's bench, from a file: docs/bench-file.md has its keys.
struct BenchFile {
  std::filesystem::path file;
  std::string sha256;  ///< of its text, in hexadecimal digits
  std::vector<BenchEntry> entries;

  /// The entry of that name; nullptr: it has none.
  [[nodiscard]] const BenchEntry* find(std::string_view name) const noexcept;
};

/// `file`: where the text stands, for messages and for the paths in it, which begin in its folder.
/// @throws DeviceError that says in which line what was expected: for a key that is unknown, a name that
/// stands twice or has other characters than letters, digits, - and _, a URI without a colon, an option that
/// is not one, a sensor that is not in the file, a frame that is none.
[[nodiscard]] BenchFile parse_bench_file(const std::string& text, const std::filesystem::path& file);

/// Where the file is looked for, in this order: KERF_BENCH alone where that is set, else bench.toml in this
/// folder, then kerf/bench.toml in XDG_CONFIG_HOME, or in ~/.config.
[[nodiscard]] std::vector<std::filesystem::path> bench_file_places();

/// The first of those that there is; nothing: none is there.
/// @throws DeviceError as parse_bench_file(), for one that cannot be read, and where KERF_BENCH names none.
[[nodiscard]] std::optional<BenchFile> find_bench_file();

/// The URI that a text stands for. One with a colon, `none` and the empty text are what they are, and no file
/// is looked at. Any other is a name of the bench file, maybe with options that go before those of the file:
/// "arm?seed=3". The URI of a name says so by its option `bench.toml`, by which open_device() finds the frame
/// of a sensor, and recordings the name.
/// @throws DeviceError where no file has it, with the names that there are or the places that were looked at.
[[nodiscard]] std::string named_uri(std::string_view text);

/// The same without that option: the device as it is, without a frame.
[[nodiscard]] std::string without_bench_name(std::string_view uri);

/// The sensor to open beside a device: what was asked for, by URI or name, else the one that the bench file
/// puts beside a device of that name; empty: none. `none` asks for none.
/// @throws DeviceError as named_uri().
[[nodiscard]] std::string sensor_beside(std::string_view device_uri, std::string_view asked_for);

}  // namespace kerf::drivers
