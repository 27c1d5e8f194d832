#pragma once

#include <span>
#include <string_view>

#include "embed/embedded_file.h"

namespace kerf::bench {

// The files of fmu/, octave/ and python/ that hosts are given, and the licence, as they are in the program.
[[nodiscard]] std::span<const EmbeddedFile> c_host_texts() noexcept;

/// One of them by its name. @throws std::logic_error where there is none
[[nodiscard]] std::string_view c_host_text(std::string_view name);

}  // namespace kerf::bench
