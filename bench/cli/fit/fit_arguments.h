#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "fits/asked_fit.h"
#include "program/verbs.h"

namespace kerf::bench {

/// What `kerf fit` is asked for.
struct FitArguments : AskedFit {
  std::vector<std::string> recordings;
  std::string batch;
  std::size_t jobs = 0;  ///< 0: one a processor
  std::string output;
  bool force = false;
  RefuseIdle refuse_idle;
};

void add_fit_options(Verb& verb, FitArguments& arguments);

/// @throws std::invalid_argument for options that exclude each other, say nothing, or that no law has.
void check(const FitArguments& arguments);

}  // namespace kerf::bench
