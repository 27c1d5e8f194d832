#include "answers/explored/explored_alike.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <fmt/core.h>

namespace kerf::bench {
namespace {

constexpr std::array exploring_members{&Exploring::speed_m_s, &Exploring::peak_speed_m_s,
                                       &Exploring::strokes_per_s, &Exploring::off_target, &Exploring::lag_s};

/// Member by member, of those that are known.
Exploring mean_exploring(const std::vector<Exploring>& all) {
  Exploring mean;
  for (const auto member : exploring_members) {
    double sum = 0.0;
    double count = 0.0;
    for (const Exploring& one : all) {
      if (!std::isfinite(one.*member)) continue;
      sum += one.*member;
      count += 1.0;
    }
    mean.*member = count > 0.0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
  }
  return mean;
}

double apart_percent(double first, double second) {
  const double middle = 0.5 * (first + second);
  return middle > 0.0 ? 100.0 * (second - first) / middle : std::numeric_limits<double>::quiet_NaN();
}

ExploredPair of_pair(const Study& study, const std::array<std::size_t, 2>& pair, double confidence) {
  std::set<std::string> subjects;
  for (const ExploredSlot& slot : study.explored) subjects.insert(slot.subject);
  std::array<std::vector<Exploring>, 2> means;
  for (const std::string& subject : subjects) {
    std::array<std::vector<Exploring>, 2> slots;
    for (const ExploredSlot& slot : study.explored) {
      if (slot.subject != subject || slot.pair != pair) continue;
      slots[slot.which].push_back(slot.hand);
    }
    if (slots[0].empty() || slots[1].empty()) continue;
    for (const std::size_t which : {0U, 1U}) means[which].push_back(mean_exploring(slots[which]));
  }
  const auto over = [&](double Exploring::*member) {
    std::vector<double> apart;
    for (std::size_t i = 0; i < means[0].size(); ++i)
      apart.push_back(apart_percent(means[0][i].*member, means[1][i].*member));
    return over_people(apart, confidence);
  };
  return {.pair = pair,
          .subjects = means[0].size(),
          .first = mean_exploring(means[0]),
          .second = mean_exploring(means[1]),
          .speed_percent = over(&Exploring::speed_m_s),
          .peak_speed_percent = over(&Exploring::peak_speed_m_s),
          .stroke_rate_percent = over(&Exploring::strokes_per_s),
          .off_target_percent = over(&Exploring::off_target)};
}

bool is_apart(const OverPeople& people) noexcept {
  return people.interval && (people.interval->lower > 0.0 || people.interval->upper < 0.0);
}

}  // namespace

bool ExploredPair::differs() const noexcept {
  return is_apart(speed_percent) || is_apart(peak_speed_percent) || is_apart(stroke_rate_percent);
}

std::vector<ExploredPair> explored_alike(const Study& study, double confidence) {
  std::set<std::array<std::size_t, 2>> pairs;
  for (const ExploredSlot& slot : study.explored) pairs.insert(slot.pair);
  std::vector<ExploredPair> explored;
  for (const auto& pair : pairs) {
    explored.push_back(of_pair(study, pair, confidence));
    if (explored.back().subjects == 0) explored.pop_back();
  }
  return explored;
}

std::array<std::string, 2> names_of(const ExploredPair& pair, const std::vector<std::string>& names) {
  if (pair.pair[0] == pair.pair[1]) return {"standard", "comparison"};
  return {names[pair.pair[0]], names[pair.pair[1]]};
}

std::vector<std::string> explored_findings(const std::vector<ExploredPair>& pairs,
                                           const std::vector<std::string>& names, double confidence) {
  std::vector<std::string> findings;
  for (const ExploredPair& pair : pairs) {
    const auto both = names_of(pair, names);
    const auto tell = [&](const OverPeople& people, const char* what) {
      if (!is_apart(people)) return;
      findings.push_back(fmt::format(
          "'{}' and '{}' were not explored alike: {} of the tool was {:.1f} % {} on '{}' ({:.3g} % {:.1f} to "
          "{:.1f} % over {} people): a law may have slowed the hand, or the hand may have made the "
          "difference",
          both[0], both[1], what, std::abs(people.mean), people.mean > 0.0 ? "higher" : "lower", both[1],
          100.0 * confidence, people.interval->lower, people.interval->upper, pair.subjects));
    };
    tell(pair.speed_percent, "the mean speed");
    tell(pair.peak_speed_percent, "the peak speed");
    tell(pair.stroke_rate_percent, "the rate of strokes");
  }
  return findings;
}

}  // namespace kerf::bench
