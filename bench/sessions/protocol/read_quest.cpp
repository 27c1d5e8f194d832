#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "protocol/read_scale.h"
#include "protocol/trial_sequence.h"

namespace kerf::bench {
namespace {

/// What a grid of QUEST+ may hold.
struct GridRange {
  std::string_view key;
  double lower = 0.0;
  double upper = 1.0;
};

/// An ascending array; or, of what is above 0, { from, to, count } in equal ratios.
std::vector<double> read_grid(const Place& place, const toml::table& table, const GridRange& range) {
  const toml::node* node = table.get(range.key);
  if (node == nullptr) return {};
  if (range.lower > 0.0 && node->is_table()) {
    const toml::table& ends = *node->as_table();
    place.allow_only(ends, {"from", "to", "count"}, fmt::format("the grid '{}'", range.key));
    const auto end = [&](std::string_view key) {
      if (!ends.contains(key)) place.refuse(ends, "the grid '{}' needs '{}'", range.key, key);
      return read_plain_number(place, ends, {.key = key, .lower = range.lower, .upper = range.upper});
    };
    const double first = end("from");
    const double last = end("to");
    if (!(first < last))
      place.refuse(ends, "the grid '{}' goes from {:g} to {:g}, expected it to rise", range.key, first, last);
    return psychophysics::geometric_grid(
        first, last,
        read_count(place, ends, {.key = "count", .standard = 41, .lower = 2, .upper = max_levels}));
  }
  const toml::array* all = node->as_array();
  if (all == nullptr || all->empty() || all->size() > max_levels) {
    place.refuse(*node, "'{}' must be an array of 1 to {} numbers{}", range.key, max_levels,
                 range.lower > 0.0 ? ", or { from, to, count }" : "");
  }
  std::vector<double> grid;
  for (const toml::node& each : *all) {
    const double value = place.number(each, fmt::format("a number of '{}'", range.key));
    if (!(value >= range.lower && value <= range.upper))
      place.refuse(each, "a number of '{}' is {:g}, expected {:g} to {:g}", range.key, value, range.lower,
                   range.upper);
    if (!grid.empty() && value <= grid.back())
      place.refuse(each, "'{}' has {:g} after {:g}, expected numbers that rise", range.key, value,
                   grid.back());
    grid.push_back(value);
  }
  return grid;
}

psychophysics::Nuisance read_nuisance(const Place& place, const toml::table& table) {
  psychophysics::Nuisance nuisance;
  const toml::node* node = table.get("nuisance");
  if (node == nullptr) return nuisance;
  const toml::array* names = node->as_array();
  if (names == nullptr || names->empty() || !names->is_homogeneous<std::string>())
    place.refuse(*node, "'nuisance' must be an array of some of \"slope\", \"guess\", \"lapse\"");
  for (const toml::node& each : *names) {
    const std::string name = **each.as_string();
    bool* const named = name == "slope"   ? &nuisance.slope
                        : name == "guess" ? &nuisance.guess
                        : name == "lapse" ? &nuisance.lapse
                                          : nullptr;
    if (named == nullptr)
      place.refuse(each, "'{}' is no nuisance, expected \"slope\", \"guess\" or \"lapse\"", name);
    if (*named) place.refuse(each, "'{}' is named twice", name);
    *named = true;
  }
  if (nuisance.guess && !table.contains("guesses"))
    place.refuse(*node,
                 "the guess rate is known, and no nuisance; give it a grid, 'guesses', or leave it out");
  return nuisance;
}

/// When the interval of the threshold is narrow enough.
void read_until(const Place& place, const toml::table& quest, Protocol& protocol) {
  if (!quest.contains("until")) return;
  const toml::table& table = place.table(quest, "until");
  place.allow_only(table, {"ratio", "confidence", "least"}, "'until'");
  psychophysics::QuestPlusOptions& options = protocol.scale.quest;
  if (!table.contains("ratio"))
    place.refuse(table, "'until' needs 'ratio', upper over lower end of the threshold's interval, such as 2");
  options.narrow = read_plain_number(place, table, {.key = "ratio", .lower = 1.01, .upper = 1e4});
  options.narrow_confidence =
      read_plain_number(place, table, {.key = "confidence", .standard = 0.95, .lower = 0.5, .upper = 0.999});
  options.least_trials =
      static_cast<int>(read_count(place, table,
                                  {.key = "least",
                                   .standard = std::min(20.0, static_cast<double>(protocol.trials)),
                                   .lower = 1,
                                   .upper = static_cast<double>(protocol.trials)}));
}

/// Grids, and what of the curve is a nuisance.
void read_grids(const Place& place, const toml::table& table, Protocol& protocol) {
  psychophysics::QuestPlusOptions& options = protocol.scale.quest;
  options.thresholds = read_grid(place, table, {.key = "thresholds", .lower = 1e-6, .upper = largest_level});
  options.guesses = read_grid(place, table, {.key = "guesses", .lower = 0.0, .upper = 0.95});
  if (auto slopes = read_grid(place, table, {.key = "slopes", .lower = 0.1, .upper = 50.0}); !slopes.empty())
    options.slopes = std::move(slopes);
  if (auto lapses = read_grid(place, table, {.key = "lapses", .lower = 0.0, .upper = 0.5}); !lapses.empty())
    options.lapses = std::move(lapses);
  const double guess = options.guesses.empty() ? 0.5 : options.guesses.back();
  if (guess + options.lapses.back() >= 1.0) {
    place.refuse(
        table, "a guess rate of {:g} and a lapse rate of {:g} leave no curve; expected less than 1 together",
        guess, options.lapses.back());
  }
  options.nuisance = read_nuisance(place, table);
}

/// The most that a trial may be chosen from within a tenth of a second.
void require_size(const Place& place, const toml::node& node, const IntensityScale& scale) {
  constexpr std::size_t largest = 2'000'000;
  const psychophysics::QuestPlusOptions all = quest_options_of(scale, 0.5);
  const std::size_t points = all.thresholds.size() * all.slopes.size() *
                             std::max<std::size_t>(1, all.guesses.size()) * all.lapses.size();
  if (points * all.intensities.size() > largest) {
    place.refuse(node, "the grids of QUEST+ have {} points and {} levels, together expected at most {}",
                 points, all.intensities.size(), largest);
  }
}

/// A tenth to ten times the expected JND, 16 a decade, to four digits so that every machine has the same.
std::vector<double> standard_levels(double expected_jnd) {
  std::vector<double> levels = psychophysics::geometric_grid(0.1 * expected_jnd, 10.0 * expected_jnd, 33);
  for (double& level : levels) {
    const std::string digits = fmt::format("{:.4g}", level);
    std::from_chars(digits.data(), digits.data() + digits.size(), level);
  }
  return levels;
}

}  // namespace

void read_quest(const Place& place, const toml::table& root, const toml::table& scale, Protocol& protocol) {
  if (scale.contains("quest")) {
    const toml::table& table = place.table(scale, "quest");
    place.allow_only(
        table, {"trials", "expected_jnd", "thresholds", "slopes", "guesses", "lapses", "nuisance", "until"},
        "[scale.quest]");
    if (table.contains("trials")) {
      if (root.contains("trials"))
        place.refuse(*table.get("trials"),
                     "'trials' stands here and at the top of the file; leave out either");
      protocol.trials = read_count(place, table, {.key = "trials", .lower = 1, .upper = max_trials});
    }
    read_grids(place, table, protocol);
    // Of thresholds that are given the middle, for the levels.
    if (const auto& given = protocol.scale.quest.thresholds; !given.empty())
      protocol.scale.expected_jnd = std::clamp(std::sqrt(given.front() * given.back()), 1e-4, 10.0);
    protocol.scale.expected_jnd = read_plain_number(
        place, table,
        {.key = "expected_jnd", .standard = protocol.scale.expected_jnd, .lower = 1e-4, .upper = 10.0});
    read_until(place, table, protocol);
  }
  protocol.scale.quest_trials = protocol.trials;
  if (scale.contains("levels")) {
    read_levels(place, *scale.get("levels"), protocol);
  } else {
    protocol.scale.levels = standard_levels(protocol.scale.expected_jnd);
    for (const double level : {protocol.scale.levels.front(), protocol.scale.levels.back()})
      require_playable(place, scale, protocol, level);
  }
  require_size(place, node_or_table(scale, "quest"), protocol.scale);
}

}  // namespace kerf::bench
