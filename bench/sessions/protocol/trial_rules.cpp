#include "protocol/trial_rules.h"

#include <algorithm>
#include <array>
#include <stdexcept>

#include <fmt/core.h>

#include "protocol/protocol_parts.h"
#include "scene/read_motion.h"

namespace kerf::bench {
namespace {

constexpr double most_ticks = 1e9;
constexpr double most_repeats = 20.0;

void read_void(const Place& place, const toml::table& table, Protocol& protocol) {
  TrialRules& rules = protocol.rules;
  if (!table.contains("void")) return;
  const toml::table& given = place.table(table, "void");
  place.allow_only(given, {"fault", "soft_start", "limited_ticks", "missed_deadlines", "off_target"},
                   "'void'");
  rules.fault = place.flag(given, "fault", false);
  rules.soft_start = place.flag(given, "soft_start", false);
  const auto most = [&](std::string_view key) -> std::optional<std::size_t> {
    if (!given.contains(key)) return std::nullopt;
    return read_count(place, given, {.key = key, .upper = most_ticks});
  };
  rules.limited_ticks = most("limited_ticks");
  rules.missed_deadlines = most("missed_deadlines");
  const toml::node* const off_target = given.get("off_target");
  if (off_target == nullptr) return;
  if (!protocol.guide || !protocol.guide->has_target())
    place.refuse(*off_target, "'off_target' is a distance to the target of a [guide], and there is none");
  rules.off_target =
      read_number(place, given,
                  {.key = "off_target", .unit = protocol.guide->position_unit, .lower = 0.0, .upper = 100.0});
  if (*rules.off_target == 0.0)
    place.refuse(*off_target, "'off_target' is 0, which no hand keeps to; expected a distance above 0");
}

void read_exploration(const Place& place, const toml::table& table, Exploration& explore) {
  if (!table.contains("explore")) return;
  const toml::table& given = place.table(table, "explore");
  place.allow_only(given, {"contact", "travel", "force", "strokes"}, "'explore'");
  explore.contact_s = read_seconds(place, given, "contact", 0.0, 0.0, 600.0);
  explore.travel_m = read_number(place, given, {.key = "travel", .unit = "m", .lower = 0.0, .upper = 100.0});
  explore.force_n = read_number(place, given, {.key = "force", .unit = "N", .lower = 0.0, .upper = 100.0});
  explore.strokes = read_count(place, given, {.key = "strokes", .upper = 1000.0});
  if (!explore.is_asked())
    place.refuse(given,
                 "'explore' asks for nothing; expected one of contact, travel, force, strokes above 0");
}

/// What one slot cannot give in the time that it has is refused before anybody tries.
void require_time_to_explore(const Place& place, const toml::table& table, const Protocol& protocol) {
  const double contact_s = protocol.rules.explore.contact_s;
  const double most_s = protocol.presentation == Presentation::sequence
                            ? protocol.interval_s
                            : protocol.longest_s / static_cast<double>(slots_of(protocol));
  if (contact_s < most_s || contact_s == 0.0) return;
  place.refuse(*table.get("explore"), "'contact' is {:g} s in each slot, and a slot has at most {:g} s",
               contact_s, most_s);
}

void read_practice_criterion(const Place& place, const toml::table& root, Protocol& protocol) {
  if (!root.contains("practice_until")) return;
  const toml::table& given = place.table(root, "practice_until");
  place.allow_only(given, {"right", "of", "otherwise"}, "'practice_until'");
  for (const char* key : {"right", "of"}) {
    if (!given.contains(key)) place.refuse(given, "'practice_until' needs '{}', a number of answers", key);
  }
  const bool some_answer_is_right = protocol.design != Design::preference && !asks_numbers(protocol.design) &&
                                    !(has_levels(protocol.design) && protocol.scale.two_sided());
  if (!some_answer_is_right)
    place.refuse(given, "'practice_until' needs a design in which an answer is right");
  PracticeCriterion& until = protocol.rules.practice_until;
  until.of =
      read_count(place, given,
                 {.key = "of", .lower = 1.0, .upper = std::max(1.0, static_cast<double>(protocol.practice))});
  until.right =
      read_count(place, given, {.key = "right", .lower = 1.0, .upper = static_cast<double>(until.of)});
  until.ends_session = read_choice(place, given, "otherwise", false, {{"go-on", false}, {"end", true}});
}

void read_states(const Place& place, const toml::table& table, Protocol& protocol) {
  TrialRules& rules = protocol.rules;
  rules.states = read_choice(place, table, "states", StatesBetween::run_on,
                             {{"run-on", StatesBetween::run_on},
                              {"reset", StatesBetween::reset},
                              {"out-of-contact", StatesBetween::out_of_contact}});
  if (rules.states != StatesBetween::run_on && protocol.switching != SwitchKind::through_zero) {
    place.refuse(
        *table.get("states"),
        "'states' of a law begin anew where no force is felt; that takes switching = \"through-zero\"");
  }
  rules.start = read_choice(place, table, "start", TrialStart::at_once,
                            {{"at-once", TrialStart::at_once},
                             {"key", TrialStart::key},
                             {"out-of-contact", TrialStart::out_of_contact}});
  for (const char* key : {"states", "start"}) {
    const bool asks = key == std::string_view("states") ? rules.states == StatesBetween::out_of_contact
                                                        : rules.start == TrialStart::out_of_contact;
    for (const SessionSample& sample : protocol.samples) {
      if (asks && sample.law.law.is_spatial())
        place.refuse(*table.get(key),
                     "the law of sample '{}' acts on several axes and has no contact of its own",
                     sample.name);
    }
  }
}

}  // namespace

std::string_view name_of(VoidReason reason) noexcept {
  static constexpr std::array<std::string_view, void_reasons> names{
      "fault", "soft-start", "limited-ticks", "missed-deadlines", "unexplored", "slipped", "off-target"};
  return names[static_cast<std::size_t>(reason)];
}

std::string joined(const std::vector<VoidReason>& reasons) {
  std::string words;
  for (const VoidReason reason : reasons)
    words += fmt::format("{}{}", words.empty() ? "" : " ", name_of(reason));
  return words;
}

std::vector<VoidReason> void_reasons_in(std::string_view words) {
  std::vector<VoidReason> reasons;
  while (!words.empty()) {
    const std::string_view word = words.substr(0, words.find(' '));
    std::size_t kind = 0;
    while (kind < void_reasons && name_of(static_cast<VoidReason>(kind)) != word) ++kind;
    if (kind == void_reasons)
      throw std::invalid_argument(fmt::format("'{}' is no reason for which a trial is void", word));
    reasons.push_back(static_cast<VoidReason>(kind));
    words.remove_prefix(std::min(words.size(), word.size() + 1));
  }
  return reasons;
}

bool TrialRules::may_void() const noexcept {
  return fault || soft_start || limited_ticks || missed_deadlines || off_target || explore.is_asked() || slip;
}

void read_trial_rules(const Place& place, const toml::table& root, Protocol& protocol) {
  read_practice_criterion(place, root, protocol);
  if (!root.contains("trial")) return;
  const toml::table& table = place.table(root, "trial");
  place.allow_only(table, {"void", "repeats", "explore", "slip", "states", "start", "pause"}, "[trial]");
  TrialRules& rules = protocol.rules;
  read_void(place, table, protocol);
  read_exploration(place, table, rules.explore);
  require_time_to_explore(place, table, protocol);
  rules.slip = place.flag(table, "slip", false);
  read_states(place, table, protocol);
  rules.pause_s = read_seconds(place, table, "pause", 0.0, 0.0, 600.0);
  rules.repeats =
      read_count(place, table,
                 {.key = "repeats", .standard = static_cast<double>(rules.repeats), .upper = most_repeats});
  if (table.contains("repeats") && !rules.may_void())
    place.refuse(*table.get("repeats"),
                 "'repeats' has nothing to repeat: say in 'void', 'explore' or 'slip' what does not count");
}

}  // namespace kerf::bench
