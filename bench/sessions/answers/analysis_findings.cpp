#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/core.h>

#include "answer_pages/analysis_words.h"
#include "answer_pages/estimates_text.h"
#include "answers/analysis.h"

namespace kerf::bench {
namespace {

/// Sentences of an analysis under way.
class Findings {
 public:
  explicit Findings(Analysis& analysis) : analysis_(analysis), options_(analysis.options) {}

  void write() {
    for (const std::string& remark : analysis_.remarks) warn(remark);
    if (analysis_.trials == 0) {
      warn(analysis_.practice > 0 ? "there are no answers besides practice" : "there are no answers");
      return;
    }
    if (analysis_.estimates) {
      add_estimate_findings(analysis_);
      write_quality();
      write_times();
      return;
    }
    if (analysis_.levels) write_levels(*analysis_.levels);
    if (analysis_.all) {
      if (is_preference()) {
        write_preference(*analysis_.all);
      } else {
        write_discrimination(*analysis_.all);
      }
    }
    write_family(analysis_.by_tissue.size() > 1 ? analysis_.by_tissue : analysis_.by_pair);
    for (const TissueRanking& ranking : analysis_.rankings) write_ranking(ranking);
    write_ratings();
    write_subjects();
    write_bias();
    write_quality();
    for (std::string& finding : felt_findings(analysis_.felt, analysis_.samples, options_.confidence))
      warn(std::move(finding));
    for (std::string& finding : explored_findings(analysis_.explored, analysis_.samples, options_.confidence))
      warn(std::move(finding));
    write_times();
  }

 private:
  [[nodiscard]] bool is_preference() const { return analysis_.design == Design::preference; }
  [[nodiscard]] bool is_alarm(double p) const { return p <= options_.level; }
  [[nodiscard]] double level_percent() const { return 100.0 * options_.level; }
  void show(std::string text) { analysis_.shows.push_back(as_sentence(std::move(text))); }
  void show_not(std::string text) { analysis_.shows_not.push_back(as_sentence(std::move(text))); }
  void warn(std::string text) { analysis_.warnings.push_back(as_sentence(std::move(text))); }

  [[nodiscard]] std::string chances(const AnswerGroup& group) const {
    std::string text;
    for (const TestPower& power : group.power) {
      text += fmt::format("{}{:.0f} % to notice {:.3g} %", text.empty() ? "" : ", ", 100.0 * power.power,
                          100.0 * power.truth);
    }
    return text;
  }

  /// Whose answers a finding is about: people, by a test over subjects, or the answers alone.
  [[nodiscard]] std::string tested(const AnswerGroup& all) const {
    const std::string count = count_text(all, options_.confidence);
    if (!all.tests_subjects) return fmt::format("{}, {}", count, p_text(all.p_value));
    return fmt::format("mean of {} subjects {}, {} by flipped signs; {}", all.subjects,
                       percent_text(all.chance + all.over_subjects->mean), p_text(all.p_value), count);
  }

  void write_preference(const AnswerGroup& all) {
    if (is_alarm(all.p_value)) {
      show(fmt::format("a preference{}: {}", all.tests_subjects ? " on the average of people" : "",
                       tested(all)));
    } else {
      show(fmt::format("no sign of a preference{}: {}", all.tests_subjects ? " on the average of people" : "",
                       tested(all)));
      show_not(fmt::format("that there is none: {} answers had a chance of {}{}", all.count.trials,
                           chances(all), if_alike(all)));
    }
    if (all.excluded_margin < 0.5)
      show(fmt::format("{}a preference beyond {} either way is unlikely (excluded at {:.3g} %)",
                       average_of(all), percent_text(all.chance + all.excluded_margin), level_percent()));
    if (all.equivalence)
      write_equivalence(all,
                        fmt::format("the preference lies within 50 +- {:.3g} %", 100.0 * *options_.margin));
    show_not(
        "that the samples cannot be told apart: two that feel different and please equally give 50 % as "
        "well; ABX or a forced choice asks for that");
  }

  [[nodiscard]] static const char* if_alike(const AnswerGroup& all) {
    return all.subjects > 1 ? ", were all subjects alike" : "";
  }
  /// Ahead of what holds; nothing of one subject.
  [[nodiscard]] static const char* average_of(const AnswerGroup& all) {
    return all.subjects > 2    ? "on the average of the subjects "
           : all.subjects == 2 ? "for both subjects "
                               : "";
  }

