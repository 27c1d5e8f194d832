#include "program/wall_search_arguments.h"

namespace kerf::bench {

void add_wall_search_options(Verb& verb, StudyOptions& study) {
  WallSearchOptions& search = study.z_width.search;
  verb.add_option("--stiffness", study.stiffness_n_per_m, "Smallest and largest stiffness of the walls [N/m]")
      .taking(2);
  verb.add_option("--damping", study.damping_n_s_per_m, "Smallest and largest damping of the walls [N·s/m]")
      .taking(2);
  verb.add_option("--felt", search.felt_n, "A limit cycle below it counts as none; rms of the force [N]")
      .positive()
      .with_default();
  verb.add_option("--strike", search.strike_n, "Force with which a wall begins to push in a trial [N]")
      .positive()
      .with_default();
  verb.add_option("--stop-at", search.stop_n,
                  "Force at which a trial ends (default: 0.8 of the axis' limit) [N]")
      .positive();
  verb.add_option("--rungs", study.z_width.rungs, "Dampings of --damping at which it is sought")
      .within(1, 100)
      .with_default();
  verb.add_option("--repeats", search.repeats, "Trials that a stiffness has to hold")
      .within(1, 100)
      .with_default();
  verb.add_option("--resolution", search.resolution, "How closely to find it, as a share of itself")
      .within(1e-4, 0.5)
      .with_default();
  verb.add_option("--false-alarms", search.false_alarms,
                  "Share of quiet trials in which an oscillation may be found by chance")
      .within(1e-9, 0.5)
      .with_default();
}

}  // namespace kerf::bench
