#include "usbip.h"

#include <array>
#include <bit>
#include <cerrno>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <kerf/drivers/usb/io_thread.h>

#include "attach.h"
#include "faults.h"
#include "make_device.h"
#include "network/own_port.h"
#include "session.h"

namespace kerf::emulators {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using usbip::Request;

TEST(UsbIp, ReadsTheSubmitOfTheKernelsDocument) {
  // CMD_SUBMIT number 13 of device 0x00010002, IN from endpoint 1, 64 bytes:
  // Documentation/usb/usbip_protocol.rst
  std::array<std::uint8_t, usbip::header_size> header{0, 0, 0, 1, 0,   0,   0,   13,  0, 1, 0, 2, 0, 0,
                                                      0, 1, 0, 0, 0,   1,   0,   0,   2, 0, 0, 0, 0, 64,
                                                      0, 0, 0, 0, 255, 255, 255, 255, 0, 0, 0, 4};
  const auto request = usbip::parse_request(header);
  ASSERT_TRUE(request.has_value());
  EXPECT_EQ(request->kind, Request::Kind::submit);
  EXPECT_EQ(request->sequence, 13U);
  EXPECT_EQ(request->device, 0x00010002U);
  EXPECT_TRUE(request->in);
  EXPECT_EQ(request->endpoint, 1U);
  EXPECT_EQ(request->length, 64U);
}

TEST(UsbIp, RefusesWhatIsNoRequest) {
  std::array<std::uint8_t, usbip::header_size> header{0, 0, 0, 9};
  EXPECT_FALSE(usbip::parse_request(header).has_value());
  header = usbip::encode({.endpoint = 15});
  EXPECT_TRUE(usbip::parse_request(header).has_value());
  header[19] = 16;  // the endpoint
  EXPECT_FALSE(usbip::parse_request(header).has_value());
  header = usbip::encode({.length = 1});
  header[24] = 0x7F;  // a buffer of 2 GB
  EXPECT_FALSE(usbip::parse_request(header).has_value());
}

TEST(EmulatorFaults, ComeAtTheirTimeAndAsOftenAsAsked) {
  FaultPlan plan(parse_faults("drop@1.0:2,stall@2,unplug@3.5"));
  EXPECT_EQ(plan.due(0.999), Disturbance::none);
  EXPECT_EQ(plan.due(1.0), Disturbance::drop);
  plan.done(Disturbance::drop, 1.0);
  EXPECT_EQ(plan.due(1.1), Disturbance::drop);
  plan.done(Disturbance::drop, 1.1);
  EXPECT_EQ(plan.due(1.2), Disturbance::none);
  EXPECT_FALSE(plan.stalls(1.9));
  EXPECT_TRUE(plan.stalls(2.0));
  EXPECT_FALSE(plan.stalls(2.1));
  EXPECT_EQ(plan.unplugged_at_s(), 3.5);
}

TEST(EmulatorFaults, LastAsLongAsAsked) {
  FaultPlan plan(parse_faults("delay@1:20ms:0.5s,refuse-out@2:30ms,stick@3:1s,delay@4:1.5s,duplicate@5"));
  EXPECT_EQ(plan.delay_s(0.9), 0.0);
  EXPECT_DOUBLE_EQ(plan.delay_s(1.0), 0.02);
  EXPECT_EQ(plan.delay_s(1.5), 0.0);
  EXPECT_DOUBLE_EQ(plan.delay_s(1e6), 1.5) << "for ever";
  EXPECT_FALSE(plan.refuses_until_s(1.99));
  EXPECT_DOUBLE_EQ(plan.refuses_until_s(2.0).value(), 2.03);
  EXPECT_FALSE(plan.refuses_until_s(2.04));
  EXPECT_TRUE(plan.sticks(3.5));
  EXPECT_FALSE(plan.sticks(4.5));
  EXPECT_TRUE(plan.duplicates(5.0));
  EXPECT_FALSE(plan.duplicates(5.0));
}

TEST(EmulatorFaults, TurnOtherBitsByAnotherSeedAndTheSameByTheSame) {
  const auto drawn = [](const char* text) {
    FaultPlan plan(parse_faults(text));
    std::vector<std::uint64_t> bits;
    while (const auto bit = plan.flips(1.0)) bits.push_back(*bit % 128);
    return bits;
  };
  EXPECT_EQ(drawn("flip@1:20:7"), drawn("flip@1:20:7"));
  EXPECT_NE(drawn("flip@1:20:7"), drawn("flip@1:20:8"));
  const auto many = drawn("flip@1:2000:7");
  EXPECT_EQ(many.size(), 2000U);
  EXPECT_EQ(std::set(many.begin(), many.end()).size(), 128U) << "none is left out";
}

TEST(EmulatorFaults, SayWhatWasExpected) {
  for (const char* text : {"drop", "drop@", "drop@x", "drop@-1", "drop@1:0", "drop@1:x", "drop@1:1:1",
                           "fall@1", "drop@1,,stall@2", "unplug@1:2", "flip@1:2:x", "delay@1", "delay@1:5",
                           "delay@1:0ms", "delay@1:1ms:2ms:3ms", "refuse-out@1", "stick@1:-1s"}) {
    try {
      (void)parse_faults(text);
      ADD_FAILURE() << text;
    } catch (const std::invalid_argument& error) {
      EXPECT_THAT(error.what(), HasSubstr("expected KIND@SECONDS")) << text;
    }
  }
}

TEST(Emulators, RefuseWhatTheyDoNotKnow) {
  EXPECT_THROW((void)make_device("toaster"), std::runtime_error);
  EXPECT_THROW((void)make_device("spacemouse?colour=red"), std::runtime_error);
}

/// A host that speaks USB/IP with a session over a socket, in place of the kernel.
class Host {
 public:
  explicit Host(const char* device, const char* faults = "") : device_(make_device(device)) {
    std::array<int, 2> ends{};
    if (socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()) != 0) throw std::runtime_error("socketpair");
    here_ = Descriptor(ends[0]);
    there_ = Descriptor(ends[1]);
    thread_ = std::jthread([this, plan = FaultPlan(parse_faults(faults))] {
      end_ = Session(there_.number(), *device_, plan).run(stop_, 0.0);
      there_ = Descriptor();
    });
  }
  ~Host() { stop_ = true; }

