#include "devices/listed_lab.h"

#include <optional>
#include <string>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <kerf/drivers/bench_file.h>

#include "doctor/facts/usb.h"
#include "program/app.h"

namespace kerf::bench {

void list_ports(const std::vector<drivers::AttachedPort>& ports, Context& context) {
  context.result["serial_ports"] = nlohmann::ordered_json::array();
  if (ports.empty()) return;
  context.say("Serial ports:");
  for (const drivers::AttachedPort& port : ports) {
    context.result["serial_ports"].push_back({{"path", port.path},
                                              {"node", port.node},
                                              {"vendor", port.vendor},
                                              {"product", port.product},
                                              {"about", port.about},
                                              {"uris", port.uris},
                                              {"emulated", port.emulated},
                                              {"problem", port.problem}});
    context.say(fmt::format("  {}  {}{}", port.node, port.about, port.emulated ? ", emulated" : ""));
    context.say(fmt::format("    {}",
                            port.uris.empty() ? port.path : fmt::format("{}", fmt::join(port.uris, " or "))));
    if (!port.problem.empty()) context.say(fmt::format("    {}", port.problem));
  }
  const doctor::Finding modems = doctor::modem_manager(doctor::HostTree());
  const bool is_said = !modems.mend.empty();
  context.result["modem_manager"] = {{"seen", modems.seen}, {"mend", modems.mend}};
  if (!is_said) return;
  context.say(
      fmt::format("  {}; it sends modem commands to a port that was plugged in. To end that:", modems.seen));
  context.say(fmt::format("    {}", modems.mend));
}

void list_libraries(const std::vector<drivers::MakerLibrary>& libraries, Context& context) {
  context.result["libraries"] = nlohmann::ordered_json::array();
  context.say("By libraries of their makers:");
  for (const drivers::MakerLibrary& one : libraries) {
    context.result["libraries"].push_back(
        {{"uri", one.uri}, {"about", one.about}, {"found", one.found}, {"problem", one.problem}});
    context.say(fmt::format("  {}  {}", one.uri, one.about));
    context.say(fmt::format("    {}", one.problem.empty() ? one.found : one.problem));
  }
}

void list_bench(const std::vector<drivers::AttachedDevice>& attached, Context& context) {
  context.result["bench"] = nullptr;
  std::optional<drivers::BenchFile> file;
  try {
    file = drivers::find_bench_file();
  } catch (const drivers::DeviceError& error) {
    context.result["bench"] = {{"problem", error.what()}};
    return context.say(fmt::format("Bench: {}", error.what()));
  }
  if (!file) return;
  nlohmann::ordered_json entries = nlohmann::ordered_json::array();
  context.say(fmt::format("Bench: {}", file->file.string()));
  for (const drivers::BenchEntry& entry : file->entries) {
    const bool is_sensor = entry.kind == drivers::BenchEntry::Kind::sensor;
    const drivers::EntryState seen = drivers::look_at(entry, attached);
    entries.push_back({{"name", entry.name},
                       {"kind", is_sensor ? "sensor" : "device"},
                       {"uri", entry.uri},
                       {"sensor", entry.sensor},
                       {"has_frame", entry.frame.has_value()},
                       {"state", seen.state},
                       {"problem", seen.problem}});
    context.say(fmt::format("  {}  {}: {}{}{}", entry.name, seen.state, entry.uri,
                            entry.sensor.empty() ? "" : ", with the sensor " + entry.sensor,
                            entry.frame ? ", with a frame"
                            : is_sensor ? ", a sensor"
                                        : ""));
    if (!seen.problem.empty()) context.say(fmt::format("    {}", seen.problem));
  }
  context.result["bench"] = {
      {"file", file->file.string()}, {"sha256", file->sha256}, {"entries", std::move(entries)}};
}

}  // namespace kerf::bench
