#include "study/swept_verbs.h"

#include <vector>

namespace kerf::bench {

SweepVerbs swept_verbs() {
  static const std::vector<const SweepVerb*> all = [] {
    std::vector<const SweepVerb*> verbs(sweep_verbs().begin(), sweep_verbs().end());
    verbs.push_back(&sweep_of_simulations);
    return verbs;
  }();
  return all;
}

}  // namespace kerf::bench