  struct Reply {
    std::uint32_t command = 0;
    std::uint32_t sequence = 0;
    std::int32_t status = 0;
    std::vector<std::uint8_t> data;
  };
  void send(const Request& request, std::vector<std::uint8_t> data = {}) {
    const auto header = usbip::encode(request);
    ASSERT_EQ(::send(here_.number(), header.data(), header.size(), 0), static_cast<ssize_t>(header.size()));
    if (!data.empty()) {
      ASSERT_EQ(::send(here_.number(), data.data(), data.size(), 0), static_cast<ssize_t>(data.size()));
    }
  }
  Reply receive(bool in) {
    std::array<std::uint8_t, usbip::header_size> header{};
    if (recv(here_.number(), header.data(), header.size(), MSG_WAITALL) <= 0) return {};
    const auto word = [&](std::size_t at) {
      return static_cast<std::uint32_t>(header[at] << 24 | header[at + 1] << 16 | header[at + 2] << 8 |
                                        header[at + 3]);
    };
    Reply reply{.command = word(0), .sequence = word(4), .status = static_cast<std::int32_t>(word(20))};
    if (reply.command == 3 && in && reply.status == 0) reply.data.resize(word(24));
    if (!reply.data.empty()) recv(here_.number(), reply.data.data(), reply.data.size(), MSG_WAITALL);
    return reply;
  }
  Reply control(std::array<std::uint8_t, 8> setup) {
    const bool in = (setup[0] & 0x80U) != 0;
    send({.sequence = 1,
          .in = in,
          .length = static_cast<std::uint32_t>(setup[6] | setup[7] << 8),
          .setup = setup});
    return receive(in);
  }
  void leave() { here_ = Descriptor(); }
  Session::End wait() {
    thread_.join();
    return end_;
  }

