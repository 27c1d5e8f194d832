#pragma once

#include <string>
#include <vector>

#include "support/program.h"

namespace kerf::test {

inline constexpr const char* spring_law = R"(model = "kelvin"
axis = "theta"
position_unit = "rad"
force_unit = "N"

[contact]
position = { value = 0.5, unit = "rad" }
direction = "decreasing"

[parameters]
parallel_stiffness = { value = 8, unit = "N/rad" }
series_stiffness = { value = 7, unit = "N/rad" }
damping = { value = 130, unit = "N·s/rad" }
)";

inline constexpr const char* one_case = R"(name = "a small suite"

[[case]]
name = "kelvin"
law = "kelvin.law.toml"
seconds = { value = 0.4, unit = "s" }
exact = true

[[case.motion]]
kind = "strokes"
from = { value = 35, unit = "deg" }
to = { value = 8, unit = "deg" }
stroke = { value = 0.3, unit = "s" }
pause = { value = 50, unit = "ms" }
)";

/// A folder with a law of two springs and a dashpot and a suite of one case.
class SuiteFolder {
 public:
  SuiteFolder() {
    write_text(folder_ / "kelvin.law.toml", spring_law);
    write_suite(one_case);
  }
  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }
  [[nodiscard]] std::string suite() const { return at("suite.toml"); }
  void write_suite(const std::string& text) const { write_text(folder_ / "suite.toml", text); }
  /// The law with one text replaced by another.
  void change_law(const std::string& from, const std::string& to) const {
    replace_in(folder_ / "kelvin.law.toml", from, to);
  }
  /// kerf regress ACTION suite.toml and more.
  [[nodiscard]] Outcome regress(const std::string& action, std::vector<std::string> more = {}) const {
    more.insert(more.begin(), {"regress", action, suite()});
    return run_kerf(more);
  }

 private:
  TemporaryFolder folder_;
};

}  // namespace kerf::test
