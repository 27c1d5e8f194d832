#pragma once

#include <span>

#include "pages/page_files.h"

namespace kerf::bench {

/// The files of the folder page/: page.html and what it loads.
[[nodiscard]] std::span<const EmbeddedFile> session_page() noexcept;

}  // namespace kerf::bench
