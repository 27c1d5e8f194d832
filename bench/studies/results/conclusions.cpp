#include "results/conclusions.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <fmt/ranges.h>

#include <kerf/models/law.h>

namespace kerf::bench {
namespace {

using Says = Conclusion::Says;

std::string counted(std::size_t count, const std::string& what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

std::string recordings_and_specimens(const StudyResults& results, const StudiedGroup& group) {
  std::set<std::string> specimens;
  bool all_known = true;
  for (const std::size_t at : group.counted) {
    const std::string& specimen = results.recordings[at].file.specimen;
    all_known = all_known && !specimen.empty();
    specimens.insert(specimen);
  }
  const std::string recordings = counted(group.counted.size(), "recording");
  return all_known ? fmt::format("{} of {}", recordings, counted(specimens.size(), "specimen"))
                   : recordings + " (specimens are not named)";
}

Conclusion drawer_in_words(const StudyResults& results) {
  std::size_t blanks = 0;
  std::size_t failed = 0;
  std::size_t doubted = 0;
  std::size_t taken = 0;
  for (const DrawerRecording& one : results.recordings) {
    if (!one.result.failure.empty()) {
      ++failed;
    } else if (one.file.blank) {
      ++blanks;
    } else if (one.counts()) {
      ++taken;
    } else {
      ++doubted;
    }
  }
  std::string text = fmt::format("Of {} count {}", counted(results.plan.files.size(), "file"), taken);
  const std::size_t ignored = results.plan.files.size() - results.recordings.size();
  const auto add = [&](const char* what, std::size_t count) {
    if (count > 0) text += fmt::format("; {}: {}", what, count);
  };
  add("blanks", blanks);
  add("left out, doubted or not fitted", doubted);
  add("could not be used", failed);
  add("take no part", ignored);
  return {.says = taken == 0             ? Says::no
                  : failed + doubted > 0 ? Says::partly
                                         : Says::yes,
          .sentence = text + "."};
}

/// What was left out of recordings that count.
void add_cycles_left_out(const StudyResults& results, std::vector<Conclusion>& all) {
  if (results.plan.all_cycles) return;
  for (const DrawerRecording& one : results.recordings) {
    std::vector<std::string> reasons;
    for (const StudiedCycle& cycle : one.result.cycles)
      if (!cycle.is_good) reasons.push_back(fmt::format("cycle {}: {}", cycle.number, cycle.reason));
    if (reasons.empty() || !one.counts()) continue;
    all.push_back({.says = Says::partly,
                   .sentence = fmt::format("{}: {} of {} cycles are left out; {}.", one.name, reasons.size(),
                                           one.result.cycles.size(), fmt::join(reasons, "; "))});
  }
}

/// What no law can make good: the sensor.
void add_sensors(const StudyResults& results, std::vector<Conclusion>& all) {
  std::size_t blind = 0;
  double least = 0.0;
  std::string unit;
  for (const DrawerRecording& one : results.recordings) {
    if (!one.result.failure.empty()) continue;
    unit = one.result.force_unit;
    if (std::isfinite(one.result.clipped_at))
      all.push_back(
          {.says = Says::partly,
           .sentence = fmt::format("{}: the sensor is clipped at {:.4g} {} in {}.", one.name,
                                   one.result.clipped_at, unit, counted(one.result.clipped_rows, "row"))});
    if (!std::isfinite(one.result.least_shown)) continue;
    ++blind;
    least = std::max(least, one.result.least_shown);
  }
  if (blind > 0)
    all.push_back(
        {.says = Says::partly,
         .sentence = fmt::format("{} of {} recordings have a dead zone: their force is exactly 0, and "
                                 "what is smaller than {:.3g} {} does not show.",
                                 blind, results.recordings.size(), least, unit)});
}

/// How much of what was measured a blank meets too.
void add_share_of_tool(const StudyResults& results, std::vector<Conclusion>& all) {
  std::vector<std::string> shares;
  for (const DrawerRecording& one : results.recordings)
    if (one.share_of_tool && one.counts())
      shares.push_back(fmt::format("{:.0f} % in {}", 100.0 * *one.share_of_tool, one.name));
  if (shares.empty()) return;
  all.push_back(
      {.says = Says::partly,
       .sentence = fmt::format("Of the peak of a closing the tool alone meets {}: what is fitted there is "
                               "tool and tissue together.",
                               fmt::join(shares, ", "))});
}

std::string blank_in_words(const std::string& name, const StudiedRecording& result) {
  const StudiedBlank& blank = *result.blank;
  const std::string& unit = result.force_unit;
  return fmt::format(
      "{} off {} ({:.3g} of {:.3g} {} rms, from {} cycles that differ by {:.3g} {}; {:.0f} % of the rows are "
      "covered, of which {:.0f} % are below zero then, {:.0f} % before, and {:.1f} % by more than two "
      "spreads)",
      blank.name, name, blank.taken_rms, blank.force_rms, unit, blank.cycles, blank.spread_rms, unit,
      100.0 * static_cast<double>(blank.covered) / static_cast<double>(blank.rows),
      100.0 * blank.negative_after, 100.0 * blank.negative_before, 100.0 * blank.pulling_share);
}

/// Which blank was taken off what, and what nothing was taken off.
void add_blanks(const StudyResults& results, std::vector<Conclusion>& all) {
  std::vector<std::string> taken;
  std::vector<std::string> hardly;
  std::vector<std::string> none;
  for (const DrawerRecording& one : results.recordings) {
    if (!one.result.blank || !one.result.failure.empty()) continue;
    if (one.result.blank->is_taken()) {
      taken.push_back(blank_in_words(one.name, one.result));
      if (one.result.blank->is_hardly_known()) hardly.push_back(one.name);
    } else {
      none.push_back(fmt::format("{} ({})", one.name, one.result.blank->why_none));
    }
  }
  if (!taken.empty())
    all.push_back({.says = hardly.empty() ? Says::yes : Says::partly,
                   .sentence = fmt::format("Blanks were taken off: {}.", fmt::join(taken, "; "))});
  if (!hardly.empty())
    all.push_back({.says = Says::partly,
                   .sentence = fmt::format("What was taken off {} is hardly known: the blank differs from "
                                           "cycle to cycle by more than half of it.",
                                           fmt::join(hardly, ", "))});
  if (!none.empty())
    all.push_back(
        {.says = Says::partly, .sentence = fmt::format("No blank was taken off {}.", fmt::join(none, ", "))});
}

/// What a blade says of six axes, and why nothing is said along one.
void add_blades(const StudyResults& results, std::vector<Conclusion>& all) {
  for (const DrawerRecording& one : results.recordings) {
    if (!one.result.blade) continue;
    const StudiedBlade& blade = *one.result.blade;
    std::string text = one.name + ": ";
    if (!blade.why_none.empty()) {
      text += "no blade is fitted: " + blade.why_none;
    } else {
      std::vector<std::string> parameters;
      for (const StudiedParameter& parameter : blade.parameters)
        parameters.push_back(fmt::format("{} {:.4g} +- {:.2g} {}", parameter.name, parameter.value,
                                         parameter.std_error, parameter.unit));
      text += fmt::format("a blade in six axes has {} (standard errors); it errs by {:.3g} of {:.3g} N rms",
                          fmt::join(parameters, ", "), blade.rmse, blade.rms);
    }
    if (!one.result.not_fitted.empty()) text += ". No other law is: " + one.result.not_fitted;
    all.push_back({.says = blade.why_none.empty() ? Says::partly : Says::unknown, .sentence = text + "."});
  }
}

/// What is blamed most often, without its numbers' sake: the sentence of the recording that errs most.
std::string blame_of(const StudyResults& results, const StudiedGroup& group, const std::string& model) {
  std::string blame;
  double most = 0.0;
  for (const std::size_t at : group.counted) {
    const StudiedRecording& one = results.recordings[at].result;
    for (const StudiedLaw& law : one.laws) {
      if (law.model != model || law.blame.empty() || law.held_out / one.jnd < most) continue;
      most = law.held_out / one.jnd;
      blame = fmt::format("{}: {}", results.recordings[at].name, law.blame);
    }
  }
  return blame;
}

/// The law that serves most recordings of a group; of those, and where none does, the one that errs least.
const LawInGroup* best_of(const StudiedGroup& group) {
  const LawInGroup* best = nullptr;
  for (const LawInGroup& law : group.laws) {
    if (!law.held_out.mean) continue;
    if (best == nullptr || law.serves > best->serves ||
        (law.serves == best->serves && *law.held_out.mean < *best->held_out.mean))
      best = &law;
  }
  return best;
}

Conclusion law_in_words(const StudyResults& results, const StudiedGroup& group) {
  const std::string of = recordings_and_specimens(results, group);
  if (group.counted.empty())
    return {.says = Says::unknown,
            .sentence = fmt::format("{}: which law serves cannot be told; none of its {} counts.",
                                    group.name(), counted(group.left_out, "recording"))};
  const LawInGroup* const best = best_of(group);
  if (best == nullptr)
    return {.says = Says::unknown,
            .sentence = fmt::format("{}: no law could be judged on held-out data ({}).", group.name(), of)};
  if (!group.serving.empty()) {
    const auto law = std::ranges::find(group.laws, group.serving, &LawInGroup::model);
    return {.says = Says::yes,
            .sentence = fmt::format(
                "{}: {} serves, with {}, in each of {}: on held-out cycles it errs by {} JND.", group.name(),
                law->model, counted(law->free_parameters, "parameter"), of, in_words(law->held_out, false))};
  }
  std::string text =
      best->serves == 0
          ? fmt::format("{}: no law serves in any of {}; {} errs least, by {} JND.", group.name(), of,
                        best->model, in_words(best->held_out, false))
          : fmt::format("{}: no law serves in each of {}; {} serves in {}, and errs by {} JND.", group.name(),
                        of, best->model, best->serves, in_words(best->held_out, false));
  const std::string blame = blame_of(results, group, best->model);
  if (!blame.empty()) text += fmt::format(" To blame, {}.", blame);
  return {.says = best->serves > 0 ? Says::partly : Says::no, .sentence = text};
}

std::vector<Conclusion> on_others_in_words(const StudyResults& results) {
  std::vector<Conclusion> sentences;
  std::vector<std::string> alone;
  for (const StudiedGroup& group : results.groups) {
    if (group.counted.size() == 1) alone.push_back(group.name());
    const auto law = std::ranges::find(group.laws, results.law, &LawInGroup::model);
    if (law == group.laws.end() || !law->on_others.mean) continue;
    sentences.push_back(
        {.says = *law->on_others.mean <= 1.0 ? Says::yes : Says::no,
         .sentence = fmt::format("{}: {} fitted to the others errs on what was left out by {} JND ({}).",
                                 group.name(), law->model, in_words(law->on_others, false),
                                 recordings_and_specimens(results, group))});
  }
  if (!alone.empty())
    sentences.push_back(
        {.says = Says::unknown,
         .sentence = fmt::format("How a law does on another recording cannot be told where there is "
                                 "one alone: {}.",
                                 fmt::join(alone, "; "))});
  return sentences;
}

std::string difference_in_words(const StudiedComparison& comparison) {
  const population::Comparison& found = comparison.found;
  if (!found.difference) return "";
  const auto value = [&](double of) { return comparison.is_logarithm ? std::exp(of) : of; };
  const std::string what = comparison.is_logarithm ? "ratio" : "difference";
  const std::string unit = comparison.is_logarithm ? "" : " " + comparison.unit;
  int digits = 3;  // more where an interval would have no width
  const auto shown = [&](double of) { return fmt::format("{:.{}g}", value(of), digits); };
  while (found.interval && digits < 9 && shown(found.interval->lower) == shown(found.interval->upper))
    ++digits;
  std::string text = fmt::format("{} {}{}", what, shown(*found.difference), unit);
  if (found.interval)
    text += fmt::format(", 95 % {} to {}", shown(found.interval->lower), shown(found.interval->upper));
  return text;
}

Conclusion comparison_in_words(const StudiedComparison& comparison) {
  const population::Comparison& found = comparison.found;
  const std::string units = found.is_crossed
                                ? fmt::format("{} specimens in both", found.first_units)
                                : fmt::format("n = {} and {}", found.first_units, found.second_units);
  std::string text = fmt::format("{} of {} and {}: {} ({}", comparison.quantity, comparison.first,
                                 comparison.second, population::name_of(found.verdict), units);
  if (const std::string difference = difference_in_words(comparison); !difference.empty())
    text += "; " + difference;
  if (found.test) text += fmt::format("; p by Holm {:.2g}", found.holm_p);
  return {.says = found.verdict == population::Verdict::differ           ? Says::yes
                  : found.verdict == population::Verdict::not_told_apart ? Says::partly
                                                                         : Says::unknown,
          .sentence = text + ")."};
}

/// Those that cannot be told, in one sentence; the table has each.
void add_comparisons(const StudyResults& results, std::vector<Conclusion>& all) {
  std::size_t untold = 0;
  for (const StudiedComparison& comparison : results.comparisons) {
    if (comparison.found.verdict == population::Verdict::cannot_be_told) {
      ++untold;
    } else {
      all.push_back(comparison_in_words(comparison));
    }
  }
  if (untold > 0)
    all.push_back(
        {.says = Says::unknown,
         .sentence = fmt::format("{} of {} comparisons cannot be told: no data of so few specimens or "
                                 "recordings could have told them apart, with as many comparisons.",
                                 untold, results.comparisons.size())});
}

}  // namespace

std::vector<Conclusion> conclusions_of(const StudyResults& results) {
  std::vector<Conclusion> all{drawer_in_words(results)};
  for (const DrawerRecording& one : results.recordings) {
    for (const std::string& doubt : one.doubts) {
      all.push_back({.says = one.file.accepted.empty() ? Says::no : Says::partly,
                     .sentence = fmt::format("{}: {}; it {}.", one.file.path, doubt,
                                             one.file.accepted.empty() ? std::string("is left out")
                                                                       : "counts: " + one.file.accepted)});
    }
  }
  add_cycles_left_out(results, all);
  add_sensors(results, all);
  add_blanks(results, all);
  add_share_of_tool(results, all);
  add_blades(results, all);
  for (const StudiedGroup& group : results.groups) all.push_back(law_in_words(results, group));
  for (Conclusion& one : on_others_in_words(results)) all.push_back(std::move(one));
  for (const std::string& model : results.plan.laws) {
    // Points of tables lie where each recording has been; nobody expects them to be those of another.
    const bool is_table = models::law_facts(model).search == models::Search::tables;
    const bool is_asked = std::ranges::any_of(
        results.plan.compare, [&](const std::string& what) { return what.starts_with(model + "."); });
    if (is_table && !is_asked) continue;
    if (std::string why = why_not_of_one_quantity(results, model); !why.empty())
      all.push_back({.says = Says::unknown, .sentence = std::move(why) + "."});
  }
  add_comparisons(results, all);
  return all;
}

}  // namespace kerf::bench
