#include "hosted/facts.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include <fmt/format.h>
#include <toml++/toml.h>

namespace kerf::drivers::hosted {
namespace {

/// Says which of them is wrong.
class Checked {
 public:
  Checked(const kerf_device_facts_v1& facts, bool has_write, std::string_view uri)
      : facts_(facts), has_write_(has_write), uri_(uri) {}

  DeviceInfo info() const {
    DeviceInfo info{.uri = std::string(uri_),
                    .model = text(facts_.model, "model"),
                    .about = text(facts_.about, "about"),
                    .measures_force = has(KERF_MEASURES_FORCE) || has(KERF_FORCE_SENSOR),
                    .report_jitter_s = not_negative(facts_.jitter_s, "jitter_s"),
                    .configuration = settings()};
    if (info.model.empty()) refuse("describe() says no 'model'");
    (void)not_negative(facts_.rate_hz, "rate_hz");
    if (const std::string serial = text(facts_.serial, "serial"); !serial.empty()) info.serial = serial;
    if (has(KERF_FORCE_SENSOR) && (facts_.axis_count != 0 || has_write_))
      refuse("it is a force sensor, which has no axes and no write()");
    if (!has(KERF_FORCE_SENSOR) && (facts_.axis_count < 1 || facts_.axis_count > KERF_DEVICE_AXES))
      refuse(fmt::format("'axis_count' is {}, expected 1 to {}", facts_.axis_count, KERF_DEVICE_AXES));
    if (facts_.channel_count > KERF_DEVICE_CHANNELS)
      refuse(fmt::format("'channel_count' is {}, expected at most {}", facts_.channel_count,
                         KERF_DEVICE_CHANNELS));
    for (std::size_t at = 0; at < facts_.axis_count; ++at) add_axis(info, facts_.axes[at], at);
    for (std::size_t at = 0; at < facts_.channel_count; ++at) add_channel(info, facts_.channels[at], at);
    return info;
  }

 private:
  [[noreturn]] void refuse(const std::string& why) const {
    throw DeviceError(fmt::format("{}: {}", uri_, why));
  }
  [[nodiscard]] bool has(unsigned flag) const noexcept { return (facts_.flags & flag) != 0; }

  template <std::size_t size>
  [[nodiscard]] std::string text(const char (&given)[size],
                                 std::string_view what) const {  // NOLINT(*-c-arrays)
    const auto* const end = std::find(std::begin(given), std::end(given), '\0');
    if (end == std::end(given)) refuse(fmt::format("'{}' has no zero behind it", what));
    return {std::begin(given), end};
  }

  [[nodiscard]] double not_negative(double value, std::string_view what) const {
    if (!(std::isfinite(value) && value >= 0.0))
      refuse(fmt::format("'{}' is {}, expected a number not below 0", what, value));
    return value;
  }

  [[nodiscard]] std::string settings() const {
    std::string settings = text(facts_.settings, "settings");
    try {
      (void)toml::parse(settings);
    } catch (const toml::parse_error& error) {
      refuse(fmt::format("'settings' are no TOML: {}", error.description()));
    }
    if (!settings.empty() && !settings.ends_with('\n')) settings += '\n';
    return settings;
  }

  [[nodiscard]] std::string name(std::string given, std::string_view what) const {
    const auto is_letter = [](char c) { return c >= 'a' && c <= 'z'; };
    const bool is_name =
        !given.empty() && is_letter(given.front()) && std::ranges::all_of(given, [&](char c) {
          return is_letter(c) || c == '_' || (c >= '0' && c <= '9');
        });
    if (!is_name)
      refuse(fmt::format("{} is named '{}', expected a-z, 0-9 and _, first a letter", what, given));
    return given;
  }

  void add_axis(DeviceInfo& info, const kerf_device_axis_v1& axis, std::size_t at) const {
    const auto what = [&](std::string_view field) { return fmt::format("axes[{}].{}", at, field); };
    AxisInfo made{.name = name(text(axis.name, what("name")), fmt::format("axis {}", at)),
                  .position_unit = text(axis.position_unit, what("position_unit")),
                  .force_unit = text(axis.force_unit, what("force_unit")),
                  .lever = axis.lever,
                  .resolution = not_negative(axis.resolution, what("resolution")),
                  .lower = axis.lower,
                  .upper = axis.upper,
                  .force_limit = not_negative(axis.force_limit, what("force_limit")),
                  .slew_limit = not_negative(axis.slew_limit, what("slew_limit")),
                  .speed_limit = not_negative(axis.speed_limit, what("speed_limit")),
                  .acceleration_limit = not_negative(axis.acceleration_limit, what("acceleration_limit"))};
    if (made.force_unit == "N*m") made.force_unit = "N·m";
    if (made.position_unit != "m" && made.position_unit != "rad")
      refuse(fmt::format("'{}' is \"{}\", expected \"m\" or \"rad\"", what("position_unit"),
                         made.position_unit));
    if (made.force_unit != "N" && made.force_unit != "N·m")
      refuse(fmt::format("'{}' is \"{}\", expected \"N\" or \"N·m\"", what("force_unit"), made.force_unit));
    const bool is_plain = (made.position_unit == "m") == (made.force_unit == "N");
    if (made.lever == 0.0 && is_plain) made.lever = 1.0;
    if (!(std::isfinite(made.lever) && made.lever > 0.0))
      refuse(
          fmt::format("'{}' is {}, expected the travel of where the force acts per unit of position, above 0",
                      what("lever"), axis.lever));
    if (!(std::isfinite(axis.lower) && std::isfinite(axis.upper) && axis.lower < axis.upper))
      refuse(fmt::format("'{}' and 'upper' are {} and {}, expected a range", what("lower"), axis.lower,
                         axis.upper));
    if (has_write_ && !(made.force_limit > 0.0 && made.slew_limit > 0.0))
      refuse(fmt::format("'{}' and 'slew_limit' are {} and {}, expected both above 0, for it has a write()",
                         what("force_limit"), made.force_limit, made.slew_limit));
    if (!has_write_) made.force_limit = made.slew_limit = 0.0;
    if (std::ranges::find(info.axes, made.name, &AxisInfo::name) != info.axes.end())
      refuse(fmt::format("there are two axes '{}'", made.name));
    info.axes.push_back(std::move(made));
  }

  void add_channel(DeviceInfo& info, const kerf_device_channel_v1& channel, std::size_t at) const {
    ChannelInfo made{
        .name = name(text(channel.name, fmt::format("channels[{}].name", at)), fmt::format("channel {}", at)),
        .unit = text(channel.unit, fmt::format("channels[{}].unit", at))};
    const bool is_ours = made.name == "report_age" || made.name.starts_with("force_");
    if (is_ours || std::ranges::find(info.channels, made.name, &ChannelInfo::name) != info.channels.end())
      refuse(fmt::format("a channel may not be named '{}': {}", made.name,
                         is_ours ? "Kerf has one of that name" : "there are two"));
    if ((channel.flags & KERF_CHANNEL_BUTTON) != 0) {
      if (info.button_channel) refuse("two channels are its button");
      info.button_channel = at;
    }
    if (made.unit.empty()) made.unit = "1";
    info.channels.push_back(std::move(made));
  }

  const kerf_device_facts_v1& facts_;
  bool has_write_;
  std::string_view uri_;
};

}  // namespace

DeviceInfo info_of(const kerf_device_facts_v1& facts, bool has_write, std::string_view uri) {
  return Checked(facts, has_write, uri).info();
}

}  // namespace kerf::drivers::hosted
