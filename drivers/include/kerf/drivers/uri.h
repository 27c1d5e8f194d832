#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kerf::drivers {

/// A device URI taken apart: "sim:scissors?seed=3&noise=off" has the name "sim:scissors" and two options.
struct Uri {
  std::string name;
  std::map<std::string, std::string> options;
};

/// Whether the value of an option is the path of a file that the driver of a device opens: `calibration` and
/// `firmware` of any (but of hapkit:, where it is a word), `model` of sim:axis. Whoever takes a URI from
/// outside has to look at these.
[[nodiscard]] bool names_a_file(std::string_view device, std::string_view option) noexcept;

/// Whether a device is named by a machine of the network, a port of this one, a plug-in or a library of its
/// maker, which whoever names it makes the driver open, or run.
[[nodiscard]] bool names_a_place(std::string_view device) noexcept;

/// Whether a device is named by the path of a serial port or of a plug-in's file.
[[nodiscard]] bool names_a_path(std::string_view device) noexcept;

/// @throws DeviceError if an option has no '=' or stands twice.
[[nodiscard]] Uri parse_uri(std::string_view text);
/// The same back: options in the order of their names.
[[nodiscard]] std::string to_text(const Uri& uri);

/// Takes the options out of a URI one by one, and refuses those that nobody asked for.
class UriOptions {
 public:
  explicit UriOptions(Uri uri) : uri_(std::move(uri)) {}

  /// A number with its unit behind it ("40deg", "1.2s"), in SI; `standard` if it is not given.
  /// `unit` is one of "deg", "m", "s", "kg", "N", "N/s", "N/m", "Ns/m", "Nm", "Hz", "ticks", "A", "1"; what
  /// is asked for in m, s or N may also stand in mm, ms or mN.
  /// @throws DeviceError if it is not such a number or not in [lower, upper], both in SI.
  struct Quantity {
    std::string_view unit;
    double standard;
    double lower;
    double upper;
  };
  [[nodiscard]] double number(const std::string& name, const Quantity& quantity);
  /// The same of `count` values: one, which is that of all of them, or as many joined by commas; none if it
  /// is not given. @throws DeviceError also for any other number of values.
  [[nodiscard]] std::vector<double> numbers(const std::string& name, const Quantity& quantity,
                                            std::size_t count);
  /// A whole number from 0 to 2^53. @throws DeviceError for any other.
  [[nodiscard]] std::uint64_t count(const std::string& name, std::uint64_t standard);
  /// "on" or "off".
  [[nodiscard]] bool flag(const std::string& name, bool standard);

  /// As it stands; nothing if it is not given.
  [[nodiscard]] std::optional<std::string> text(const std::string& name);
  /// The same of an option that names_a_file(). @throws std::logic_error for another.
  [[nodiscard]] std::optional<std::string> file(const std::string& name);

  /// Leaves an option to somebody else.
  void allow(const std::string& name) { known_.push_back(name); }

  /// @throws DeviceError for an option that was not taken, listing those that exist.
  void refuse_others() const;

 private:
  [[nodiscard]] double number_from(std::string_view text, const std::string& name,
                                   const Quantity& quantity) const;

  Uri uri_;
  std::vector<std::string> known_;
};

}  // namespace kerf::drivers
