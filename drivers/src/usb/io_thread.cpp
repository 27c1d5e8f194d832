#include "kerf/drivers/usb/io_thread.h"

#include <cerrno>
#include <system_error>

#include <poll.h>
#include <sys/eventfd.h>
#include <time.h>
#include <unistd.h>

#include "kerf/drivers/urgent_thread.h"

namespace kerf::drivers::usb {
std::int64_t now_ns() noexcept {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{1'000'000'000} * now.tv_sec + now.tv_nsec;
}

IoThread::IoThread() : wake_descriptor_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (wake_descriptor_ < 0) throw std::system_error(errno, std::generic_category(), "eventfd");
}

IoThread::~IoThread() {
  stop();
  close(wake_descriptor_);
}

void IoThread::start(std::function<void(const std::stop_token&)> work) {
  thread_ = std::jthread([work = std::move(work)](const std::stop_token& stop) {
    become_urgent("kerf-usb");
    work(stop);
  });
}

void IoThread::stop() noexcept {
  if (!thread_.joinable()) return;
  thread_.request_stop();
  wake();
  thread_.join();
}

void IoThread::wake() noexcept {
  const std::uint64_t one = 1;
  // It fails only where as many wake-ups wait as a counter holds; then it is awake.
  [[maybe_unused]] const auto written = write(wake_descriptor_, &one, sizeof one);
}

void IoThread::take_wakes() noexcept {
  std::uint64_t count = 0;
  [[maybe_unused]] const auto got = read(wake_descriptor_, &count, sizeof count);
}

bool IoThread::wait(std::int64_t max_ns) noexcept {
  pollfd descriptor{.fd = wake_descriptor_, .events = POLLIN, .revents = 0};
  const timespec most{.tv_sec = max_ns / 1'000'000'000, .tv_nsec = max_ns % 1'000'000'000};
  if (ppoll(&descriptor, 1, &most, nullptr) <= 0) return false;
  take_wakes();
  return true;
}

}  // namespace kerf::drivers::usb
