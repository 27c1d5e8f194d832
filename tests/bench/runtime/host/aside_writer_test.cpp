#include "host/aside_writer.h"

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <string>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace kerf::bench {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::IsEmpty;

/// A pipe that nobody reads unless asked to.
class AsideWriterToAPipe : public testing::Test {
 protected:
  AsideWriterToAPipe() {
    (void)std::signal(SIGPIPE, SIG_IGN);
    EXPECT_EQ(pipe(ends_.data()), 0);
  }
  ~AsideWriterToAPipe() override {
    for (const int end : ends_) close(end);
  }
  /// So that the next write waits.
  void fill() {
    capacity_ = static_cast<std::size_t>(fcntl(ends_[1], F_GETPIPE_SZ));
    writer_.write(ends_[1], std::string(capacity_, '.'));
    writer_.wait();
  }
  std::string read(std::size_t bytes) {
    std::string text(bytes, '\0');
    std::size_t done = 0;
    while (done < bytes) {
      const ssize_t count = ::read(ends_[0], text.data() + done, bytes - done);
      if (count <= 0) break;
      done += static_cast<std::size_t>(count);
    }
    return text;
  }

  std::array<int, 2> ends_{-1, -1};
  std::size_t capacity_ = 0;
  AsideWriter writer_;
};

TEST_F(AsideWriterToAPipe, WritesInItsOrder) {
  for (const auto* text : {"one ", "two ", "three"}) writer_.write(ends_[1], text);
  writer_.wait();
  EXPECT_EQ(read(13), "one two three");
  EXPECT_THAT(writer_.unwritten(ends_[1]), IsEmpty());
}

TEST_F(AsideWriterToAPipe, KeepsNobodyWaitingWhoWrites) {
  fill();
  writer_.write(ends_[1], "late\n");
  EXPECT_FALSE(writer_.wait(1ms));
  EXPECT_THAT(writer_.unwritten(ends_[1]), ElementsAre("late\n"));
  (void)read(capacity_);
  EXPECT_EQ(read(5), "late\n");
  writer_.wait();
  EXPECT_THAT(writer_.unwritten(ends_[1]), IsEmpty());
}

TEST_F(AsideWriterToAPipe, DropsWhatIsDrawnBehindSomethingThatWaits) {
  fill();
  writer_.write(ends_[1], "line ");
  writer_.draw(ends_[1], "bar");
  writer_.write(ends_[1], "line");
  (void)read(capacity_);
  EXPECT_EQ(read(9), "line line");
}

TEST_F(AsideWriterToAPipe, IsLeftBehindWhereAWriteHangs) {
  fill();
  AsideWriter other;
  other.write(ends_[1], "x");
  EXPECT_FALSE(other.wait(1ms));
}

TEST(AsideWriter, SaysWhatFailedAndGoesOn) {
  const int full = open("/dev/full", O_WRONLY);
  AsideWriter writer;
  writer.write(full, "lost");
  writer.write(full, "lost too");
  writer.draw(full, "not missed");
  writer.wait();
  EXPECT_EQ(writer.failure(full), ENOSPC);
  EXPECT_EQ(writer.failure(full + 1), 0);
  EXPECT_THAT(writer.unwritten(full), ElementsAre("lost", "lost too"));
  close(full);
}

}  // namespace
}  // namespace kerf::bench
