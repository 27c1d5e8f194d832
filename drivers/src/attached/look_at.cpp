#include <algorithm>
#include <charconv>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "kerf/drivers/attached_ports.h"
#include "kerf/drivers/protocols/inverse3.h"
#include "kerf/drivers/uri.h"
#include "network/byte_stream.h"
#include "network/datagrams.h"
#include "network/http_get.h"
#include "open_uri.h"

namespace kerf::drivers {
namespace {

namespace fs = std::filesystem;

std::string option_of(const Uri& uri, const std::string& name, const std::string& standard) {
  const auto found = uri.options.find(name);
  return found == uri.options.end() ? standard : found->second;
}

std::uint16_t port_option(const Uri& uri, const std::string& name, std::uint16_t standard) {
  const std::string text = option_of(uri, name, "");
  std::uint16_t port = standard;
  std::from_chars(text.data(), text.data() + text.size(), port);
  return port;
}

EntryState of_simulated(const std::string& uri) {
  try {
    (void)open_uri(uri, {});
  } catch (const std::exception& error) {
    return {.state = "cannot be opened", .problem = error.what()};
  }
  return {.state = "simulated", .problem = {}};
}

EntryState on_usb(const Uri& uri, const std::vector<AttachedDevice>& attached) {
  const std::string index = option_of(uri, "index", "0");
  const std::string wanted = index == "0" ? uri.name : uri.name + "?index=" + index;
  const auto found = std::ranges::find(attached, wanted, &AttachedDevice::uri);
  if (found == attached.end())
    return {.state = "not there", .problem = "it is not on the USB: is it plugged in and switched on?"};
  return {.state = found->problem.empty() ? "there" : "cannot be opened", .problem = found->problem};
}

EntryState at_path(std::string_view scheme, const std::string& path, const fs::path& root) {
  if (scheme == "plugin") {
    std::error_code error;
    if (fs::is_regular_file(path, error)) return {.state = "not asked", .problem = {}};
    return {.state = "not there", .problem = fmt::format("there is no file {}", path)};
  }
  std::error_code error;
  const std::string problem = problem_of_port(path, root);
  if (problem.empty()) return {.state = "there", .problem = {}};
  const bool is_there = fs::exists(root / fs::path(path).relative_path(), error);
  return {.state = is_there ? "cannot be opened" : "not there", .problem = problem};
}

EntryState in_network(std::string_view scheme, const std::string& host, const Uri& uri,
                      std::chrono::milliseconds patience) {
  try {
    if (scheme == "inverse3") {
      const auto found = find_inverse3(host, port_option(uri, "port", 10001), patience);
      if (found) return {.state = found->problem.empty() ? "there" : "no answer", .problem = found->problem};
      return {.state = "no answer",
              .problem = fmt::format("nothing listens at port {} of {}; does its service run there? "
                                     "'sudo systemctl start haply-inverse-service'",
                                     port_option(uri, "port", 10001), host)};
    }
    if (scheme == "t7") {
      const ByteStream stream(address_of(host), port_option(uri, "port", 502), patience);
      return {.state = "there", .problem = {}};
    }
    if (scheme == "net-ft" && option_of(uri, "page", "on") == "on") {
      (void)http_get({.address = address_of(host),
                      .port = port_option(uri, "http", 80),
                      .target = "/netftapi2.xml",
                      .patience = patience});
      return {.state = "there", .problem = {}};
    }
  } catch (const std::exception& error) {
    return {.state = "no answer",
            .problem = fmt::format("{}; is it on, and is that its address?", error.what())};
  }
  // Who asks an EtherDAQ for its stream takes it from whoever has it; others are only seen by opening them.
  return {.state = "not asked", .problem = {}};
}

}  // namespace

std::optional<AttachedDevice> find_inverse3(const std::string& host, std::uint16_t port,
                                            std::chrono::milliseconds patience) {
  AttachedDevice found{.uri = "inverse3:" + host,
                       .about = "service of a Haply Inverse3",
                       .node = fmt::format("{}:{}", host, port),
                       .problem = {}};
  if (port != 10001) found.uri += fmt::format("?port={}", port);
  std::string address;
  try {
    address = address_of(host);
    const ByteStream listens(address, port, patience);
  } catch (const std::exception&) {
    return std::nullopt;
  }
  try {
    const std::string version =
        http_get({.address = address, .port = port, .target = "/version", .patience = patience});
    if (!inverse3::naming_of(version)) found.problem = "what listens there tells no version of it";
  } catch (const std::exception&) {
    // Before 3.5 it answers to no such question, and neither does another program.
    found.about = "something that listens where the service of a Haply Inverse3 does; 3.1 to 3.4 do not tell";
  }
  return found;
}

EntryState look_at(const BenchEntry& entry, const std::vector<AttachedDevice>& attached, const fs::path& root,
                   std::chrono::milliseconds patience) {
  const Uri uri = parse_uri(entry.uri);
  const auto colon = uri.name.find(':');
  const std::string scheme = uri.name.substr(0, colon);
  const std::string place = uri.name.substr(std::min(colon + 1, uri.name.size()));
  if (scheme == "sim") return of_simulated(entry.uri);
  if (names_a_path(uri.name)) return at_path(scheme, place, root);
  for (const std::string_view usb : {"falcon", "spacemouse", "hid", "u6"}) {
    if (scheme == usb) return on_usb(uri, attached);
  }
  return in_network(scheme, place, uri, patience);
}

}  // namespace kerf::drivers
