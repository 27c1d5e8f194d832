#include "protocol/attention/catch_trials.h"

#include <algorithm>
#include <stdexcept>

#include "protocol/protocol_parts.h"
#include "protocol/samples.h"

namespace kerf::bench {
namespace {

constexpr double least_every = 3.0;
constexpr double most_level = 100.0;

/// Trials that count of one session, of an adaptive design the most.
std::size_t trials_of_session(const Protocol& protocol) {
  std::size_t cells = 0;
  for (std::size_t tissue = 0; tissue < protocol.tissues.size(); ++tissue)
    cells += pairs_of(protocol, tissue).size();
  if (protocol.design == Design::constant) cells *= protocol.scale.levels.size();
  return cells * protocol.trials;
}

/// The largest level that any other trial may have.
double largest_level_of(const Protocol& protocol) {
  double largest = protocol.scale.levels.empty() ? 0.0 : std::ranges::max(protocol.scale.levels);
  if (protocol.design != Design::staircase) return largest;
  for (const psychophysics::StaircaseOptions& each : protocol.scale.staircases())
    largest = std::max(largest, each.start);
  return largest;
}

void read_catch_level(const Place& place, const toml::table& table, Protocol& protocol) {
  if (!table.contains("level"))
    place.refuse(table, "[catch] of a design of levels needs 'level', one that nobody can miss, such as 1.0");
  CatchTrials& catches = protocol.catches;
  catches.level = read_plain_number(place, table, {.key = "level", .upper = most_level});
  const double largest = largest_level_of(protocol);
  if (catches.level <= largest)
    place.refuse(*table.get("level"), "'level' is {:g}, expected more than {:g}, {}", catches.level, largest,
                 protocol.design == Design::staircase ? "where a staircase starts"
                                                      : "the largest of the other trials");
  try {
    (void)played(protocol, protocol.scale.standard, catches.level);
  } catch (const std::invalid_argument& error) {
    place.refuse(*table.get("level"), "{}", error.what());
  }
}

}  // namespace

bool asks_for_more(const Protocol& protocol) noexcept {
  return protocol.signal.has_value() || protocol.design == Design::preference;
}

std::vector<std::array<std::size_t, 2>> catch_pairs_of(const Protocol& protocol, std::size_t tissue) {
  if (has_levels(protocol.design)) return {{protocol.scale.standard, protocol.scale.standard}};
  const CatchTrials& catches = protocol.catches;
  const std::size_t own = catches.sample.value();
  std::vector<std::array<std::size_t, 2>> pairs;
  for (const std::size_t other : protocol.tissues.at(tissue).samples) {
    if (protocol.signal && (other == *protocol.signal) == catches.is_more) continue;
    if (asks_for_more(protocol) && !catches.is_more) {
      pairs.push_back({own, other});
    } else {
      pairs.push_back({other, own});
    }
  }
  return pairs;
}

void read_catch_sample(const Place& place, const toml::table& root, Protocol& protocol) {
  if (!root.contains("catch")) return;
  const toml::table& table = place.table(root, "catch");
  place.allow_only(table, {"every", "sample", "is", "level"}, "[catch]");
  if (asks_numbers(protocol.design))
    place.refuse(table, "'{}' asks for a number, of which none is right; leave [catch] out",
                 name_of(protocol.design));
  if (!table.contains("every"))
    place.refuse(table, "[catch] needs 'every', a number of trials of which one more is a catch trial");
  const bool of_levels = has_levels(protocol.design);
  for (const char* key : {"sample", "is"}) {
    if (of_levels && table.contains(key))
      place.refuse(*table.get(key), "'{}' of [catch] is for designs without levels; expected 'level'", key);
  }
  if (of_levels) return;
  if (table.contains("level"))
    place.refuse(*table.get("level"), "'level' of [catch] is for designs of levels; expected 'sample'");
  const toml::node* const sample = table.get("sample");
  if (sample == nullptr) place.refuse(table, "[catch] needs 'sample', one that nobody can take for another");
  protocol.catches.sample = sample_of(place, *sample, protocol);
}

void read_catch_trials(const Place& place, const toml::table& root, Protocol& protocol) {
  if (!root.contains("catch")) return;
  const toml::table& table = place.table(root, "catch");
  CatchTrials& catches = protocol.catches;
  catches.every = read_count(place, table, {.key = "every", .lower = least_every, .upper = max_trials});
  if (const std::size_t trials = trials_of_session(protocol); catches.every > trials)
    place.refuse(*table.get("every"), "'every' is {}, and a session has {} trials: there would be none",
                 catches.every, trials);
  if (has_levels(protocol.design)) return read_catch_level(place, table, protocol);
  if (table.contains("is") && !asks_for_more(protocol))
    place.refuse(*table.get("is"),
                 "'is' of [catch] says whether the sample has more or less of what is asked for, and this "
                 "question asks what is different; leave it out");
  catches.is_more = read_choice(place, table, "is", false, {{"less", false}, {"more", true}});
}

}  // namespace kerf::bench
