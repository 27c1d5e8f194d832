#include "host/aside_writer.h"

#include <cerrno>
#include <condition_variable>
#include <deque>
#include <map>
#include <mutex>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

#include <poll.h>
#include <unistd.h>

#include "host/realtime.h"

namespace kerf::bench {
namespace {

/// @returns errno, 0 if all of it was written.
int write_all(int descriptor, std::string_view text) noexcept {
  while (!text.empty()) {
    const ssize_t count = ::write(descriptor, text.data(), text.size());
    if (count > 0) {
      text.remove_prefix(static_cast<std::size_t>(count));
    } else if (count < 0 && errno == EAGAIN) {  // somebody else has made it non-blocking
      pollfd room{.fd = descriptor, .events = POLLOUT, .revents = 0};
      static_cast<void>(::poll(&room, 1, -1));
    } else if (count == 0 || errno != EINTR) {
      return count == 0 ? EIO : errno;
    }
  }
  return 0;
}

}  // namespace

struct AsideWriter::State {
  struct Text {
    int descriptor;
    std::string text;
    bool is_missed;  ///< where it cannot be written; else it need not wait for others either
  };

  mutable std::mutex mutex;
  std::condition_variable changed;
  std::deque<Text> queue;  ///< its front is being written
  std::vector<Text> failed;
  std::map<int, int> failures;  ///< errno of the first, by descriptor
  bool ended = false;
  bool has_thread = false;

  void add(int descriptor, std::string_view text, bool is_missed) noexcept {
    try {
      const std::lock_guard lock(mutex);
      if (!is_missed && !queue.empty()) return;
      queue.push_back({descriptor, std::string(text), is_missed});
    } catch (const std::exception&) {
      return;  // no memory to print with
    }
    changed.notify_all();
    if (!has_thread) write_what_waits();
  }

  void write_what_waits() {
    std::unique_lock lock(mutex);
    while (!queue.empty()) write_next(lock);
  }

  void write_until_ended() {
    std::unique_lock lock(mutex);
    for (;;) {
      changed.wait(lock, [this] { return ended || !queue.empty(); });
      if (ended) return;
      write_next(lock);
    }
  }

 private:
  void write_next(std::unique_lock<std::mutex>& lock) {
    Text& next = queue.front();  // which stays where it is while others come behind it
    lock.unlock();
    const int failure = write_all(next.descriptor, next.text);
    lock.lock();
    if (failure != 0) failures.try_emplace(next.descriptor, failure);
    if (failure != 0 && next.is_missed) failed.push_back(std::move(next));
    queue.pop_front();
    changed.notify_all();
  }
};

AsideWriter::AsideWriter() : state_(std::make_shared<State>()) {
  try {
    std::thread([state = state_] {
      stay_off_loop_processor();
      state->write_until_ended();
    }).detach();
    state_->has_thread = true;
  } catch (const std::system_error&) {
    // Then it waits as any program does.
  }
}

AsideWriter::~AsideWriter() {
  const std::lock_guard lock(state_->mutex);
  state_->ended = true;
  state_->changed.notify_all();
}

void AsideWriter::write(int descriptor, std::string_view text) noexcept {
  state_->add(descriptor, text, true);
}

void AsideWriter::draw(int descriptor, std::string_view text) noexcept {
  state_->add(descriptor, text, false);
}

bool AsideWriter::wait(std::chrono::milliseconds at_most) {
  std::unique_lock lock(state_->mutex);
  return state_->changed.wait_for(lock, at_most, [this] { return state_->queue.empty(); });
}

void AsideWriter::wait() noexcept {
  std::unique_lock lock(state_->mutex);
  state_->changed.wait(lock, [this] { return state_->queue.empty(); });
}

int AsideWriter::failure(int descriptor) const noexcept {
  const std::lock_guard lock(state_->mutex);
  const auto found = state_->failures.find(descriptor);
  return found == state_->failures.end() ? 0 : found->second;
}

std::vector<std::string> AsideWriter::unwritten(int descriptor) const {
  const std::lock_guard lock(state_->mutex);
  std::vector<std::string> texts;
  for (const State::Text& text : state_->failed) {
    if (text.descriptor == descriptor) texts.push_back(text.text);
  }
  for (const State::Text& text : state_->queue) {
    if (text.descriptor == descriptor && text.is_missed) texts.push_back(text.text);
  }
  return texts;
}

}  // namespace kerf::bench
