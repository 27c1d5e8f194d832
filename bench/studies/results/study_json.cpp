#include <cmath>

#include "results/study_results.h"

namespace kerf::bench {
namespace {

using json = nlohmann::ordered_json;

json of_optional(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? json(*value) : json(nullptr);
}

json of_interval(const std::optional<population::Interval>& interval) {
  return interval ? json::array({of_optional(interval->lower), of_optional(interval->upper)}) : json(nullptr);
}

json of_spread(const std::optional<population::Spread>& spread) {
  return spread ? json{{"value", spread->value}, {"ci95", of_interval(spread->interval)}} : json(nullptr);
}

/// How far the mean errs by what was taken off several recordings; null: nothing was, or it is not known.
json of_shared(const std::optional<population::SharedError>& error) {
  return error ? json(error->standard_error) : json(nullptr);
}

json of_estimate(const population::GroupEstimate& estimate) {
  return {{"recordings", estimate.recordings},
          {"left_out", estimate.left_out},
          {"specimens", estimate.specimens ? json(*estimate.specimens) : json(nullptr)},
          {"over", estimate.unit == population::Unit::specimens ? "specimens" : "recordings"},
          {"mean", of_optional(estimate.mean)},
          {"std_error", of_optional(estimate.standard_error)},
          {"ci95", of_interval(estimate.interval)},
          {"ci95_of_this_specimen", of_interval(estimate.of_this_specimen)},
          {"std_error_of_blanks", of_shared(estimate.shared_error)},
          {"between_specimens", of_spread(estimate.between_specimens)},
          {"between_recordings", of_spread(estimate.between_recordings)},
          {"together", of_spread(estimate.together)},
          {"next_specimen", of_interval(estimate.of_the_next)}};
}

json of_group(const StudyResults& results, const StudiedGroup& group) {
  json counted = json::array();
  for (const std::size_t at : group.counted) counted.push_back(results.recordings[at].name);
  json laws = json::array();
  for (const LawInGroup& law : group.laws)
    laws.push_back({{"law", law.model},
                    {"free_parameters", law.free_parameters},
                    {"serves", law.serves},
                    {"held_out_jnd", of_estimate(law.held_out)},
                    {"on_others_jnd", of_estimate(law.on_others)}});
  json quantities = json::array();
  for (const StudiedQuantity& quantity : group.quantities)
    quantities.push_back({{"name", quantity.name},
                          {"unit", quantity.unit},
                          {"logarithm", quantity.is_logarithm},
                          {"estimate", of_estimate(quantity.estimate)}});
  return {{"tissue", group.tissue},
          {"speed", group.speed},
          {"recordings", counted},
          {"left_out", group.left_out},
          {"serves", group.serving.empty() ? json(nullptr) : json(group.serving)},
          {"laws", laws},
          {"quantities", quantities}};
}

json of_comparison(const StudiedComparison& comparison) {
  const population::Comparison& found = comparison.found;
  return {{"quantity", comparison.quantity},
          {"unit", comparison.unit},
          {"by", comparison.by},
          {"first", comparison.first},
          {"second", comparison.second},
          {"verdict", population::name_of(found.verdict)},
          {"logarithm", comparison.is_logarithm},
          {"first_units", found.first_units},
          {"second_units", found.second_units},
          {"left_out", found.left_out},
          {"crossed", found.is_crossed},
          {"difference", of_optional(found.difference)},
          {"ci95", of_interval(found.interval)},
          {"std_error_of_blanks", of_shared(found.shared_error)},
          {"hedges_g", of_optional(found.hedges_g)},
          {"p", found.test ? json(found.test->p) : json(nullptr)},
          {"p_holm", found.test ? json(found.holm_p) : json(nullptr)},
          {"p_benjamini_hochberg", found.test ? json(found.benjamini_hochberg_p) : json(nullptr)}};
}

json of_recording(const DrawerRecording& one) {
  std::size_t good = 0;
  for (const StudiedCycle& cycle : one.result.cycles) good += cycle.is_good ? 1 : 0;
  return {{"name", one.name},
          {"file", one.file.path},
          {"tissue", one.file.tissue},
          {"speed", one.file.speed},
          {"specimen", one.file.specimen.empty() ? json(nullptr) : json(one.file.specimen)},
          {"blank", one.file.blank},
          {"rig", one.file.rig.empty() ? json(nullptr) : json(one.file.rig)},
          {"joined", one.result.join ? as_json(*one.result.join) : json(nullptr)},
          {"blade", one.result.blade ? as_json(*one.result.blade) : json(nullptr)},
          {"blank_taken_off", one.result.blank ? as_json(*one.result.blank) : json(nullptr)},
          {"counts", one.counts()},
          {"failure", one.result.failure.empty() ? json(nullptr) : json(one.result.failure)},
          {"doubts", one.doubts},
          {"accepted", one.file.accepted.empty() ? json(nullptr) : json(one.file.accepted)},
          {"warnings", one.result.warnings},
          {"cycles", one.result.cycles.size()},
          {"good_cycles", good},
          {"law", one.result.chosen.empty() ? json(nullptr) : json(one.result.chosen)},
          {"not_fitted", one.result.not_fitted.empty() ? json(nullptr) : json(one.result.not_fitted)}};
}

const char* in_a_word(Conclusion::Says says) {
  switch (says) {
    case Conclusion::Says::yes:
      return "yes";
    case Conclusion::Says::partly:
      return "partly";
    case Conclusion::Says::no:
      return "no";
    case Conclusion::Says::unknown:
      break;
  }
  return "unknown";
}

}  // namespace

json study_as_json(const StudyResults& results) {
  json recordings = json::array();
  for (const DrawerRecording& one : results.recordings) recordings.push_back(of_recording(one));
  json ignored = json::array();
  for (const DrawerFile& file : results.plan.files)
    if (!file.ignored.empty()) ignored.push_back({{"file", file.path}, {"why", file.ignored}});
  json groups = json::array();
  for (const StudiedGroup& group : results.groups) groups.push_back(of_group(results, group));
  json comparisons = json::array();
  for (const StudiedComparison& one : results.comparisons) comparisons.push_back(of_comparison(one));
  json conclusions = json::array();
  for (const Conclusion& one : results.conclusions)
    conclusions.push_back({{"says", in_a_word(one.says)}, {"sentence", one.sentence}});
  return {{"study", results.name},
          {"laws", results.plan.laws},
          {"law", results.law.empty() ? json(nullptr) : json(results.law)},
          {"cycles", results.plan.all_cycles ? "all" : "good"},
          {"blanks", {{"subtracted", results.plan.subtracts_blanks}, {"why", results.plan.why_blanks}}},
          {"conclusions", conclusions},
          {"recordings", recordings},
          {"ignored", ignored},
          {"groups", groups},
          {"comparisons", comparisons}};
}

}  // namespace kerf::bench
