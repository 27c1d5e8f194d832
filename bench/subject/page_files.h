#pragma once

#include <span>
#include <string_view>

namespace kerf::bench {

/// A file of the folder page/, as it is in the program.
struct PageFile {
  std::string_view name;  ///< "page.css"
  std::string_view content;
};

/// All of them; written into the program by page/embed.cmake.
[[nodiscard]] std::span<const PageFile> page_files() noexcept;

}  // namespace kerf::bench
