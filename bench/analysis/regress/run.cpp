#include "regress/run.h"

#include <algorithm>
#include <chrono>
#include <new>
#include <set>
#include <stdexcept>

#include <fmt/core.h>

#include "recordings/provenance.h"
#include "regress/inputs.h"
#include "regress/renderers/child_program.h"
#include "regress/renderers/made_with.h"
#include "regress/renderers/step_cost.h"
#include "regress/stored/stored_suite.h"
#include "regress/stored/summary.h"
#include "threads/for_each_index.h"

namespace kerf::bench {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

const schema::StoredForces* find(const std::vector<schema::StoredForces>& all, const std::string& name) {
  const auto found = std::ranges::find(all, name, &schema::StoredForces::name);
  return found == all.end() ? nullptr : &*found;
}

/// @throws std::invalid_argument if its stored forces cannot be read.
void require_readable(const StoredSuite& stored, const std::string& name) {
  const auto error = stored.errors.find(name);
  if (error != stored.errors.end()) throw std::invalid_argument(error->second);
}

/// Stored forces without a case in the suite.
std::vector<std::string> dropped_from(const Suite& suite, const std::vector<schema::StoredForces>& stored) {
  std::vector<std::string> dropped;
  for (const schema::StoredForces& one : stored) {
    if (!std::ranges::count(suite.cases, one.name, &RegressionCase::name)) dropped.push_back(one.name);
  }
  return dropped;
}

RenderedForces rendered(const RegressionCase& one, const SampledMotion& path) {
  return one.outside ? render_forces(*one.outside, path) : render_forces(one.law, path);
}

/// What is another program, version or plug-in than it was, as the end of a sentence.
std::string programs_changed(const RegressionOutcome& outcome) {
  const std::string words = made_otherwise(outcome.stored.made_with, outcome.made_with);
  return words.empty() ? "" : ": " + words;
}

std::string why_different(const RegressionOutcome& outcome) {
  const bool law = checksum(outcome.about) != outcome.stored.law_sha256;
  const bool trajectory =
      checksum(outcome.path, outcome.got.channels.size()) != outcome.stored.trajectory_sha256;
  const std::string since =
      fmt::format("since {} ({}: {})", outcome.stored.date, outcome.stored.software, outcome.stored.reason);
  const char* const what = outcome.about.outside ? "renderer (its command, program or axes)" : "law file";
  const std::string programs = programs_changed(outcome);
  if (law && trajectory)
    return fmt::format("the {} and the trajectory have changed {}{}", what, since, programs);
  if (law) return fmt::format("the {} has changed {}{}", what, since, programs);
  if (trajectory) return fmt::format("the trajectory has changed {}{}", since, programs);
  if (!programs.empty()) return fmt::format("what renders has changed {}{}", since, programs);
  if (outcome.about.outside)
    return fmt::format("command, program and trajectory are as they were; what they rest on has changed {}",
                       since);
  return fmt::format("law file and trajectory are as they were; the code or the compiler has changed {}",
                     since);
}

void judge_cost(RegressionOutcome& outcome) {
  if (!outcome.about.tick_cost || !outcome.tick_cost) return;
  if (!outcome.stored.tick_cost) {
    outcome.note = "no tick cost is stored; 'kerf regress update' stores one";
  } else if (outcome.stored.tick_cost_build != build_kind()) {
    outcome.note = fmt::format("tick cost not compared: stored by a build that was {}, and this one is {}",
                               outcome.stored.tick_cost_build, build_kind());
  } else if (*outcome.tick_cost > *outcome.about.tick_cost * *outcome.stored.tick_cost) {
    outcome.messages.push_back(fmt::format(
        "a tick costs {:.3g} rounds of the calibration loop where {:.3g} are stored: {:.2g} times "
        "as much, and {:g} times is allowed",
        *outcome.tick_cost, *outcome.stored.tick_cost, *outcome.tick_cost / *outcome.stored.tick_cost,
        *outcome.about.tick_cost));
  }
}

/// What has changed though the forces have not: a trajectory that a law does not feel is soon forgotten.
void note_silent_change(RegressionOutcome& outcome) {
  if (!outcome.passed()) return;
  const bool trajectory =
      checksum(outcome.path, outcome.got.channels.size()) != outcome.stored.trajectory_sha256;
  if (!trajectory && checksum(outcome.about) == outcome.stored.law_sha256 &&
      programs_changed(outcome).empty())
    return;
  outcome.note +=
      (outcome.note.empty() ? "" : "; ") + outcome.why + ", and the forces are within the tolerance";
}

/// Calls work(i) for every case: those whose cost is measured one by one, so that none disturbs another.
template <typename Work>
void for_each_case(const std::vector<RegressionCase>& cases, const SuiteOptions& options, const Work& work) {
  const auto timed = [&](std::size_t i) { return options.tick_costs && cases[i].tick_cost.has_value(); };
  for_each_index(cases.size(), std::max<std::size_t>(options.jobs, 1), [&](std::size_t i) {
    if (!timed(i)) work(i);
  });
  for (std::size_t i = 0; i < cases.size(); ++i) {
    if (timed(i)) work(i);
  }
}

struct CaseError {
  std::string line;
  std::string said{};  ///< by its renderer
};

/// What is wrong with a case, if work() cannot be done; empty if it was done.
template <typename Work>
CaseError error_of(const RegressionCase& one, const Work& work) {
  if (!one.error.empty()) return {one.error};
  try {
    work();
    return {};
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const RendererError& error) {
    return {error.what(), error.said()};
  } catch (const std::exception& error) {
    return {error.what()};
  }
}

RegressionOutcome run_case(const RegressionCase& one, const schema::StoredForces& stored, bool tick_costs,
                           AskedVersions& versions) {
  RegressionOutcome outcome{.about = one, .path = path_of(one), .stored = stored};
  outcome.got = rendered(one, outcome.path);
  outcome.comparison = compare_forces(stored, outcome.got, one.tolerance, outcome.path.period_s.back());
  outcome.messages = outcome.comparison.messages;
  const compare::Facts facts{
      .law_changed = checksum(one) != stored.law_sha256,
      .trajectory_changed = checksum(outcome.path, outcome.got.channels.size()) != stored.trajectory_sha256};
  if (!outcome.comparison.passed) {
    outcome.diagnosis = diagnose(stored, outcome.got, outcome.path, facts);
    for (std::string& line : sentences_of(outcome.diagnosis, stored))
      outcome.messages.push_back(std::move(line));
  }
  outcome.made_with = made_with(one, versions);
  outcome.why = why_different(outcome);
  if (one.outside) {
    for (std::string& line : judge_step_cost(*one.outside, stored, outcome.got))
      outcome.messages.push_back(std::move(line));
  }
  if (tick_costs && one.tick_cost) outcome.tick_cost = tick_cost(one.law, outcome.path);
  judge_cost(outcome);
  note_silent_change(outcome);
  return outcome;
}

RegressionOutcome case_left_out(const RegressionCase& one, const schema::StoredForces& stored) {
  return {
      .about = one,
      .stored = stored,
      .why = fmt::format("what it follows from is as it was when its forces were stored on {}", stored.date),
      .left_out = true};
}

std::string how_different(const ForceComparison& comparison) {
  if (comparison.expected_rows != comparison.got_rows)
    return fmt::format("{} samples instead of {}", comparison.got_rows, comparison.expected_rows);
  if (comparison.channels.empty()) return "other channels";
  if (comparison.differing == 0) return "the same forces, bit for bit";
  const ChannelComparison* const most = farthest_channel(comparison);
  return fmt::format("{} of {} ticks differ, {} by up to {:.3g} {} ({:.3g} JND)", comparison.differing,
                     comparison.expected_rows, most->channel.name, most->largest_difference,
                     most->channel.unit, most->largest_jnds);
}

/// A case as it is now, measured anew.
schema::StoredForces stored_now(const RegressionCase& one, const SampledMotion& path,
                                const RenderedForces& got, std::optional<double> cost,
                                const std::string& made) {
  schema::StoredForces now{.name = one.name,
                           .model = one.outside ? "" : std::string(one.law.law.model()),
                           .renderer = one.outside ? called(*one.outside) : "",
                           .law_sha256 = checksum(one),
                           .trajectory_sha256 = checksum(path, got.channels.size()),
                           .channels = got.channels,
                           .force = got.force,
                           .trajectory = stored_trajectory(one, path),
                           .faults = got.faults,
                           .tick_cost = cost,
                           .compute_time_s = got.compute_time_s,
                           .compute_time_of = got.compute_time_of,
                           .made_with = made};
  if (cost) now.tick_cost_build = build_kind();
  return now;
}

StoredChange change_of(const RegressionCase& one, const schema::StoredForces* before, bool tick_costs,
                       AskedVersions& versions) {
  if (before == nullptr) {
    const SampledMotion path = path_of(one);
    const RenderedForces got = rendered(one, path);
    std::optional<double> cost;
    if (tick_costs && one.tick_cost) cost = tick_cost(one.law, path);
    return {.name = one.name,
            .kind = ChangeKind::added,
            .what = fmt::format("{} ticks of {} channel{}", got.rows(), got.channels.size(),
                                got.channels.size() == 1 ? "" : "s"),
            .why = "nothing is stored for it yet",
            .now = stored_now(one, path, got, cost, made_with(one, versions))};
  }
  const RegressionOutcome outcome = run_case(one, *before, tick_costs, versions);
  StoredChange change{.name = one.name, .kind = ChangeKind::unchanged, .now = *before};
  change.what = how_different(outcome.comparison);
  const bool same_source = checksum(one) == before->law_sha256 &&
                           checksum(outcome.path, outcome.got.channels.size()) == before->trajectory_sha256;
  const bool no_cost_yet = (outcome.tick_cost && !before->tick_cost) ||
                           (one.outside && one.outside->compute_times && before->compute_time_s.empty() &&
                            !outcome.got.compute_time_s.empty());
  if (outcome.passed() && same_source && !no_cost_yet) {
    if (outcome.comparison.differing > 0) change.what += ", within the tolerance: it stays as it is";
    if (before->trajectory.empty()) change.now.trajectory = stored_trajectory(one, outcome.path);
    change.completes = before->trajectory.empty() && !change.now.trajectory.empty();
    return change;
  }
  change.kind = ChangeKind::changed;
  change.outcome = outcome;
  change.why = outcome.why;
  if (outcome.comparison.passed && !outcome.messages.empty()) change.what = outcome.messages.back();
  if (outcome.passed() && same_source) change.what = "the cost of a tick is added";
  std::optional<double> cost = outcome.tick_cost;
  if (!cost && one.tick_cost) cost = before->tick_cost;
  change.now = stored_now(one, outcome.path, outcome.got, cost, outcome.made_with);
  change.now.history = before->history;
  if (!change.now.history.empty() && !change.now.history.ends_with('\n')) change.now.history += '\n';
  change.now.history += fmt::format("{} {}: {}\n", before->date, before->software, before->reason);
  return change;
}

}  // namespace

