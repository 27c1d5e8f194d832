#include "workspace/page_uri.h"

#include <string_view>

#include <fmt/format.h>

#include <kerf/drivers/bench_file.h>
#include <kerf/drivers/uri.h>

#include "http/routes.h"

namespace kerf::bench {

namespace {

/// A name of the bench file is taken for what it leads to, and for the sensor that stands beside that.
void refuse_what_a_name_leads_to(const std::string& name, const std::string& uri) {
  const std::string plain = drivers::without_bench_name(uri);
  const std::string sensor = drivers::without_bench_name(drivers::sensor_beside(uri, ""));
  for (const std::string& one : {plain, sensor}) {
    const drivers::Uri parts = drivers::parse_uri(one);
    bool leads_out = drivers::names_a_place(parts.name);
    for (const auto& [option, value] : parts.options) leads_out |= drivers::names_a_file(parts.name, option);
    if (!leads_out) continue;
    throw RequestError(
        400, fmt::format("{}: in the bench file it leads to a machine, a port, a plug-in or a file, which "
                         "a page cannot name; give it to kerf studio with --device",
                         name));
  }
}

}  // namespace

std::string uri_from_page(const Workspace& workspace, const std::string& text) {
  const std::string uri = drivers::named_uri(text);
  if (uri != text) {
    refuse_what_a_name_leads_to(text, uri);
    return uri;
  }
  drivers::Uri parts = drivers::parse_uri(uri);
  if (drivers::names_a_place(parts.name)) {
    throw RequestError(
        400,
        fmt::format("{}: from a page no machine of the network, no port and no plug-in can be named; give "
                    "the URI to kerf studio with --device",
                    parts.name));
  }
  // Only a name is looked up; a page that writes what stands for one would go round what is asked above.
  const std::string plain = drivers::without_bench_name(uri);
  parts = drivers::parse_uri(plain);
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
  return names_a_file ? drivers::to_text(parts) : plain;
}

}  // namespace kerf::bench
