#include <cmath>

#include <gtest/gtest.h>

#include <kerf/population/group.h>

#include "metafor_values.h"

namespace kerf::population {
namespace {

std::vector<Estimate> estimates_of(const PeerValues& peer) {
  std::vector<Estimate> estimates;
  for (const Recorded& one : peer.recordings) {
    Estimate estimate{.value = one.value, .standard_error = {}, .specimen = std::to_string(one.specimen)};
    if (one.error > 0.0) estimate.standard_error = one.error;
    estimates.push_back(estimate);
  }
  return estimates;
}

TEST(GroupBesidePeers, AgreesWithMetaforAndNlme) {
  for (const PeerValues& peer : peer_values()) {
    SCOPED_TRACE(peer.name);
    const GroupEstimate group = estimate_group(estimates_of(peer));
    EXPECT_NEAR(*group.mean, peer.mean, 1e-6);
    EXPECT_NEAR(*group.standard_error, peer.standard_error, 1e-6);
    const Spread between = group.between_specimens ? *group.between_specimens : *group.together;
    EXPECT_NEAR(between.value * between.value, peer.between, 1e-6 * std::max(peer.between, 0.01));
    if (group.between_recordings) {
      EXPECT_NEAR(std::pow(group.between_recordings->value, 2), peer.within, 1e-6 * peer.within);
    }
    if (peer.between_upper == 0.0) continue;
    EXPECT_NEAR(between.interval->lower, peer.between_lower, 1e-6);
    EXPECT_NEAR(between.interval->upper, peer.between_upper, 1e-6);
  }
}

}  // namespace
}  // namespace kerf::population
