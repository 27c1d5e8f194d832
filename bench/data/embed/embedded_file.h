#pragma once

#include <string_view>

namespace kerf::bench {

/// A file that is part of the program; embed_files.cmake puts it there.
struct EmbeddedFile {
  std::string_view name;  ///< "page.css"
  std::string_view content;
};

}  // namespace kerf::bench
