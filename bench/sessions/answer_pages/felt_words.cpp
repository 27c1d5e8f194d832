#include "answer_pages/felt_words.h"

#include <cmath>

#include <fmt/core.h>

#include <kerf/fitting/jnd.h>

#include "files/json_number.h"
#include "html/html.h"

namespace kerf::bench {
namespace {

using FeltJson = nlohmann::ordered_json;

/// "1.24 (0.90 to 1.58)"
std::string felt_text(const OverPeople& people, double scale = 1.0) {
  if (!std::isfinite(people.mean)) return "not known";
  std::string text = fmt::format("{:.2f}", scale * people.mean);
  if (people.interval)
    text +=
        fmt::format(" ({:.2f} to {:.2f})", scale * people.interval->lower, scale * people.interval->upper);
  return text;
}

std::string felt_figure(double value, double scale = 1.0) {
  return std::isfinite(value) ? fmt::format("{:.3g}", scale * value) : std::string("not known");
}

FeltJson felt_json(const FeltLevel& level) {
  return {{"rms_N", json_number(level.rms_n)},
          {"peak_N", json_number(level.peak_n)},
          {"limited_share", json_number(level.limited_share)},
          {"vibration_N", json_number(level.vibration_n)},
          {"vibration_thresholds", json_number(level.vibration_thresholds)}};
}

FeltJson felt_json(const OverPeople& people, bool differs) {
  return {{"mean", json_number(people.mean)},
          {"interval", people.interval ? FeltJson::array({json_number(people.interval->lower),
                                                          json_number(people.interval->upper)})
                                       : FeltJson(nullptr)},
          {"differs", differs}};
}

}  // namespace

std::vector<std::string> felt_lines(const FeltCheck& check, const std::vector<std::string>& names,
                                    double confidence) {
  std::vector<std::string> lines;
  for (const FeltOfSample& one : check.samples) {
    lines.push_back(fmt::format(
        "felt of {}: {} N rms, {} N peak, {} % of the ticks at a limit, vibration {} N ({} slots)",
        names[one.sample], felt_figure(one.level.rms_n), felt_figure(one.level.peak_n),
        felt_figure(one.level.limited_share, 100.0), felt_figure(one.level.vibration_n), one.slots));
  }
  for (const FeltOfPair& pair : check.pairs) {
    lines.push_back(fmt::format(
        "felt of {} less {}: {} JND rms, {} JND peak, {} % of the ticks at a limit, vibration {} dB{}",
        names[pair.pair[1]], names[pair.pair[0]], felt_text(pair.rms_jnds), felt_text(pair.peak_jnds),
        felt_text(pair.limited_share, 100.0), felt_text(pair.vibration_db),
        pair.rms_jnds.interval ? fmt::format(" ({:.3g} % over {} people)", 100.0 * confidence, pair.subjects)
                               : std::string()));
  }
  return lines;
}

FeltJson felt_json(const FeltCheck& check, const std::vector<std::string>& names) {
  FeltJson json{{"jnd",
                 {{"weber_fraction", fitting::force_jnd.weber_fraction},
                  {"threshold_N", fitting::force_jnd.threshold},
                  {"source", jnd_of_levels_source()}}},
                {"samples", FeltJson::array()},
                {"pairs", FeltJson::array()},
                {"note", check.note.empty() ? FeltJson(nullptr) : FeltJson(check.note)}};
  for (const FeltOfSample& one : check.samples) {
    FeltJson sample = felt_json(one.level);
    sample["sample"] = names[one.sample];
    sample["slots"] = one.slots;
    json["samples"].push_back(std::move(sample));
  }
  for (const FeltOfPair& pair : check.pairs) {
    json["pairs"].push_back({{"first", names[pair.pair[0]]},
                             {"second", names[pair.pair[1]]},
                             {"subjects", pair.subjects},
                             {"rms_jnds", felt_json(pair.rms_jnds, pair.strength_differs())},
                             {"peak_jnds", felt_json(pair.peak_jnds, is_strength_apart(pair.peak_jnds.mean))},
                             {"limited_share", felt_json(pair.limited_share, pair.limits_differ())},
                             {"vibration_dB", felt_json(pair.vibration_db, pair.vibration_differs())}});
  }
  return json;
}

std::string felt_section(const FeltCheck& check, const std::vector<std::string>& names, double confidence) {
  if (check.samples.empty()) return {};
  std::vector<std::vector<std::string>> samples{
      {"sample", "rms [N]", "peak [N]", "ticks at a limit [%]", "20 Hz to 1 kHz [N]", "slots"}};
  for (const FeltOfSample& one : check.samples) {
    samples.push_back({names[one.sample], felt_figure(one.level.rms_n), felt_figure(one.level.peak_n),
                       felt_figure(one.level.limited_share, 100.0), felt_figure(one.level.vibration_n),
                       fmt::format("{}", one.slots)});
  }
  std::vector<std::vector<std::string>> pairs{
      {"apart", "rms [JND]", "peak [JND]", "ticks at a limit [%]", "20 Hz to 1 kHz [dB]", "subjects"}};
  for (const FeltOfPair& pair : check.pairs) {
    pairs.push_back({fmt::format("{} less {}", names[pair.pair[1]], names[pair.pair[0]]),
                     felt_text(pair.rms_jnds), felt_text(pair.peak_jnds),
                     felt_text(pair.limited_share, 100.0), felt_text(pair.vibration_db),
                     fmt::format("{}", pair.subjects)});
  }
  return fmt::format(
      "<h2>Was it the law?</h2>\n<p class=\"soft\">What was felt in the trials that count, means over "
      "subjects, "
      "with {:.3g} % intervals (Student) from three subjects on. JND: {}.</p>\n{}{}",
      100.0 * confidence, escaped(jnd_of_levels_source()), html_table(samples), html_table(pairs));
}

}  // namespace kerf::bench
