#include "protocol/read_scale.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "protocol/samples.h"

namespace kerf::bench {
namespace {

void read_varied(const Place& place, const toml::table& table, Protocol& protocol) {
  const toml::node* vary = table.get("vary");
  if (vary == nullptr) {
    place.refuse(
        table, "[scale] needs 'vary': \"force\", or parameters of the standard's law such as [\"damping\"]");
  }
  if (vary->is_string() && **vary->as_string() == "force") return;
  const toml::array* names = vary->as_array();
  if (names == nullptr || names->empty() || !names->is_homogeneous<std::string>())
    place.refuse(*vary, "'vary' must be \"force\" or an array of parameters, such as [\"damping\"]");
  const models::Law& law = protocol.samples[protocol.scale.standard].law.law;
  bool is_any_other_than_zero = false;
  for (const toml::node& node : *names) {
    const std::string name = **node.as_string();
    const std::vector<std::size_t> places = parameters_named(law, name);
    if (places.empty()) place.refuse(node, "law '{}' has no parameter {:?}", law.model(), name);
    if (std::ranges::count(protocol.scale.parameters, name) != 0)
      place.refuse(node, "parameter '{}' is named twice", name);
    for (const std::size_t at : places) is_any_other_than_zero |= law.values()[at] != 0.0;
    protocol.scale.parameters.push_back(name);
  }
  if (!is_any_other_than_zero)
    place.refuse(*vary, "what is to vary is 0 in law '{}', and stays 0 at every level", law.model());
}

std::vector<double> read_steps(const Place& place, const toml::table& table) {
  psychophysics::StaircaseOptions standard;
  const toml::node* node = table.get("steps");
  if (node == nullptr) return standard.steps;
  const toml::array* all = node->as_array();
  if (all == nullptr || all->empty() || all->size() > max_levels)
    place.refuse(*node, "'steps' must be an array of numbers, such as [0.4, 0.2, 0.1]");
  std::vector<double> steps;
  for (const toml::node& each : *all) {
    steps.push_back(place.number(each, "a step"));
    if (!(steps.back() > 0.0 && steps.back() <= 10.0))
      place.refuse(each, "a step is {:g}, expected a number above 0, at most 10", steps.back());
  }
  return steps;
}

psychophysics::StaircaseOptions read_staircase(const Place& place, const toml::table& table,
                                               const Protocol& protocol) {
  place.allow_only(
      table, {"up", "down", "start", "steps", "step_ratio", "axis", "least", "most", "reversals", "dropped"},
      "[scale.staircase]");
  psychophysics::StaircaseOptions options;
  const auto count = [&](std::string_view key, int standard, double lower, double upper) {
    return static_cast<int>(
        read_count(place, table,
                   {.key = key, .standard = static_cast<double>(standard), .lower = lower, .upper = upper}));
  };
  options.up = count("up", options.up, 1, 20);
  options.down = count("down", options.down, 1, 20);
  options.reversals = count("reversals", options.reversals, 2, max_trials);
  options.dropped = count("dropped", std::min(options.dropped, options.reversals - 2), 0, max_trials);
  options.steps = read_steps(place, table);
  options.step_ratio =
      read_plain_number(place, table, {.key = "step_ratio", .standard = 1.0, .lower = 0.01, .upper = 100.0});
  options.axis = read_choice(
      place, table, "axis", psychophysics::Axis::logarithmic,
      {{"logarithmic", psychophysics::Axis::logarithmic}, {"linear", psychophysics::Axis::linear}});
  if (!table.contains("start"))
    place.refuse(table, "[scale.staircase] needs 'start', the first level; one that is easy to tell");
  const auto level = [&](std::string_view key, double standard) {
    return read_plain_number(place, table,
                             {.key = key, .standard = standard, .lower = 1e-6, .upper = largest_level});
  };
  options.start = level("start", 0.0);
  options.least = level("least", 1e-3 * options.start);
  options.most = level("most", 4.0 * options.start);
  options.max_trials = static_cast<int>(protocol.trials);
  try {
    (void)psychophysics::Staircase(options);
  } catch (const std::exception& error) {
    place.refuse(table, "{}", error.what());
  }
  for (const auto& [key, value] :
       {std::pair{"start", options.start}, {"least", options.least}, {"most", options.most}})
    require_playable(place, node_or_table(table, key), protocol, value);
  return options;
}

/// One, or several that are interleaved.
void read_staircases(const Place& place, const toml::table& scale, Protocol& protocol) {
  constexpr std::size_t most = 8;
  const toml::node* node = scale.get("staircase");
  const toml::array* several = node != nullptr ? node->as_array() : nullptr;
  if (several == nullptr) {
    protocol.scale.staircase = read_staircase(place, place.table(scale, "staircase"), protocol);
    return;
  }
  if (several->size() < 2 || several->size() > most || !several->is_homogeneous<toml::table>())
    place.refuse(*node, "'staircase' is a table, or an array of 2 to {} of them, which are interleaved",
                 most);
  protocol.scale.staircase = read_staircase(place, *several->front().as_table(), protocol);
  for (std::size_t i = 1; i < several->size(); ++i)
    protocol.scale.interleaved.push_back(read_staircase(place, *several->get(i)->as_table(), protocol));
}

void read_shape(const Place& place, const toml::table& table, IntensityScale& scale) {
  using psychophysics::Shape;
  scale.shape = read_choice(
      place, table, "shape", scale.two_sided() ? Shape::gaussian : Shape::weibull,
      {{"weibull", Shape::weibull}, {"logistic", Shape::logistic}, {"gaussian", Shape::gaussian}});
  if (scale.two_sided() && scale.shape == Shape::weibull) {
    place.refuse(
        *table.get("shape"),
        "a Weibull curve has levels above 0 only; expected \"gaussian\" or \"logistic\" for levels on "
        "both sides");
  }
}

}  // namespace

void require_playable(const Place& place, const toml::node& node, const Protocol& protocol, double level) {
  try {
    (void)played(protocol, protocol.scale.standard, level);
  } catch (const std::invalid_argument& error) {
    place.refuse(node, "{}", error.what());
  }
}

void read_levels(const Place& place, const toml::node& node, Protocol& protocol) {
  const toml::array* all = node.as_array();
  if (all == nullptr || all->empty() || all->size() > max_levels)
    place.refuse(node, "'levels' must be an array of 1 to {} numbers, such as [0.1, 0.2]", max_levels);
  std::vector<double>& levels = protocol.scale.levels;
  for (const toml::node& each : *all) {
    const double level = place.number(each, "a level");
    if (!(std::isfinite(level) && level > -1.0 && level <= largest_level)) {
      place.refuse(each,
                   "level {:g} is not above -1 and at most {:g}; the comparison is 1 + level of the standard",
                   level, largest_level);
    }
    if (std::ranges::count(levels, level) != 0) place.refuse(each, "level {:g} is there twice", level);
    levels.push_back(level);
  }
  const bool may_be_on_both_sides = protocol.design == Design::magnitude ||
                                    (protocol.design == Design::constant && protocol.scale.two_sided());
  for (const toml::node& each : *all) {
    const double level = place.number(each, "a level");
    if (level <= 0.0 && !may_be_on_both_sides) {
      place.refuse(each, "level {:g} is not above 0; {}", level,
                   protocol.design == Design::constant ? "levels are all above 0, or lie on both sides of it"
                                                       : "an adaptive design has levels above 0 only");
    }
    require_playable(place, each, protocol, level);
  }
  std::ranges::sort(levels);
}

void read_scale(const Place& place, const toml::table& root, Protocol& protocol) {
  const bool may_have = protocol.design == Design::magnitude;
  if (may_have && !root.contains("scale")) return;
  if (!has_levels(protocol.design) && !may_have) {
    if (const toml::node* node = root.get("scale"))
      place.refuse(*node, "[scale] is for the designs of levels and for magnitudes, and this is \"{}\"",
                   name_of(protocol.design));
    return;
  }
  if (!root.contains("scale")) {
    place.refuse(root,
                 "the design \"{}\" needs a table [scale]: how the comparison differs from the standard",
                 name_of(protocol.design));
  }
  const toml::table& table = place.table(root, "scale");
  IntensityScale& scale = protocol.scale;
  scale.standard = table.contains("standard") ? sample_of(place, *table.get("standard"), protocol) : 0;
  read_varied(place, table, protocol);
  if (may_have) {
    place.allow_only(table, {"standard", "vary", "levels"}, "the [scale] of magnitudes");
    if (!table.contains("levels"))
      place.refuse(table, "[scale] needs 'levels', such as levels = [-0.5, 0, 1, 3]");
    read_levels(place, *table.get("levels"), protocol);
    if (scale.levels.size() < 2)
      place.refuse(*table.get("levels"), "one level has no exponent; expected two levels or more");
    return;
  }
  if (protocol.design == Design::constant) {
    place.allow_only(table, {"standard", "vary", "levels", "shape"}, "the [scale] of constant levels");
    if (!table.contains("levels"))
      place.refuse(table, "[scale] needs 'levels', such as levels = [0.05, 0.1, 0.2, 0.4]");
    read_levels(place, *table.get("levels"), protocol);
  } else if (protocol.design == Design::staircase) {
    place.allow_only(table, {"standard", "vary", "staircase", "shape"}, "the [scale] of a staircase");
    read_staircases(place, table, protocol);
  } else {
    place.allow_only(table, {"standard", "vary", "levels", "quest", "shape"}, "the [scale] of QUEST+");
    read_quest(place, root, table, protocol);
  }
  read_shape(place, table, scale);
}

}  // namespace kerf::bench
