#pragma once

#include <string>

#include <kerf/schema/regression.h>

/// Names of `kerf.regression` that its reader, its writer and its validator share.
namespace kerf::schema {

inline const std::string group_of_cases = "/cases";
inline const std::string group_of_trajectories = "/trajectories";  ///< each under its SHA-256

/// The texts of a case, under the names that they have in the file.
struct CaseText {
  const char* name;
  std::string StoredForces::*member;
};
inline constexpr CaseText texts_of_a_case[] = {{"model", &StoredForces::model},
                                               {"law_sha256", &StoredForces::law_sha256},
                                               {"trajectory_sha256", &StoredForces::trajectory_sha256},
                                               {"reason", &StoredForces::reason},
                                               {"date", &StoredForces::date},
                                               {"software", &StoredForces::software},
                                               {"history", &StoredForces::history}};

}  // namespace kerf::schema