std::size_t SuiteOutcome::errors() const noexcept {
  return static_cast<std::size_t>(
      std::ranges::count_if(cases, [](const RegressionOutcome& one) { return !one.error.empty(); }));
}

std::size_t SuiteOutcome::left_out() const noexcept {
  return static_cast<std::size_t>(std::ranges::count(cases, true, &RegressionOutcome::left_out));
}

std::size_t SuiteOutcome::failed() const noexcept {
  return dropped.size() + static_cast<std::size_t>(std::ranges::count_if(
                              cases, [](const RegressionOutcome& one) { return !one.passed(); }));
}

SuiteOutcome run_suite(const Suite& suite, const SuiteOptions& options) {
  const auto begin = Clock::now();
  const Suite chosen = only(suite, options.only);
  StoredSuite stored;
  SummaryCheck summary;
  std::string unreadable;
  try {
    stored = read_stored(suite);
    summary = check_summary(suite, stored.cases);
  } catch (const schema::FormatError& error) {
    unreadable = error.what();
  } catch (const std::invalid_argument& error) {
    unreadable = error.what();
  }
  stored.errors.merge(summary.wrong);
  SuiteOutcome outcome{.cases = {}, .dropped = {}, .notes = summary.notes};
  outcome.cases.resize(chosen.cases.size());
  AskedVersions versions;
  for_each_case(chosen.cases, options, [&](std::size_t i) {
    const auto case_begin = Clock::now();
    const RegressionCase& one = chosen.cases[i];
    RegressionOutcome& result = outcome.cases[i];
    const CaseError error = error_of(one, [&] {
      if (!unreadable.empty()) throw std::invalid_argument(unreadable);
      require_readable(stored, one.name);
      const schema::StoredForces* const before = find(stored.cases, one.name);
      if (before == nullptr) {
        throw std::invalid_argument(fmt::format(
            "{}: no forces are stored for case '{}'; 'kerf regress update {} --reason WHY' stores them",
            suite.stored.string(), one.name, suite.file.string()));
      }
      result = options.changed && changed_since(inputs_of(one, versions), *before).empty()
                   ? case_left_out(one, *before)
                   : run_case(one, *before, options.tick_costs, versions);
    });
    if (!error.line.empty()) result = {.about = one, .error = error.line, .said = error.said};
    result.seconds = seconds_since(case_begin);
  });
  if (options.only.empty()) outcome.dropped = dropped_from(suite, stored.cases);
  outcome.seconds = seconds_since(begin);
  return outcome;
}

