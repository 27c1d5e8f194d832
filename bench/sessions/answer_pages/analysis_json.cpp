#include "answer_pages/analysis_json.h"

#include <cmath>

#include <fmt/core.h>

#include "answer_pages/analysis_words.h"
#include "answer_pages/estimates_text.h"
#include "answer_pages/experiment_words.h"
#include "answer_pages/explored_words.h"
#include "answer_pages/felt_words.h"
#include "answer_pages/levels_json.h"
#include "answer_pages/ratings_text.h"
#include "files/json_number.h"

namespace kerf::bench {
namespace {

using json = nlohmann::ordered_json;

json note_of(const std::string& note) { return note.empty() ? json(nullptr) : json(note); }

json count_as_json(psychophysics::Count count) {
  return {{"successes", count.successes}, {"trials", count.trials}};
}

json or_null(const std::optional<double>& value) { return value ? json(*value) : json(nullptr); }

/// What is excluded stands there always; whether a margin is kept only if one was set.
json equivalence_as_json(const AnswerGroup& group, const AnalysisOptions& options) {
  if (!group.d_prime && group.counted == "right") return nullptr;
  json result{{"of", group.d_prime ? "dprime" : "preference"}};
  if (group.d_prime) {
    result["bound"] = or_null(options.d_prime_bound);
    result["excluded_above"] = json_number(group.excluded_d_prime);
  } else {
    result["margin"] = or_null(options.margin);
    result["excluded_margin"] = json_number(group.excluded_margin);
  }
  result["level"] = options.level;
  const bool is_asked = group.equivalence.has_value();
  const GroupEquivalence found = group.equivalence.value_or(GroupEquivalence());
  result["p_value"] = is_asked ? json_number(found.p) : json(nullptr);
  result["interval"] = is_asked ? pair_of(found.interval) : json(nullptr);
  result["shown"] = is_asked ? json(found.is_shown) : json(nullptr);
  result["subjects_shown"] = is_asked ? json(found.subjects_shown) : json(nullptr);
  result["subjects_differ"] = is_asked && group.subjects > 2 ? json(found.subjects_differ) : json(nullptr);
  return result;
}

json over_subjects_as_json(const AnswerGroup& group) {
  if (!group.over_subjects) return nullptr;
  const psychophysics::SignFlips& flips = *group.over_subjects;
  return {{"test", "sign flips"},
          {"subjects", group.subjects},
          {"mean", json_number(group.chance + flips.mean)},
          {"p_greater", json_number(flips.p_greater)},
          {"p_two_sided", json_number(flips.p_two_sided)},
          {"exact", flips.is_exact},
          {"is_main", group.tests_subjects}};
}

json power_as_json(const AnswerGroup& group) {
  json result = json::array();
  for (const TestPower& power : group.power) {
    result.push_back(
        {{"truth", power.truth},
         {"power", json_number(power.power)},
         {"trials_for_0.8", power.trials_needed > 0 ? json(power.trials_needed) : json(nullptr)}});
  }
  return result;
}

/// What stands at the top for all answers and in lists for the others.
void add_group(json& result, const AnswerGroup& group, const AnalysisOptions& options) {
  result["trials"] = group.count.trials;
  result["correct"] = group.counted == "right" ? json(group.count.successes) : json(nullptr);
  result["counted"] = group.counted;
  result["count"] = group.count.successes;
  result["proportion"] = static_cast<double>(group.count.successes) / group.count.trials;
  result["chance"] = group.chance;
  result["p_value"] = json_number(group.p_value);
  result["main_test"] = std::isnan(group.p_value) ? "none" : group.one_sided ? "one-sided" : "two-sided";
  result["p_greater"] = json_number(group.p_greater);
  result["p_two_sided"] = json_number(group.p_two_sided);
  result["over_subjects"] = over_subjects_as_json(group);
  result["ci95"] = pair_of(group.interval);
  result["wilson95"] = pair_of(group.wilson);
  result["dprime"] = group.d_prime ? json_number(group.d_prime->value) : json(nullptr);
  result["dprime_ci95"] = group.d_prime ? pair_of(group.d_prime->interval) : json(nullptr);
  result["dprime_std_error"] = group.d_prime ? json_number(group.d_prime->standard_error) : json(nullptr);
  result["power"] = power_as_json(group);
  result["equivalence"] = equivalence_as_json(group, options);
  result["note"] = note_of(group.note);
}

json groups_as_json(const std::vector<AnswerGroup>& groups, const char* key, const AnalysisOptions& options) {
  json result = json::array();
  for (const AnswerGroup& group : groups) {
    json& one = result.emplace_back(json{{key, group.name}});
    add_group(one, group, options);
    one["p_adjusted"] = json_number(group.p_adjusted);
  }
  return result;
}

json spread_as_json(const SubjectSpread& spread) {
  json result{{"subjects", spread.subjects},
              {"equal",
               {{"test", "Fisher-Freeman-Halton"},
                {"chi_squared", json_number(spread.equal.statistic)},
                {"freedom", spread.equal.degrees_of_freedom},
                {"p_value", json_number(spread.equal.p)},
                {"exact", spread.equal.is_exact}}},
              {"mean", nullptr},
              {"ci95", nullptr},
              {"p_value", nullptr},
              {"dprime", nullptr},
              {"dprime_ci95", nullptr},
              {"note", note_of(spread.note)}};
  if (!spread.population) return result;
  const auto& population = *spread.population;
  result["mean"] = json_number(population.mean);
  result["ci95"] = pair_of(population.interval);
  result["p_value"] = json_number(population.p_value);
  if (population.d_prime) {
    result["dprime"] = json_number(population.d_prime_of_mean);
    result["dprime_ci95"] = pair_of(*population.d_prime);
  }
  return result;
}

json bias_as_json(const SlotBias& bias, Design design) {
  json result{{"slots", json::array()},
              {"p_value", bias.note.empty() ? json_number(bias.test.p) : json(nullptr)}};
  for (std::size_t slot = 0; slot < bias.answers.size(); ++slot) {
    result["slots"].push_back({{"slot", answer_label_of(design, slot)},
                               {"answers", bias.answers[slot]},
                               {"right", count_as_json(bias.right_in[slot])}});
  }
  if (bias.detection) {
    result["dprime"] = json_number(bias.detection->d_prime);
    result["dprime_ci95"] = pair_of(bias.detection->interval);
    result["criterion"] = json_number(bias.detection->criterion);
    result["criterion_std_error"] = json_number(bias.detection->criterion_standard_error);
  }
  result["note"] = note_of(bias.note);
  return result;
}

json scale_as_json(const psychophysics::Ranking& ranking) {
  return {{"worth", json_numbers(ranking.worth)},
          {"std_error", json_numbers(ranking.standard_error)},
          {"all_equal",
           {{"ratio", json_number(ranking.ratio)},
            {"freedom", ranking.ratio_degrees_of_freedom},
            {"p_value", json_number(ranking.ratio_p)}}},
          {"one_scale",
           {{"deviance", json_number(ranking.deviance)},
            {"freedom", ranking.deviance_degrees_of_freedom},
            {"p_value", json_number(ranking.deviance_p)}}}};
}

json ranking_over_subjects_as_json(const TissueRanking& ranking) {
  if (!ranking.over_subjects) return nullptr;
  const psychophysics::SubjectsRanking& over = *ranking.over_subjects;
  std::vector<double> errors;
  for (std::size_t i = 0; i < over.covariance.size(); ++i) errors.push_back(std::sqrt(over.covariance[i][i]));
  return {{"test", "score of Bradley-Terry, flipped by subjects"},
          {"subjects", over.subjects},
          {"p_value", json_number(over.p)},
          {"exact", over.is_exact},
          {"std_error", json_numbers(errors)},
          {"is_main", ranking.tests_subjects}};
}

json rankings_as_json(const Analysis& analysis) {
  json result = json::array();
  for (const TissueRanking& ranking : analysis.rankings) {
    json names = json::array();
    for (const std::size_t sample : ranking.samples) names.push_back(analysis.samples[sample]);
    json intervals = json::array();
    for (const psychophysics::Interval& interval : ranking.intervals) intervals.push_back(pair_of(interval));
    json pairs = json::array();
    for (const RankedPair& pair : ranking.pairs) {
      pairs.push_back({{"first", names[pair.first]},
                       {"second", names[pair.second]},
                       {"difference", json_number(pair.difference.value)},
                       {"std_error", json_number(pair.difference.standard_error)},
                       {"p_value", json_number(pair.difference.p)},
                       {"p_adjusted", json_number(pair.p_adjusted)}});
    }
    result.push_back(
        {{"tissue", ranking.tissue},
         {"samples", std::move(names)},
         {"wins", ranking.wins},
         {"bradley_terry", ranking.bradley_terry ? scale_as_json(*ranking.bradley_terry) : json(nullptr)},
         {"thurstone", ranking.thurstone ? scale_as_json(*ranking.thurstone) : json(nullptr)},
         {"over_subjects", ranking_over_subjects_as_json(ranking)},
         {"pairs", std::move(pairs)},
         {"note", note_of(ranking.note)}});
  }
  return result;
}

json tracks_as_json(const std::vector<AdaptiveTrack>& tracks) {
  json result = json::array();
  for (const AdaptiveTrack& track : tracks) {
    json& one = result.emplace_back(json{{"subject", track.subject},
                                         {"session", track.session},
                                         {"staircase", track.number + 1},
                                         {"trials", track.levels.size()},
                                         {"reversals", track.reversals},
                                         {"mean_of_reversals", nullptr},
                                         {"quest_plus", nullptr},
                                         {"note", note_of(track.note)}});
    if (track.staircase) {
      one["mean_of_reversals"] = {{"value", json_number(track.staircase->threshold)},
                                  {"std_error_of_log", json_number(track.staircase->standard_error)},
                                  {"criterion", json_number(track.staircase->probability)},
                                  {"reversals", track.staircase->reversals}};
    }
    if (track.quest) {
      one["quest_plus"] = {{"threshold", json_number(track.quest->threshold)},
                           {"credible95", pair_of(track.quest->interval)},
                           {"slope", json_number(track.quest->slope)},
                           {"guess", json_number(track.quest->guess)},
                           {"lapse", json_number(track.quest->lapse)}};
    }
  }
  return result;
}

json times_as_json(const ResponseTimes& times) {
  return {{"trials", times.trials},
          {"median_s", json_number(times.median_s)},
          {"quartiles_s", pair_of({.lower = times.lower_quartile_s, .upper = times.upper_quartile_s})},
          {"median_right_s", json_number(times.median_right_s)},
          {"median_wrong_s", json_number(times.median_wrong_s)},
          {"right_is_faster", json_number(times.right_is_faster)},
          {"p_value", json_number(times.p_value)},
          {"note", note_of(times.note)}};
}

json quality_as_json(const AnswerQuality& quality) {
  json reasons = json::object();
  for (std::size_t reason = 0; reason < void_reasons; ++reason)
    reasons[std::string(name_of(static_cast<VoidReason>(reason)))] = quality.by_reason[reason];
  return {{"known", quality.known},
          {"unfelt", quality.known > 0 ? json(quality.unfelt) : json(nullptr)},
          {"faulty", quality.known > 0 ? json(quality.faulty) : json(nullptr)},
          {"without", {{"trials", quality.without}, {"p_value", json_number(quality.p_value)}}},
          {"void",
           {{"trials", quality.voided},
            {"reasons", std::move(reasons)},
            {"p_value_with", json_number(quality.p_with_void)}}}};
}

json catches_as_json(const std::vector<SubjectCatches>& catches) {
  json all = json::array();
  for (const SubjectCatches& each : catches)
    all.push_back({{"subject", each.subject}, {"right", each.tally.right}, {"trials", each.tally.trials}});
  return all;
}

json corrections_as_json(const Analysis& analysis) {
  json families = json::array();
  const auto add = [&](const char* family, std::size_t tests) {
    if (tests > 1) families.push_back({{"family", family}, {"tests", tests}});
  };
  add("by_subject", analysis.by_subject.size());
  add("by_tissue", analysis.by_tissue.size());
  add("by_pair", analysis.by_pair.size());
  for (const TissueRanking& ranking : analysis.rankings) add("ranking", ranking.pairs.size());
  std::size_t estimated_pairs = 0;
  if (analysis.estimates) {
    for (const EstimatedTissue& tissue : analysis.estimates->tissues) estimated_pairs += tissue.pairs.size();
  }
  add("estimates", estimated_pairs);
  return {{"method", analysis.options.correction == FamilyCorrection::holm ? "holm" : "benjamini-hochberg"},
          {"families", std::move(families)}};
}

json preferred_as_json(const Analysis& analysis) {
  if (analysis.design != Design::preference) return nullptr;
  json result = json::object();
  for (std::size_t sample = 0; sample < analysis.samples.size(); ++sample)
    result[analysis.samples[sample]] = analysis.preferred[sample];
  return result;
}

}  // namespace

json analysis_as_json(const Analysis& analysis) {
  const AnalysisOptions& options = analysis.options;
  json result{{"name", analysis.name}, {"design", name_of(analysis.design)}};
  if (analysis.all) {
    add_group(result, *analysis.all, options);
  } else {
    for (const char* key : {"correct", "ci95", "dprime"}) result[key] = nullptr;
    result["note"] = analysis.main_test;
  }
  result["trials"] = analysis.trials;
  result["p_value"] = json_number(analysis.p_value);
  result["main_test"] = analysis.main_test;
  result["preferred"] = preferred_as_json(analysis);
  result["practice"] = analysis.practice;
  result["subjects"] = analysis.subjects;
  result["confidence"] = options.confidence;
  result["level"] = options.level;
  result["seed"] = options.seed;
  result["by_subject"] = groups_as_json(analysis.by_subject, "subject", options);
  result["by_tissue"] = groups_as_json(analysis.by_tissue, "tissue", options);
  result["by_pair"] = groups_as_json(analysis.by_pair, "pair", options);
  result["across_subjects"] = spread_as_json(analysis.spread);
  result["slot_bias"] = bias_as_json(analysis.bias, analysis.design);
  result["ranking"] = rankings_as_json(analysis);
  result["psychometric"] =
      analysis.levels ? levels_as_json(*analysis.levels, options.confidence) : json(nullptr);
  result["tracks"] = tracks_as_json(analysis.tracks);
  result["ratings"] = analysis.ratings ? ratings_as_json(*analysis.ratings) : json(nullptr);
  result["estimates"] = analysis.estimates ? estimates_as_json(*analysis.estimates) : json(nullptr);
  result["questionnaire"] = questionnaire_as_json(analysis);
  result["response_times"] = times_as_json(analysis.times);
  result["quality"] = quality_as_json(analysis.quality);
  result["catch"] = catches_as_json(analysis.catches);
  result["felt"] = felt_json(analysis.felt, analysis.samples);
  result["explored"] = explored_json(analysis.explored, analysis.samples);
  result["corrections"] = corrections_as_json(analysis);
  result["experiment"] = analysis.experiment ? experiment_json(*analysis.experiment) : json(nullptr);
  result["shown"] = analysis.shows;
  result["not_shown"] = analysis.shows_not;
  result["warnings"] = analysis.warnings;
  return result;
}

}  // namespace kerf::bench
