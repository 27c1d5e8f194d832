#include "answers/analysis.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

namespace kerf::bench {
namespace {

using Answers = std::vector<const Judgement*>;

void require(bool holds, const char* what, double found, const char* expected) {
  if (holds) return;
  throw std::invalid_argument(
      fmt::format("the analysis' {} is {:g}, expected a number in {}", what, found, expected));
}

void require_options(const AnalysisOptions& options) {
  const auto inside = [](double value, double end) { return value > 0.0 && value < end; };
  require(inside(options.confidence, 1.0), "confidence", options.confidence, "0 to 1, such as 0.95");
  require(inside(options.level, 0.5), "level", options.level, "0 to 0.5, such as 0.05");
  if (options.margin)
    require(inside(*options.margin, 1.0), "margin of a preference", *options.margin, "0 to 1, such as 0.1");
  if (options.d_prime_bound)
    require(*options.d_prime_bound > 0.0 && std::isfinite(*options.d_prime_bound), "bound of d'",
            *options.d_prime_bound, "0 to infinity, such as 1");
  for (const double truth : options.truths) require(inside(truth, 1.0), "truth of a power", truth, "0 to 1");
  require(options.bootstrap >= 0, "number of bootstrap samples", options.bootstrap, "0 or more");
  if (options.lapse)
    require(*options.lapse >= 0.0 && *options.lapse < 0.25, "lapse rate", *options.lapse, "0 to 0.25");
  if (options.jnd_margins) {
    require(options.jnd_margins->lower >= 0.0 && options.jnd_margins->lower < options.jnd_margins->upper,
            "lower margin of a JND", options.jnd_margins->lower, "0 to the upper one");
  }
}

void require_samples(const Study& study) {
  for (const Judgement& judgement : study.judgements) {
    for (const std::size_t sample : judgement.pair) {
      if (sample < study.samples.size()) continue;
      throw std::invalid_argument(fmt::format("{}: an answer of subject {} names sample {} of {}", study.name,
                                              judgement.subject, sample, study.samples.size()));
    }
  }
}

Answers counted(const Study& study) {
  Answers judgements;
  for (const Judgement& judgement : study.judgements) {
    if (judgement.counts()) judgements.push_back(&judgement);
  }
  return judgements;
}

/// Answers by a key, in the order in which the keys appear.
template <typename Key>
std::vector<std::pair<std::string, Answers>> grouped(const Answers& judgements, const Key& key) {
  std::vector<std::pair<std::string, Answers>> groups;
  for (const Judgement* judgement : judgements) {
    const std::string name = key(*judgement);
    auto group =
        std::find_if(groups.begin(), groups.end(), [&](const auto& known) { return known.first == name; });
    if (group == groups.end()) group = groups.insert(groups.end(), {name, {}});
    group->second.push_back(judgement);
  }
  return groups;
}

std::size_t pairs_in(const Answers& judgements) {
  std::vector<std::array<std::size_t, 2>> pairs;
  for (const Judgement* judgement : judgements) {
    if (std::find(pairs.begin(), pairs.end(), judgement->pair) == pairs.end())
      pairs.push_back(judgement->pair);
  }
  return pairs.size();
}

bool has_answer(const Study& study, const Answers& judgements) {
  return std::any_of(judgements.begin(), judgements.end(), [&](const Judgement* judgement) {
    return !study.scale.two_sided() || judgement->level != 0.0;
  });
}

/// Of preferences among three samples one count would add up different questions.
bool asks_one_question(const Study& study, const Answers& judgements) {
  if (study.design != Design::preference) return true;
  const auto tissues = grouped(judgements, [](const Judgement& judgement) { return judgement.tissue; });
  return std::all_of(tissues.begin(), tissues.end(),
                     [](const auto& tissue) { return pairs_in(tissue.second) == 1; });
}

void add_groups(const Study& study, const Answers& judgements, Analysis& analysis) {
  const AnalysisOptions& options = analysis.options;
  const auto add = [&](std::vector<AnswerGroup>& family, const std::string& name, const Answers& answers) {
    if (has_answer(study, answers)) family.push_back(answer_group(study, answers, name, options));
  };
  const bool one_question = asks_one_question(study, judgements);
  if (one_question && has_answer(study, judgements)) {
    analysis.all = answer_group(study, judgements, "all", options);
    add_trials_needed(*analysis.all, options);
    for (const auto& [name, answers] :
         grouped(judgements, [](const Judgement& each) { return each.subject; }))
      add(analysis.by_subject, name, answers);
  }
  const auto tissues = grouped(judgements, [](const Judgement& each) { return each.tissue; });
  bool several_pairs = false;
  for (const auto& [name, answers] : tissues) {
    const bool is_one = pairs_in(answers) == 1;
    several_pairs |= !is_one;
    if (is_one || study.design != Design::preference) add(analysis.by_tissue, name, answers);
  }
  if (several_pairs) {
    for (const auto& [tissue, own] : tissues) {
      const auto name_of_pair = [&study](const Judgement& each) {
        return fmt::format("{}{}{} or {}", each.tissue, each.tissue.empty() ? "" : ": ",
                           study.samples[each.pair[0]], study.samples[each.pair[1]]);
      };
      for (const auto& [name, answers] : grouped(own, name_of_pair)) add(analysis.by_pair, name, answers);
    }
  }
  for (auto* family : {&analysis.by_subject, &analysis.by_tissue, &analysis.by_pair})
    correct(*family, options);
  if (!analysis.by_subject.empty()) analysis.spread = subject_spread(study, analysis.by_subject, options);
}

/// The least p of several rankings, after Holm.
double ranking_p(const std::vector<TissueRanking>& rankings) {
  std::vector<double> p;
  for (const TissueRanking& ranking : rankings) {
    if (ranking.bradley_terry) p.push_back(ranking.p_value());
  }
  if (p.empty()) return std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> adjusted = psychophysics::holm(p);
  return *std::min_element(adjusted.begin(), adjusted.end());
}

std::string main_test_text(const AnswerGroup& group) {
  const char* sides = group.one_sided ? "one-sided" : "two-sided";
  if (group.tests_subjects)
    return fmt::format("flipped signs of the {} subjects' shares less {:.4g} %, {}", group.subjects,
                       100.0 * group.chance, sides);
  return fmt::format(
      "exact binomial, {}, against {:.4g} %{}", sides, 100.0 * group.chance,
      group.subjects > 1 ? ": of the answers, since so few subjects are no test of people" : "");
}

std::string ranking_test_text(const std::vector<TissueRanking>& rankings) {
  const bool over_subjects = std::any_of(rankings.begin(), rankings.end(),
                                         [](const TissueRanking& each) { return each.tests_subjects; });
  return fmt::format("{} of Bradley-Terry against equal worth, the least of the tissues' after Holm",
                     over_subjects ? "score, flipped by subjects," : "likelihood ratio");
}

void name_main_test(Analysis& analysis) {
  if (analysis.estimates) {
    analysis.p_value = analysis.estimates->p_value;
    analysis.main_test = analysis.estimates->main_test;
    return;
  }
  if (analysis.all) {
    analysis.p_value = analysis.all->p_value;
    analysis.main_test = std::isnan(analysis.p_value) ? analysis.all->note : main_test_text(*analysis.all);
  } else if (!analysis.rankings.empty()) {
    analysis.p_value = ranking_p(analysis.rankings);
    analysis.main_test =
        std::isnan(analysis.p_value) ? analysis.rankings.front().note : ranking_test_text(analysis.rankings);
  } else {
    analysis.main_test = "there are no answers";
  }
}

AnswerQuality quality_of_answers(const Study& study, const AnalysisOptions& options) {
  AnswerQuality quality;
  Study rest = study;
  rest.judgements.clear();
  for (const Judgement& each : study.judgements) {
    if (each.practice || each.is_catch) continue;
    if (!each.counts()) {
      ++quality.voided;
      for (const VoidReason reason : each.void_reasons) ++quality.by_reason[static_cast<std::size_t>(reason)];
      continue;
    }
    const bool is_unfelt = each.is_felt == false;
    const bool is_faulty = each.is_sound == false;
    quality.known += each.is_felt ? 1 : 0;
    quality.unfelt += is_unfelt ? 1 : 0;
    quality.faulty += is_faulty ? 1 : 0;
    if (!is_unfelt && !is_faulty) rest.judgements.push_back(each);
  }
  quality.without = rest.judgements.size();
  AnalysisOptions test_alone = options;
  test_alone.curves = false;
  if (quality.unfelt > 0 || quality.faulty > 0) quality.p_value = main_result(rest, test_alone).p_value;
  if (quality.voided == 0) return quality;
  rest.judgements = study.judgements;
  for (Judgement& each : rest.judgements) {
    if (each.answer != no_answer) each.void_reasons.clear();
  }
  quality.p_with_void = main_result(rest, test_alone).p_value;
  return quality;
}

}  // namespace

Analysis analyse(const Study& study, const AnalysisOptions& options) {
  require_options(options);
  require_samples(study);
  Analysis analysis{.options = options, .name = study.name, .design = study.design, .samples = study.samples};
  const Answers judgements = counted(study);
  analysis.trials = judgements.size();
  analysis.practice = static_cast<std::size_t>(std::ranges::count_if(study.judgements, &Judgement::practice));
  for (const auto& [name, answers] : grouped(judgements, [](const Judgement& each) { return each.subject; }))
    analysis.subjects.push_back(name);
  if (study.design == Design::preference) {
    analysis.preferred.assign(study.samples.size(), 0);
    for (const Judgement* judgement : judgements)
      ++analysis.preferred[judgement->pair[judgement->is_right() ? 1 : 0]];
  }
  analysis.estimates = analyse_estimates(study, judgements, options);
  if (asks_numbers(study.design)) {
    analysis.bias.note = "numbers were answered";
  } else {
    add_groups(study, judgements, analysis);
    analysis.bias = slot_bias(study, judgements, options);
  }
  analysis.rankings = rank_tissues(study, judgements, options);
  if (has_levels(study.design) && !judgements.empty()) {
    analysis.levels = analyse_levels(study, judgements, options);
    analysis.tracks = adaptive_tracks(study, judgements, options);
  }
  analysis.ratings = analyse_ratings(study, judgements, options);
  analysis.questionnaire = questionnaire_scores(study, options.confidence);
  analysis.times = response_times(study, judgements);
  analysis.catches = catches_by_subject(study);
  analysis.quality = quality_of_answers(study, options);
  analysis.felt = felt_check(study, options.confidence);
  analysis.explored = explored_alike(study, options.confidence);
  analysis.remarks = study.remarks;
  name_main_test(analysis);
  add_findings(analysis);
  return analysis;
}

MainResult main_result(const Study& study, const AnalysisOptions& options) {
  const Answers judgements = counted(study);
  MainResult result{.trials = judgements.size()};
  if (judgements.empty()) {
    result.note = "there are no answers";
    return result;
  }
  if (const auto estimates = analyse_estimates(study, judgements, options)) {
    result.p_value = estimates->p_value;
    if (std::isnan(result.p_value)) result.note = estimates->main_test;
    if (estimates->law && estimates->law->mean) {
      result.exponent = estimates->law->mean->mean;
      result.exponent_interval = estimates->law->mean->interval;
    }
    return result;
  }
  AnalysisOptions quick = options;
  quick.truths.clear();
  quick.bootstrap = 0;
  if (!asks_one_question(study, judgements)) {
    const auto rankings = rank_tissues(study, judgements, quick);
    result.p_value = ranking_p(rankings);
    if (std::isnan(result.p_value) && !rankings.empty()) result.note = rankings.front().note;
    return result;
  }
  if (has_answer(study, judgements)) {
    const AnswerGroup all = answer_group(study, judgements, "all", quick);
    result.p_value = all.p_value;
    if (all.equivalence) result.equivalent = all.equivalence->is_shown;
    if (all.d_prime) {
      result.d_prime = all.d_prime->value;
      result.d_prime_interval = all.d_prime->interval;
    }
  }
  if (!has_levels(study.design) || !options.curves) return result;
  const LevelAnalysis levels = analyse_levels(study, judgements, quick, false);
  if (levels.people) {
    result.jnd = levels.people->jnd.mean;
    result.jnd_interval = levels.people->jnd.interval(options.confidence);
  } else if (levels.pooled.jnd) {
    result.jnd = levels.pooled.jnd->value;
    result.jnd_interval = levels.pooled.jnd->interval;
  }
  if (levels.people && levels.people->equality) {
    result.equality = levels.people->equality->mean;
    result.equality_interval = levels.people->equality->interval(options.confidence);
  } else if (levels.pooled.equality) {
    result.equality = levels.pooled.equality->value;
    result.equality_interval = levels.pooled.equality->interval;
  }
  result.equivalent = levels.people ? levels.people->jnd_within : levels.pooled.jnd_within;
  for (const std::string& note : levels.pooled.notes) {
    if (!result.note.empty()) result.note += "; ";
    result.note += note;
  }
  return result;
}

}  // namespace kerf::bench
