#pragma once

#include <string>
#include <vector>

#include <kerf/compare/compare.h>
#include <kerf/compare/diagnose.h>
#include <kerf/schema/regression.h>

#include "laws/sampled_motion.h"
#include "regress/forces.h"
#include "regress/suite.h"

namespace kerf::bench {

using compare::ChannelComparison;
using compare::ForceDifference;
using ForceComparison = compare::Comparison;

/// Stored and rendered forces as what is compared. What they were rendered for stands beside them if it is
/// given.
[[nodiscard]] compare::Series series_of(const schema::StoredForces& stored, double period_s = 1e-3);
[[nodiscard]] compare::Series series_of(const RenderedForces& got, double period_s = 1e-3);
/// Adds the positions and velocities of as many axes as there are channels, if there are as many ticks.
void add_motion(compare::Series& series, const SampledMotion& motion);

/// Compares forces with the stored ones, tick by tick and channel by channel, as
/// compare::compare_with_gaps(). A law that faults in more or fewer ticks than it did does not pass either.
[[nodiscard]] ForceComparison compare_forces(const schema::StoredForces& stored, const RenderedForces& got,
                                             const Tolerance& tolerance, double period_s = 1e-3);

/// The channel of the largest difference in JNDs; none without channels.
[[nodiscard]] const ChannelComparison* farthest_channel(const ForceComparison& comparison);
/// Its largest difference, "4 N"; "none" of forces that do not differ.
[[nodiscard]] std::string largest_in_words(const ForceComparison& comparison);

/// What the difference looks like: compare::diagnose(). `path`: what the forces
/// were rendered for now, and were then, unless the facts say that it has changed.
[[nodiscard]] compare::Diagnosis diagnose(const schema::StoredForces& stored, const RenderedForces& got,
                                          const SampledMotion& path = {}, const compare::Facts& facts = {});
/// The same, one sentence each.
[[nodiscard]] std::vector<std::string> sentences_of(const compare::Diagnosis& diagnosis,
                                                    const schema::StoredForces& stored);

}  // namespace kerf::bench
