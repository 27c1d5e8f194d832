#include <cstdlib>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bench_file/bench_option.h"
#include "kerf/drivers/bench_file.h"
#include "kerf/drivers/uri.h"
#include "small_file.h"

namespace kerf::drivers {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t largest_bench_file = 1U << 20U;  // bytes

std::string environment(const char* name) {
  const char* const value = std::getenv(name);
  return value == nullptr ? "" : value;
}

bool has_no_scheme(std::string_view text) {
  const std::string_view name = text.substr(0, text.find('?'));
  return !text.empty() && name != "none" && name.find(':') == std::string_view::npos;
}

std::string names_in(const BenchFile& file) {
  std::vector<std::string_view> names;
  for (const BenchEntry& one : file.entries) names.emplace_back(one.name);
  return names.empty() ? "nothing" : fmt::format("{}", fmt::join(names, ", "));
}

[[noreturn]] void refuse_nameless(std::string_view name) {
  std::vector<std::string> places;
  for (const fs::path& one : bench_file_places()) places.push_back(one.string());
  throw DeviceError(fmt::format(
      "no device '{}': 'kerf devices' lists URIs, and a name without a colon stands in a bench file, "
      "of which there is none; looked for {}, and KERF_BENCH may name one (docs/bench-file.md)",
      name, fmt::join(places, " and ")));
}

}  // namespace

std::vector<fs::path> bench_file_places() {
  if (const std::string named = environment("KERF_BENCH"); !named.empty()) return {named};
  std::vector<fs::path> places{"bench.toml"};
  if (const std::string config = environment("XDG_CONFIG_HOME"); fs::path(config).is_absolute()) {
    places.push_back(fs::path(config) / "kerf" / "bench.toml");
  } else if (const std::string home = environment("HOME"); !home.empty()) {
    places.push_back(fs::path(home) / ".config" / "kerf" / "bench.toml");
  }
  return places;
}

std::optional<BenchFile> find_bench_file() {
  const bool is_named = !environment("KERF_BENCH").empty();
  for (const fs::path& place : bench_file_places()) {
    std::error_code error;
    if (!is_named && fs::status(place, error).type() == fs::file_type::not_found) continue;
    const fs::path file = fs::absolute(place);
    const SmallFile read = read_small_file(file.string(), largest_bench_file);
    if (!read.problem.empty())
      throw DeviceError(fmt::format("{}{}: the bench file cannot be read ({})", is_named ? "KERF_BENCH=" : "",
                                    place.string(), read.problem));
    return parse_bench_file(read.content, file);
  }
  return std::nullopt;
}

std::string named_uri(std::string_view text) {
  if (!has_no_scheme(text)) return std::string(text);
  const Uri asked = parse_uri(text);
  const auto file = find_bench_file();
  if (!file) refuse_nameless(asked.name);
  const BenchEntry* entry = file->find(asked.name);
  if (entry == nullptr) {
    throw DeviceError(fmt::format("no device '{}' in {}, which has {}; 'kerf devices' lists what there is",
                                  asked.name, file->file.string(), names_in(*file)));
  }
  Uri uri = parse_uri(entry->uri);
  for (const auto& [option, value] : asked.options) uri.options.insert_or_assign(option, value);
  uri.options.insert_or_assign(std::string(bench_option), entry->name);
  return to_text(uri);
}

std::string without_bench_name(std::string_view uri) {
  Uri parts = parse_uri(uri);
  return parts.options.erase(std::string(bench_option)) == 0 ? std::string(uri) : to_text(parts);
}

std::string sensor_beside(std::string_view device_uri, std::string_view asked_for) {
  if (asked_for == "none") return {};
  if (!asked_for.empty() || device_uri.empty()) return named_uri(asked_for);
  const Uri device = parse_uri(named_uri(device_uri));
  const auto name = device.options.find(std::string(bench_option));
  if (name == device.options.end()) return {};
  const auto file = find_bench_file();
  const BenchEntry* entry = file ? file->find(name->second) : nullptr;
  return entry == nullptr ? std::string() : named_uri(entry->sensor);
}

}  // namespace kerf::drivers
