#include "doctor/watch/counters.h"

#include <algorithm>

#include <fmt/core.h>

#include "doctor/facts/host_tree.h"

namespace kerf::bench::doctor {
namespace {

/// A table with a line of "CPU0 CPU1 ..." at its head and a name before each row's numbers.
std::vector<Count> column_of(std::string_view table, int processor, bool has_words) {
  std::vector<Count> counts;
  const auto lines = lines_of(table);
  if (lines.empty()) return counts;
  const auto heads = words_of(lines.front());
  const auto head = std::ranges::find(heads, fmt::format("CPU{}", processor));
  if (head == heads.end()) return counts;
  const auto column = static_cast<std::size_t>(head - heads.begin()) + 1;
  for (const std::string_view line : lines) {
    const auto words = words_of(line);
    if (words.size() <= column || !words.front().ends_with(':')) continue;
    const auto count = number_of(words[column]);
    if (!count) continue;
    std::string name(words.front().substr(0, words.front().size() - 1));
    const bool is_numbered = number_of(name).has_value();
    const std::size_t first_word = heads.size() + 1;
    if (has_words && words.size() > first_word) {
      // Of a device's line the last word is who asked for it; the others are words for people.
      for (std::size_t at = is_numbered ? words.size() - 1 : first_word; at < words.size(); ++at)
        name += fmt::format(" {}", words[at]);
    }
    counts.push_back({.name = std::move(name), .count = static_cast<std::uint64_t>(*count)});
  }
  return counts;
}

}  // namespace

std::optional<ProcessorTimes> processor_times(std::string_view stat, int processor,
                                              std::int64_t ticks_per_s) {
  const std::string name = fmt::format("cpu{}", processor);
  for (const std::string_view line : lines_of(stat)) {
    const auto words = words_of(line);
    if (words.size() < 9 || words.front() != name) continue;
    const double tick_us = 1e6 / static_cast<double>(ticks_per_s);
    // user, nice, system, idle, iowait, irq, softirq, steal; guests' time is within that of user
    const auto field = [&](std::size_t at) {
      return tick_us * static_cast<double>(number_of(words[at]).value_or(0));
    };
    ProcessorTimes times;
    for (std::size_t at = 1; at <= 8; ++at) times.total_us += field(at);
    times.idle_us = field(4) + field(5);
    times.interrupt_us = field(6);
    times.softirq_us = field(7);
    times.steal_us = field(8);
    return times;
  }
  return std::nullopt;
}

std::vector<Count> interrupts_of(std::string_view interrupts, int processor) {
  return column_of(interrupts, processor, true);
}

std::vector<Count> softirqs_of(std::string_view softirqs, int processor) {
  return column_of(softirqs, processor, false);
}

bool is_timer(const Count& interrupt) { return interrupt.name.starts_with("LOC"); }

std::vector<Count> growth(const std::vector<Count>& before, const std::vector<Count>& after) {
  std::vector<Count> grown;
  for (const Count& now : after) {
    const auto same = std::ranges::find(before, now.name, &Count::name);
    const std::uint64_t then = same == before.end() ? 0 : same->count;
    if (now.count > then) grown.push_back({.name = now.name, .count = now.count - then});
  }
  std::ranges::stable_sort(grown, std::ranges::greater{}, &Count::count);
  return grown;
}

}  // namespace kerf::bench::doctor
