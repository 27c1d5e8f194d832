#include "answers/felt_check.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include <kerf/psychophysics/repeated_measures.h>

namespace kerf::bench {
namespace {

constexpr std::size_t fewest_subjects = 3;  ///< of whom an interval is made

using Slots = std::vector<const FeltSlot*>;

bool is_known(const FeltSlot& slot) { return std::isfinite(slot.level.rms_n); }

/// NaN of none; values that are not known are left out.
class Mean {
 public:
  void add(double value) {
    if (!std::isfinite(value)) return;
    sum_ += value;
    count_ += 1.0;
  }
  [[nodiscard]] double value() const {
    return count_ == 0.0 ? std::numeric_limits<double>::quiet_NaN() : sum_ / count_;
  }

 private:
  double sum_ = 0.0;
  double count_ = 0.0;
};

/// Of the slots of one subject.
FeltLevel level_of(const Slots& slots) {
  Mean rms, peak, limited, vibration, thresholds;
  for (const FeltSlot* const slot : slots) {
    rms.add(slot->level.rms_n * slot->level.rms_n);
    peak.add(slot->level.peak_n);
    limited.add(slot->level.limited_share);
    vibration.add(slot->level.vibration_n * slot->level.vibration_n);
    thresholds.add(slot->level.vibration_thresholds);
  }
  return {.rms_n = std::sqrt(rms.value()),
          .peak_n = peak.value(),
          .limited_share = limited.value(),
          .vibration_n = std::sqrt(vibration.value()),
          .vibration_thresholds = thresholds.value()};
}

FeltLevel mean_of(const std::vector<FeltLevel>& subjects) {
  Mean rms, peak, limited, vibration, thresholds;
  for (const FeltLevel& level : subjects) {
    rms.add(level.rms_n);
    peak.add(level.peak_n);
    limited.add(level.limited_share);
    vibration.add(level.vibration_n);
    thresholds.add(level.vibration_thresholds);
  }
  return {.rms_n = rms.value(),
          .peak_n = peak.value(),
          .limited_share = limited.value(),
          .vibration_n = vibration.value(),
          .vibration_thresholds = thresholds.value()};
}

OverPeople over_people(const std::vector<FeltApart>& subjects, double FeltApart::*value, double confidence) {
  std::vector<double> values;
  for (const FeltApart& apart : subjects) values.push_back(apart.*value);
  return kerf::bench::over_people(values, confidence);
}

/// Those that stand for one of something, in order of appearance.
template <typename Key>
auto in_order(const std::vector<FeltSlot>& slots, const Key& key) {
  std::vector<decltype(key(slots.front()))> all;
  for (const FeltSlot& slot : slots) {
    if (is_known(slot) && std::ranges::find(all, key(slot)) == all.end()) all.push_back(key(slot));
  }
  return all;
}

template <typename Holds>
Slots those(const std::vector<FeltSlot>& slots, const Holds& holds) {
  Slots some;
  for (const FeltSlot& slot : slots) {
    if (is_known(slot) && holds(slot)) some.push_back(&slot);
  }
  return some;
}

class FeltChecking {
 public:
  FeltChecking(const Study& study, double confidence)
      : slots_(study.felt),
        confidence_(confidence),
        subjects_(in_order(slots_, [](const FeltSlot& slot) { return slot.subject; })) {}

  [[nodiscard]] FeltCheck check() const {
    FeltCheck check;
    auto samples = in_order(slots_, [](const FeltSlot& slot) { return slot.sample; });
    std::ranges::sort(samples);
    for (const std::size_t sample : samples) check.samples.push_back(of_sample(sample));
    auto pairs = in_order(slots_, [](const FeltSlot& slot) { return slot.pair; });
    std::ranges::sort(pairs);
    for (const auto& pair : pairs) check.pairs.push_back(of_pair(pair));
    std::erase_if(check.pairs, [](const FeltOfPair& pair) { return pair.subjects == 0; });
    return check;
  }

 private:
  [[nodiscard]] FeltOfSample of_sample(std::size_t sample) const {
    FeltOfSample found{.sample = sample};
    std::vector<FeltLevel> levels;
    for (const std::string& subject : subjects_) {
      const Slots slots = those(
          slots_, [&](const FeltSlot& slot) { return slot.subject == subject && slot.sample == sample; });
      found.slots += slots.size();
      if (!slots.empty()) levels.push_back(level_of(slots));
    }
    found.level = mean_of(levels);
    return found;
  }