  void write_discrimination(const AnswerGroup& all) {
    if (std::isnan(all.p_value)) return;
    const std::string count = count_text(all, options_.confidence);
    if (is_alarm(all.p_value)) {
      show(fmt::format("the difference is noticed{}: {}",
                       all.tests_subjects ? " on the average of people"
                       : all.subjects > 1 ? " by at least one of the subjects"
                                          : "",
                       tested(all)));
    } else if (all.tests_subjects && is_alarm(all.p_greater)) {
      show(fmt::format("the difference is noticed by at least one of the subjects: {}, {} (exact)", count,
                       p_text(all.p_greater)));
      show_not(fmt::format("that people notice it on the average: {}", tested(all)));
    } else {
      show(fmt::format("no sign that the difference is noticed: {}", tested(all)));
      show_not(fmt::format("that nobody notices it: {} answers had a chance of {} right{}", all.count.trials,
                           chances(all), if_alike(all)));
    }
    if (!all.d_prime) return;
    if (has_two_rates(analysis_.design)) {
      show(fmt::format("d' is {} ({:.3g} % {}), freed of the tendency to one answer{}",
                       d_prime_text(all.d_prime->value), 100.0 * options_.confidence,
                       d_prime_text(all.d_prime->interval),
                       all.subjects > 1 ? "; of all answers, as if of one subject" : ""));
      if (options_.d_prime_bound) show_not("that d' is below a bound: this design has no test of it");
    }
    if (all.equivalence) write_equivalence(all, fmt::format("d' is below {:.3g}", *options_.d_prime_bound));
    if (std::isfinite(all.excluded_d_prime))
      show(fmt::format("{}a d' above {} is unlikely (excluded at {:.3g} %)", average_of(all),
                       d_prime_text(all.excluded_d_prime), level_percent()));
  }

  /// Never from pooled answers, nor where subjects differ: a mean of some who hear and some who do not is
  /// nobody's.
  void write_equivalence(const AnswerGroup& all, const std::string& what) {
    const GroupEquivalence& found = *all.equivalence;
    std::string each;
    if (all.subjects > 1)
      each = fmt::format("; of each alone it is shown for {} of {} subjects", found.subjects_shown,
                         all.subjects);
    if (found.is_shown) {
      show(fmt::format("{}{} ({}){}", average_of(all), what, p_text(found.p), each));
    } else if (found.subjects_differ) {
      show_not(
          fmt::format("that {}: the subjects differ, and an average says nothing of each{}", what, each));
    } else {
      show_not(fmt::format("that {} ({}){}", what, p_text(found.p), each));
    }
  }

  void write_family(const std::vector<AnswerGroup>& family) {
    if (family.size() < 2) return;
    const auto& rankings = analysis_.rankings;
    const bool is_ranked =
        !rankings.empty() && std::all_of(rankings.begin(), rankings.end(),
                                         [](const auto& each) { return each.bradley_terry.has_value(); });
    for (const AnswerGroup& group : family) {
      if (std::isnan(group.p_value)) return;
      if (is_alarm(group.p_adjusted) && !is_ranked) {
        show(fmt::format("of {}: {}, {} after correction over {} tests", group.name,
                         count_text(group, options_.confidence), p_text(group.p_adjusted), family.size()));
      }
    }
    write_too_few(family);
  }

  void write_too_few(const std::vector<AnswerGroup>& family) {
    std::string names;
    for (const AnswerGroup& group : family) {
      const psychophysics::Count best{.successes = group.count.trials, .trials = group.count.trials};
      const double least = psychophysics::binomial_test(
          best, group.chance,
          group.one_sided ? psychophysics::Alternative::greater : psychophysics::Alternative::two_sided);
      if (least <= options_.level || group.tests_subjects) continue;
      names += fmt::format("{}{} ({})", names.empty() ? "" : ", ", group.name, group.count.trials);
    }
    if (!names.empty())
      show_not(fmt::format("anything of {} taken alone: with so few answers no outcome reaches {:.3g} %",
                           names, level_percent()));
  }

  void write_ranking(const TissueRanking& ranking) {
    const std::string tissue = ranking.tissue.empty() ? "" : fmt::format("of {}: ", ranking.tissue);
    if (!ranking.bradley_terry) {
      warn(fmt::format("{}no ranking: {}", tissue, ranking.note));
      return;
    }
    for (const RankedPair& pair : ranking.pairs) {
      if (!is_alarm(pair.p_adjusted)) continue;
      const bool first = pair.difference.value > 0.0;
      // Not as the first word, which has a capital letter: "a" and "A" are two samples.
      show(fmt::format("{}preferred is {} to {} (worth apart {:.2f}, {} after correction over {} pairs)",
                       tissue, analysis_.samples[ranking.samples[first ? pair.first : pair.second]],
                       analysis_.samples[ranking.samples[first ? pair.second : pair.first]],
                       std::abs(pair.difference.value), p_text(pair.p_adjusted), ranking.pairs.size()));
    }
    if (is_alarm(ranking.bradley_terry->deviance_p))
      warn(
          fmt::format("{}one scale does not describe the answers ({}): what is preferred depends on the pair",
                      tissue, p_text(ranking.bradley_terry->deviance_p)));
  }