 private:
  std::unique_ptr<EmulatedDevice> device_;
  Descriptor here_;
  Descriptor there_;
  std::atomic<bool> stop_{false};
  Session::End end_ = Session::End::stopped;
  std::jthread thread_;
};

TEST(Session, AnswersTheStandardRequests) {
  Host host("spacemouse");
  // The first eight bytes of the device descriptor, as a host asks for them first.
  EXPECT_THAT(host.control({0x80, 6, 0, 1, 0, 0, 8, 0}).data, ElementsAre(0x12, 1, 0, 2, 0, 0, 0, 8));
  EXPECT_EQ(host.control({0x80, 6, 0, 2, 0, 0, 255, 0}).data.size(), 41U);
  EXPECT_THAT(host.control({0x80, 6, 0, 3, 0, 0, 255, 0}).data, ElementsAre(4, 3, 9, 4));
  const auto name = host.control({0x80, 6, 2, 3, 9, 4, 255, 0}).data;
  EXPECT_EQ(name.size(), 2 + 2 * std::string("SpaceNavigator").size());
  EXPECT_EQ(host.control({0x81, 6, 0, 0x22, 0, 0, 217, 0}).data.size(), 217U);
  EXPECT_EQ(host.control({0x80, 6, 3, 3, 9, 4, 255, 0}).status, -EPIPE) << "there is no third string";
  EXPECT_EQ(host.control({0x80, 6, 0, 6, 0, 0, 10, 0}).status, -EPIPE)
      << "a full-speed device has no qualifier";
  EXPECT_EQ(host.control({0x00, 9, 1, 0, 0, 0, 0, 0}).status, 0);
}

TEST(Session, EndsATransferThatIsUnlinkedAndNotOneThatHasEnded) {
  Host host("spacemouse?rest=0.001s");
  // Let go, the cap falls silent after its zeros: the last transfer waits for ever.
  for (std::uint32_t number = 10; number < 30; ++number)
    host.send({.sequence = number, .in = true, .endpoint = 1, .length = 8});
  std::uint32_t last = 0;
  for (int i = 0; i < 7; ++i) last = host.receive(true).sequence;
  EXPECT_EQ(last, 16U) << "in the order in which they were asked for";
  host.send({.kind = Request::Kind::unlink, .sequence = 40, .unlinked = 29});
  auto reply = host.receive(false);
  EXPECT_EQ(reply.command, 4U);
  EXPECT_EQ(reply.sequence, 40U);
  EXPECT_EQ(reply.status, -ECONNRESET);
  host.send({.kind = Request::Kind::unlink, .sequence = 41, .unlinked = 10});
  reply = host.receive(false);
  EXPECT_EQ(reply.sequence, 41U);
  EXPECT_EQ(reply.status, 0);
}

TEST(Session, StallsWhenAskedTo) {
  Host host("spacemouse", "stall@0:1");
  host.send({.sequence = 5, .in = true, .endpoint = 1, .length = 8});
  EXPECT_EQ(host.receive(true).status, -EPIPE);
  host.send({.sequence = 6, .in = true, .endpoint = 1, .length = 8});
  const auto reply = host.receive(true);
  EXPECT_EQ(reply.status, 0);
  EXPECT_EQ(reply.data.size(), 7U);
}

/// Time since the host sent its first, in whole frames, at which each of some transfers was taken.
std::vector<std::int64_t> frames_taken(Host& host, const Request& request, std::size_t size, int count) {
  const auto now_ms = [] { return drivers::usb::now_ns() / 1'000'000; };
  const std::int64_t sent_ms = now_ms();
  for (int i = 0; i < count; ++i) host.send(request, std::vector<std::uint8_t>(size));
  std::vector<std::int64_t> frames;
  for (int i = 0; i < count; ++i) {
    EXPECT_EQ(host.receive(false).status, 0);
    frames.push_back(now_ms() - sent_ms);
  }
  return frames;
}

