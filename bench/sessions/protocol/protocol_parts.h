#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <utility>

#include "laws/law_toml.h"
#include "protocol/protocol.h"
#include "texts/plain_text.h"

// The parts of a protocol's file. All throw std::invalid_argument with file, line, found and expected.

namespace kerf::bench {

inline constexpr double max_trials = 10000.0;  ///< of a subject

/// A name of 1 to 60 printable characters, without spaces around it; `what` has it, for messages.
[[nodiscard]] std::string read_name(const Place& place, const toml::table& table, std::string_view what);

/// The node under `key`, or the table itself, for messages.
[[nodiscard]] const toml::node& node_or_table(const toml::table& table, std::string_view key);

/// A number that a protocol's file gives under `key`, without a unit.
struct PlainNumber {
  std::string_view key;
  double standard = 0.0;  ///< if it is not given
  double lower = 0.0;
  double upper = 1.0;
};
[[nodiscard]] double read_plain_number(const Place& place, const toml::table& table,
                                       const PlainNumber& about);
/// Likewise a whole one.
[[nodiscard]] std::size_t read_count(const Place& place, const toml::table& table, const PlainNumber& about);

/// One of some words.
template <typename Value>
Value read_choice(const Place& place, const toml::table& table, std::string_view key, Value standard,
                  std::initializer_list<std::pair<std::string_view, Value>> choices) {
  if (!table.contains(key)) return standard;
  const std::string given = read_plain_text(place, table, key);
  std::string known;
  for (const auto& [name, value] : choices) {
    if (name == given) return value;
    known += fmt::format("{}\"{}\"", known.empty() ? "" : ", ", name);
  }
  place.refuse(*table.get(key), "'{}' is \"{}\", expected one of {}", key, given, known);
}

/// [[sample]], [[tissue]], signal.
void read_samples(const Place& place, const toml::table& root,
                  const std::function<std::string(const std::string&)>& law_text, Protocol& protocol);
void read_tissues(const Place& place, const toml::table& root, Protocol& protocol);
void read_signal(const Place& place, const toml::table& root, Protocol& protocol);

/// standard, modulus; points, ends.
void read_numbers(const Place& place, const toml::table& root, Protocol& protocol);

/// The sample of that name.
[[nodiscard]] std::size_t sample_of(const Place& place, const toml::node& node, const Protocol& protocol);

/// [trial]
void read_trial_rules(const Place& place, const toml::table& root, Protocol& protocol);

/// [catch]: its sample, which is in no tissue, before these are read; and the rest, once all is known.
void read_catch_sample(const Place& place, const toml::table& root, Protocol& protocol);
void read_catch_trials(const Place& place, const toml::table& root, Protocol& protocol);
/// [guide], after the samples and the practice.
void read_guide(const Place& place, const toml::table& root, Protocol& protocol);
/// The target's way as a motion that no force disturbs, in whole cycles of at least 4 s.
[[nodiscard]] MotionSource motion_of(const GuidedMotion& guide);

/// [scale]
void read_scale(const Place& place, const toml::table& root, Protocol& protocol);

}  // namespace kerf::bench
