#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <kerf/psychophysics/binomial.h>

#include "answers/analysis.h"
#include "observers/simulated_truth.h"
#include "registered/looks.h"

// What a design can find, and whether its analysis keeps its promises: docs/sessions.md.

namespace kerf::bench {

struct SimulationOptions {
  Observer observer;
  SensationOptions sensation;
  AnalysisOptions analysis;
  std::size_t experiments = 1000;
  std::size_t subjects = 1;
  std::size_t visits = 1;                ///< sessions of each
  std::optional<Experiment> experiment;  ///< whose stopping rule is tried too
  /// Who has a smaller share of right catch trials is not analysed; none: everybody is.
  std::optional<double> catch_right;
  double power = 0.8;            ///< wanted
  std::size_t curve_points = 8;  ///< numbers of trials of the power curve; 0: none
  /// At each of them; 0: as many as `experiments`, of designs with levels, which take longer, a fifth of it.
  std::size_t curve_experiments = 0;
  double answer_s = 2.0;  ///< that a subject takes to answer
  std::size_t jobs = 1;   ///< threads; the result does not depend on them
  std::uint64_t seed = 1;
};

/// So many experiments of all, with the interval of Clopper and Pearson.
struct SimulatedShare {
  psychophysics::Count count;
  [[nodiscard]] double value() const noexcept;  ///< NaN of none
  [[nodiscard]] psychophysics::Interval interval() const;
};

/// What many experiments of one design found.
struct SimulatedFindings {
  SimulatedShare significant;  ///< of those with a main test: p < level
  SimulatedShare equivalent;   ///< shown that the difference is below its bound
  SimulatedShare jnd_found;    ///< a JND could be told
  SimulatedShare jnd_bounded;  ///< and its interval is closed at both ends
  SimulatedShare jnd_covered;  ///< of the JNDs told, the interval holds the true one
  SimulatedShare d_prime_covered;
  SimulatedShare exponent_covered;  ///< of those told, the interval holds the mean of people
  double exponent_mean = std::numeric_limits<double>::quiet_NaN();  ///< of the estimates
  double jnd_bias =
      std::numeric_limits<double>::quiet_NaN();  ///< geometric mean of estimate over truth, less 1
  double jnd_spread = std::numeric_limits<double>::quiet_NaN();  ///< standard deviation of ln(estimate)
  /// Median of upper over lower end, of all told; infinite where most are open.
  double jnd_ratio = std::numeric_limits<double>::quiet_NaN();
  double d_prime_median = std::numeric_limits<double>::quiet_NaN();
  double trials = 0.0;             ///< mean, of all subjects, without practice
  std::vector<std::string> notes;  ///< why there was no JND, each with how often, the most frequent first
};

/// Of a design with another number of trials.
struct PowerPoint {
  std::size_t trials = 0;  ///< of each pair or level; of a staircase its reversals
  double total = 0.0;      ///< mean number of trials that count, of all subjects
  double theory = std::numeric_limits<double>::quiet_NaN();  ///< power by the exact probability
  SimulatedFindings found;
};

/// How a rule of exclusion by catch trials tells who attends from who does not.
struct SimulatedCatches {
  double least_share = 0.8;  ///< of right catch trials
  double trials = 0.0;       ///< mean number of catch trials of a subject
  double attentive_right = std::numeric_limits<double>::quiet_NaN();  ///< share of their catch trials
  double inattentive_right = std::numeric_limits<double>::quiet_NaN();
  SimulatedShare attentive_out;  ///< of those who attend, who would be excluded
  SimulatedShare inattentive_out;
};

/// What studies came to that were looked at as their experiment plans.
struct LookedAt {
  SimulatedShare shown;               ///< the registered hypothesis, at one of the looks
  SimulatedShare none;                ///< a Bayes factor said that there is no difference
  std::vector<SimulatedShare> ended;  ///< at each look
  double participants = 0.0;          ///< mean number when they ended
};

struct SimulatedLooks {
  std::vector<Look> looks;
  LookedAt found;    ///< with the observers of the simulation
  LookedAt nothing;  ///< with observers who feel no difference
};

/// What became of the trials of one session on the average, practice included, where some are void.
struct SimulatedVoid {
  double given = 0.0;
  double slipped = 0.0;
  double unexplored = 0.0;
  double again = 0.0;
  double lost = 0.0;
};

struct Simulation {
  SimulationOptions options;
  std::string name;
  Design design = Design::preference;
  std::string device_uri;  ///< empty: open loop
  bool by_strength = false;
  double scatter = 0.0;  ///< of the rendered levels about their curve, in JNDs
  std::vector<FeltSample> samples;
  SimulatedTruth truth;
  SimulatedFindings found;
  double theory = std::numeric_limits<double>::quiet_NaN();  ///< power by the exact probability
  double mean_session_s = 0.0;          ///< of one subject: presentations, answers, breaks; practice included
  std::optional<SimulatedVoid> voided;  ///< with observers who slip or explore too little
  SimulatedShare false_alarms;          ///< of observers who feel no difference
  std::optional<SimulatedCatches> catches;  ///< where the protocol has catch trials
  std::optional<SimulatedLooks> looks;      ///< of an experiment that is looked at before its end
  std::vector<PowerPoint> curve;
  std::size_t curve_experiments = 0;    ///< at each point of the curve
  std::string curve_of;                 ///< what is counted: "trials of each pair"
  std::size_t needed_total = 0;         ///< answers for the power wanted, by theory; 0: not known
  std::optional<PowerPoint> confirmed;  ///< the design with that many
  std::optional<Study> example;         ///< the first of the experiments
  std::optional<LevelAnalysis> example_fit;
  std::vector<CellTruth> curve_truth;  ///< the psychometric function, at all levels rendered
};

/// @throws std::invalid_argument, drivers::DeviceError. `done` counts experiments, of
/// simulated_experiments().
[[nodiscard]] Simulation simulate(const Protocol& protocol, const SimulationOptions& options,
                                  std::atomic<std::size_t>& done);
/// How many experiments a simulation takes at most.
[[nodiscard]] std::size_t simulated_experiments(const Protocol& protocol,
                                                const SimulationOptions& options) noexcept;

}  // namespace kerf::bench
