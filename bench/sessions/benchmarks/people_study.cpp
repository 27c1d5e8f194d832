// Simulated studies of people with a known truth: kerf_people_study
// alarms|equivalence|coverage|power|words|words-power STUDIES [CELL...] prints a line of JSON a cell (of
// those numbered, from 0); kerf_people_study oracle STUDIES the answers of studies with what was found of
// them.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <initializer_list>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include <kerf/psychophysics/comparisons.h>
#include <kerf/psychophysics/dprime.h>
#include <kerf/psychophysics/mixed_fit.h>
#include <kerf/psychophysics/psychometric.h>
#include <kerf/psychophysics/random.h>
#include <kerf/psychophysics/sign_flips.h>

#include "answers/analysis.h"
#include "answers/rankings.h"
#include "observers/observer.h"
#include "threads/for_each_index.h"

namespace {

using namespace kerf;
using namespace kerf::bench;
using psychophysics::Random;

double logistic(double x) { return 1.0 / (1.0 + std::exp(-x)); }

Study study_of_design(Design design) {
  Study study{.name = "simulated", .design = design, .samples = {"first", "second"}};
  if (design == Design::abx)
    study.task = psychophysics::Task{.decision = psychophysics::Decision::abx_independent};
  if (design == Design::two_interval) study.task = psychophysics::Task{};
  if (design == Design::three_interval) study.task = psychophysics::Task{.intervals = 3};
  return study;
}

void add_answer(Study& study, int subject, bool is_success, std::size_t trial) {
  const std::size_t right = trial % 2;
  const bool is_right = study.design == Design::preference ? !is_success : is_success;
  study.judgements.push_back({.subject = fmt::format("S{}", subject),
                              .pair = {0, 1},
                              .right = right,
                              .answer = is_right ? right : 1 - right});
}

/// The middle of logits whose logistic is `mean` on the average over N(middle, sd).
double middle_of(double mean, double sd) {
  double lower = -20.0;
  double upper = 20.0;
  for (int round = 0; round < 60; ++round) {
    const double middle = 0.5 * (lower + upper);
    double sum = 0.0;
    double weight = 0.0;
    for (double z = -6.0; z <= 6.0; z += 0.02) {
      sum += std::exp(-0.5 * z * z) * logistic(middle + sd * z);
      weight += std::exp(-0.5 * z * z);
    }
    (sum / weight < mean ? lower : upper) = middle;
  }
  return 0.5 * (lower + upper);
}

/// Subjects whose logits are N(middle, sd), so that their mean share is `mean`.
Study drawn_shares(Design design, int subjects, int trials, double middle, double sd, Random& random) {
  Study study = study_of_design(design);
  for (int subject = 0; subject < subjects; ++subject) {
    const double p = logistic(middle + sd * random.normal());
    for (int trial = 0; trial < trials; ++trial)
      add_answer(study, subject, random.chance(p), static_cast<std::size_t>(trial));
  }
  return study;
}

/// Subjects whose worths of `samples` samples are N(of each, sd).
Study drawn_ranking(int subjects, int trials, const std::vector<double>& worth, double sd, Random& random) {
  Study study = study_of_design(Design::preference);
  study.samples.clear();
  for (std::size_t i = 0; i < worth.size(); ++i) study.samples.push_back(fmt::format("law {}", i));
  for (int subject = 0; subject < subjects; ++subject) {
    std::vector<double> own = worth;
    for (double& each : own) each += sd * random.normal();
    for (std::size_t i = 0; i < own.size(); ++i) {
      for (std::size_t j = i + 1; j < own.size(); ++j) {
        for (int trial = 0; trial < trials; ++trial) {
          const bool first = random.chance(logistic(own[i] - own[j]));
          study.judgements.push_back({.subject = fmt::format("S{}", subject),
                                      .pair = {i, j},
                                      .right = 1,
                                      .answer = first ? 0U : 1U});
        }
      }
    }
  }
  return study;
}

/// The cells of a table in their order, of which only some may be wanted.
class Cells {
 public:
  explicit Cells(std::vector<int> wanted) : wanted_(std::move(wanted)) {}
  /// Whether the next one is.
  bool next() {
    const int number = count_++;
    return wanted_.empty() || std::ranges::find(wanted_, number) != wanted_.end();
  }

