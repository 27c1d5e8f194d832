#pragma once

#include <functional>
#include <string>

#include "drawer/study_file.h"
#include "imports/import_file.h"

namespace kerf::bench {

struct BlankSuggestion {
  bool subtract = false;
  std::string why;
};

/// Whether blanks are to be taken off, as far as the drawer tells. They are where every blank that is of the
/// rig and speed of another file says what it takes off: its force differs from one of its cycles to the next
/// by no more than half of what it is (root mean squares over its positions). What cannot be read or has
/// unknown columns says nothing. `import_of` says how a file is imported.
[[nodiscard]] BlankSuggestion suggest_blank(const StudyPlan& plan,
                                            const std::function<ImportFile(const DrawerFile&)>& import_of);

}  // namespace kerf::bench
