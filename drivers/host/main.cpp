// kerf-device-host: runs a device of somebody else, a plug-in of kerf/device.h, in a process of its own, so
// that what it does wrong ends no program, and lets the device go when its program dies. Started by
// drivers/src/hosted with all signals blocked, in a session of its own.

#include <algorithm>
#include <array>
#include <csignal>
#include <string>
#include <string_view>
#include <vector>

#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include "built_in.h"
#include "plugin.h"
#include "stand_by.h"
#include "work.h"

namespace {

using namespace kerf::host;
using namespace kerf::drivers::hosted;

void say(char kind, std::string_view text = {}) {
  const std::string message = kind + std::string(text.substr(0, longest_message - 1));
  (void)send(host_to_program, message.data(), message.size(), MSG_NOSIGNAL);
}

/// What it is asked: a letter, then texts with a zero behind each.
std::vector<std::string> question(char& kind) {
  std::array<char, longest_message> bytes{};
  const auto size = recv(host_to_program, bytes.data(), bytes.size(), 0);
  if (size < 1) return {};
  kind = bytes[0];
  std::vector<std::string> texts;
  std::string_view rest(bytes.data() + 1, static_cast<std::size_t>(size - 1));
  for (auto end = rest.find('\0'); end != std::string_view::npos; end = rest.find('\0')) {
    texts.emplace_back(rest.substr(0, end));
    rest.remove_prefix(end + 1);
  }
  return texts;
}

const kerf_device_v1& load_at_stage(const std::string& path, Page& page) {
  if (const kerf_device_v1* const own = built_in(path)) return *own;
  const AtStage stage(page.reader, Stage::loading);
  return load(path);
}

void look(const kerf_device_v1& description) {
  std::string about = description.about == nullptr ? "" : description.about;
  if (&description == &open_haptics_device) about = look_for_open_haptics();
  if (&description == &force_dimension_device) about = look_for_force_dimension();
  std::string told = description.name + std::string(1, '\0') + about + '\0';
  for (const std::string_view name : option_names(description)) told += std::string(name) + '\0';
  say(says_look, told);
}

Opened open_at_stage(const kerf_device_v1& description, const std::vector<std::string>& texts, Page& page) {
  const double open_s = description.open_s > 0.0 ? description.open_s : 2.0;
  say(says_opening, std::to_string(static_cast<int>(1e3 * open_s)));
  Options given;
  for (std::size_t at = 1; at + 1 < texts.size(); at += 2) given.emplace_back(texts[at], texts[at + 1]);
  void* device = nullptr;
  {
    const AtStage stage(page.reader, Stage::opening);
    device = open_device(description, given);
  }
  const AtStage stage(page.reader, Stage::describing);
  description.describe(device, &page.facts);
  return {.description = description, .device = device, .facts = page.facts};
}

/// Until the program is gone or the device lost.
void serve(const std::vector<std::string>& texts, Page& page) {
  const kerf_device_v1& description = load_at_stage(texts.front(), page);
  const Opened opened = open_at_stage(description, texts, page);
  page.has_write.store(description.write != nullptr ? 1 : 0);
  const bool paced = (opened.facts.flags & KERF_ANSWERS_AT_ONCE) != 0;
  if (paced && !(opened.facts.rate_hz >= 1.0 && opened.facts.rate_hz <= 1e5)) {
    description.close(opened.device);
    throw Refusal("it answers at once, and its 'rate_hz' is " + std::to_string(opened.facts.rate_hz) +
                  ", expected 1 to 100000");
  }
  const pid_t copy = stand_by(opened, page);
  prctl(PR_SET_PDEATHSIG, 0);
  say(says_ready);
  work(opened, page, copy);
  if (page.lost.load() != 0 && description.trouble != nullptr) {
    const char* const why = description.trouble(opened.device);
    say(says_lost, one_line(why == nullptr ? "" : why));
  }
  {
    const AtStage stage(page.reader, Stage::closing);
    description.close(opened.device);
  }
  page.standby_may_go.store(1, std::memory_order_release);
}

}  // namespace

int main() {
  // No force acts before somebody stands by: until then it ends with its program, whatever open() does.
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  void* const mapped = mmap(nullptr, sizeof(Page), PROT_READ | PROT_WRITE, MAP_SHARED, host_of_page, 0);
  if (mapped == MAP_FAILED) return 1;
  Page& page = *static_cast<Page*>(mapped);
  char kind = 0;
  const auto texts = question(kind);
  if (texts.empty()) return 1;
  int status = 1;
  try {
    if (kind == ask_to_look) {
      look(load_at_stage(texts.front(), page));
    } else {
      serve(texts, page);
    }
    status = 0;
  } catch (const std::exception& error) {
    say(says_refused, one_line(error.what()));
  } catch (...) {
    say(says_refused, "it throws what is no std::exception");
  }
  // Its own destructors may hang: nothing of it is wanted any more.
  _exit(status);
}
