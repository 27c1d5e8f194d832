#include "convert/convert.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cctype>
#include <cmath>
#include <stdexcept>
#include <string_view>
#include <variant>

#include <fmt/format.h>

#include <kerf/version.h>

#include "convert/formats.h"
#include "convert/recording_columns.h"

namespace kerf::bench {
namespace {

struct ConversionFormat {
  std::string_view name;  ///< and the ending, after a dot
  void (*convert)(const RecordingColumns&, const ConversionTarget&);
};

constexpr std::array conversion_formats{ConversionFormat{"csv", convert_to_csv},
                                        ConversionFormat{"mat", convert_to_mat},
                                        ConversionFormat{"mcap", convert_to_mcap}};

const ConversionFormat& format_of(const std::filesystem::path& output) {
  std::string ending = output.extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return std::tolower(c); });
  for (const ConversionFormat& format : conversion_formats) {
    if (ending == fmt::format(".{}", format.name)) return format;
  }
  throw std::invalid_argument(fmt::format(
      "{}: {}; expected a name that ends in .csv, .mat or .mcap, which says the format", output.string(),
      ending.empty() ? "its name has no ending" : fmt::format("'{}' is no format to convert to", ending)));
}

}  // namespace

std::map<std::string, std::string> facts_of(const schema::Recording& about) {
  const schema::Header& header = about.header;
  std::map<std::string, std::string> facts{
      {"created", header.created},         {"software", header.software},
      {"converted_by", software()},        {"uuid", header.uuid},
      {"status", header.status},           {"source", header.source},
      {"start_clock", header.start_clock}, {"history", header.history},
      {"device_uri", header.device_uri},   {"device_toml", header.device_toml},
      {"scene_toml", header.scene_toml}};
  if (header.start_ns) facts["start_ns"] = std::to_string(*header.start_ns);
  const auto add = [&facts](const std::string& group, const schema::Properties& properties) {
    for (const auto& [name, value] : properties)
      facts[group + "." + name] = std::visit([](const auto& one) { return fmt::format("{}", one); }, value);
  };
  add("device", header.device_properties);
  add("scene", header.scene_properties);
  for (const schema::Axis& axis : about.axes) {
    facts[fmt::format("axis.{}.lever", axis.name)] = fmt::format("{}", axis.lever);
    if (!std::isnan(axis.contact_position))
      facts[fmt::format("axis.{}.contact_position", axis.name)] = fmt::format("{}", axis.contact_position);
    if (!std::isnan(axis.contact_direction))
      facts[fmt::format("axis.{}.contact_direction", axis.name)] = fmt::format("{}", axis.contact_direction);
    if (!std::isnan(axis.contact_error))
      facts[fmt::format("axis.{}.contact_error", axis.name)] = fmt::format("{}", axis.contact_error);
  }
  std::erase_if(facts, [](const auto& fact) { return fact.second.empty(); });
  return facts;
}

std::string conversion_format(const std::filesystem::path& output) {
  return std::string(format_of(output).name);
}

std::vector<std::filesystem::path> files_of_conversion(const std::filesystem::path& output,
                                                       const schema::Recording& about) {
  std::vector<std::filesystem::path> files{output};
  if (format_of(output).name == "csv") {
    files.push_back(dictionary_beside(output));
    if (!about.events.empty()) files.push_back(events_beside(output));
  }
  return files;
}

Converted convert(const schema::RecordedRows& rows, const ConvertOptions& options) {
  const ConversionFormat& format = format_of(options.output);
  const RecordingColumns recording(rows);
  options.progress(
      fmt::format("converting to {}", format.name), static_cast<std::size_t>(rows.rows()),
      [&](std::atomic<std::size_t>& done) {
        format.convert(recording, {.file = options.output, .existing = options.existing, .rows_done = &done});
      });
  return {.format = std::string(format.name),
          .rows = rows.rows(),
          .columns = recording.columns().size(),
          .events = rows.about().events.size(),
          .files = files_of_conversion(options.output, rows.about())};
}

}  // namespace kerf::bench
