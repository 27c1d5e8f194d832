#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <kerf/compare/tolerance.h>

#include "laws/law_file.h"
#include "scene/motion.h"

namespace kerf::bench {

using compare::Tolerance;

/// A law, a trajectory and how exactly the forces have to be those stored.
struct RegressionCase {
  std::string name;
  std::filesystem::path law_file;
  LawFile law;
  MotionSource motion;
  Tolerance tolerance;
  std::optional<double> tick_cost;  ///< how many times its stored cost a tick may cost
};

struct Suite {
  std::string name;
  std::filesystem::path file;
  std::filesystem::path stored;  ///< SUITE.h5 beside SUITE.toml
  std::vector<RegressionCase> cases;
};

/// Reads a suite and the laws that it names; paths are relative to its folder. docs/regress.md has the
/// format. @throws std::invalid_argument with file, line, found and expected; std::system_error.
[[nodiscard]] Suite read_suite(const std::filesystem::path& file);

/// The suite with these cases alone, in the suite's order; all of them if none is named.
/// @throws std::invalid_argument for a name that is none.
[[nodiscard]] Suite only(const Suite& suite, const std::vector<std::string>& names);

}  // namespace kerf::bench
