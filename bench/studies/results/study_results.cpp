#include "results/study_results.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include <boost/math/statistics/univariate_statistics.hpp>
#include <fmt/ranges.h>

#include <kerf/models/law.h>
#include <kerf/population/held_out.h>

#include "results/conclusions.h"
#include "units/units.h"

namespace kerf::bench {
namespace {

using population::Estimate;
using population::GroupEstimate;

std::optional<std::string> specimen_of(const DrawerRecording& recording) {
  return recording.file.specimen.empty() ? std::nullopt : std::optional(recording.file.specimen);
}

const StudiedLaw* law_of(const DrawerRecording& recording, const std::string& model) {
  for (const StudiedLaw& law : recording.result.laws)
    if (law.model == model) return &law;
  return nullptr;
}

/// Mean over the good cycles, with its standard error where there are two.
std::optional<Estimate> over_cycles(const DrawerRecording& recording, double StudiedCycle::*quantity,
                                    bool all_cycles) {
  const std::vector<double> values = of_cycles(recording.result, quantity, all_cycles);
  if (values.empty()) return std::nullopt;
  Estimate estimate{.value = values.front(), .standard_error = {}, .specimen = specimen_of(recording)};
  if (values.size() > 1) {
    const auto [mean, variance] = boost::math::statistics::mean_and_sample_variance(values);
    estimate.value = mean;
    estimate.standard_error = std::sqrt(variance / static_cast<double>(values.size()));
  }
  return estimate;
}

const StudiedBlank* blank_of(const StudyResults& results, const std::string& recording) {
  const auto found = std::ranges::find(results.recordings, recording, &DrawerRecording::name);
  const auto& blank = found->result.blank;
  return blank && blank->is_taken() ? &*blank : nullptr;
}

std::vector<double> values_of(const StudiedQuantity& quantity) {
  std::vector<double> values;
  for (const Estimate& one : quantity.values) values.push_back(one.value);
  return values;
}

/// The values of a quantity with each part of a blank left out of what was taken off its recordings.
population::Shared without_parts_of(const std::string& name, const StudyResults& results,
                                    const StudiedQuantity& quantity) {
  population::Shared shared;
  for (std::size_t i = 0; i < quantity.recordings.size(); ++i) {
    const StudiedBlank* const blank = blank_of(results, quantity.recordings[i]);
    if (blank == nullptr || blank->name != name) continue;
    shared.without.resize(std::max(shared.without.size(), blank->without.size()), values_of(quantity));
    for (std::size_t part = 0; part < shared.without.size(); ++part) {
      constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
      double value = unknown;
      if (part < blank->without.size()) {
        const auto found = blank->without[part].find(quantity.name);
        if (found != blank->without[part].end()) value = found->second;
      }
      shared.without[part][i] = quantity.is_logarithm ? (value > 0.0 ? std::log(value) : unknown) : value;
    }
  }
  return shared;
}

void add_blanks(const StudyResults& results, StudiedQuantity& quantity) {
  std::set<std::string> names;
  for (const std::string& recording : quantity.recordings)
    if (const StudiedBlank* const blank = blank_of(results, recording)) names.insert(blank->name);
  for (const std::string& name : names)
    quantity.blanks.push_back({.name = name, .values = without_parts_of(name, results, quantity)});
}

/// As a logarithm if all values are positive, and are so by nature.
void settle(const StudyResults& results, StudiedQuantity& quantity, bool positive_by_nature) {
  quantity.is_logarithm = positive_by_nature && std::ranges::all_of(quantity.values, [](const Estimate& one) {
                            return one.value > 0.0;
                          });
  if (quantity.is_logarithm)
    std::ranges::transform(quantity.values, quantity.values.begin(), population::log_of);
  add_blanks(results, quantity);
  std::vector<population::Shared> shared;
  for (const SharedBlank& blank : quantity.blanks) shared.push_back(blank.values);
  quantity.estimate = population::estimate_group(quantity.values, {.shared = shared});
}

StudiedQuantity cycle_quantity(const StudyResults& results, const StudiedGroup& group,
                               const std::string& name, const std::string& unit,
                               double StudiedCycle::*quantity) {
  StudiedQuantity found{.name = name, .unit = unit, .recordings = {}, .values = {}, .estimate = {}};
  for (const std::size_t at : group.counted) {
    const DrawerRecording& recording = results.recordings[at];
    const auto value = over_cycles(recording, quantity, results.plan.all_cycles);
    if (!value) continue;
    found.recordings.push_back(recording.name);
    found.values.push_back(*value);
  }
  settle(results, found, true);
  return found;
}

/// Every parameter of a law, in the order of the first recording that has it.
std::vector<StudiedQuantity> parameters_in_group(const StudyResults& results, const StudiedGroup& group,
                                                 const std::string& model) {
  if (!why_not_of_one_quantity(results, model).empty()) return {};
  std::vector<StudiedQuantity> found;
  std::vector<bool> positive;
  for (const std::size_t at : group.counted) {
    const DrawerRecording& recording = results.recordings[at];
    const StudiedLaw* const law = law_of(recording, model);
    if (law == nullptr || !law->can_be_chosen) continue;
    for (const StudiedParameter& parameter : law->parameters) {
      const std::string name = model + "." + parameter.name;
      auto place = std::ranges::find(found, name, &StudiedQuantity::name);
      if (place == found.end()) {
        found.push_back(
            {.name = name, .unit = parameter.unit, .recordings = {}, .values = {}, .estimate = {}});
        positive.push_back(parameter.is_positive);
        place = std::prev(found.end());
      }
      place->recordings.push_back(recording.name);
      place->values.push_back({.value = parameter.value,
                               .standard_error = parameter.std_error,
                               .specimen = specimen_of(recording)});
    }
  }
  for (std::size_t i = 0; i < found.size(); ++i) settle(results, found[i], positive[i]);
  return found;
}

LawInGroup law_in_group(const StudyResults& results, const StudiedGroup& group, const std::string& model) {
  LawInGroup found{.model = model, .held_out = {}, .on_others = {}};
  std::vector<population::HeldOutError> own;
  for (const std::size_t at : group.counted) {
    const DrawerRecording& recording = results.recordings[at];
    const StudiedLaw* const law = law_of(recording, model);
    if (law == nullptr) continue;
    found.free_parameters = std::max(found.free_parameters, law->free_parameters);
    if (law->within_jnd) ++found.serves;
    own.push_back({.recording = recording.name,
                   .specimen = specimen_of(recording),
                   .error = law->held_out / recording.result.jnd});
  }
  std::vector<population::HeldOutError> others;
  for (const ErrorOnOthers& error : group.on_others) {
    if (error.law != model) continue;
    const auto recording = std::ranges::find(results.recordings, error.recording, &DrawerRecording::name);
    others.push_back(
        {.recording = error.recording, .specimen = specimen_of(*recording), .error = error.error_jnd});
  }
  found.held_out = population::summarise(own);
  found.on_others = population::summarise(others);
  return found;
}

/// In the order of `kerf laws`, so that of laws that serve alike the first there is taken, as by a fit.
std::vector<std::string> as_listed(std::vector<std::string> models) {
  std::ranges::stable_sort(models, {}, models::place_in_registry);
  return models;
}

/// The simplest of those that serve every recording that counts.
std::string serving_all(const StudyResults& results, const StudiedGroup& group) {
  const LawInGroup* simplest = nullptr;
  for (const std::string& model : as_listed(results.plan.laws)) {
    const LawInGroup& law = *std::ranges::find(group.laws, model, &LawInGroup::model);
    if (law.serves < group.counted.size()) continue;
    if (simplest == nullptr || law.free_parameters < simplest->free_parameters) simplest = &law;
  }
  return simplest == nullptr ? "" : simplest->model;
}

void judge_group(const StudyResults& results, StudiedGroup& group) {
  if (group.counted.empty()) return;
  const StudiedRecording& first = results.recordings[group.counted.front()].result;
  group.quantities.push_back(cycle_quantity(results, group, "peak", first.force_unit, &StudiedCycle::peak));
  group.quantities.push_back(cycle_quantity(
      results, group, "work", work_unit(first.force_unit, first.position_unit), &StudiedCycle::closing_work));
  for (const std::string& model : results.plan.laws) {
    group.laws.push_back(law_in_group(results, group, model));
    for (StudiedQuantity& quantity : parameters_in_group(results, group, model))
      group.quantities.push_back(std::move(quantity));
  }
  group.serving = serving_all(results, group);
}

/// That serves most recordings of the study; of those the one with fewest parameters, then the first listed.
std::string law_of_study(const StudyResults& results) {
  std::string best;
  std::pair<std::size_t, std::size_t> most{0, 0};  // recordings, parameters
  for (const std::string& model : as_listed(results.plan.laws)) {
    std::size_t serves = 0;
    std::size_t parameters = 0;
    for (const StudiedGroup& group : results.groups) {
      const auto law = std::ranges::find(group.laws, model, &LawInGroup::model);
      if (law == group.laws.end()) continue;
      serves += law->serves;
      parameters = std::max(parameters, law->free_parameters);
    }
    if (parameters == 0) continue;
    if (best.empty() || serves > most.first || (serves == most.first && parameters < most.second)) {
      best = model;
      most = {serves, parameters};
    }
  }
  return best;
}

/// The blanks of two groups; of a blank that is one group's alone, the other has its own values.
std::vector<population::SharedByGroups> shared_by(const StudiedQuantity& first,
                                                  const StudiedQuantity& second) {
  std::map<std::string, population::SharedByGroups> blanks;
  for (const SharedBlank& blank : first.blanks) blanks[blank.name].first = blank.values;
  for (const SharedBlank& blank : second.blanks) blanks[blank.name].second = blank.values;
  std::vector<population::SharedByGroups> shared;
  for (auto& [name, one] : blanks) {
    const std::size_t parts = std::max(one.first.without.size(), one.second.without.size());
    one.first.without.resize(parts, values_of(first));
    one.second.without.resize(parts, values_of(second));
    shared.push_back(std::move(one));
  }
  return shared;
}

/// A pair of groups, each by one quantity that both have.
void add_comparison(const StudiedGroup& first, const StudiedGroup& second, const std::string& what,
                    const std::string& by, std::vector<StudiedComparison>& comparisons,
                    std::vector<population::Pair>& pairs) {
  const auto of = [&](const StudiedGroup& group) {
    const auto found = std::ranges::find(group.quantities, what, &StudiedQuantity::name);
    return found == group.quantities.end() ? nullptr : &*found;
  };
  const StudiedQuantity* const one = of(first);
  const StudiedQuantity* const other = of(second);
  if (one == nullptr || other == nullptr || one->is_logarithm != other->is_logarithm) return;
  comparisons.push_back({.quantity = what,
                         .unit = one->unit,
                         .is_logarithm = one->is_logarithm,
                         .by = by,
                         .first = first.name(),
                         .second = second.name(),
                         .found = {}});
  pairs.push_back({.first = one->values, .second = other->values, .shared = shared_by(*one, *other)});
}

void compare_groups(StudyResults& results) {
  std::vector<population::Pair> pairs;
  for (const std::string& what : results.plan.compare) {
    for (std::size_t i = 0; i < results.groups.size(); ++i) {
      for (std::size_t k = i + 1; k < results.groups.size(); ++k) {
        const StudiedGroup& first = results.groups[i];
        const StudiedGroup& second = results.groups[k];
        const bool of_tissues = first.speed == second.speed && first.tissue != second.tissue;
        const bool of_speeds = first.tissue == second.tissue && first.speed != second.speed;
        if (of_tissues || of_speeds)
          add_comparison(first, second, what, of_tissues ? "tissue" : "speed", results.comparisons, pairs);
      }
    }
  }
  const std::vector<population::Comparison> found = population::compare(pairs);
  for (std::size_t i = 0; i < found.size(); ++i) results.comparisons[i].found = found[i];
}

}  // namespace

std::string StudiedGroup::name() const {
  const std::string& what = tissue.empty() ? std::string("(no tissue)") : tissue;
  return speed.empty() ? what : what + ", " + speed;
}

void form_groups(StudyResults& results) {
  std::map<std::pair<std::string, std::string>, StudiedGroup> groups;
  for (std::size_t i = 0; i < results.recordings.size(); ++i) {
    const DrawerRecording& one = results.recordings[i];
    if (one.file.blank) continue;
    StudiedGroup& group = groups
                              .try_emplace({one.file.tissue, one.file.speed},
                                           StudiedGroup{.tissue = one.file.tissue, .speed = one.file.speed})
                              .first->second;
    if (one.counts()) {
      group.counted.push_back(i);
    } else {
      ++group.left_out;
    }
  }
  for (auto& [factors, group] : groups) results.groups.push_back(std::move(group));
}

std::string why_not_of_one_quantity(const StudyResults& results, const std::string& model) {
  constexpr double same = 1e-9;
  std::map<std::string, std::pair<double, double>> ranges;  // of each option
  for (const DrawerRecording& recording : results.recordings) {
    const StudiedLaw* const law = law_of(recording, model);
    if (!recording.counts() || law == nullptr || !law->can_be_chosen) continue;
    for (const auto& [name, value] : law->taken_from_it) {
      auto& range = ranges.try_emplace(name, value, value).first->second;
      range = {std::min(range.first, value), std::max(range.second, value)};
    }
  }
  for (const auto& [name, range] : ranges) {
    const auto& [least, most] = range;
    if (most - least <= same * std::abs(most)) continue;
    return fmt::format(
        "parameters of {} are neither pooled nor compared: its {} was taken from each recording, {:.4g} to "
        "{:.4g}, so that they are not of one quantity; law_options = [\"{}={:.2g}\"] in study.toml makes "
        "them so",
        model, name, least, most, name, least);
  }
  return "";
}

void conclude(StudyResults& results) {
  for (StudiedGroup& group : results.groups) judge_group(results, group);
  results.law = law_of_study(results);
  compare_groups(results);
  results.conclusions = conclusions_of(results);
}

std::string in_words(const GroupEstimate& estimate, bool is_logarithm) {
  const auto value = [&](double of) { return is_logarithm ? std::exp(of) : of; };
  if (!estimate.mean) return "unknown";
  std::string text = fmt::format("{:.3g}", value(*estimate.mean));
  const std::string count =
      estimate.specimens
          ? fmt::format("{} specimen{}", *estimate.specimens, *estimate.specimens == 1 ? "" : "s")
          : fmt::format("{} recording{}", estimate.recordings, estimate.recordings == 1 ? "" : "s");
  if (estimate.interval)
    return text + fmt::format(" ({:.3g} to {:.3g}; {})", value(estimate.interval->lower),
                              value(estimate.interval->upper), count);
  return text + fmt::format(" (no interval; {})", count);
}

}  // namespace kerf::bench