std::vector<StoredChange> plan_update(const Suite& suite, const SuiteOptions& options) {
  const StoredSuite stored = read_stored(suite);
  const Suite chosen = only(suite, options.only);
  std::vector<StoredChange> changes(suite.cases.size());
  AskedVersions versions;
  for_each_case(suite.cases, options, [&](std::size_t i) {
    const RegressionCase& one = suite.cases[i];
    const schema::StoredForces* before = find(stored.cases, one.name);
    changes[i] = {.name = one.name, .asked = false};
    if (before != nullptr) changes[i].now = *before;
    if (std::ranges::count(chosen.cases, one.name, &RegressionCase::name) == 0) return;
    const CaseError error = error_of(one, [&] {
      require_readable(stored, one.name);
      changes[i] = change_of(one, before, options.tick_costs, versions);
    });
    if (error.line.empty()) return;
    changes[i].asked = true;
    changes[i].kind = ChangeKind::impossible;
    changes[i].what = error.line;
  });
  std::erase_if(changes, [](const StoredChange& one) { return !one.asked && one.now.channels.empty(); });
  for (const std::string& name : dropped_from(suite, stored.cases)) {
    const bool asked = options.only.empty();
    changes.push_back({.name = name,
                       .kind = asked ? ChangeKind::removed : ChangeKind::unchanged,
                       .what = "its forces are removed",
                       .why = "the suite has no such case any more",
                       .asked = asked,
                       .now = *find(stored.cases, name)});
  }
  return changes;
}

