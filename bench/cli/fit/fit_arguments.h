#pragma once

#include <optional>
#include <string>
#include <vector>

#include <kerf/schema/recording.h>

#include "fits/fit_recording.h"
#include "program/contact_arguments.h"
#include "program/jnd_arguments.h"
#include "program/verbs.h"

namespace kerf::bench {

/// What `kerf fit` is asked for.
struct FitArguments {
  std::vector<std::string> recordings;
  std::string batch;
  std::size_t jobs = 0;  ///< 0: one a processor
  std::string output;
  bool force = false;

  std::string axis;
  ContactArguments contact;
  std::vector<double> noise;
  JndArguments jnd;
  std::string rows = "contact";
  std::string cycles = "good";

  std::string segments = "5";
  std::vector<std::string> breakpoints;
  std::size_t arms = 0;  ///< 0: as many as held-out data pay for
  std::size_t memberships = 0;
  std::optional<double> thickness;

  bool no_folds = false;
  std::string loss = "squares";
  FitRecordingOptions options;  ///< what of the above stands as it is
};

void add_fit_options(Verb& verb, FitArguments& arguments);

/// @throws std::invalid_argument for options that exclude each other, or that no law has.
void check(const FitArguments& arguments);

/// A recording with the axis, contact and noise that were asked for; `place` among the recordings.
[[nodiscard]] FitSource source_of(const FitArguments& arguments, const schema::Recording& recording,
                                  const std::string& name, std::size_t place = 0);

/// How to fit; breakpoints are turned to penetrations with the source's axis and contact.
[[nodiscard]] FitRecordingOptions options_of(const FitArguments& arguments, const FitSource& source);

}  // namespace kerf::bench
