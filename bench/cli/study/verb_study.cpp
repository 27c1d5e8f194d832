#include "study/verb_study.h"

#include "program/verbs.h"

namespace kerf::bench {

void add_study(CLI::App& app, Context& context) {
  CLI::App& study =
      add_verb_of_verbs(app, "study", "Say of a drawer of files which law serves, and whether tissues differ",
                        "Example:\n"
                        "  kerf study new drawer --map 'time=1[s],position=2[mm],force=3[N]' -o S\n"
                        "  kerf study run S/study.toml -j 2\n"
                        "  kerf study verify S --rerun all\n\n"
                        "Look through S/study.toml before it is run: what names of files suggest is a guess. "
                        "docs/studies.md\nwalks through a drawer.");
  add_study_new(study, context);
  add_study_run(study, context);
  add_study_report(study, context);
  add_study_verify(study, context);
}

}  // namespace kerf::bench
