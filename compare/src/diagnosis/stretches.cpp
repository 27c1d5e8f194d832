#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "diagnosis/pair.h"

namespace kerf::compare {
namespace {

constexpr std::size_t shortest_silence = 3;
constexpr std::size_t most_spikes = 5;

/// Rows that differ: the first, one past the last, how many.
struct Differing {
  std::size_t begin = 0;
  std::size_t end = 0;
  std::vector<std::size_t> rows;
};

Differing differing_rows(const ForcePair& pair) {
  Differing all;
  for (std::size_t row = 0; row < pair.rows(); ++row) {
    if (std::abs(pair.difference[row]) > pair.tiny) all.rows.push_back(row);
  }
  if (!all.rows.empty()) {
    all.begin = all.rows.front();
    all.end = all.rows.back() + 1;
  }
  return all;
}

/// Zero, or the value that stands from a row on, where something else is expected.
void find_stillness(const ForcePair& pair, const Differing& all, Findings& found) {
  const double value = pair.got[all.begin];
  std::size_t begin = all.begin;
  while (begin > 0 && std::abs(pair.got[begin - 1] - value) <= pair.tiny) --begin;
  std::size_t end = all.begin;
  while (end < pair.rows() && std::abs(pair.got[end] - value) <= pair.tiny) ++end;
  if (end - begin < shortest_silence) return;
  const auto predicted = [&](std::size_t row) {
    return row >= begin && row < end ? value : pair.expected[row];
  };
  const double remainder = pair.remainder(predicted);
  const bool to_the_end = end == pair.rows();
  const bool zero = std::abs(value) <= pair.tiny;
  if (!zero && (!to_the_end || all.end < pair.rows() - (pair.rows() - begin) / 10)) return;
  const double most = std::abs(*std::ranges::max_element(pair.expected.subspan(begin, end - begin), {},
                                                         [](double force) { return std::abs(force); }));
  Finding finding{.change = zero ? Change::silence : Change::stuck,
                  .remainder = remainder,
                  .numbers = {{"row", static_cast<double>(all.begin)}, {"end", static_cast<double>(end)}}};
  // The force may have been zero for some time where it should be: silent since it should not be.
  const std::string from = to_the_end ? fmt::format("from tick {} on", all.begin)
                                      : fmt::format("in ticks {} to {}", all.begin, end - 1);
  if (!zero) {
    finding.sentence = fmt::format("the force stays at {:.4g} {} {}", value, pair.unit, from);
  } else if (begin == 0 && to_the_end) {
    finding.sentence =
        fmt::format("the law is silent: no force in any tick, where up to {:.3g} is expected", most);
  } else {
    finding.sentence = fmt::format("the law is silent {}, where up to {:.3g} is expected", from, most);
  }
  add_finding(found, pair, std::move(finding));
}

void find_spikes(const ForcePair& pair, const Differing& all, Findings& found) {
  if (all.rows.size() > most_spikes || pair.rows() < 10 * all.rows.size()) return;
  const std::size_t worst = *std::ranges::max_element(
      all.rows, {}, [&](std::size_t row) { return std::abs(pair.difference[row]); });
  const std::string more = all.rows.size() > 1
                               ? fmt::format(", and {} more by tick {}", all.rows.size() - 1, all.rows.back())
                               : "";
  add_finding(found, pair,
              {.change = Change::spike,
               .remainder = 0.0,
               .sentence = fmt::format("a spike of {:+.4g} {} at tick {}{}", pair.difference[worst],
                                       pair.unit, worst, more),
               .numbers = {{"row", static_cast<double>(worst)}, {"size", pair.difference[worst]}}});
}

/// Samples that are those of the tick before, while the others are as expected.
void find_repeated(const ForcePair& pair, const Differing& all, Findings& found) {
  if (all.rows.size() * 4 > pair.rows() || all.begin == 0) return;
  const bool held = std::ranges::all_of(
      all.rows, [&](std::size_t row) { return std::abs(pair.got[row] - pair.got[row - 1]) <= pair.tiny; });
  if (!held) return;
  add_finding(found, pair,
              {.change = Change::repeated,
               .remainder = 0.0,
               .sentence = fmt::format("{} the sample before, first tick {}",
                                       all.rows.size() == 1
                                           ? std::string("a sample is replaced by")
                                           : fmt::format("{} samples are replaced by", all.rows.size()),
                                       all.begin),
               .numbers = {{"row", static_cast<double>(all.begin)},
                           {"count", static_cast<double>(all.rows.size())}}});
}

}  // namespace

void find_stretches(const ForcePair& pair, Findings& found) {
  const Differing all = differing_rows(pair);
  if (all.rows.empty()) return;
  find_stillness(pair, all, found);
  find_spikes(pair, all, found);
  find_repeated(pair, all, found);
}

}  // namespace kerf::compare
