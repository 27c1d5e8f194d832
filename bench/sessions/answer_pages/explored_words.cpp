#include "answer_pages/explored_words.h"

#include <cmath>

#include <fmt/core.h>

#include "files/json_number.h"
#include "html/html.h"

namespace kerf::bench {
namespace {

using ExploredJson = nlohmann::ordered_json;

/// "+4.1 (-2.0 to 10.2) %"
std::string apart_in_percent(const OverPeople& people) {
  if (!std::isfinite(people.mean)) return "not known";
  if (!people.interval) return fmt::format("{:+.1f} %", people.mean);
  return fmt::format("{:+.1f} ({:+.1f} to {:+.1f}) %", people.mean, people.interval->lower,
                     people.interval->upper);
}

std::string explored_figure(double value) {
  return std::isfinite(value) ? fmt::format("{:.3g}", value) : std::string("not known");
}

ExploredJson exploring_json(const Exploring& one) {
  return {{"speed_m_s", json_number(one.speed_m_s)},
          {"peak_speed_m_s", json_number(one.peak_speed_m_s)},
          {"strokes_per_s", json_number(one.strokes_per_s)},
          {"off_target", json_number(one.off_target)},
          {"lag_s", json_number(one.lag_s)}};
}

ExploredJson percent_json(const OverPeople& people) {
  return {{"mean", json_number(people.mean)},
          {"interval", people.interval ? ExploredJson::array({json_number(people.interval->lower),
                                                              json_number(people.interval->upper)})
                                       : ExploredJson(nullptr)}};
}

}  // namespace

std::vector<std::string> explored_lines(const std::vector<ExploredPair>& pairs,
                                        const std::vector<std::string>& names, double confidence) {
  std::vector<std::string> lines;
  for (const ExploredPair& pair : pairs) {
    const auto [first, second] = names_of(pair, names);
    std::string line =
        fmt::format("explored {} less {}: mean speed {}, peak speed {}, strokes a second {}", second, first,
                    apart_in_percent(pair.speed_percent), apart_in_percent(pair.peak_speed_percent),
                    apart_in_percent(pair.stroke_rate_percent));
    if (std::isfinite(pair.off_target_percent.mean))
      line += fmt::format(", distance to the target {}", apart_in_percent(pair.off_target_percent));
    if (pair.speed_percent.interval)
      line += fmt::format(" ({:.3g} % over {} people)", 100.0 * confidence, pair.subjects);
    lines.push_back(std::move(line));
  }
  return lines;
}

ExploredJson explored_json(const std::vector<ExploredPair>& pairs, const std::vector<std::string>& names) {
  ExploredJson all = ExploredJson::array();
  for (const ExploredPair& pair : pairs) {
    const auto [first, second] = names_of(pair, names);
    all.push_back({{"first", first},
                   {"second", second},
                   {"subjects", pair.subjects},
                   {"of_first", exploring_json(pair.first)},
                   {"of_second", exploring_json(pair.second)},
                   {"speed_percent", percent_json(pair.speed_percent)},
                   {"peak_speed_percent", percent_json(pair.peak_speed_percent)},
                   {"stroke_rate_percent", percent_json(pair.stroke_rate_percent)},
                   {"off_target_percent", percent_json(pair.off_target_percent)},
                   {"differs", pair.differs()}});
  }
  return all;
}

std::string explored_section(const std::vector<ExploredPair>& pairs, const std::vector<std::string>& names,
                             double confidence) {
  if (pairs.empty()) return {};
  std::vector<std::vector<std::string>> rows{{"", "mean speed [m/s]", "peak speed [m/s]", "strokes [1/s]",
                                              "off target [unit of the axis]", "lag [s]", "subjects"}};
  for (const ExploredPair& pair : pairs) {
    const auto both = names_of(pair, names);
    for (const std::size_t which : {0U, 1U}) {
      const Exploring& one = which == 0 ? pair.first : pair.second;
      rows.push_back({both[which], explored_figure(one.speed_m_s), explored_figure(one.peak_speed_m_s),
                      explored_figure(one.strokes_per_s), explored_figure(one.off_target),
                      explored_figure(one.lag_s), fmt::format("{}", pair.subjects)});
    }
    rows.push_back({fmt::format("{} less {}", both[1], both[0]), apart_in_percent(pair.speed_percent),
                    apart_in_percent(pair.peak_speed_percent), apart_in_percent(pair.stroke_rate_percent),
                    apart_in_percent(pair.off_target_percent), "", ""});
  }
  return fmt::format(
      "<h2>Were they explored alike?</h2>\n<p class=\"soft\">What the hand did in the trials that count, "
      "means "
      "over subjects; differences as shares of the mean of the two, with {:.3g} % intervals (Student) from "
      "three subjects on.</p>\n{}",
      100.0 * confidence, html_table(rows));
}

}  // namespace kerf::bench
