#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <kerf/compare/tolerance.h>

#include "laws/law_file.h"
#include "regress/renderers/outside_renderer.h"
#include "scene/motion.h"

namespace kerf::bench {

using compare::Tolerance;

/// What stands in a case for a law until one is read, and where there is none.
[[nodiscard]] LawFile stand_in();

/// A law, a trajectory and how exactly the forces have to be those stored.
struct RegressionCase {
  std::string name;
  std::filesystem::path law_file;
  LawFile law = stand_in();
  std::optional<OutsideRenderer> outside;  ///< in place of a law
  std::filesystem::path trajectory;        ///< a table of ticks, in place of `motion`
  MotionSource motion;
  Tolerance tolerance;
  std::optional<double> tick_cost;  ///< how many times its stored cost a tick may cost
  std::string error;                ///< why it cannot be run: a law or a file that cannot be read
};

/// The axes of a case's law, or those that its renderer is declared to have.
[[nodiscard]] std::vector<models::LawAxis> axes_of(const RegressionCase& one);
/// The law's model; of another renderer how it is called.
[[nodiscard]] std::string renderer_of(const RegressionCase& one);

/// In what form the forces of a suite are stored.
enum class References : std::uint8_t {
  hdf5,  ///< one file, SUITE.h5
  text,  ///< a folder SUITE.forces with a table a case, which git merges
};

struct Suite {
  std::string name;
  std::filesystem::path file;
  std::filesystem::path stored;  ///< SUITE.h5 or SUITE.forces beside SUITE.toml
  References references = References::hdf5;
  std::vector<RegressionCase> cases;
};

/// Reads a suite and the laws that it names; paths are relative to its folder. docs/regress.md has the
/// format. A case whose law or trajectory cannot be read is kept with its reason; the others go on.
/// @throws std::invalid_argument with file, line, found and expected; std::system_error.
[[nodiscard]] Suite read_suite(const std::filesystem::path& file);

/// The suite with these cases alone, in the suite's order; all of them if none is named.
/// @throws std::invalid_argument for a name that is none.
[[nodiscard]] Suite only(const Suite& suite, const std::vector<std::string>& names);

}  // namespace kerf::bench
