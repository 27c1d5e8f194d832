// The sketch as it is compiled for the board, on a simulated one, and with the driver at the other end of its
// line.
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/drivers/device.h>
#include <kerf/drivers/protocols/frame_reader.h>
#include <kerf/drivers/protocols/hapkit.h>

#include "serial/pseudo_port.h"
#include "simulated_board.h"

namespace kerf::test {
namespace {

using drivers::hapkit::Frame;

class HapkitSketch : public testing::Test {
 protected:
  /// What comes until then.
  std::vector<Frame> frames_until(double at_s) {
    board_.run_until(at_s);
    std::vector<Frame> found;
    for (const auto& heard : board_.take_heard()) {
      reader_.take(
          std::array{heard.byte},
          [&](std::span<const std::uint8_t> bytes) {
            found.push_back(drivers::hapkit::parse(bytes));
            last_byte_s_.push_back(heard.at_s);
          },
          [&] { ++wrong_; });
    }
    return found;
  }

  SimulatedBoard board_{KERF_HAPKIT_ELF};
  drivers::FrameReader<drivers::hapkit::FrameBytes> reader_;
  std::vector<double> last_byte_s_;
  int wrong_ = 0;
};

TEST_F(HapkitSketch, SendsAThousandFramesASecond) {
  const auto frames = frames_until(0.5);
  ASSERT_GT(frames.size(), 495U);
  EXPECT_EQ(wrong_, 0);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    ASSERT_EQ(frames[i].count, i + 1);
    ASSERT_NEAR(frames[i].sensor, 512, 1);
    ASSERT_EQ(frames[i].status, drivers::hapkit::let_go | drivers::hapkit::fresh);
    if (i > 1) {
      ASSERT_NEAR(last_byte_s_[i] - last_byte_s_[i - 1], 1e-3, 5e-5);
    }
  }
}

// With orders as they come from a loop, one a millisecond, whatever their place in the board's own.
TEST_F(HapkitSketch, TakesAThousandOrdersASecondWithoutLosingAFrame) {
  (void)frames_until(0.01);
  std::size_t frames = 0;
  std::uint8_t number = 0;
  for (int i = 1; i <= 400; ++i) {
    board_.say(drivers::hapkit::order(++number, i % 2 == 0 ? 255 - i % 100 : i % 100 - 255));
    for (const Frame& frame : frames_until(0.01 + 1.0009e-3 * i)) {
      ++frames;
      ASSERT_EQ(frame.count, 10 + frames - 1);
      ASSERT_EQ(frame.status & ~(drivers::hapkit::let_go | drivers::hapkit::fresh), 0U);
      if (i > 2) {
        ASSERT_LE(static_cast<std::uint8_t>(number - frame.order), 1);
      }
    }
  }
  EXPECT_GE(frames, 399U);
  EXPECT_EQ(wrong_, 0);
}

TEST_F(HapkitSketch, PushesAsItIsToldEitherWay) {
  double now_s = 0.01;
  (void)frames_until(now_s);
  std::uint8_t number = 0;
  for (const int duty : {1, 128, 255, -1, -128, -255, 0, 300, -300}) {
    const std::uint8_t sent = ++number;
    auto order = drivers::hapkit::order(sent, duty);
    board_.say(order);
    const auto frames = frames_until(now_s += 3e-3);
    ASSERT_FALSE(frames.empty());
    EXPECT_EQ(frames.back().order, sent);
    EXPECT_EQ(board_.motor(), std::clamp(duty, -255, 255)) << duty;
    EXPECT_EQ(frames.back().duty, board_.motor());
  }
}

TEST_F(HapkitSketch, LetsGoTwentyMillisecondsAfterTheLastOrder) {
  (void)frames_until(0.05);
  board_.say(drivers::hapkit::order(1, -200));
  double let_go_s = 0.0;
  for (double now_s = 0.05; now_s < 0.1 && let_go_s == 0.0; now_s += 1e-4) {
    (void)frames_until(now_s);
    if (now_s > 0.052 && board_.motor() == 0) let_go_s = now_s;
    if (now_s > 0.052 && let_go_s == 0.0) {
      ASSERT_EQ(board_.motor(), -200);
    }
  }
  EXPECT_GT(let_go_s, 0.05 + 18.9e-3);
  EXPECT_LT(let_go_s, 0.05 + 20.5e-3);
  const auto frames = frames_until(0.11);
  ASSERT_FALSE(frames.empty());
  EXPECT_EQ(frames.back().status, drivers::hapkit::let_go);
  // And what is no order feeds nothing.
  auto turned = drivers::hapkit::order(2, 100);
  turned[4] ^= 1U;
  board_.say(turned);
  EXPECT_TRUE(std::ranges::any_of(frames_until(0.12), [](const Frame& frame) {
    return frame.status == (drivers::hapkit::let_go | drivers::hapkit::refused);
  }));
  EXPECT_EQ(board_.motor(), 0);
}

TEST_F(HapkitSketch, CountsTheHalfTurnsOfItsSensor) {
  int place = 500;
  for (int i = 1; i < 400; ++i) {
    place += i < 200 ? 23 : -31;
    const int half_turns = static_cast<int>(std::floor(place / 923.0));
    board_.set_sensor(48 + place - 923 * half_turns);
    for (const Frame& frame : frames_until(1e-3 * i + 8e-4))
      ASSERT_NEAR(frame.sensor + 923 * frame.flips, 48 + place, 2) << i;
  }
}

/// The board at the other end of a pseudo-terminal, at the pace of the clock on the wall; on a machine that
/// is too busy, slower.
class RunningBoard {
 public:
  RunningBoard()
      : thread_([this] {
          for (double board_s = 0.0; !stop_; board_s += 5e-4) {
            const auto began = std::chrono::steady_clock::now();
            board_.set_sensor(sensor_);
            board_.run_until(board_s);
            motor_ = board_.motor();
            std::array<std::uint8_t, 256> bytes{};
            if (const auto size = port_.receive(bytes); size > 0)
              board_.say(std::span(bytes).first(static_cast<std::size_t>(size)));
            for (const auto& heard : board_.take_heard()) port_.send(std::array{heard.byte});
            std::this_thread::sleep_until(began + std::chrono::microseconds(450));
          }
        }) {}
  RunningBoard(const RunningBoard&) = delete;
  RunningBoard& operator=(const RunningBoard&) = delete;
  ~RunningBoard() {
    stop_ = true;
    thread_.join();
  }
  [[nodiscard]] std::string uri() const { return "hapkit:" + port_.path(); }
  void set_sensor(int count) { sensor_ = count; }
  [[nodiscard]] int motor() const { return motor_; }