  void write_people(const LevelAnalysis& levels, const PeopleFit& people) {
    const double confidence = options_.confidence;
    show(fmt::format(
        "the JND of people is {} {} ({:.3g} % {}, mixed model of {} subjects, who differ by a factor of "
        "{:.2f})",
        percent_text(people.jnd.mean),
        levels.two_sided ? "of the standard, half of 25 to 75 %"
                         : fmt::format("of the standard at {:.3g} % right",
                                       100.0 * options_.criterion.value_or(0.5 + 0.5 * levels.guess)),
        100.0 * confidence, percent_text(people.jnd.interval(confidence)), people.fit.subjects,
        std::exp(people.jnd.deviation)));
    if (people.equality)
      show(fmt::format("people feel equal strength at {} from the standard ({:.3g} % {}; they differ by {})",
                       percent_text(people.equality->mean), 100.0 * confidence,
                       percent_text(people.equality->interval(confidence)),
                       percent_text(people.equality->deviation)));
  }

  void write_levels(const LevelAnalysis& levels) {
    const LevelFit& pooled = levels.pooled;
    if (levels.people) {
      write_people(levels, *levels.people);
    } else {
      const char* whose = analysis_.subjects.size() > 1 ? "the JND over all answers is" : "the JND is";
      if (pooled.jnd)
        show(threshold_text(whose, *pooled.jnd, criterion_text(levels, *pooled.jnd).c_str(),
                            options_.confidence));
      if (pooled.equality)
        show(threshold_text("equal strength is felt at", *pooled.equality, "from the standard",
                            options_.confidence));
    }
    if (levels.across && !levels.people) {
      show(fmt::format(
          "the mean JND of the {} subjects is {} ({:.3g} % {}, Student): the one for people like them",
          levels.by_subject.size(), percent_text(levels.across->mean), 100.0 * options_.confidence,
          percent_text(levels.across->interval)));
    }
    const std::optional<bool> within = levels.people ? levels.people->jnd_within : pooled.jnd_within;
    if (within) {
      const std::string margins = fmt::format("the JND{} lies within {}", levels.people ? " of people" : "",
                                              percent_text(*options_.jnd_margins));
      if (*within) {
        show(margins);
      } else {
        show_not("that " + margins);
      }
    }
    if (pooled.jnd && is_adaptive(analysis_.design) && !pooled.by_posterior) {
      warn(
          "levels that follow the answers make the interval of the pooled JND too narrow; those of the "
          "subjects are not, nor that of their mean");
    }
    for (const std::string& note : pooled.notes) warn(note);
    for (const std::string& note : levels.notes) warn(note);
    if (pooled.fit && is_alarm(pooled.fit->overdispersion_p)) {
      warn(fmt::format(
          "subjects differ ({}, correlation of answers {:.2f}): what is said of people, or the mean over "
          "subjects, is to be reported, not the pooled JND",
          p_text(pooled.fit->overdispersion_p), pooled.fit->overdispersion));
    }
    const auto check = [&](const LevelFit& fit) {
      if (fit.bootstrap && is_alarm(fit.bootstrap->deviance_p))
        warn(fmt::format("{}: the curve does not describe the answers (deviance {:.1f}, {})", fit.name,
                         fit.fit->deviance, p_text(fit.bootstrap->deviance_p)));
    };
    if (levels.by_subject.empty()) check(pooled);
    for (const LevelFit& subject : levels.by_subject) check(subject);
    show_not("that the JND is the same for other motions, tissues or forces than those that were felt");
  }

  void write_ratings() {
    if (!analysis_.ratings) return;
    const RatingGroup& all = analysis_.ratings->all;
    if (all.area)
      show(fmt::format("the area below the ROC curve is {:.3f} ({:.3g} % {:.3f} to {:.3f})", all.area->value,
                       100.0 * options_.confidence, all.area->interval.lower, all.area->interval.upper));
    if (all.fit) {
      show(fmt::format(
          "d_a is {} ({:.3g} % {}), with a signal that varies {:.2f} times as much as what is not one "
          "(equal variances: {})",
          d_prime_text(all.fit->d_a), 100.0 * options_.confidence, d_prime_text(all.fit->d_a_interval),
          all.fit->deviation, p_text(*all.equal_variances_p)));
    } else if (!all.note.empty()) {
      warn(fmt::format("no curve of normal distributions: {}", all.note));
    }
    if (const auto& people = analysis_.ratings->over_subjects)
      show(fmt::format("the mean of the subjects' areas is {:.3f}, {} by flipped signs", 0.5 + people->mean,
                       p_text(people->p_greater)));
  }

