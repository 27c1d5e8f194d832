#include "inspect/inspection_text.h"

#include <cmath>

#include <fmt/core.h>

#include "files/json_number.h"
#include "units/units.h"

namespace kerf::bench {
namespace {

using nlohmann::ordered_json;

ordered_json as_json(const Sampling& sampling) {
  ordered_json gaps = ordered_json::array();
  for (const SamplingGap& gap : sampling.first_gaps) {
    gaps.push_back({{"row", gap.row},
                    {"begin_s", json_number(gap.begin_s)},
                    {"seconds", json_number(gap.seconds)},
                    {"missing_ticks", gap.missing_ticks}});
  }
  const bool stepped = sampling.period_s > 0.0;
  return {{"duration_s", json_number(sampling.duration_s)},
          {"period_s", stepped ? ordered_json(sampling.period_s) : ordered_json(nullptr)},
          {"true_rate_hz", json_number(sampling.true_rate_hz)},
          {"jitter_s", json_number(sampling.jitter_s)},
          {"shortest_step_s", json_number(sampling.shortest_s)},
          {"longest_step_s", json_number(sampling.longest_s)},
          {"resolution_s", json_number(sampling.resolution_s)},
          {"gaps", sampling.gaps},
          {"first_gaps", gaps},
          {"repeated", sampling.repeated},
          {"backward", sampling.backward},
          {"not_finite", sampling.not_finite}};
}

ordered_json as_json(const EndOfRange& end) {
  ordered_json runs = ordered_json::array();
  for (const RowSpan& run : end.first_runs)
    runs.push_back({{"first_row", run.begin}, {"rows", run.end - run.begin}});
  return {{"value", json_number(end.value)},
          {"rows", end.rows},
          {"longest", end.longest},
          {"clipped", end.is_clipped ? ordered_json(*end.is_clipped) : ordered_json(nullptr)},
          {"runs", end.runs},
          {"first_runs", runs}};
}

ordered_json as_json(const std::optional<Drift>& drift) {
  if (!drift) return nullptr;
  return {{"level", json_number(drift->level)},
          {"per_s", json_number(drift->per_s)},
          {"over_all", json_number(drift->over_all)},
          {"scatter", json_number(drift->scatter)},
          {"windows", drift->windows}};
}

ordered_json as_json(const InspectedSignal& signal) {
  const SignalFacts& facts = signal.facts;
  ordered_json outliers = ordered_json::array();
  for (const SingleRow& outlier : facts.largest_outliers)
    outliers.push_back({{"row", outlier.row}, {"value", outlier.value}, {"height", outlier.height}});
  ordered_json json{{"unit", signal.unit},
                    {"not_finite", facts.not_finite},
                    {"quantum", json_number(facts.quantum)},
                    {"noise", json_number(facts.noise)}};
  if (signal.is_force) {
    json["noise_idle"] = json_number(signal.noise_idle);
    json["noise_contact"] = json_number(signal.noise_contact);
    json["drift"] = as_json(signal.drift);
    json["dead_zone"] = facts.rows > 0 ? ordered_json(signal.is_blind_at_zero()) : ordered_json(nullptr);
  }
  json["zeros"] = {
      {"rows", facts.zeros}, {"longest", facts.longest_zeros}, {"nearest", json_number(facts.nearest_zero)}};
  json["least"] = as_json(signal.ends.least);
  json["most"] = as_json(signal.ends.most);
  json["longest_between"] = signal.ends.longest_between;
  if (facts.held_rows) json["held_rows"] = *facts.held_rows;
  json["outliers"] = facts.outliers ? ordered_json(*facts.outliers) : ordered_json(nullptr);
  json["largest_outliers"] = outliers;
  return json;
}

ordered_json as_json(const std::optional<ContactRows>& contact, double felt) {
  if (!contact) return nullptr;
  ordered_json spans = ordered_json::array();
  for (const RowSpan& span : contact->spans)
    spans.push_back({{"first_row", span.begin}, {"rows", span.end - span.begin}});
  return {{"felt", felt}, {"least", contact->least}, {"rows", contact->rows}, {"stretches", spans}};
}

ordered_json as_json(const std::optional<Lag>& lag) {
  if (!lag) return nullptr;
  return {{"seconds", lag->seconds},
          {"correlation", lag->correlation},
          {"correlation_now", lag->correlation_now},
          {"rows", lag->rows}};
}

ordered_json as_json(const std::optional<VelocityMatch>& match) {
  if (!match) return nullptr;
  return {{"gain", match->gain},
          {"offset", match->offset},
          {"lag_s", match->lag_s},
          {"correlation", match->correlation},
          {"correlation_now", match->correlation_now},
          {"ways", match->ways}};
}

ordered_json as_json(const FlaggedCycle& cycle) {
  const CycleFacts& facts = cycle.facts;
  ordered_json flags = ordered_json::array();
  for (const CycleFlag& flag : cycle.flags)
    flags.push_back({{"kind", name_of(flag.fault)}, {"reason", flag.reason}});
  ordered_json farthest;
  if (cycle.farthest)
    farthest = {{"quantity", cycle.farthest->quantity}, {"distance", cycle.farthest->distance}};
  return {{"number", facts.number},
          {"first_row", facts.rows.begin},
          {"rows", facts.rows.end - facts.rows.begin},
          {"begin_s", facts.begin_s},
          {"duration_s", facts.duration_s},
          {"wait_s", facts.wait_s},
          {"closing_s", facts.closing_s},
          {"hold_s", facts.hold_s},
          {"idle_hold_s", facts.idle_hold_s},
          {"opening_s", json_number(facts.opening_s)},
          {"peak", json_number(facts.peak)},
          {"closing_work", json_number(facts.closing_work)},
          {"work", json_number(facts.work)},
          {"clipped_rows", facts.clipped_rows},
          {"gaps", facts.gaps},
          {"farthest", farthest},
          {"good", cycle.is_good()},
          {"accepted", cycle.accepted ? ordered_json(*cycle.accepted) : ordered_json(nullptr)},
          {"flags", flags}};
}

std::string work_unit_of(const Inspection& inspection) {
  return work_unit(inspection.force_unit, inspection.position_unit);
}

ordered_json cycles_as_json(const Inspection& inspection) {
  const InspectedCycles& inspected = inspection.cycles;
  if (inspected.cycles.empty()) return nullptr;
  ordered_json list = ordered_json::array();
  for (const FlaggedCycle& cycle : inspected.cycles) list.push_back(as_json(cycle));
  return {{"stored", inspected.are_stored},
          {"good", good_cycles(inspected.cycles)},
          {"force_unit", inspection.force_unit},
          {"work_unit", work_unit_of(inspection)},
          {"list", list}};
}

std::string number(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? fmt::format("{:.4g}", *value + 0.0) : "-";
}

std::string seconds(const std::optional<double>& value) {
  return value ? fmt::format("{:.2f}", *value) : "-";
}

std::string remarks_on(const FlaggedCycle& cycle) {
  const std::string reasons = reasons_of(cycle);
  return cycle.accepted
             ? fmt::format("{}{}accepted: {}", reasons, reasons.empty() ? "" : "; ", *cycle.accepted)
             : reasons;
}

void add_cycle_lines(const Inspection& inspection, std::vector<std::string>& lines) {
  const InspectedCycles& inspected = inspection.cycles;
  lines.emplace_back();
  if (inspected.cycles.empty()) {
    lines.push_back("cycles      none: " + inspected.why_none);
    return;
  }
  lines.push_back(fmt::format(
      "cycles      {} {}", inspected.cycles.size(),
      inspected.are_stored ? "that are stored in the recording" : "found now; 'kerf segment' stores them"));
  lines.push_back(fmt::format("{:>5}{:>10}{:>8}{:>9}{:>8}{:>9}{:>10}{:>11}  {}", "cycle", "begin s", "wait",
                              "closing", "hold", "opening", "peak " + inspection.force_unit,
                              "work " + work_unit_of(inspection), "flags"));
  for (const FlaggedCycle& cycle : inspected.cycles) {
    const CycleFacts& facts = cycle.facts;
    lines.push_back(fmt::format("{:>5}{:>10.3f}{:>8.2f}{:>9.2f}{:>8.2f}{:>9}{:>10}{:>11}  {}", facts.number,
                                facts.begin_s, facts.wait_s, facts.closing_s, facts.hold_s,
                                seconds(facts.opening_s), number(facts.peak), number(facts.work),
                                remarks_on(cycle)));
  }
}

std::string clipped(const EndsOfRange& ends) {
  const auto word = [](const EndOfRange& end, const char* which) -> std::string {
    if (!end.is_clipped) return fmt::format("{}?", which);
    return *end.is_clipped ? which : "";
  };
  const std::string both = word(ends.least, "low") + word(ends.most, "high");
  return both.empty() ? "no" : both;
}

std::string sampling_line(const Sampling& sampling) {
  std::string line = fmt::format("sampling    {} rows over {:.3f} s", sampling.rows, sampling.duration_s);
  if (!sampling.true_rate_hz) return line;
  line += fmt::format(" at {:.5g} Hz; usual step {:.4g} ms, {:.4g} to {:.4g} ms, jitter {:.3g} ms",
                      *sampling.true_rate_hz, 1e3 * sampling.period_s, 1e3 * *sampling.shortest_s,
                      1e3 * *sampling.longest_s, 1e3 * *sampling.jitter_s);
  if (sampling.resolution_s) line += fmt::format(" (time stamps by {:.3g} ms)", 1e3 * *sampling.resolution_s);
  return line + fmt::format("; {} gaps", sampling.gaps);
}

std::string contact_line(const Inspection& inspection) {
  if (!inspection.contact) return "contact     not known without a force";
  const ContactRows& contact = *inspection.contact;
  const auto rows = static_cast<double>(inspection.sampling.rows);
  return fmt::format(
      "contact     {} rows of {} ({:.1f} %) in {} stretches, by a force beyond {:.3g} {}; the rest "
      "is idle",
      contact.rows, inspection.sampling.rows,
      rows > 0.0 ? 100.0 * static_cast<double>(contact.rows) / rows : 0.0, contact.spans.size(),
      contact.least, inspection.force_unit);
}

std::string lag_line(const std::optional<Lag>& lag) {
  if (!lag) return "lag         not known";
  return fmt::format(
      "lag         the force goes best with the position {:.3g} ms {} (correlation {:.3f}; now {:.3f})",
      1e3 * std::abs(lag->seconds), lag->seconds < 0.0 ? "later" : "before", lag->correlation,
      lag->correlation_now);
}

}  // namespace

ordered_json inspection_as_json(const Inspection& inspection) {
  ordered_json signals = ordered_json::object();
  for (const InspectedSignal& signal : inspection.signals) signals[signal.name] = as_json(signal);
  ordered_json velocities = ordered_json::object();
  for (const InspectedVelocity& velocity : inspection.velocities)
    velocities[velocity.name] = as_json(velocity.match);
  return {{"recording", inspection.recording},
          {"axis", inspection.axis},
          {"rows", inspection.sampling.rows},
          {"sampling", as_json(inspection.sampling)},
          {"signals", signals},
          {"velocities", velocities},
          {"contact", as_json(inspection.contact, inspection.options.felt)},
          {"lag", as_json(inspection.lag)},
          {"cycles", cycles_as_json(inspection)},
          {"warnings", warnings_of(inspection)}};
}

std::vector<std::string> inspection_lines(const Inspection& inspection) {
  std::vector<std::string> lines{sampling_line(inspection.sampling), contact_line(inspection),
                                 lag_line(inspection.lag), ""};
  lines.push_back(fmt::format("{:<20}{:>5}{:>11}{:>11}{:>11}{:>11}{:>9}{:>8}{:>9}{:>11}", "signal", "unit",
                              "least", "most", "quantum", "noise", "zeros", "clipped", "outliers", "drift"));
  for (const InspectedSignal& signal : inspection.signals) {
    const SignalFacts& facts = signal.facts;
    const auto drift = signal.drift ? std::optional(signal.drift->over_all) : std::nullopt;
    const double share =
        facts.rows > 0 ? 100.0 * static_cast<double>(facts.zeros) / static_cast<double>(facts.rows) : 0.0;
    lines.push_back(fmt::format("{:<20}{:>5}{:>11}{:>11}{:>11}{:>11}{:>7.1f} %{:>8}{:>9}{:>11}", signal.name,
                                signal.unit, number(facts.least), number(facts.most), number(facts.quantum),
                                number(facts.noise), share, clipped(signal.ends),
                                facts.outliers ? std::to_string(*facts.outliers) : "-", number(drift)));
  }
  add_cycle_lines(inspection, lines);
  return lines;
}

}  // namespace kerf::bench
