// False alarms and power of studies that are looked at before their end: kerf_looks_study STUDIES prints a
// line of JSON a cell.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include <fmt/core.h>

#include <kerf/psychophysics/dprime.h>
#include <kerf/psychophysics/random.h>

#include "observers/simulated_looks.h"
#include "threads/for_each_index.h"

namespace {

using namespace kerf;
using namespace kerf::bench;
using psychophysics::Random;

constexpr int trials_each = 12;

/// Subjects whose logits of being right, or of preferring the first, are N(mean, sd).
Study drawn_study(Design design, std::size_t subjects, double mean, double sd, Random& random) {
  Study study{.name = "simulated", .design = design, .samples = {"first", "second"}};
  if (design == Design::abx)
    study.task = psychophysics::Task{.decision = psychophysics::Decision::abx_independent};
  for (std::size_t subject = 0; subject < subjects; ++subject) {
    const double p = 1.0 / (1.0 + std::exp(-mean - sd * random.normal()));
    for (std::size_t trial = 0; trial < trials_each; ++trial) {
      const std::size_t right = trial % 2;
      const bool is_right = random.chance(p) != (design == Design::preference);
      study.judgements.push_back({.subject = fmt::format("S{}", subject),
                                  .pair = {0, 1},
                                  .right = right,
                                  .answer = is_right ? right : 1 - right});
    }
  }
  return study;
}

Experiment planned(std::size_t subjects, const std::string& stopping) {
  return parse_experiment(
      fmt::format(
          "name = \"x\"\nprotocol = \"p\"\n[participants]\ntarget = {}\n[analysis]\nstopping = {{ {}, looks "
          "= [{}, {}] }}\n",
          subjects, stopping, subjects / 2, 3 * subjects / 4),
      "looks");
}

struct CellOfLooks {
  Design design = Design::abx;
  std::size_t subjects = 12;
  double mean = 0.0;
  double sd = 0.0;
};

void print_cell(const CellOfLooks& cell, const std::string& rule, const std::string& stopping, int studies) {
  const Experiment experiment = planned(cell.subjects, stopping);
  std::vector<Look> looks = planned_looks(experiment, cell.design == Design::preference);
  if (rule == "unpaid") {
    for (Look& look : looks) look.nominal = experiment.analysis.alpha;
  }
  AnalysisOptions options;
  options.truths.clear();
  std::vector<StudyCourse> courses(static_cast<std::size_t>(studies));
  for_each_index(courses.size(), std::max(1U, std::thread::hardware_concurrency()), [&](std::size_t i) {
    Random random(1000 + i);
    courses[i] = course_of(drawn_study(cell.design, cell.subjects, cell.mean, cell.sd, random), experiment,
                           looks, options);
  });
  int shown = 0;
  int none = 0;
  double participants = 0.0;
  for (const StudyCourse& course : courses) {
    shown += course.is_shown ? 1 : 0;
    none += course.is_none ? 1 : 0;
    participants += static_cast<double>(looks[course.look].participants.size()) / studies;
  }
  std::printf(
      "{\"design\": \"%s\", \"subjects\": %zu, \"mean\": %g, \"sd\": %g, \"rule\": \"%s\", \"shown\": %d, "
      "\"none\": "
      "%d, \"participants\": %.2f, \"studies\": %d}\n",
      std::string(name_of(cell.design)).c_str(), cell.subjects, cell.mean, cell.sd, rule.c_str(), shown, none,
      participants, studies);
  std::fflush(stdout);
}

}  // namespace

int main(int count, char** words) {
  const int studies = count > 1 ? std::atoi(words[1]) : 0;
  if (studies < 1) {
    std::fprintf(stderr, "usage: kerf_looks_study STUDIES\n");
    return 2;
  }
  const std::vector<std::pair<std::string, std::string>> rules{
      {"unpaid", "rule = \"alpha-spending\""},
      {"obrien-fleming", "rule = \"alpha-spending\", spending = \"obrien-fleming\""},
      {"pocock", "rule = \"alpha-spending\", spending = \"pocock\""},
      {"bayes-factor 10", "rule = \"bayes-factor\", evidence = 10"}};
  for (const auto& [rule, stopping] : rules) {
    for (const Design design : {Design::abx, Design::preference}) {
      for (const std::size_t subjects : {std::size_t{12}, std::size_t{24}}) {
        for (const double sd : {0.0, 1.0, 2.0})
          print_cell({.design = design, .subjects = subjects, .sd = sd}, rule, stopping, studies);
        print_cell({.design = design, .subjects = subjects, .mean = 0.5, .sd = 0.5}, rule, stopping, studies);
      }
    }
  }
  return 0;
}
