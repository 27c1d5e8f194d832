#include "program/jnd_arguments.h"

#include "fits/fit_series.h"

namespace kerf::bench {

fitting::Jnd JndArguments::over(const fitting::Jnd& known) const {
  return {.weber_fraction = weber_fraction.value_or(known.weber_fraction),
          .threshold = threshold.value_or(known.threshold)};
}

void JndArguments::put_into(fitting::FitOptions& options, const schema::Axis& axis) const {
  take_jnd_of(axis, options);
  options.jnd = over(options.jnd);
  if (weber_fraction || threshold) options.jnd_source = "given, without a source";
  if (!source.empty()) options.jnd_source = source;
}

void add_jnd_options(Verb& verb, JndArguments& arguments) {
  verb.add_option("--weber", arguments.weber_fraction,
                  "Weber fraction of the JND (default: 0.07 of a force, 0.127 of a torque)")
      .within(0.0, 1.0);
  verb.add_option("--threshold", arguments.threshold,
                  "Smallest JND, in the axis' unit of force (default: 0.05 N, at a lever as much torque)")
      .not_negative();
  verb.add_option("--jnd-source", arguments.source, "Who measured that JND, for the report");
}

}  // namespace kerf::bench
