#pragma once

#include <span>
#include <string>
#include <string_view>

#include "http/http_server.h"

namespace kerf::bench {

/// A file of a page, as it is in the program; embed.cmake writes them there.
struct PageFile {
  std::string_view name;  ///< "page.css"
  std::string_view content;
};

/// What is at a path: "/" the one file in HTML, in which every {{token}} becomes the token, "/page.css"
/// another one; 404 anything else.
[[nodiscard]] HttpResponse page_file(std::span<const PageFile> files, std::string_view path,
                                     const std::string& token);

}  // namespace kerf::bench
