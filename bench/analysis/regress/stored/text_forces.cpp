#include "regress/stored/text_forces.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <iterator>
#include <stdexcept>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "files/file_names.h"
#include "files/named_file.h"
#include "recordings/provenance.h"
#include "regress/renderers/number_table.h"
#include "regress/stored/conflict.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

/// Texts of a case under the names that they have in `kerf.regression`.
constexpr std::array<std::pair<const char*, std::string schema::StoredForces::*>, 9> declared_texts{
    {{"case", &schema::StoredForces::name},
     {"model", &schema::StoredForces::model},
     {"renderer", &schema::StoredForces::renderer},
     {"law_sha256", &schema::StoredForces::law_sha256},
     {"trajectory_sha256", &schema::StoredForces::trajectory_sha256},
     {"reason", &schema::StoredForces::reason},
     {"date", &schema::StoredForces::date},
     {"software", &schema::StoredForces::software},
     {"tick_cost_build", &schema::StoredForces::tick_cost_build}}};

void add_declaration(std::string& text, std::string_view key, std::string value) {
  std::ranges::replace(value, '\n', ' ');
  if (!value.empty()) text += fmt::format("# {}: {}\n", key, value);
}

/// A text of several lines, a declaration each.
void add_declared_lines(std::string& text, std::string_view key, const std::string& lines) {
  for (std::size_t at = 0; at < lines.size();) {
    const std::size_t end = std::min(lines.find('\n', at), lines.size());
    add_declaration(text, key, lines.substr(at, end - at));
    at = end + 1;
  }
}

void add_number_rows(std::string& text, const std::vector<double>& values, std::size_t columns, bool ticks) {
  auto out = std::back_inserter(text);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (ticks && i % columns == 0) fmt::format_to(out, "{},", i / columns);
    fmt::format_to(out, "{}{}", values[i], (i + 1) % columns == 0 ? '\n' : ',');
  }
}

NumberTable read_stored_table(const fs::path& file, const Suite& suite) {
  require_no_conflict(file, read_named_file(file, LargestInput::table), suite);
  return read_number_table(file, LargestInput::table);
}

/// "theta[N]" taken apart.
schema::ForceChannel channel_of_column(const fs::path& file, const std::string& head) {
  const auto at = head.rfind('[');
  if (at == std::string::npos || at == 0 || !head.ends_with(']'))
    throw std::invalid_argument(
        fmt::format("{}: found the column '{}', expected a name with its unit, x[N]", file.string(), head));
  return {.name = head.substr(0, at), .unit = head.substr(at + 1, head.size() - at - 2)};
}

template <typename Number>
Number declared_number(const fs::path& file, const std::string& key, const std::string& text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size())
    throw std::invalid_argument(
        fmt::format("{}: '{}' is '{}', expected a number", file.string(), key, text.substr(0, 40)));
  return value;
}

void take_declared(const fs::path& file, const std::string& key, const std::string& value,
                   schema::StoredForces& one) {
  for (const auto& [name, member] : declared_texts) {
    if (key == name) one.*member = value;
  }
  if (key == "history") one.history += value + '\n';
  if (key == "made_with") one.made_with += value + '\n';
  if (key == "faults") one.faults = declared_number<std::uint64_t>(file, key, value);
  if (key == "tick_cost") one.tick_cost = declared_number<double>(file, key, value);
  if (key == schema::regression_schema_name &&
      declared_number<std::uint32_t>(file, key, value) != schema::regression_schema_version) {
    throw std::invalid_argument(
        fmt::format("{}: found version {} of {}, expected {}: a later kerf wrote it; use that one",
                    file.string(), value, key, schema::regression_schema_version));
  }
}

}  // namespace

std::string forces_as_text(const schema::StoredForces& stored) {
  std::string text =
      fmt::format("# {}: {}\n", schema::regression_schema_name, schema::regression_schema_version);
  for (const auto& [name, member] : declared_texts) add_declaration(text, name, stored.*member);
  add_declared_lines(text, "made_with", stored.made_with);
  add_declared_lines(text, "history", stored.history);
  add_declaration(text, "faults", fmt::format("{}", stored.faults));
  if (stored.tick_cost) add_declaration(text, "tick_cost", fmt::format("{}", *stored.tick_cost));
  text += "tick";
  for (const schema::ForceChannel& channel : stored.channels)
    text += fmt::format(",{}[{}]", channel.name, channel.unit);
  text += '\n';
  add_number_rows(text, stored.force, stored.channels.size(), true);
  return text;
}

std::string trajectory_as_text(const schema::StoredTrajectory& trajectory) {
  std::string text = "time[s]";
  for (const schema::ForceChannel& axis : trajectory.axes)
    text += fmt::format(",{}[{}]", axis.name, axis.unit);
  text += '\n';
  const std::size_t axes = trajectory.axes.size();
  for (std::size_t row = 0; row < trajectory.time_s.size(); ++row) {
    fmt::format_to(std::back_inserter(text), "{}", trajectory.time_s[row]);
    for (std::size_t i = 0; i < axes; ++i)
      fmt::format_to(std::back_inserter(text), ",{}", trajectory.position[row * axes + i]);
    text += '\n';
  }
  return text;
}

schema::StoredForces read_forces_text(const fs::path& file, const Suite& suite) {
  const NumberTable table = read_stored_table(file, suite);
  schema::StoredForces one;
  for (const auto& [key, value] : table.declared) take_declared(file, key, value, one);
  if (one.name.empty() || text_file_of(one.name) != file.filename())
    throw std::invalid_argument(fmt::format("{}: it says that it is of case '{}', expected to be {}",
                                            file.string(), one.name, text_file_of(one.name)));
  if (table.names.front() != "tick" || table.names.size() < 2)
    throw std::invalid_argument(fmt::format("{}: found the column '{}', expected 'tick' and forces",
                                            file.string(), table.names.front()));
  for (std::size_t i = 1; i < table.names.size(); ++i)
    one.channels.push_back(channel_of_column(file, table.names[i]));
  for (std::size_t row = 0; row < table.rows(); ++row) {
    if (table.at(row, 0) != static_cast<double>(row))
      throw std::invalid_argument(
          fmt::format("{}: found tick {} in row {}, expected {}: a row is missing or there twice",
                      file.string(), table.at(row, 0), row, row));
    for (std::size_t i = 1; i < table.names.size(); ++i) one.force.push_back(table.at(row, i));
  }
  return one;
}

schema::StoredTrajectory read_trajectory_text(const fs::path& file, const Suite& suite) {
  const NumberTable table = read_stored_table(file, suite);
  if (table.names.front() != "time[s]" || table.names.size() < 2)
    throw std::invalid_argument(fmt::format("{}: found the column '{}', expected 'time[s]' and positions",
                                            file.string(), table.names.front()));
  schema::StoredTrajectory path;
  for (std::size_t i = 1; i < table.names.size(); ++i)
    path.axes.push_back(channel_of_column(file, table.names[i]));
  for (std::size_t row = 0; row < table.rows(); ++row) {
    path.time_s.push_back(table.at(row, 0));
    for (std::size_t i = 1; i < table.names.size(); ++i) path.position.push_back(table.at(row, i));
  }
  return path;
}

std::string text_file_of(const std::string& case_name) {
  const std::string plain = as_file_name(case_name);
  return plain + (plain == case_name ? "" : '-' + sha256_of(std::string_view(case_name)).substr(0, 6)) +
         ".csv";
}

}  // namespace kerf::bench