 private:
  std::vector<int> wanted_;
  int count_ = 0;
};

AnalysisOptions quick() { return {.truths = {}, .bootstrap = 0}; }

using Draw = std::function<Study(Random&)>;

/// How many of so many studies fulfil something.
int counted(int studies, std::uint64_t seed, const std::function<bool(Random&)>& holds) {
  std::vector<char> results(static_cast<std::size_t>(studies));
  for_each_index(results.size(), std::thread::hardware_concurrency(), [&](std::size_t i) {
    Random random(seed + 1'000'003 * (i + 1));
    results[i] = holds(random) ? 1 : 0;
  });
  int count = 0;
  for (const char each : results) count += each;
  return count;
}

struct Alarms {
  std::string design;
  double sd = 0.0;
  int subjects = 8;
  int trials = 12;
};

void print_alarms(const Alarms& cell, int studies, const Draw& draw) {
  const int over_people = counted(
      studies, 11, [&](Random& random) { return main_result(draw(random), quick()).p_value <= 0.05; });
  const int over_answers = counted(studies, 11, [&](Random& random) {
    const Study study = draw(random);
    std::vector<const Judgement*> all;
    for (const Judgement& each : study.judgements) all.push_back(&each);
    const auto rankings = rank_tissues(study, all, quick());
    if (!rankings.empty())
      return rankings.front().bradley_terry && rankings.front().bradley_terry->ratio_p <= 0.05;
    const AnswerGroup group = answer_group(study, all, "all", quick());
    return (group.one_sided ? group.p_greater : group.p_two_sided) <= 0.05;
  });
  std::printf(
      "{\"design\": \"%s\", \"sd\": %g, \"subjects\": %d, \"trials\": %d, \"studies\": %d, \"people\": %d, "
      "\"answers\": %d}\n",
      cell.design.c_str(), cell.sd, cell.subjects, cell.trials, studies, over_people, over_answers);
  std::fflush(stdout);
}

constexpr std::array designs{Design::preference, Design::abx, Design::two_interval, Design::three_interval};

void alarms(int studies, Cells& cells) {
  for (const Design design : designs) {
    for (const double sd : {0.0, 1.0, 2.0}) {
      const double middle = middle_of(design == Design::three_interval ? 1.0 / 3.0 : 0.5, sd);
      for (const int subjects : {8, 12, 24}) {
        if (!cells.next()) continue;
        print_alarms({std::string(name_of(design)), sd, subjects}, studies,
                     [=](Random& random) { return drawn_shares(design, subjects, 12, middle, sd, random); });
      }
    }
  }
  for (const std::size_t samples : {std::size_t{3}, std::size_t{5}}) {
    for (const double sd : {0.0, 1.0, 2.0}) {
      for (const int subjects : {8, 12, 24}) {
        if (!cells.next()) continue;
        print_alarms({fmt::format("preference among {}", samples), sd, subjects, 4}, studies,
                     [=](Random& random) {
                       return drawn_ranking(subjects, 4, std::vector<double>(samples, 0.0), sd, random);
                     });
      }
    }
  }
}

/// Some hear at a d', the others guess; "d' below a bound" is said of them.
void equivalence(int studies, Cells& cells) {
  const psychophysics::Task abx{.decision = psychophysics::Decision::abx_independent};
  struct Cell {
    int subjects, hearing;
    double d_prime, bound;
    int trials;
  };
  for (const Cell& cell : {Cell{12, 1, 3.0, 1.0, 12},
                           {12, 1, 3.0, 1.0, 24},
                           {12, 1, 3.0, 1.0, 48},
                           {12, 3, 2.5, 1.0, 24},
                           {24, 1, 3.0, 1.0, 24},
                           {24, 2, 3.0, 1.0, 24},
                           {12, 12, 1.0, 1.0, 24},
                           {12, 0, 0.0, 1.0, 24},
                           {12, 0, 0.0, 1.0, 48},
                           {24, 0, 0.0, 1.0, 48}}) {
    if (!cells.next()) continue;
    const double heard = psychophysics::proportion_correct(abx, cell.d_prime);
    const auto draw = [&](Random& random) {
      Study study = study_of_design(Design::abx);
      for (int subject = 0; subject < cell.subjects; ++subject) {
        for (int trial = 0; trial < cell.trials; ++trial)
          add_answer(study, subject, random.chance(subject < cell.hearing ? heard : 0.5),
                     static_cast<std::size_t>(trial));
      }
      return study;
    };
    AnalysisOptions options = quick();
    options.d_prime_bound = cell.bound;
    const int shown = counted(
        studies, 12, [&](Random& random) { return main_result(draw(random), options).equivalent == true; });
    const int pooled = counted(studies, 12, [&](Random& random) {
      const Study study = draw(random);
      psychophysics::Count count{.successes = 0, .trials = static_cast<int>(study.judgements.size())};
      for (const Judgement& each : study.judgements) count.successes += each.is_right() ? 1 : 0;
      return psychophysics::below_d_prime(abx, count, cell.bound).is_shown;
    });
    std::printf(
        "{\"subjects\": %d, \"hearing\": %d, \"d_prime\": %g, \"bound\": %g, \"trials\": %d, \"studies\": "
        "%d, "
        "\"people\": %d, \"answers\": %d}\n",
        cell.subjects, cell.hearing, cell.d_prime, cell.bound, cell.trials, studies, shown, pooled);
    std::fflush(stdout);
  }
}

/// Levels of a standard of 1, answered by subjects with curves of their own.
struct LevelTruth {
  bool two_sided = true;
  int subjects = 8;
  int trials = 12;  ///< a level
  double sd = 0.0;  ///< of a PSE in half JNDs, of ln(JND) in quarters
  double jnd = 0.1;
  double pse = 0.03;
  double lapse = 0.02;
};

Study drawn_levels(const LevelTruth& truth, Random& random) {
  Study study = study_of_design(Design::constant);
  study.design = Design::constant;
  study.task = psychophysics::Task{};
  study.scale.shape = truth.two_sided ? psychophysics::Shape::gaussian : psychophysics::Shape::weibull;
  study.scale.levels = truth.two_sided ? std::vector<double>{-0.4, -0.3, -0.2, -0.1, 0.0, 0.1, 0.2, 0.3, 0.4}
                                       : std::vector<double>{0.025, 0.05, 0.1, 0.2, 0.4, 0.8};
  using psychophysics::Axis;
  using psychophysics::Psychometric;
  for (int subject = 0; subject < truth.subjects; ++subject) {
    const double pse = truth.pse + 0.5 * truth.sd * truth.jnd * random.normal();
    const double jnd = truth.jnd * std::exp(0.25 * truth.sd * random.normal());
    const double weibull_slope = 2.0 * std::exp(0.125 * truth.sd * random.normal());
    Psychometric curve{.shape = study.scale.shape, .lapse = truth.lapse};
    if (truth.two_sided) {
      curve.axis = Axis::linear;
      curve.threshold = pse;
      curve.slope = 0.6744897501960817 / jnd;  // half the way from 25 to 75 %
      curve.guess = truth.lapse;
    } else {
      curve.slope = weibull_slope;
      curve.threshold = jnd / curve.intensity_at(0.75);  // of a threshold of 1
    }
    for (const double level : study.scale.levels) {
      const double p = curve.probability(level);
      for (int trial = 0; trial < truth.trials; ++trial) {
        const auto right = static_cast<std::size_t>(trial % 2);
        study.judgements.push_back({.subject = fmt::format("S{}", subject),
                                    .pair = {0, 0},
                                    .level = level,
                                    .right = right,
                                    .answer = random.chance(p) ? right : 1 - right});
      }
    }
  }
  return study;
}

void coverage(int studies, Cells& cells) {
  for (const bool two_sided : {true, false}) {
    for (const double sd : {0.0, 1.0, 2.0}) {
      for (const int subjects : {8, 12, 24}) {
        if (!cells.next()) continue;
        const LevelTruth truth{
            .two_sided = two_sided, .subjects = subjects, .trials = two_sided ? 12 : 20, .sd = sd};
        std::vector<MainResult> results(static_cast<std::size_t>(studies));
        for_each_index(results.size(), std::thread::hardware_concurrency(), [&](std::size_t i) {
          Random random(13 + 1'000'003 * (i + 1));
          results[i] = main_result(drawn_levels(truth, random), quick());
        });
        int told = 0;
        int jnd = 0;
        int pse = 0;
        for (const MainResult& each : results) {
          told += std::isfinite(each.jnd) ? 1 : 0;
          jnd += each.jnd_interval.lower <= truth.jnd && truth.jnd <= each.jnd_interval.upper ? 1 : 0;
          pse +=
              each.equality_interval.lower <= truth.pse && truth.pse <= each.equality_interval.upper ? 1 : 0;
        }
        std::printf(
            "{\"design\": \"%s\", \"sd\": %g, \"subjects\": %d, \"trials\": %d, \"studies\": %d, \"told\": "
            "%d, "
            "\"jnd\": %d, \"pse\": %d}\n",
            two_sided ? "levels on both sides" : "levels on one side", sd, subjects, truth.trials, studies,
            told, jnd, two_sided ? pse : -1);
        std::fflush(stdout);
      }
    }
  }
}

void power(int studies, Cells& cells) {
  for (const double effect : {0.25, 0.5, 1.0}) {
    for (const double sd : {0.0, 1.0}) {
      for (const int subjects : {8, 12, 24}) {
        if (!cells.next()) continue;
        const int found = counted(studies, 14, [&](Random& random) {
          return main_result(drawn_shares(Design::two_interval, subjects, 12, effect, sd, random), quick())
                     .p_value <= 0.05;
        });
        std::printf(
            "{\"effect\": %g, \"sd\": %g, \"subjects\": %d, \"trials\": 12, \"studies\": %d, \"people\": "
            "%d}\n",
            effect, sd, subjects, studies, found);
        std::fflush(stdout);
      }
    }
  }
}

/// People who say same or different, by the likelihood ratio.
struct WordsTruth {
  double d_prime = 0.0;
  double bias = 0.0;  ///< to "same", Observer::bias
  double sd = 0.0;    ///< between people: of the logit of being right
  int subjects = 8;
  int trials = 48;  ///< of each, half of them different
};

/// Of each person e of N(0, sd) makes "different" likelier where it is right and less likely where it is not:
///     logit H = logit H(d', bias) + e,   logit F = logit F(d', bias) - e,
/// so that without d' the share of right answers has a mean of 1/2, whatever the leaning.
Study drawn_words(const WordsTruth& truth, double logit_hit, double logit_alarm, Random& random) {
  // Without its task: the test is the same, and no d' is told, which takes a hundred times as long.
  Study study = study_of_design(Design::same_different);
  for (int subject = 0; subject < truth.subjects; ++subject) {
    const double own = truth.sd * random.normal();
    const double hit = logistic(logit_hit + own);
    const double alarm = logistic(logit_alarm - own);
    for (int trial = 0; trial < truth.trials; ++trial) {
      const auto right = static_cast<std::size_t>(trial % 2);
      study.judgements.push_back({.subject = fmt::format("S{}", subject),
                                  .pair = {0, 1},
                                  .right = right,
                                  .answer = random.chance(right == 1 ? hit : alarm) ? 1U : 0U});
    }
  }
  return study;
}

void print_words(const WordsTruth& truth, int studies) {
  const auto logit_different = [&](std::uint8_t second) {
    const Observer observer{.bias = truth.bias};
    const FeltTrial trial{
        .judging = Judging::same_by_likelihood, .plays = {0, second, 0}, .d_prime = truth.d_prime};
    const double p = answer_probability(observer, trial, 1);
    return std::log(p / (1.0 - p));
  };
  const double hit = logit_different(1);
  const double alarm = logit_different(0);
  const int found = counted(studies, 16, [&](Random& random) {
    return main_result(drawn_words(truth, hit, alarm, random), quick()).p_value <= 0.05;
  });
  std::printf(
      "{\"d_prime\": %g, \"bias\": %g, \"sd\": %g, \"subjects\": %d, \"trials\": %d, \"hit\": %.6g, "
      "\"false_alarm\": %.6g, \"studies\": %d, \"people\": %d}\n",
      truth.d_prime, truth.bias, truth.sd, truth.subjects, truth.trials, logistic(hit), logistic(alarm),
      studies, found);
  std::fflush(stdout);
}

void same_different(std::initializer_list<double> d_primes, int studies, Cells& cells) {
  for (const double d_prime : d_primes) {
    for (const double bias : {0.0, 0.5}) {
      for (const double sd : {0.0, 1.0, 2.0}) {
        for (const int subjects : {8, 12, 24}) {
          if (cells.next())
            print_words({.d_prime = d_prime, .bias = bias, .sd = sd, .subjects = subjects}, studies);
        }
      }
    }
  }
}

void print_array(const char* name, const std::vector<double>& values) {
  std::printf("\"%s\": [", name);
  for (std::size_t i = 0; i < values.size(); ++i) std::printf("%s%.17g", i == 0 ? "" : ", ", values[i]);
  std::printf("]");
}

void print_mixed(psychophysics::Shape shape, Random& random) {
  std::vector<std::vector<psychophysics::Level>> subjects;
  std::vector<double> rows;
  for (int subject = 0; subject < 10; ++subject) {
    const double pse = 0.02 + 0.1 * random.normal();
    std::vector<psychophysics::Level>& levels = subjects.emplace_back();
    for (const double level : {-0.3, -0.2, -0.1, 0.0, 0.1, 0.2, 0.3}) {
      const int k = random.successes(16, logistic(14.0 * (level - pse)));
      levels.push_back({.intensity = level, .answers = {.successes = k, .trials = 16}});
      rows.insert(rows.end(), {static_cast<double>(subject), level, static_cast<double>(k), 16.0 - k});
    }
  }
  const psychophysics::MixedFit fit = psychophysics::fit_mixed(subjects, {.shape = shape,
                                                                          .axis = psychophysics::Axis::linear,
                                                                          .two_sided = true,
                                                                          .lapse = 0.0,
                                                                          .criterion = 0.5,
                                                                          .slopes_differ = false});
  std::printf("{\"kind\": \"mixed\", \"link\": \"%s\", ",
              shape == psychophysics::Shape::logistic ? "logit" : "probit");
  print_array("rows", rows);
  std::printf(", \"threshold\": %.17g, \"slope\": %.17g, \"deviation\": %.17g, \"log_likelihood\": %.17g}\n",
              fit.threshold.mean, fit.slope.mean, fit.threshold.deviation, fit.log_likelihood);
}

void print_flips(Random& random) {
  std::vector<double> values;
  for (int i = 0; i < 12; ++i) values.push_back(0.3 + random.normal());
  const psychophysics::SignFlips flips = psychophysics::flip_signs(values);
  std::printf("{\"kind\": \"flips\", ");
  print_array("values", values);
  std::printf(", \"p_greater\": %.17g, \"p_two_sided\": %.17g}\n", flips.p_greater, flips.p_two_sided);
}

void print_ranking(Random& random) {
  std::vector<psychophysics::Wins> subjects;
  std::vector<double> rows;
  for (int subject = 0; subject < 9; ++subject) {
    std::vector<double> worth;
    for (const double mean : {0.6, 0.2, -0.2, -0.6}) worth.push_back(mean + 0.7 * random.normal());
    psychophysics::Wins& wins = subjects.emplace_back(4, std::vector<int>(4, 0));
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = i + 1; j < 4; ++j) {
        wins[i][j] = random.successes(6, logistic(worth[i] - worth[j]));
        wins[j][i] = 6 - wins[i][j];
        rows.insert(rows.end(), {static_cast<double>(subject), static_cast<double>(i), static_cast<double>(j),
                                 static_cast<double>(wins[i][j]), static_cast<double>(wins[j][i])});
      }
    }
  }
  const psychophysics::SubjectsRanking ranking = psychophysics::rank_over_subjects(subjects);
  std::printf("{\"kind\": \"ranking\", ");
  print_array("rows", rows);
  std::vector<double> differences;
  std::vector<double> errors;
  for (std::size_t i = 1; i < 4; ++i) {
    const psychophysics::Difference found = psychophysics::difference(ranking, i, 0);
    differences.push_back(found.value);
    errors.push_back(found.standard_error);
  }
  std::printf(", ");
  print_array("differences", differences);
  std::printf(", ");
  print_array("errors", errors);
  std::printf(", \"p\": %.17g}\n", ranking.p);
}

void oracle(int studies) {
  Random random(15);
  for (int study = 0; study < studies; ++study) {
    print_mixed(study % 2 == 0 ? psychophysics::Shape::gaussian : psychophysics::Shape::logistic, random);
    print_flips(random);
    print_ranking(random);
  }
}

}  // namespace

int main(int count, char** words) {
  const std::string what = count > 1 ? words[1] : "";
  const int studies = count > 2 ? std::atoi(words[2]) : 0;
  if (studies < 1) {
    std::fprintf(stderr,
                 "usage: kerf_people_study alarms|equivalence|coverage|power|words|words-power|oracle "
                 "STUDIES [CELL...]\n");
    return 2;
  }
  std::vector<int> wanted;
  for (int i = 3; i < count; ++i) wanted.push_back(std::atoi(words[i]));
  Cells cells(wanted);
  if (what == "alarms") alarms(studies, cells);
  if (what == "equivalence") equivalence(studies, cells);
  if (what == "coverage") coverage(studies, cells);
  if (what == "power") power(studies, cells);
  if (what == "words") same_different({0.0}, studies, cells);
  if (what == "words-power") same_different({0.5, 1.0, 1.5}, studies, cells);
  if (what == "oracle") oracle(studies);
  return 0;
}