TEST(Session, TakesOneInterruptTransferInEachInterval) {
  const Request order{.sequence = 1, .endpoint = 1, .length = 8};
  Host v1("woody?generation=v1");
  const auto frames = frames_taken(v1, order, 8, 8);
  for (std::size_t i = 0; i < frames.size(); ++i) EXPECT_GE(frames[i], static_cast<std::int64_t>(i) + 1);
  // 10 ms by its descriptor, which a host controller takes for 8.
  Host cap("spacemouse");
  const auto slow = frames_taken(cap, {.sequence = 1, .endpoint = 2, .length = 2}, 2, 3);
  EXPECT_GE(slow[1], 8);
  EXPECT_GE(slow[2], 16);
}

TEST(Session, RefusesWhatTheHostSendsForAsLongAsAsked) {
  Host host("woody?generation=v1", "refuse-out@0:30ms");
  const auto frames = frames_taken(host, {.sequence = 1, .endpoint = 1, .length = 8}, 8, 1);
  EXPECT_GE(frames[0], 29);
  Host given_up("woody?generation=v1", "refuse-out@0:1000s");
  given_up.send({.sequence = 7, .endpoint = 1, .length = 8}, std::vector<std::uint8_t>(8));
  given_up.send({.kind = Request::Kind::unlink, .sequence = 8, .unlinked = 7});
  EXPECT_EQ(given_up.receive(false).status, -ECONNRESET);
}

TEST(Session, DelaysRepeatsAndFlipsAnswers) {
  const Request ask{.sequence = 5, .in = true, .endpoint = 1, .length = 8};
  Host late("woody?generation=v1", "delay@0:40ms");
  const std::int64_t asked_ns = drivers::usb::now_ns();
  late.send(ask);
  EXPECT_EQ(late.receive(true).data.size(), 8U);
  EXPECT_GE(drivers::usb::now_ns() - asked_ns, 40'000'000);
  const auto three = [&](const char* faults) {
    Host host("woody?generation=v1&sway=0m", faults);
    std::vector<std::vector<std::uint8_t>> answers;
    for (int i = 0; i < 3; ++i) host.send(ask);
    for (int i = 0; i < 3; ++i) answers.push_back(host.receive(true).data);
    return answers;
  };
  const auto well = three("");
  const auto twice = three("duplicate@0");
  EXPECT_EQ(twice[0], twice[1]) << "with its counter";
  EXPECT_EQ(twice[2], well[1]);
  const auto turned = three("flip@0:1:3");
  int bits = 0;
  for (std::size_t i = 0; i < 8; ++i) bits += std::popcount(static_cast<unsigned>(turned[0][i] ^ well[0][i]));
  EXPECT_EQ(bits, 1);
  EXPECT_EQ(turned[1], well[1]);
}

TEST(Session, NoticesWhenTheHostLeavesAndUnplugsItself) {
  Host leaving("spacemouse");
  leaving.leave();
  EXPECT_EQ(leaving.wait(), Session::End::host_left);
  Host unplugged("spacemouse", "unplug@0.01");
  EXPECT_EQ(unplugged.wait(), Session::End::unplugged);
  EXPECT_EQ(unplugged.receive(true).command, 0U) << "the connection is closed";
}

TEST(UsbIp, ServesAClientOverLoopback) {
  const auto device = make_device("spacemouse");
  const OwnPort own = open_port(Transport::connections, "127.0.0.1", 0);
  EXPECT_LT(accept_import(own.socket, device->description(), 1).number(), 0) << "nobody came";
  EXPECT_EQ(usbip::list_reply(device->description()).size(), 8U + 4 + 312 + 4);
  const auto granted = usbip::import_reply(device->description(), true);
  ASSERT_EQ(granted.size(), 8U + 312);
  EXPECT_THAT(std::vector(granted.begin() + 8 + 300, granted.begin() + 8 + 304),
              ElementsAre(0x04, 0x6d, 0xc6, 0x26));
  EXPECT_EQ(usbip::import_reply(device->description(), false).size(), 8U);
}

}  // namespace
}  // namespace kerf::emulators
