#include "program/jnd_arguments.h"

namespace kerf::bench {

void add_jnd_options(Verb& verb, AskedJnd& jnd) {
  verb.add_option("--weber", jnd.weber_fraction,
                  "Weber fraction of the JND (default: 0.07 of a force, 0.127 of a torque)")
      .within(AskedFit::weber_fractions.lower, AskedFit::weber_fractions.upper);
  verb.add_option("--threshold", jnd.threshold,
                  "Smallest JND, in the axis' unit of force (default: 0.05 N, at a lever as much torque)")
      .not_negative();
  verb.add_option("--jnd-source", jnd.source, "Who measured that JND, for the report");
}

}  // namespace kerf::bench