  void write_subjects() {
    const SubjectSpread& spread = analysis_.spread;
    if (analysis_.subjects.size() < 2) {
      show_not("anything of people: it is one subject");
      return;
    }
    if (spread.population && !analysis_.levels) {
      const auto& population = *spread.population;
      const bool is_tested = analysis_.all && analysis_.all->tests_subjects;
      const double p = is_tested ? analysis_.p_value : population.p_value;
      const std::string mean =
          fmt::format("mean of the subjects {} ({:.3g} % {}, Student), {}{}", percent_text(population.mean),
                      100.0 * options_.confidence, percent_text(population.interval), p_text(p),
                      is_tested ? " by flipped signs" : "");
      if (is_alarm(p)) {
        show(fmt::format("it holds on the average for the people that the {} subjects stand for: {}",
                         spread.subjects, mean));
      } else {
        show_not(
            fmt::format("anything of the people that the {} subjects stand for: {}", spread.subjects, mean));
      }
    } else if (!spread.note.empty() && !analysis_.levels) {
      show_not(fmt::format("anything of people in general: {}", spread.note));
    }
    if (is_alarm(spread.equal.p) && !analysis_.levels) {
      warn(fmt::format(
          "subjects differ ({}): the pooled count hides it, its interval is too narrow for people, "
          "and those who notice stand beside those who do not; look at each subject",
          p_text(spread.equal.p)));
    } else if (is_preference()) {
      const std::string agreement =
          analysis_.by_subject.empty()
              ? std::string("whether the subjects agree is not tested among more than two samples")
              : fmt::format("that the subjects differ does not show ({}), which with few answers says little",
                            p_text(spread.equal.p));
      warn(fmt::format("{} answers of {} subjects are not as many independent ones; {}", analysis_.trials,
                       analysis_.subjects.size(), agreement));
    }
  }

  void write_bias() {
    const SlotBias& bias = analysis_.bias;
    if (!bias.note.empty()) {
      warn(fmt::format("no test of a response bias to one slot: {}", bias.note));
      return;
    }
    if (!is_alarm(bias.test.p)) return;
    std::string counts;
    for (std::size_t slot = 0; slot < bias.answers.size(); ++slot) {
      counts += fmt::format("{}{} {} times", counts.empty() ? "" : ", ",
                            answer_label_of(analysis_.design, slot), bias.answers[slot]);
    }
    if (has_two_rates(analysis_.design)) {
      warn(fmt::format(
          "one answer was given more readily than the other ({}; {}): d' is freed of it, the count of "
          "right answers is not",
          counts, p_text(bias.test.p)));
      return;
    }
    warn(fmt::format("the answers have a response bias to one slot ({}; {}){}", counts, p_text(bias.test.p),
                     is_preference() ? ": a preference is seen less clearly for it"
                                     : ": the count makes the difference look smaller than it is"));
  }

  void write_quality() {
    const AnswerQuality& quality = analysis_.quality;
    write_void();
    if (quality.unfelt == 0 && quality.faulty == 0) return;
    std::string what;
    if (quality.unfelt > 0)
      what = fmt::format("{} had a slot without a force that can be felt", quality.unfelt);
    if (quality.faulty > 0)
      what += fmt::format("{}{} a fault while a slot played", what.empty() ? "" : ", ", quality.faulty);
    warn(fmt::format("of {} trials {}: they are counted; without them {} are left, with {}", quality.known,
                     what, quality.without, p_text(quality.p_value)));
  }

  void write_void() {
    const AnswerQuality& quality = analysis_.quality;
    if (quality.voided == 0) return;
    std::string why;
    for (std::size_t reason = 0; reason < void_reasons; ++reason) {
      if (quality.by_reason[reason] == 0) continue;
      why += fmt::format("{}{} {}", why.empty() ? "" : ", ", name_of(static_cast<VoidReason>(reason)),
                         quality.by_reason[reason]);
    }
    warn(fmt::format("{} void by the protocol's rules ({}), not counted here; had they counted, {}",
                     quality.voided == 1 ? "a trial was" : fmt::format("{} trials were", quality.voided), why,
                     p_text(quality.p_with_void)));
  }

  void write_times() {
    if (analysis_.times.trials > 0 && analysis_.times.median_s < 0.5)
      warn(fmt::format("half of the answers came within {:.2f} s of when one could be given: hardly weighed",
                       analysis_.times.median_s));
  }

  Analysis& analysis_;
  const AnalysisOptions& options_;
};

}  // namespace

void add_findings(Analysis& analysis) { Findings(analysis).write(); }

}  // namespace kerf::bench
