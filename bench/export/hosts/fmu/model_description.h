#pragma once

#include <string>
#include <vector>

#include "exported_law.h"

namespace kerf::bench {

/// A number of the law as the FMU shows it: it is baked in and never changes.
struct FmuConstant {
  std::string name;  ///< "contact.position", "law.parallel_stiffness"
  double value = 0.0;
  std::string unit;  ///< as Kerf writes it, "N·s/rad"; "1" without one
  std::string meaning;
};
/// In the order of their value references, which begin at `fmu_first_constant`.
[[nodiscard]] std::vector<FmuConstant> fmu_constants(const LawFile& law);

inline constexpr int fmu_time = 0;
inline constexpr int fmu_position = 1;
inline constexpr int fmu_velocity = 2;
inline constexpr int fmu_force = 3;
inline constexpr int fmu_first_constant = 4;

/// What an importer has to give back when it instantiates: another law, another text of it, another version
/// of this program, another token.
[[nodiscard]] std::string fmu_token(const ExportedLaw& law);

/// modelDescription.xml: FMI 3.0, Co-Simulation.
[[nodiscard]] std::string model_description(const ExportedLaw& law);
/// sources/buildDescription.xml
[[nodiscard]] std::string build_description(const ExportedLaw& law);

}  // namespace kerf::bench
