// Simulated studies of people with a known truth: kerf_people_study
// alarms|equivalence|coverage|power|words|words-power STUDIES [CELL...] prints a line of JSON a cell (of
// those numbered, from 0); kerf_people_study oracle STUDIES the answers of studies with what was found of
// them.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <initializer_list>
#include <string>
#include <thread>
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
#include "simulated_studies.h"
#include "threads/for_each_index.h"

namespace {

using namespace kerf;
using namespace kerf::bench;
using namespace kerf::bench::simulated;

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

void alarms(int studies, WantedCells& cells) {
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
void equivalence(int studies, WantedCells& cells) {
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

void coverage(int studies, WantedCells& cells) {
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

void power(int studies, WantedCells& cells) {
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

void same_different(std::initializer_list<double> d_primes, int studies, WantedCells& cells) {
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
  WantedCells cells(wanted);
  if (what == "alarms") alarms(studies, cells);
  if (what == "equivalence") equivalence(studies, cells);
  if (what == "coverage") coverage(studies, cells);
  if (what == "power") power(studies, cells);
  if (what == "words") same_different({0.0}, studies, cells);
  if (what == "words-power") same_different({0.5, 1.0, 1.5}, studies, cells);
  if (what == "oracle") oracle(studies);
  return 0;
}
