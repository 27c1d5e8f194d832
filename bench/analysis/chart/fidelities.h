#pragma once

#include <string>
#include <vector>

#include "laws/law_file.h"

namespace kerf::bench {

/// One way to compute a law: how finely, by which integrator, in which precision, at which rate.
struct Fidelity {
  std::string label;  ///< "strips 8", "euler, 250 Hz"; "as given" where there is nothing to choose
  LawFile law;
  double rate_hz = 0.0;  ///< of the loop that renders it
};

/// A fidelity with more or fewer elements than the law has as given.
struct RefinedLaw {
  double factor = 1.0;  ///< times the elements a side
  Fidelity fidelity;
};

/// The ways to compute one law, and the one that all of them are judged by.
struct Fidelities {
  std::vector<Fidelity> all;
  Fidelity reference;
  std::vector<RefinedLaw> refinements{};  ///< from the law as given to the reference, by factor; empty: exact
  std::vector<std::string> notes;         ///< what could not be made, and why
};

/// How many times the loop's rate the reference is computed at, where a law depends on the rate at all.
inline constexpr double reference_rate_factor = 16.0;

/// The fidelities of a law at a rate of the loop, by what its facts call finer:
///
///     strips       paper and strips, 1 to 64 a polygon, and exact; judged by exact
///     nodes        half the nodes, as given, twice the nodes a side, and the sub-steps of its stiffest
///                  spring, half and a quarter of them; judged by four times the nodes
///     integrators  exact, semi-implicit and Euler; the latter two also at 250, 500, 1000 and 4000 Hz;
///                  judged by exact at 16 times the rate
///     segments     as given, and with 1 to 12 segments by least squares; judged by itself
///     points       as given, and resampled to 2, 4, ... 256 points; judged by itself
///     memberships  as given, and with 2 to 5 memberships an input trained on it; judged by itself
///     projections  consistent and paper; judged by consistent at 16 times the rate
///     nothing      as given, judged by itself at 16 times the rate
///
/// Laws that can be single are also computed singly, as given.
///
/// A lattice of other spacing is the same slab of the same tissue: a spring of a plane has one stiffness
/// whatever the spacing h, a node's mass and damping go with h^2, and an element breaks at one strain.
[[nodiscard]] Fidelities fidelities_of(const LawFile& law, double rate_hz);

/// A law file with other options, values as they are. @throws std::invalid_argument.
[[nodiscard]] LawFile with_options(const LawFile& law, const models::Options& changes);

/// A law file with another law in it.
[[nodiscard]] LawFile with_law(const LawFile& file, models::Law law);

/// A segmented law with 1 to `most` segments that follow its curve, or its loop, by least squares.
[[nodiscard]] std::vector<Fidelity> resampled_segments(const LawFile& piecewise, std::size_t most,
                                                       double rate_hz);
/// A table with 2, 4, ... up to `most` points taken from it.
[[nodiscard]] std::vector<Fidelity> resampled_tables(const LawFile& recording, std::size_t most,
                                                     double rate_hz);
/// A fuzzy law with 2 to 5 memberships an input, its rupture threshold trained on that of the law given.
void add_memberships(const LawFile& fuzzy, double rate_hz, Fidelities& to);

}  // namespace kerf::bench
