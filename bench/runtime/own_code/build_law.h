#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <kerf/models/foreign.h>
#include <kerf/schema/final_name.h>

namespace kerf::bench {

/// The folder with the headers that a law of one's own includes, <kerf/plugin.h>: `include`, `include/kerf`'s
/// parent where Kerf is installed, or `models/include` of the tree that it was built in; both are looked for
/// from the program upwards. @throws std::invalid_argument where there is none.
[[nodiscard]] std::filesystem::path headers_for_laws();

/// What was built.
struct BuiltLaw {
  const models::ForeignLaw* law = nullptr;
  double step_s = 0.0;
  std::string compiler;
  std::string said;  ///< by the compiler: warnings
};

/// Compiles the header of a law to a plug-in, by the compiler that the environment names as CXX or else c++,
/// tries it, and gives it its name.
/// @throws std::invalid_argument with the compiler's first error, or with what the trial found;
///         std::system_error without a compiler, or where nothing can be written.
[[nodiscard]] BuiltLaw build_law(const std::filesystem::path& header, const std::filesystem::path& plugin,
                                 schema::Existing existing);

}  // namespace kerf::bench