  [[nodiscard]] FeltOfPair of_pair(const std::array<std::size_t, 2>& pair) const {
    FeltOfPair found{.pair = pair};
    std::vector<FeltLevel> firsts, seconds;
    std::vector<FeltApart> aparts;
    for (const std::string& subject : subjects_) {
      std::array<Slots, 2> slots;
      for (std::size_t which = 0; which < 2; ++which) {
        slots[which] = those(slots_, [&](const FeltSlot& slot) {
          return slot.subject == subject && slot.pair == pair && slot.sample == pair[which];
        });
      }
      if (slots[0].empty() || slots[1].empty()) continue;
      firsts.push_back(level_of(slots[0]));
      seconds.push_back(level_of(slots[1]));
      aparts.push_back(felt_apart(firsts.back(), seconds.back()));
    }
    found.subjects = aparts.size();
    found.first = mean_of(firsts);
    found.second = mean_of(seconds);
    found.rms_jnds = over_people(aparts, &FeltApart::rms_jnds, confidence_);
    found.peak_jnds = over_people(aparts, &FeltApart::peak_jnds, confidence_);
    found.limited_share = over_people(aparts, &FeltApart::limited_share, confidence_);
    found.vibration_db = over_people(aparts, &FeltApart::vibration_db, confidence_);
    return found;
  }

  const std::vector<FeltSlot>& slots_;
  double confidence_;
  std::vector<std::string> subjects_;
};

std::string interval_text(const OverPeople& people, double confidence, double scale, const char* unit) {
  if (!people.interval) return "";
  return fmt::format(", {:.3g} % {:.2f} to {:.2f}{} over people", 100.0 * confidence,
                     scale * people.interval->lower, scale * people.interval->upper, unit);
}

}  // namespace

OverPeople over_people(const std::vector<double>& subjects, double confidence) {
  std::vector<double> known;
  Mean mean;
  for (const double value : subjects) {
    mean.add(value);
    if (std::isfinite(value)) known.push_back(value);
  }
  OverPeople people{.mean = mean.value(), .interval = {}};
  if (known.size() >= fewest_subjects)
    people.interval = psychophysics::subjects_mean(known, confidence).interval;
  return people;
}

bool FeltOfPair::strength_differs() const noexcept { return is_strength_apart(rms_jnds.mean); }
bool FeltOfPair::limits_differ() const noexcept {
  return is_limit_apart({.limited_share = limited_share.mean});
}
bool FeltOfPair::vibration_differs() const noexcept { return is_vibration_apart(felt_apart(first, second)); }

FeltCheck felt_check(const Study& study, double confidence) {
  FeltCheck none;
  if (has_levels(study.design)) {
    none.note = "the design varies how strong samples are";
    return none;
  }
  FeltCheck check = FeltChecking(study, confidence).check();
  if (check.samples.empty()) check.note = "of no trial that counts the forces are known";
  return check;
}

std::vector<std::string> felt_findings(const FeltCheck& check, const std::vector<std::string>& names,
                                       double confidence) {
  std::vector<std::string> findings;
  for (const FeltOfPair& pair : check.pairs) {
    const std::string both = fmt::format("samples '{}' and '{}'", names[pair.pair[0]], names[pair.pair[1]]);
    if (pair.strength_differs()) {
      findings.push_back(fmt::format(
          "{} were not felt equally strong, but {:.1f} JND apart (rms {:.3g} and {:.3g} N{}; JND {}): "
          "strength may have told them apart",
          both, std::abs(pair.rms_jnds.mean), pair.first.rms_n, pair.second.rms_n,
          interval_text(pair.rms_jnds, confidence, 1.0, " JND"), jnd_of_levels_source()));
    }
    if (pair.limits_differ()) {
      findings.push_back(
          fmt::format("{} were cut to a limit of the device in {:.2f} and {:.2f} % of the ticks{}: the limit "
                      "may have told "
                      "them apart",
                      both, 100.0 * pair.first.limited_share, 100.0 * pair.second.limited_share,
                      interval_text(pair.limited_share, confidence, 100.0, " % apart")));
    }
    if (pair.vibration_differs()) {
      findings.push_back(
          fmt::format("{} vibrated with {:.2g} and {:.2g} N rms from 20 Hz to 1 kHz{}: a buzz or the sound "
                      "of the device may "
                      "have told them apart",
                      both, pair.first.vibration_n, pair.second.vibration_n,
                      interval_text(pair.vibration_db, confidence, 1.0, " dB apart")));
    }
  }
  return findings;
}

}  // namespace kerf::bench
