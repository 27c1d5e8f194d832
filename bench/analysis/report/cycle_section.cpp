#include "report/cycle_section.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <vector>

#include <fmt/core.h>

#include <kerf/fitting/jnd.h>
#include <kerf/schema/recording_file.h>

#include "html/html.h"
#include "inspect/flagged_cycles.h"
#include "report/charts.h"
#include "units/units.h"

namespace kerf::bench {
namespace {

using CellRow = std::vector<std::string>;

constexpr std::size_t cycles_in_full = 40;  ///< of more the page lists those of which something is said

/// A cycle, and what is said of it.
struct CycleRemarks {
  CycleFacts facts;
  std::string faults;   ///< "put_down, clipped"
  std::string reasons;  ///< with what a person said
  bool good = true;
};

void add_to_list(std::string& list, const char* between, const std::string& one) {
  list += (list.empty() ? "" : between) + one;
}

/// As the recording keeps it.
void take_stored(CycleRemarks& cycle, const schema::CycleFlags& stored) {
  bool taken_anyway = false;
  for (const schema::CycleFlag& flag : stored.flags) {
    if (flag.cycle != cycle.facts.number) continue;
    taken_anyway = taken_anyway || flag.fault == "accepted";
    add_to_list(cycle.faults, ", ", flag.fault);
    add_to_list(cycle.reasons, "; ", flag.fault == "accepted" ? "accepted: " + flag.reason : flag.reason);
  }
  cycle.good = cycle.faults.empty() || taken_anyway;
}

std::vector<CycleRemarks> remarks_on_cycles(const schema::RecordedRows& rows, std::size_t axis) {
  const schema::Recording& about = rows.about();
  const auto& stored = about.cycle_flags;
  const double felt =
      stored ? stored->felt : fitting::jnd_of(about.axes[axis].force_unit, about.axes[axis].lever).threshold;
  std::vector<CycleRemarks> all;
  for (const FlaggedCycle& found : flagged_cycles(rows, *about.cycles, felt)) {
    CycleRemarks& cycle = all.emplace_back(CycleRemarks{.facts = found.facts});
    if (stored) {
      take_stored(cycle, *stored);
      continue;
    }
    for (const CycleFlag& flag : found.flags)
      add_to_list(cycle.faults, ", ", std::string(name_of(flag.fault)));
    cycle.reasons = reasons_of(found);
    cycle.good = found.is_good();
  }
  return all;
}

CellRow cells_of(const CycleRemarks& cycle) {
  const CycleFacts& facts = cycle.facts;
  const auto number = [](double value) { return fmt::format("{:.4g}", value); };
  return {fmt::format("{}", facts.number),
          fmt::format("{:.2f}", facts.begin_s),
          number(facts.closing_s),
          number(facts.hold_s),
          facts.opening_s ? number(*facts.opening_s) : "-",
          number(facts.peak),
          number(facts.closing_work),
          cycle.good ? "yes" : "no",
          cycle.faults,
          cycle.reasons};
}

std::string cycle_tables(const std::vector<CycleRemarks>& cycles, const schema::Axis& axis) {
  const CellRow head{"cycle",
                     "begin [s]",
                     "closing [s]",
                     "hold [s]",
                     "opening [s]",
                     fmt::format("peak [{}]", axis.force_unit),
                     fmt::format("closing work [{}]", work_unit(axis.force_unit, axis.position_unit)),
                     "counts",
                     "flags",
                     "why"};
  std::vector<CellRow> all{head};
  std::vector<CellRow> remarked{head};
  for (const CycleRemarks& cycle : cycles) {
    all.push_back(cells_of(cycle));
    if (!cycle.faults.empty()) remarked.push_back(all.back());
  }
  if (cycles.size() <= cycles_in_full) return html_table(all);
  return (remarked.size() > 1 ? html_table(remarked) : std::string()) +
         fmt::format("<details><summary>All {} cycles</summary>\n", cycles.size()) + html_table(all) +
         "</details>\n";
}

/// The force, with flagged cycles that follow each other as one band with their numbers above.
Chart flagged_chart(const std::vector<CycleRemarks>& cycles, const schema::RecordedRows& rows,
                    std::size_t axis) {
  Chart chart = force_chart(rows.about(), rows, axis);
  chart.title = "Force over time, cycles that do not count in red";
  double highest = -std::numeric_limits<double>::infinity();
  for (const Curve& curve : chart.curves) {
    for (const double y : curve.y) highest = std::max(highest, y);
  }
  for (std::size_t i = 0; i < cycles.size();) {
    const std::size_t first = i++;
    if (cycles[first].good) continue;
    while (i < cycles.size() && !cycles[i].good) ++i;
    const CycleFacts& begin = cycles[first].facts;
    const CycleFacts& last = cycles[i - 1].facts;
    chart.bands.push_back(
        {.begin = begin.begin_s, .end = last.begin_s + last.duration_s, .colour = Colour::vermillion});
    chart.labels.push_back({.x = begin.begin_s,
                            .y = highest,
                            .text = begin.number == last.number
                                        ? fmt::format("{}", begin.number)
                                        : fmt::format("{} to {}", begin.number, last.number)});
  }
  if (chart.labels.size() > cycles_in_full) chart.labels.clear();  // one over the other
  return chart;
}

std::string who_said_so(const std::optional<schema::CycleFlags>& stored, const std::string& force_unit) {
  if (!stored)
    return "The recording keeps no flags; these are found now, and <code>kerf inspect --store</code> keeps "
           "them.";
  return escaped(fmt::format("Flags as the recording keeps them, of {} by {}; in contact beyond {:.3g} {}.",
                             stored->created, stored->software, stored->felt, force_unit));
}

CycleCount count_of(const std::vector<CycleRemarks>& cycles) {
  return {.good = static_cast<std::size_t>(std::ranges::count_if(cycles, &CycleRemarks::good)),
          .all = cycles.size()};
}

bool has_cycles(const schema::RecordedRows& rows, std::size_t axis) {
  const auto& cycles = rows.about().cycles;
  return cycles && cycles->axis == axis && !cycles->phases.empty() &&
         rows.width(schema::Column::force_measured) + rows.width(schema::Column::force_commanded) > 0;
}

std::string section_of_cycles(const schema::RecordedRows& rows, std::size_t axis) {
  const schema::Recording& about = rows.about();
  const std::vector<CycleRemarks> cycles = remarks_on_cycles(rows, axis);
  const std::size_t good = count_of(cycles).good;
  const std::string& force_unit = about.axes[axis].force_unit;
  std::string html = fmt::format("<p>{} of {} cycles count: laws are fitted to and judged by them.</p>\n",
                                 good, cycles.size());
  html += "<p class=\"soft\">" + who_said_so(about.cycle_flags, force_unit) + "</p>\n";
  if (good < cycles.size()) html += html_figure(draw(flagged_chart(cycles, rows, axis)));
  return html + cycle_tables(cycles, about.axes[axis]);
}

}  // namespace

std::optional<CycleCount> count_cycles(const schema::RecordedRows& rows, std::size_t axis) {
  if (!has_cycles(rows, axis)) return std::nullopt;
  try {
    return count_of(remarks_on_cycles(rows, axis));
  } catch (const schema::FormatError&) {
    return std::nullopt;
  }
}

std::string cycle_section(const schema::RecordedRows& rows, std::size_t axis) {
  if (!has_cycles(rows, axis)) return "";
  const std::string heading = "<h2>Cycles</h2>\n";
  try {
    return heading + section_of_cycles(rows, axis);
  } catch (const schema::FormatError& error) {  // phases of rows that are not there
    return heading + "<p class=\"soft\">" + escaped(error.what()) + "</p>\n";
  }
}

}  // namespace kerf::bench
