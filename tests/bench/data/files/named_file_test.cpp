#include "files/named_file.h"

#include <array>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "files/mapped_file.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;
using testing::EndsWith;
using testing::HasSubstr;

template <typename Action>
std::string refusal(const Action& action) {
  try {
    action();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(NamedFile, HoldsWhatStandsInIt) {
  const test::TemporaryFolder folder;
  const std::string content = std::string(100'000, 'x') + std::string("a\0b\r\n", 5);
  test::write_text(folder / "x", content);
  EXPECT_EQ(read_named_file(folder / "x"), content);
  EXPECT_EQ(MappedFile(folder / "x").text(), content);
  test::write_text(folder / "empty", "");
  EXPECT_EQ(read_named_file(folder / "empty"), "");
  EXPECT_EQ(MappedFile(folder / "empty").text(), "");
}

TEST(MappedFile, IsZerosWhereTheFileBecameShorter) {
  const test::TemporaryFolder folder;
  const std::string content(100'000, 'x');
  test::write_text(folder / "x", content);
  test::write_text(folder / "y", content);
  const MappedFile mapped(folder / "x");
  const MappedFile other(folder / "y");
  EXPECT_EQ(mapped.text(), content);
  fs::resize_file(folder / "x", 10'000);
  EXPECT_EQ(mapped.text().substr(0, 10'000), content.substr(0, 10'000));
  EXPECT_NO_THROW(mapped.require_whole()) << "nobody looked there";
  EXPECT_EQ(mapped.text().back(), '\0');
  EXPECT_THAT(refusal([&] { mapped.require_whole(); }), HasSubstr("x: it became shorter while it was read"));
  EXPECT_EQ(other.text(), content);
  EXPECT_NO_THROW(other.require_whole());
  // A place that another file had before.
  const MappedFile again(folder / "y");
  EXPECT_NO_THROW(again.require_whole());
}

TEST(MappedFileDeathTest, LeavesBusErrorsOfOthersAsTheyWere) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const test::TemporaryFolder folder;
  test::write_text(folder / "x", "1");
  const MappedFile mapped(folder / "x");
  // The first is passed on to nobody, which makes the second what it would have been.
  EXPECT_DEATH(
      {
        (void)raise(SIGBUS);
        (void)raise(SIGBUS);
      },
      "");
}

/// A pipe as a shell hands it over.
struct HandedOver {
  HandedOver() {
    if (pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
  }
  HandedOver(const HandedOver&) = delete;
  HandedOver& operator=(const HandedOver&) = delete;
  ~HandedOver() {
    close(ends[0]);
    close_writer();
  }
  void close_writer() {
    if (ends[1] >= 0) close(std::exchange(ends[1], -1));
  }
  void write_text(const std::string& text) const {
    EXPECT_EQ(write(ends[1], text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }
  [[nodiscard]] fs::path name() const { return "/dev/fd/" + std::to_string(ends[0]); }

  std::array<int, 2> ends{};
};

TEST(NamedFile, MayBeAPipeThatIsHandedOver) {
  for (const auto& read : {+[](const fs::path& file) { return read_named_file(file); },
                           +[](const fs::path& file) { return std::string(MappedFile(file).text()); }}) {
    HandedOver pipe;
    pipe.write_text("through ");
    std::jthread writer([&] {
      pipe.write_text("a pipe");
      pipe.close_writer();
    });
    EXPECT_EQ(read(pipe.name()), "through a pipe");
  }
  HandedOver ended;
  ended.close_writer();
  EXPECT_EQ(read_named_file(ended.name()), "");
}

TEST(NamedFile, IsGivenUpWhereItsPipeStaysSilent) {
  HandedOver pipe;
  pipe.write_text("the beginning");
  const NamedFile file(pipe.name(), std::chrono::milliseconds(20));
  EXPECT_THAT(refusal([&] { (void)file.read_all(LargestInput::text); }),
              EndsWith(": nothing came through the pipe for 0.02 s; is its writer at work?"));
}

TEST(NamedFile, IsNoFifoOrDeviceThatIsMerelyNamed) {
  const test::TemporaryFolder folder;
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  const std::string fifo = refusal([&] { (void)read_named_file(folder / "pipe"); });
  EXPECT_THAT(fifo, HasSubstr("pipe: a FIFO; expected a regular file, or a pipe handed over"));
  for (const char* device : {"/dev/zero", "/dev/null"}) {
    EXPECT_EQ(refusal([&] { (void)read_named_file(device); }),
              std::string(device) + ": a device; expected a regular file");
    EXPECT_THAT(refusal([&] { const MappedFile mapped(device); }), HasSubstr(": a device;"));
  }
}

TEST(NamedFile, HasALimit) {
  const test::TemporaryFolder folder;
  test::write_text(folder / "x", "");
  fs::resize_file(folder / "x", LargestInput::text);
  EXPECT_EQ(read_named_file(folder / "x").size(), LargestInput::text);
  fs::resize_file(folder / "x", LargestInput::text + 1);
  const std::string expected = "x: 16777217 bytes; expected 16 MiB at most";
  EXPECT_THAT(refusal([&] { (void)read_named_file(folder / "x"); }), HasSubstr(expected));
  EXPECT_THAT(refusal([&] { const MappedFile mapped(folder / "x", LargestInput::text); }),
              HasSubstr(expected));
  HandedOver pipe;
  pipe.write_text("12345");
  pipe.close_writer();
  EXPECT_THAT(refusal([&] { (void)read_named_file(pipe.name(), 4); }), HasSubstr("more than"));
}

TEST(NamedFile, IsNamedWronglyWhereItCannotBeOpened) {
  const test::TemporaryFolder folder;
  fs::create_symlink("loop", folder / "loop");
  for (const auto& open : {+[](const fs::path& file) { (void)read_named_file(file); },
                           +[](const fs::path& file) { const MappedFile mapped(file); }}) {
    EXPECT_EQ(refusal([&] { open(folder / "none"); }), (folder / "none").string() + ": no such file");
    EXPECT_THAT(refusal([&] { open(folder.path()); }), EndsWith(": a folder; expected a file"));
    EXPECT_THAT(refusal([&] { open(folder / "loop"); }), HasSubstr("loop: cannot be read: Too many levels"));
  }
}

TEST(NamedFolder, IsNamedWronglyWhereThereIsNone) {
  const test::TemporaryFolder folder;
  test::write_text(folder / "x", "");
  EXPECT_EQ(refusal([&] { require_named_folder(folder.path()); }), "accepted");
  for (const char* name : {"none", "x"})
    EXPECT_EQ(refusal([&] { require_named_folder(folder / name); }),
              (folder / name).string() + ": there is no such folder");
}

}  // namespace
}  // namespace kerf::bench
