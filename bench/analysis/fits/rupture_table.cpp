#include "fits/rupture_table.h"

#include <atomic>
#include <cmath>
#include <stdexcept>
#include <vector>

#include <fmt/core.h>

#include "files/named_file.h"
#include "import/text/text_layout.h"
#include "import/text/text_table.h"
#include "units/units.h"

namespace kerf::bench {
namespace {

constexpr double milli = 1e-3;

struct Wanted {
  const char* name;
  const char* si;
};

/// The column of that name, and what turns its unit into SI.
std::pair<std::size_t, double> find_column(const TextLayout& layout, const Wanted& wanted,
                                           const std::string& file) {
  for (std::size_t i = 0; i < layout.columns.size(); ++i) {
    const TextColumn& column = layout.columns[i];
    if (column.name != wanted.name) continue;
    if (column.unit.empty()) {
      throw std::invalid_argument(
          fmt::format("{}: column '{}' has no unit; write it as '{} [{}]' or a multiple of it", file,
                      wanted.name, wanted.name, wanted.si));
    }
    const Unit unit = parse_unit(column.unit);
    if (unit.si == wanted.si) return {i, unit.factor};
    throw std::invalid_argument(fmt::format("{}: column '{}' is in {}, expected {} or a multiple of it", file,
                                            wanted.name, column.unit, wanted.si));
  }
  throw std::invalid_argument(fmt::format(
      "{}: no column '{}'; expected a header such as depth [mm],speed [mm/s],force [N]", file, wanted.name));
}

}  // namespace

fitting::RuptureSamples liver_ruptures() {
  fitting::RuptureSamples samples;
  for (int depth_mm = 1; depth_mm <= 10; ++depth_mm) {
    for (const double speed_mm_s : {0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0}) {
      samples.depth_m.push_back(milli * depth_mm);
      samples.speed_m_per_s.push_back(milli * speed_mm_s);
      samples.force_n.push_back(0.05 * std::pow(depth_mm / 5.0, 1.2) *
                                (0.6 + 0.4 * std::sqrt(speed_mm_s / 2.0)));
    }
  }
  return samples;
}

fitting::RuptureSamples read_ruptures(const std::filesystem::path& file) {
  const std::string text = read_named_file(file, LargestInput::table);
  const TextLayout layout = find_layout(text, file.string());
  constexpr Wanted wanted[] = {{"depth", "m"}, {"speed", "m/s"}, {"force", "N"}};
  std::vector<std::size_t> columns;
  std::vector<double> factors;
  for (const Wanted& one : wanted) {
    const auto [index, factor] = find_column(layout, one, file.string());
    columns.push_back(index);
    factors.push_back(factor);
  }
  std::atomic<std::size_t> done{0};
  TextTable table = parse_table(text, layout, columns, done);
  if (!table.bad_lines.empty()) {
    throw std::invalid_argument(fmt::format("{}:{}: a depth, speed or force is missing or not a number",
                                            file.string(), table.bad_lines.front()));
  }
  for (std::size_t i = 0; i < columns.size(); ++i) {
    for (double& value : table.columns[i]) value *= factors[i];
  }
  return {.depth_m = std::move(table.columns[0]),
          .speed_m_per_s = std::move(table.columns[1]),
          .force_n = std::move(table.columns[2])};
}

std::string as_csv(const fitting::RuptureSamples& samples) {
  std::string text = "depth [mm],speed [mm/s],force [N]\n";
  for (std::size_t i = 0; i < samples.force_n.size(); ++i) {
    text += fmt::format("{:g},{:g},{:.9f}\n", samples.depth_m[i] / milli, samples.speed_m_per_s[i] / milli,
                        samples.force_n[i]);
  }
  return text;
}

}  // namespace kerf::bench
