#pragma once

#include <span>
#include <string>
#include <string_view>

#include "embed/embedded_file.h"
#include "http/http_server.h"

namespace kerf::bench {

/// What is at a path: "/" the one file in HTML, in which every {{token}} becomes the token, "/page.css"
/// another one; 404 anything else.
[[nodiscard]] HttpResponse page_file(std::span<const EmbeddedFile> files, std::string_view path,
                                     const std::string& token);

}  // namespace kerf::bench
