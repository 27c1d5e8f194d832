#include "workspace/page_uri.h"

#include <fmt/format.h>

#include <kerf/drivers/uri.h>

#include "http/routes.h"

namespace kerf::bench {

namespace {

std::string as_text(const drivers::Uri& uri) {
  std::string text = uri.name;
  for (const auto& [name, value] : uri.options)
    text += fmt::format("{}{}={}", text.size() == uri.name.size() ? '?' : '&', name, value);
  return text;
}

}  // namespace

std::string uri_from_page(const Workspace& workspace, const std::string& uri) {
  drivers::Uri parts = drivers::parse_uri(uri);
  if (drivers::names_a_place(parts.name)) {
    throw RequestError(
        400,
        fmt::format("{}: from a page no machine of the network, no port and no plug-in can be named; give "
                    "the URI to kerf studio with --device",
                    parts.name));
  }
  bool names_a_file = false;
  for (auto& [option, value] : parts.options) {
    if (!drivers::names_a_file(parts.name, option)) continue;
    const auto file = workspace.regular_file(value);
    if (!file) {
      throw RequestError(400,
                         fmt::format("{}={}: from a page only a file of the studio's folder can be named, by "
                                     "its path in there; or give the URI to kerf studio with --device",
                                     option, value));
    }
    value = file->string();
    names_a_file = true;
  }
  return names_a_file ? as_text(parts) : uri;
}

}  // namespace kerf::bench
