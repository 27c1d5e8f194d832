#pragma once

#include <optional>
#include <string>

#include <kerf/fitting/fit.h>
#include <kerf/schema/recording.h>

#include "program/verb.h"

namespace kerf::bench {

/// A JND that the command line puts in place of what is known of forces and torques.
struct JndArguments {
  std::optional<double> weber_fraction;
  std::optional<double> threshold;
  std::string source;

  /// As given; what is not, that of the axis (fitting::jnd_of()).
  [[nodiscard]] fitting::Jnd over(const fitting::Jnd& known) const;
  /// Puts the JND of an axis, and who measured it, into the options.
  void put_into(fitting::FitOptions& options, const schema::Axis& axis) const;
};

/// Adds --weber, --threshold and --jnd-source.
void add_jnd_options(Verb& verb, JndArguments& arguments);

}  // namespace kerf::bench
