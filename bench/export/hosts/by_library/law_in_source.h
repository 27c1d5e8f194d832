#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "exported_law.h"

// What the hosts share whose file calls libkerf: the law file as a text of a source, and what is said of it.

namespace kerf::bench {

/// A language in which the text of a law file stands.
enum class Language { cpp, csharp };

/// The bytes of a text as literals of that language, a line each: printable ASCII as it is, all else escaped,
/// so that nothing within ends a literal and no compiler has to guess an encoding. In C# each character of
/// the literals is a byte.
[[nodiscard]] std::string quoted(std::string_view text, Language language);

/// What a source says of its law, as lines of a comment that begin with `//`: law, SHA-256, axes, fit, range,
/// version. What comes out of a file stays within its line.
[[nodiscard]] std::string provenance_comment(const ExportedLaw& law);

/// The axes of a law along x, y and z of a host that knows the tool's position and gives it a force, as their
/// indices: "0, 1, 2". A law along one axis is on the one of its name, and on z if that is none of them.
/// Empty for a law that takes an angle or a joint or gives a torque.
[[nodiscard]] std::string axes_in_space(const ExportedLaw& law);

/// "my_law" is MyLaw.
[[nodiscard]] std::string type_name(std::string_view name);

/// @throws std::invalid_argument for a law in space, whose ticks a HostSample does not tell
void require_one_axis(const ExportedLaw& law, std::string_view host);

/// What the texts of a host are filled in with (filled_in() of own_code/compiler.h): NAME, TYPE, SHA256,
/// VERSION, PROVENANCE, and TEXT in that language.
[[nodiscard]] std::vector<std::pair<std::string_view, std::string>> law_values(const ExportedLaw& law,
                                                                               Language language);

/// The same for a host in C++ that knows the tool's place in space: with LAW_ON_AXES, the class of
/// law_on_axes.in. @throws std::invalid_argument where axes_in_space() are none, with the axes that it has
[[nodiscard]] std::vector<std::pair<std::string_view, std::string>> values_in_space(const ExportedLaw& law,
                                                                                    std::string_view host);

}  // namespace kerf::bench
