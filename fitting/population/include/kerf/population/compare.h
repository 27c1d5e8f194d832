#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <kerf/population/group.h>

namespace kerf::population {

/// What a permutation exchanges.
enum class Exchange {
  whole_specimens,  ///< nested: each specimen is in one group, and goes to the other with all its recordings
  recordings_in_specimen,  ///< crossed: recordings of one specimen, between its two groups
  groups_in_specimen,      ///< crossed: the two groups of a specimen as a whole (signs of differences)
  recordings,              ///< specimens are not known
};

struct PermutationTest {
  Exchange exchange = Exchange::whole_specimens;
  double p = 1.0;               ///< two-sided
  bool is_exact = true;         ///< every permutation was tried
  double standard_error = 0.0;  ///< of p, by the drawing; 0 if exact
  double least_p = 1.0;         ///< no data of this many units give a smaller one
};

struct CompareOptions {
  double level = 0.05;       ///< of the tests of a study together, between 0 and 1
  double confidence = 0.95;  ///< of each interval, between 0 and 1
  int draws = 9999;          ///< of a test with more permutations than `most_exact`
  int most_exact = 20000;
  std::uint64_t seed = 1;
  /// In a crossed design: recordings are exchanged (the null: in these specimens the factor does nothing), or
  /// whole groups (the null: over all specimens its effect is symmetric about 0; needs six specimens for p <
  /// 0.05).
  bool exchanges_recordings = true;
};

enum class Verdict {
  differ,  ///< p, corrected for all comparisons of the study, is at most the level, and where recordings
           ///< share something, that of the t of the interval is, too
  not_told_apart,  ///< it is not; `interval` says how large a difference is still possible
  cannot_be_told,  ///< with so few no data could have told them apart, or there is no data to compare
};

struct Comparison {
  Verdict verdict = Verdict::cannot_be_told;
  std::optional<PermutationTest> test;  ///< nothing if there is nothing to exchange
  double holm_p = 1.0;                  ///< p by Holm over all comparisons; 1 without a test
  double benjamini_hochberg_p = 1.0;    ///< beside it: of the share of false alarms
  double least_holm_p = 1.0;            ///< Holm's p if every test of the study came out as small as it can
  bool is_crossed = false;              ///< the same specimens in both groups
  std::size_t first_units = 0;          ///< specimens (recordings where they are not known) that counted
  std::size_t second_units = 0;
  std::size_t left_out = 0;  ///< recordings: no limit, not finite, or of a specimen that breaks the design

  std::optional<double> difference;  ///< first less second; of logarithms the logarithm of a ratio
  std::optional<double> standard_error;
  std::optional<Interval> interval;  ///< of the difference over all such specimens
  double degrees_of_freedom = 0.0;
  bool has_shared = false;                  ///< recordings share something
  std::optional<SharedError> shared_error;  ///< of the difference; it is in `standard_error` and `interval`
  /// Of the difference by its t, two-sided; takes specimens as normal, and so may be smaller than `test->p`
  /// can. The verdict asks it only where recordings share something, which no permutation knows of.
  std::optional<double> model_p;
  std::optional<double> holm_model_p;  ///< by Holm over all comparisons that have one
  /// Hedges' g [Hedges1981], over specimens: the difference in pooled standard deviations of specimens;
  /// crossed: in those of the specimens' differences. Nothing below two units a side, or without any spread.
  std::optional<double> hedges_g;
};

/// What recordings of one or of both groups share; both have the same number of parts.
struct SharedByGroups {
  Shared first;
  Shared second;
};

/// Two groups whose difference is asked for.
struct Pair {
  std::vector<Estimate> first;
  std::vector<Estimate> second;
  std::vector<SharedByGroups> shared{};
};

/// Whether groups differ: all comparisons of a study at once, because they are corrected for each other.
///
/// Nested (no specimen in both): the difference of `estimate_group`'s means, q_1 + q_2 its variance, t by
/// Welch and Satterthwaite [Welch1947], df = (q_1 + q_2)^2 / (q_1^2 / (n_1 - 1) + q_2^2 / (n_2 - 1)); the
/// test permutes specimens, by Welch's t of their means [ChungRomano2013]. Crossed (two or more specimens in
/// both): differences within each specimen, as a group of their own; the test permutes within specimens, by
/// t of their differences: exact where the factor does nothing, and near its level where specimens only react
/// unlike each other [ChungRomano2013]. Specimens in one group only are then left out; if only one is in
/// both, it is left out. p is the share of permutations no less extreme; drawn ones count with the data among
/// them [PhipsonSmyth2010].
[[nodiscard]] std::vector<Comparison> compare(std::span<const Pair> pairs,
                                              const CompareOptions& options = {});

/// "differ", "not told apart", "cannot be told".
[[nodiscard]] const char* name_of(Verdict verdict);

}  // namespace kerf::population