 private:
  emulators::PseudoPort port_{""};
  SimulatedBoard board_{KERF_HAPKIT_ELF};
  std::atomic<int> sensor_{500};
  std::atomic<int> motor_{0};
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

TEST(HapkitSketchAndDriver, UnderstandEachOther) {
  RunningBoard board;
  const auto device = drivers::open_device(board.uri());
  const drivers::hapkit::Made made;
  const auto becomes = [&](double force_n, const auto& condition) {
    for (int tick = 0; tick < 10'000; ++tick) {
      drivers::Sample sample;
      (void)device->write({force_n});
      // Of a board that is too slow every reading is too old, and what it says is true all the same.
      if (device->read(0.0, sample) != drivers::Status::lost && condition(sample)) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
  };
  for (const double force_n : {1.5, -3.0}) {
    EXPECT_TRUE(becomes(force_n, [&](const drivers::Sample& now) {
      return now.channels[2] == made.duty(force_n) / 255.0 && board.motor() == made.duty(force_n);
    })) << force_n;
  }
  board.set_sensor(600);
  EXPECT_TRUE(becomes(0.0, [&](const drivers::Sample& now) {
    return std::abs(now.position[0] - 100 * made.step_m()) < 1.5 * made.step_m() && board.motor() == 0;
  }));
}

}  // namespace
}  // namespace kerf::test
