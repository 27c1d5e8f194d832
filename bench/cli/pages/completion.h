#pragma once

#include <string>
#include <vector>

#include "program/described.h"

namespace kerf::bench {

/// What a shell has to know besides the verbs.
struct CompletionWords {
  std::vector<std::string> laws;     ///< of the registry
  std::vector<std::string> devices;  ///< simulated ones; attached ones `kerf devices` tells when asked
};

/// Scripts that let a shell complete verbs, options and their values, for the folders of each shell.
[[nodiscard]] std::string bash_completion(const std::vector<DescribedVerb>& all,
                                          const CompletionWords& words);
[[nodiscard]] std::string zsh_completion(const std::vector<DescribedVerb>& all, const CompletionWords& words);
[[nodiscard]] std::string fish_completion(const std::vector<DescribedVerb>& all,
                                          const CompletionWords& words);

}  // namespace kerf::bench
