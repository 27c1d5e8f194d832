#include "probe/kept_probes.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/core.h>
#include <nlohmann/json.hpp>
#include <sys/file.h>
#include <unistd.h>

#include <kerf/drivers/sign_tables.h>
#include <kerf/drivers/uri.h>
#include <kerf/schema/recording.h>

#include "files/json_file.h"
#include "files/whole_file.h"
#include "probe/probe.h"

namespace kerf::bench {
namespace {

using json = nlohmann::ordered_json;

/// The file is read, changed and written by one process at a time. Another file beside it is locked, because
/// the one that is written takes the place of the one that was read.
class OnlyOne {
 public:
  explicit OnlyOne(const std::filesystem::path& file)
      : descriptor_(open(file.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0600)) {
    if (descriptor_ < 0) fail(file);
    while (flock(descriptor_, LOCK_EX) != 0) {
      if (errno == EINTR) continue;
      const int reason = errno;
      close(descriptor_);
      errno = reason;
      fail(file);
    }
  }
  OnlyOne(const OnlyOne&) = delete;
  OnlyOne& operator=(const OnlyOne&) = delete;
  ~OnlyOne() { close(descriptor_); }

 private:
  [[noreturn]] static void fail(const std::filesystem::path& file) {
    throw std::system_error(errno, std::generic_category(), "cannot write " + file.string());
  }
  int descriptor_;
};

/// What tells one device from another.
json identity_of(const drivers::DeviceInfo& device) {
  return {{"model", device.model},
          {"serial", device.serial ? json(*device.serial) : json(nullptr)},
          {"port", device.port},
          {"sign_tables", drivers::sign_tables_version}};
}

bool is_of(const json& kept, const json& identity) {
  return std::ranges::all_of(identity.items(),
                             [&](const auto& one) { return kept.at(one.key()) == one.value(); });
}

/// Of its options those alone that say which signs are meant.
std::string lasting_uri(const drivers::DeviceInfo& device) {
  const drivers::Uri uri = drivers::parse_uri(device.uri);
  const auto model = uri.options.find("model");
  return model == uri.options.end() ? uri.name : fmt::format("{}?model={}", uri.name, model->second);
}

KeptProbe probe_from(const json& kept) {
  KeptProbe probe{.date = kept.at("date"), .axes = {}};
  for (const json& axis : kept.at("axes")) {
    probe.axes.push_back(
        {.name = axis.at("name"),
         .verdict = verdict_named(axis.at("verdict").get<std::string>()).value_or(PushVerdict::unknown)});
  }
  return probe;
}

/// The list of probes; empty where there is no file. @throws json::exception, std::system_error
json probes_in(const std::filesystem::path& file) {
  if (std::error_code ignored; !std::filesystem::exists(file, ignored)) return json::array();
  json probes = json::parse(read_whole_file(file)).at("probes");
  for (const json& kept : probes) {
    (void)is_of(kept, identity_of({}));
    (void)probe_from(kept);
  }
  return probes;
}

/// The same for whoever writes it anew.
json probes_to_keep(const std::filesystem::path& file) {
  try {
    return probes_in(file);
  } catch (const json::exception&) {
    return json::array();
  }
}

}  // namespace

std::string KeptProbe::axes_that_are(PushVerdict verdict) const {
  std::string names;
  for (const Axis& axis : axes) {
    if (axis.verdict == verdict) names += (names.empty() ? "" : ", ") + axis.name;
  }
  return names;
}

std::filesystem::path KeptProbes::usual_file() {
  const char* const folder = std::getenv("XDG_DATA_HOME");
  const char* const home = std::getenv("HOME");
  if (folder == nullptr && home == nullptr) return {};
  const std::filesystem::path root = folder != nullptr ? folder : std::string(home) + "/.local/share";
  return root / "kerf" / "probes.json";
}

std::optional<KeptProbe> KeptProbes::find(const drivers::DeviceInfo& device,
                                          const std::function<void(std::string_view)>& warn) const {
  try {
    const json identity = identity_of(device);
    for (const json& kept : probes_in(file_)) {
      if (is_of(kept, identity)) return probe_from(kept);
    }
  } catch (const std::exception&) {
    if (warn) {
      warn(
          fmt::format("{}: it is no list of probes any more, so none is known; a probe that is made now "
                      "replaces it",
                      file_.string()));
    }
  }
  return std::nullopt;
}

void KeptProbes::keep(const ProbeResult& result) const {
  std::error_code ignored;  // writing says it better
  std::filesystem::create_directories(file_.parent_path(), ignored);
  std::filesystem::path lock = file_;
  const OnlyOne only_one(lock += ".lock");
  const json identity = identity_of(result.device);
  json probes = json::array();
  for (json& kept : probes_to_keep(file_)) {
    if (!is_of(kept, identity)) probes.push_back(std::move(kept));
  }
  const schema::Header header = schema::new_header("");
  json probe = identity;
  probe["uri"] = lasting_uri(result.device);
  probe["date"] = header.created;
  probe["axes"] = probe_as_json(result).at("axes");
  probes.push_back(std::move(probe));
  write_json_file(file_, {{"probes", std::move(probes)}});
}

void require_probed(const drivers::DeviceInfo& device, const std::function<void(std::string_view)>& warn) {
  const bool has_force =
      std::ranges::any_of(device.axes, [](const drivers::AxisInfo& axis) { return axis.force_limit > 0.0; });
  if (device.simulated || !has_force) return;
  const std::string command = fmt::format("kerf devices --probe '{}'", device.uri);
  const auto kept = KeptProbes(KeptProbes::usual_file()).find(device, warn);
  const auto say = [&](const std::string& line) {
    if (warn) warn(line);
  };
  if (!kept) {
    return say(
        fmt::format("{}: nobody has seen which way it pushes, and a wall that pulls is dangerous; '{}' "
                    "finds out by small pushes",
                    device.uri, command));
  }
  if (const std::string wrong = kept->axes_that_are(PushVerdict::wrong); !wrong.empty()) {
    throw drivers::DeviceError(
        fmt::format("{}: a push along {} moved the handle the wrong way when it was probed ({}), so that "
                    "nothing is rendered; name the right '?model=', or mend the leads of motor or encoder, "
                    "then run '{}'",
                    device.uri, wrong, kept->date, command));
  }
  if (const std::string unknown = kept->axes_that_are(PushVerdict::unknown); !unknown.empty()) {
    say(fmt::format("{}: its probe ({}) could not tell which way it pushes along {}; '{}' tries again",
                    device.uri, kept->date, unknown, command));
  }
}

}  // namespace kerf::bench
