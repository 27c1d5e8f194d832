#pragma once

#include <span>

#include "pages/page_files.h"

namespace kerf::bench {

/// The bundled page: studio.html and what it loads.
[[nodiscard]] std::span<const EmbeddedFile> studio_page() noexcept;

}  // namespace kerf::bench
