#include "inspect/cycle_facts.h"

#include <algorithm>
#include <limits>
#include <map>

#include <fmt/core.h>

#include "recordings/axis_series.h"
#include "recordings/axis_values.h"
#include "recordings/row_figures.h"

namespace kerf::bench {
namespace {

using Phases = std::map<schema::Phase, RowSpan>;

std::map<std::uint32_t, Phases> phases_by_cycle(const schema::Cycles& cycles, std::uint64_t rows) {
  std::map<std::uint32_t, Phases> all;
  for (const schema::PhaseSpan& phase : cycles.phases) {
    if (phase.begin >= phase.end || phase.end > rows)
      throw schema::FormatError(
          fmt::format("/cycles: a phase of cycle {} has rows {} to {} of {}; run 'kerf segment' again",
                      phase.cycle, phase.begin, phase.end, rows));
    all[phase.cycle][phase.phase] = {.begin = phase.begin, .end = phase.end};
  }
  return all;
}

/// The columns that cycles are told by.
class CycleColumns {
 public:
  CycleColumns(const schema::RecordedRows& rows, const schema::Cycles& cycles, const CycleContext& context)
      : context_(context),
        time_s_(axis_values(rows, schema::Column::time)),
        position_(axis_values(rows, schema::Column::position, cycles.axis)),
        force_(axis_values(rows, force_column(rows), cycles.axis)),
        measured_(force_column(rows) == schema::Column::force_measured),
        closing_{.position = cycles.contact_position, .direction = cycles.closing_direction} {}

  [[nodiscard]] CycleFacts facts(std::uint32_t number, const Phases& phases) const {
    CycleFacts facts{.number = number, .rows = rows_of(phases)};
    facts.begin_s = time_s_[facts.rows.begin];
    facts.duration_s = seconds(facts.rows);
    const auto time_of = [&](schema::Phase phase) {
      const auto found = phases.find(phase);
      return found == phases.end() ? std::optional<double>() : seconds(found->second);
    };
    facts.wait_s = time_of(schema::Phase::open_to_close).value_or(0.0);
    facts.closing_s = time_of(schema::Phase::closing).value_or(0.0);
    facts.hold_s = time_of(schema::Phase::close_to_open).value_or(0.0);
    facts.opening_s = time_of(schema::Phase::opening);
    if (const auto hold = phases.find(schema::Phase::close_to_open); hold != phases.end())
      facts.idle_hold_s = idle_seconds(hold->second);
    const auto closing = phases.find(schema::Phase::closing);
    const std::size_t begin = closing == phases.end() ? facts.rows.begin : closing->second.begin;
    add_rows(facts);
    add_work(facts, begin);
    // What is felt before the closing may be the end of the opening before it.
    facts.peak = force(begin);
    for (std::size_t row = begin; row < facts.rows.end; ++row) facts.peak = std::max(facts.peak, force(row));
    return facts;
  }

 private:
  static RowSpan rows_of(const Phases& phases) {
    RowSpan all{.begin = std::numeric_limits<std::size_t>::max(), .end = 0};
    for (const auto& [phase, span] : phases)
      all = {.begin = std::min(all.begin, span.begin), .end = std::max(all.end, span.end)};
    return all;
  }
  [[nodiscard]] double seconds(RowSpan span) const { return time_s_[span.end - 1] - time_s_[span.begin]; }
  [[nodiscard]] double force(std::size_t row) const { return resisting(force_[row], measured_, closing_); }

  [[nodiscard]] double idle_seconds(RowSpan span) const {
    InSpans in_contact(context_.contact.spans);
    double idle_s = 0.0;
    for (std::size_t row = span.begin + 1; row < span.end; ++row)
      idle_s += in_contact(row) ? 0.0 : time_s_[row] - time_s_[row - 1];
    return idle_s;
  }

  void add_rows(CycleFacts& facts) const {
    for (std::size_t row = facts.rows.begin; row < facts.rows.end; ++row) {
      const double recorded = force_[row];
      facts.clipped_rows += recorded == context_.clipped_low || recorded == context_.clipped_high ? 1 : 0;
      const bool jumps =
          row > facts.rows.begin && time_s_[row] - time_s_[row - 1] > gap_in_periods * context_.period_s;
      facts.gaps += jumps ? 1 : 0;
    }
  }

  void add_work(CycleFacts& facts, std::size_t begin) const {
    double deepest = -std::numeric_limits<double>::infinity();
    for (std::size_t row = begin + 1; row < facts.rows.end; ++row) {
      const double travel = closing_.direction * (position_[row] - position_[row - 1]);
      facts.work += 0.5 * (force(row) + force(row - 1)) * travel;
      if (closing_.direction * position_[row] <= deepest) continue;
      deepest = closing_.direction * position_[row];
      facts.closing_work = facts.work;
    }
  }

  const CycleContext& context_;
  BlockedValues time_s_;
  BlockedValues position_;
  BlockedValues force_;
  bool measured_;
  models::Contact closing_;
};

}  // namespace

std::vector<CycleFacts> cycle_facts(const schema::RecordedRows& rows, const schema::Cycles& cycles,
                                    const CycleContext& context) {
  const CycleColumns columns(rows, cycles, context);
  std::vector<CycleFacts> all;
  for (const auto& [number, phases] : phases_by_cycle(cycles, rows.rows()))
    all.push_back(columns.facts(number, phases));
  return all;
}

}  // namespace kerf::bench
