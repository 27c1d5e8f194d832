#include "hosted/device_host.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstring>
#include <new>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <sys/eventfd.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "interruption.h"
#include "kerf/drivers/device.h"
#include "kerf/drivers/device_notes.h"
#include "kerf/drivers/usb/io_thread.h"

namespace kerf::drivers::hosted {
namespace {

constexpr int load_ms = 2000;
constexpr int beyond_ms = 500;  // what open() said that it takes
constexpr int usual_open_ms = 2000;
constexpr int look_ms = 50;
constexpr int reason_ms = 300;
constexpr int end_ms = 500;
constexpr std::int64_t hangs_ns = 200'000'000;

std::string texts_of(char kind, const DeviceHost::Question& question) {
  const bool is_own = !question.built_in.empty();
  std::string texts =
      kind + (is_own ? question.built_in : std::filesystem::absolute(question.plugin).string()) + '\0';
  for (const auto& [name, value] : question.options) {
    texts += name + '\0';
    texts += value + '\0';
  }
  return texts;
}

/// Of both threads, where both are in the plug-in: one of them it was.
std::string whereabouts(const Page& page) {
  const Stage reader = page.reader.stage.load();
  const Stage writer = page.writer.stage.load();
  if (writer == Stage::elsewhere) return in_words(reader);
  if (reader == Stage::elsewhere) return in_words(writer);
  return std::string(in_words(reader)) + " or " + in_words(writer);
}

std::string signal_name(int number) {
  const char* const name = sigabbrev_np(number);
  return std::string("SIG") + (name == nullptr ? "?" : name);
}

}  // namespace

DeviceHost::DeviceHost(std::string uri) : uri_(std::move(uri)) {
  const std::string host = processes::helper_program("kerf-device-host");
  const auto refuse_start = [&](int number) {
    throw DeviceError(fmt::format("{}: {}, in which it runs, does not start ({}): install or build it there",
                                  uri_, host, std::strerror(number)));
  };
  const processes::Descriptor memory(memfd_create("kerf-device-host", MFD_CLOEXEC));
  if (memory.number() < 0 || ftruncate(memory.number(), sizeof(Page)) != 0) refuse_start(errno);
  auto [ours, theirs] = processes::connection(SOCK_SEQPACKET);
  wakes_ = processes::Descriptor(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK));
  readings_ = processes::Descriptor(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK));
  if (ours.number() < 0 || wakes_.number() < 0 || readings_.number() < 0) refuse_start(errno);
  void* const mapped =
      mmap(nullptr, sizeof(Page), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_POPULATE, memory.number(), 0);
  if (mapped == MAP_FAILED) refuse_start(errno);
  page_ = new (mapped) Page;
  const std::array descriptors{theirs.number(), memory.number(), wakes_.number(), readings_.number()};
  if (const int number = processes::start(host, descriptors, process_); number != 0) {
    process_ = 0;
    end();
    refuse_start(number);
  }
  // Its own end only it may hold: then the connection ends when it does.
  theirs.reset();
  socket_ = std::move(ours);
}

DeviceHost::~DeviceHost() { end(); }

void DeviceHost::end() noexcept {
  if (process_ > 0) {
    (void)shutdown(socket_.number(), SHUT_WR);
    // Messages may wait before the end of the connection; those of a host that is done are few.
    for (int round = 0; round < 8; ++round) {
      std::array<char, 64> unread{};
      if (!processes::becomes_readable(socket_.number(), end_ms)) {
        (void)kill(process_, SIGKILL);  // who stands by lets the device go
        (void)processes::becomes_readable(socket_.number(), end_ms);
        break;
      }
      if (recv(socket_.number(), unread.data(), unread.size(), MSG_DONTWAIT) <= 0) break;
    }
    processes::wait_for(process_);
    process_ = 0;
  }
  if (page_ != nullptr) munmap(page_, sizeof(Page));
  page_ = nullptr;
}

void DeviceHost::ask(char kind, const Question& question) {
  std::error_code error;
  if (question.built_in.empty() && !std::filesystem::is_regular_file(question.plugin, error))
    refuse(fmt::format("there is no file {}; expected a shared object that 'kerf device build' made",
                       question.plugin.string()));
  const std::string texts = texts_of(kind, question);
  if (texts.size() > longest_message) refuse("its options are longer than 8 kB");
  (void)send(socket_.number(), texts.data(), texts.size(), MSG_NOSIGNAL);
}

