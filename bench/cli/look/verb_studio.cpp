#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <thread>

#include <fmt/core.h>

#include "look/verb_forms.h"
#include "pages/browser_link.h"
#include "program/verbs.h"
#include "run/run.h"
#include "server/studio.h"
#include "study/swept_verbs.h"

namespace kerf::bench {
namespace {

struct StudioVerbArguments {
  std::string folder = ".";
  std::string device;
  std::string key_file;
  std::string listen;
  double port = 0.0;
  bool open = false;
};

/// A machine without a desktop has no browser to open; the studio runs all the same.
void open_link(const std::string& url, std::optional<BrowserLink>& link) {
  try {
    link.emplace(url);
  } catch (const std::system_error& error) {
    warn(fmt::format("{}; open the address yourself", error.what()));
  }
}

void run_studio(const CLI::App& app, const StudioVerbArguments& arguments, Context& context) {
  std::error_code unknown;  // without /proc no verb is run from the page
  StudioOptions options{.folder = arguments.folder,
                        .port = static_cast<std::uint16_t>(arguments.port),
                        .key_file = arguments.key_file,
                        .program = std::filesystem::read_symlink("/proc/self/exe", unknown),
                        .verbs = verb_forms(app),
                        .check_words = [](const auto& words) { (void)read_command_line(words); },
                        .swept = swept_verbs()};
  if (!arguments.device.empty()) options.device_uri = arguments.device;
  if (!arguments.listen.empty()) options.address = arguments.listen;
  const StopOnSignal signals;
  const Studio studio(options);
  if (!studio.is_loopback()) {
    warn(
        fmt::format("listening on {}: other machines can reach this studio, move its device and read its "
                    "files once they know the address below, which crosses the network in the clear",
                    arguments.listen));
  }
  note(fmt::format("The studio of {}: {}", arguments.folder, studio.url()));
  note("Ctrl-C ends it.");
  std::optional<BrowserLink> link;
  if (arguments.open) open_link(studio.url(), link);
  while (!signals.requested()) std::this_thread::sleep_for(std::chrono::milliseconds(50));
  context.result = {{"folder", arguments.folder}};
}

}  // namespace

void add_studio(CLI::App& app, Context& context) {
  auto arguments = std::make_shared<StudioVerbArguments>();
  Verb verb = add_verb(
      app, context, "studio", "See, draw and judge in a browser",
      "kerf studio lab --open\n\n"
      "Serves the recordings, laws and sessions of a folder to a browser of this machine: live scope,\n"
      "recordings, the segment editor, fits, charts, studies and sessions. Whoever has the printed\n"
      "address can use it. docs/studio.md says more.",
      [arguments, &app, &context] { run_studio(app, *arguments, context); });
  verb.takes_laws(context);
  verb.add_option("DIR", arguments->folder, "The folder to work in").with_default();
  verb.add_uri("--device", arguments->device,
               "Device URI to offer (default: sim:scissors); it is opened from the page");
  verb.add_option("--key-file", arguments->key_file,
                  "Key file of whoever keeps the blinding, to run sessions that were sealed with one");
  verb.add_option("--port", arguments->port, "Port (default: any that is free)").within(0.0, 65535.0);
  verb.add_option("--listen", arguments->listen,
                  "Address to listen on in place of 127.0.0.1, such as 192.168.1.20: for other machines too");
  verb.add_flag("--open", arguments->open, "Open it in the browser");
}

}  // namespace kerf::bench
