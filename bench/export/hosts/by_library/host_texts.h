#pragma once

#include <span>
#include <string_view>

#include "embed/embedded_file.h"

namespace kerf::bench {

// The files of by_library/, chai3d/, sofa/ and unity/ that sources are made of, as they are in the program.
[[nodiscard]] std::span<const EmbeddedFile> host_texts() noexcept;

/// One of them by its name. @throws std::logic_error where there is none
[[nodiscard]] std::string_view host_text(std::string_view name);

}  // namespace kerf::bench
