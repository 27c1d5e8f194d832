#pragma once

#include <string>

#include <kerf/schema/regression.h>

#include "regress/renderers/made_with.h"
#include "regress/suite.h"

namespace kerf::bench {

/// All that the forces of a case follow from: as long as none of it changes, they are the same bits. Kept
/// beside the forces, except for what cannot be seen.
struct CaseInputs {
  std::string law_sha256;         ///< of the law's file; of a renderer its command, its files, its axes
  std::string trajectory_sha256;  ///< of what it is rendered for, tick by tick
  std::string made_with;          ///< programs and plug-ins, as far as they are seen
  std::string software;           ///< Kerf itself, whose law it is; empty of a renderer
  std::string unseen;             ///< what else they follow from, and nothing is known of; empty: nothing
};

/// @throws as path_of() and made_with().
[[nodiscard]] CaseInputs inputs_of(const RegressionCase& one, AskedVersions& versions);

/// What is not as it was when forces were stored, or not known to be, in words; empty if nothing is.
[[nodiscard]] std::string changed_since(const CaseInputs& now, const schema::StoredForces& stored);

}  // namespace kerf::bench
