#include "pages/page_files.h"

namespace kerf::bench {
namespace {

std::string_view type_of(std::string_view name) noexcept {
  if (name.ends_with(".css")) return "text/css; charset=utf-8";
  if (name.ends_with(".js")) return "text/javascript; charset=utf-8";
  if (name.ends_with(".svg")) return "image/svg+xml";
  return "text/html; charset=utf-8";
}

std::string with_token(std::string_view html, const std::string& token) {
  constexpr std::string_view mark = "{{token}}";
  std::string text(html);
  for (std::size_t at = text.find(mark); at != std::string::npos; at = text.find(mark, at)) {
    text.replace(at, mark.size(), token);
  }
  return text;
}

}  // namespace

HttpResponse page_file(std::span<const EmbeddedFile> files, std::string_view path, const std::string& token) {
  for (const EmbeddedFile& it : files) {
    const bool is_page = it.name.ends_with(".html");
    if (is_page ? path != "/" : path.substr(0, 1) != "/" || path.substr(1) != it.name) continue;
    return {.type = std::string(type_of(it.name)),
            .body = is_page ? with_token(it.content, token) : std::string(it.content)};
  }
  return refusal(404);
}

}  // namespace kerf::bench
