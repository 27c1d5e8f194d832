#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace kerf::bench {

/// What `kerf law new` writes for a law of this name, one text a file.
struct NewLaw {
  std::string header;  ///< NAME.h: a spring with dry friction, to be changed
  std::string test;    ///< NAME_test.cpp
  std::string cmake;   ///< CMakeLists.txt, for who builds it within a project
};

/// @throws std::invalid_argument for a name that is none (a to z, 0 to 9 and _), or that of a law of the
///         house.
[[nodiscard]] NewLaw new_law(std::string_view name);

}  // namespace kerf::bench