DeviceHost::Answer DeviceHost::answer(int patience_ms, const std::atomic<bool>* stop, std::string& text) {
  for (int waited_ms = 0; !processes::becomes_readable(socket_.number(), look_ms); waited_ms += look_ms) {
    refuse_if_stopped(uri_, stop);
    if (waited_ms >= patience_ms) return Answer::silent;
  }
  std::array<char, longest_message> bytes{};
  const auto size = recv(socket_.number(), bytes.data(), bytes.size(), MSG_DONTWAIT);
  if (size < 1) return Answer::ended;
  text.assign(bytes.data() + 1, static_cast<std::size_t>(size - 1));
  switch (bytes[0]) {
    case says_look:
      return Answer::look;
    case says_opening:
      return Answer::opening;
    case says_ready:
      return Answer::ready;
    default:
      return Answer::refused;
  }
}

void DeviceHost::refuse(const std::string& why) const { throw DeviceError(fmt::format("{}: {}", uri_, why)); }

void DeviceHost::refuse(Answer answer, const std::string& text) const {
  if (answer == Answer::refused) refuse(text);
  if (answer == Answer::silent)
    refuse(fmt::format("it gives no sign of life {}; it was ended", in_words(page_->reader.stage.load())));
  // It is about to be over.
  for (int round = 0; round < 20 && trouble().empty(); ++round) usleep(10'000);
  const std::string how = trouble();
  refuse(how.empty() ? std::string("it closed its connection") : how);
}

Look DeviceHost::look(const std::filesystem::path& plugin) {
  return look(Question{.uri = plugin.string(), .plugin = plugin, .options = {}});
}

Look DeviceHost::look_for_library(const std::string& built_in) {
  return look(Question{.uri = built_in, .plugin = {}, .built_in = built_in, .options = {}});
}

Look DeviceHost::look(const Question& question) {
  DeviceHost host(question.uri);
  host.ask(ask_to_look, question);
  std::string text;
  if (const Answer answer = host.answer(load_ms, nullptr, text); answer != Answer::look)
    host.refuse(answer, text);
  std::vector<std::string> texts;
  std::string_view rest = text;
  for (auto end = rest.find('\0'); end != std::string_view::npos; end = rest.find('\0')) {
    texts.emplace_back(rest.substr(0, end));
    rest.remove_prefix(end + 1);
  }
  if (texts.size() < 2) host.refuse("it says nothing of itself");
  return {.name = texts[0], .about = texts[1], .options = {texts.begin() + 2, texts.end()}};
}

DeviceHost::DeviceHost(const Question& question) : DeviceHost(question.uri) {
  ask(ask_to_open, question);
  std::string text;
  Answer said = answer(load_ms, question.stop, text);
  int patience_ms = usual_open_ms;
  if (said == Answer::opening) {
    std::from_chars(text.data(), text.data() + text.size(), patience_ms);
    if (patience_ms > usual_open_ms)
      tell_wait(fmt::format("{}: it may take {:.3g} s to be opened", uri_, 1e-3 * patience_ms));
    said = answer(patience_ms + beyond_ms, question.stop, text);
  }
  if (said != Answer::ready) refuse(said, text);
}

void DeviceHost::wake() const noexcept {
  constexpr std::uint64_t one = 1;
  [[maybe_unused]] const auto written = ::write(wakes_.number(), &one, sizeof one);
}

void DeviceHost::wait_for_reason() const { (void)processes::becomes_readable(socket_.number(), reason_ms); }

std::string DeviceHost::trouble() const {
  const std::string where = whereabouts(*page_);
  const auto said = [&](char kind) -> std::string {
    std::array<char, longest_message> bytes{};
    const auto size = recv(socket_.number(), bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_PEEK);
    return size > 1 && bytes[0] == kind ? std::string(bytes.data() + 1, static_cast<std::size_t>(size - 1))
                                        : std::string();
  };
  if (const std::string why = said(says_lost); !why.empty()) return why;
  siginfo_t info{};
  if (waitid(P_PID, static_cast<id_t>(process_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
      info.si_pid != 0) {
    if (const std::string why = said(says_refused); !why.empty()) return why + " " + where;
    if (info.si_code != CLD_EXITED)
      return fmt::format("it crashed: {} {}", signal_name(info.si_status), where);
    if (page_->lost.load() != 0) return "it says that the device is lost";
    return fmt::format("it called exit({}) {}", info.si_status, where);
  }
  if (page_->lost.load() != 0) return "it says that the device is lost";
  if (page_->unguarded.load() != 0)
    return "the process that would let it go has ended: it gives no force any more";
  for (const Whereabouts* const thread : {&page_->writer, &page_->reader}) {
    const Stage stage = thread->stage.load();
    if (stage != Stage::elsewhere && usb::now_ns() - thread->since_ns.load() > hangs_ns)
      return std::string("it does not come back ") + in_words(stage);
  }
  return {};
}

}  // namespace kerf::drivers::hosted
