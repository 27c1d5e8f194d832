#pragma once

#include <span>

#include "pages/page_files.h"

namespace kerf::bench {

/// texts.toml, as it is in the program.
[[nodiscard]] std::span<const EmbeddedFile> shipped_texts_file() noexcept;

}  // namespace kerf::bench