SuiteOutcome what_changes(const std::vector<StoredChange>& changes) {
  SuiteOutcome all;
  for (const StoredChange& change : changes) {
    if (change.outcome) all.cases.push_back(*change.outcome);
    if (change.kind == ChangeKind::removed) all.dropped.push_back(change.name);
    if (change.kind == ChangeKind::impossible)
      all.cases.push_back({.about = {.name = change.name}, .error = change.what});
  }
  return all;
}

bool changes_anything(const std::vector<StoredChange>& changes) noexcept {
  return std::ranges::any_of(changes, [](const StoredChange& one) {
    return one.kind != ChangeKind::unchanged && one.kind != ChangeKind::impossible;
  });
}

std::string completes_anything(const Suite& suite, const std::vector<StoredChange>& changes) {
  std::vector<schema::StoredForces> all;
  for (const StoredChange& change : changes) {
    if (change.completes) return "trajectories of recordings are stored besides";
    if (!change.now.channels.empty()) all.push_back(change.now);
  }
  return what_is_missing(suite, all);
}

void write_update(const Suite& suite, const std::vector<StoredChange>& changes, const std::string& reason) {
  if (reason.find_first_not_of(" \t\r\n") == std::string::npos)
    throw std::invalid_argument("say why the forces change: --reason WHY");
  std::string line = reason;
  std::ranges::replace(line, '\n', ' ');
  const std::string date = schema::new_header("").created;
  std::vector<schema::StoredForces> all;
  std::vector<std::string> gone;
  for (const StoredChange& change : changes) {
    if (change.kind == ChangeKind::removed) gone.push_back(change.name);
    if (change.kind == ChangeKind::removed || change.now.channels.empty()) continue;
    all.push_back(change.now);
    if (change.kind == ChangeKind::unchanged || change.kind == ChangeKind::impossible) continue;
    all.back().reason = line;
    all.back().date = date;
    all.back().software = software();
  }
  write_stored(suite, all, gone);
}

}  // namespace kerf::bench
