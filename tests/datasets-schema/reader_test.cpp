#include <algorithm>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <kerf/schema/recording.h>
#include <kerf/schema/recording_file.h>
#include <kerf/schema/session.h>
#include <kerf/schema/validate.h>

#include "datasets-schema/changed_file.h"
#include "datasets-schema/recording/sample_recording.h"

namespace kerf::schema {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// Children of this process that are called `kerf-reader`, also those that have ended unnoticed.
std::vector<pid_t> readers() {
  std::vector<pid_t> found;
  for (const auto& task : fs::directory_iterator("/proc/self/task")) {
    std::ifstream children(task.path() / "children");
    for (pid_t child = 0; children >> child;) {
      std::string name;
      std::getline(std::ifstream("/proc/" + std::to_string(child) + "/comm"), name);
      if (name == "kerf-reader") found.push_back(child);
    }
  }
  return found;
}

std::ptrdiff_t descriptors() {
  return std::distance(fs::directory_iterator("/proc/self/fd"), fs::directory_iterator());
}

/// Descriptors of this process that are sockets.
std::vector<int> sockets() {
  std::vector<int> found;
  for (const auto& descriptor : fs::directory_iterator("/proc/self/fd")) {
    std::error_code gone;  // the one that lists them is among them
    if (fs::read_symlink(descriptor, gone).string().starts_with("socket:")) {
      found.push_back(std::stoi(descriptor.path().filename()));
    }
  }
  return found;
}

template <typename Action>
std::string refusal(const Action& action) {
  try {
    action();
    return {};
  } catch (const FormatError& error) {
    return error.what();
  }
}

TEST(Reader, LivesAsLongAsItsFileAndLeavesNothingBehind) {
  const test::TemporaryFolder folder;
  write_recording(folder / "r.h5", test::sample_recording());
  const auto open_before = descriptors();
  {
    const RecordingFile file(folder / "r.h5");
    EXPECT_EQ(readers().size(), 1U);
  }
  static_cast<void>(read_recording(folder / "r.h5"));
  static_cast<void>(refusal([&] { static_cast<void>(read_session(folder / "r.h5")); }));
  EXPECT_TRUE(readers().empty());
  EXPECT_EQ(descriptors(), open_before);
}

TEST(Reader, ThatDiesIsDamageAndTheProgramGoesOn) {
  const test::TemporaryFolder folder;
  const Recording recording = test::sample_recording();
  write_recording(folder / "r.h5", recording);
  const RecordingFile file(folder / "r.h5");
  ASSERT_EQ(readers().size(), 1U);
  ASSERT_EQ(::kill(readers().front(), SIGKILL), 0);
  std::vector<std::uint64_t> ticks(recording.rows());
  const auto read = [&] { file.read_ticks(0, ticks); };
  EXPECT_THAT(refusal(read), HasSubstr("r.h5: damaged HDF5 file (HDF5 fell over: Killed)"));
  EXPECT_THAT(refusal(read), HasSubstr("its reader has fallen over before"));
  EXPECT_EQ(read_recording(folder / "r.h5").rows(), recording.rows());
}

TEST(Reader, ThatEndsOfItselfIsDamageAndSaysHow) {
  const test::TemporaryFolder folder;
  const Recording recording = test::sample_recording();
  write_recording(folder / "r.h5", recording);
  const auto before = sockets();
  const RecordingFile file(folder / "r.h5");
  std::vector<int> ours = sockets();
  std::erase_if(ours, [&](int socket) { return std::ranges::find(before, socket) != before.end(); });
  ASSERT_EQ(ours.size(), 1U);
  ASSERT_EQ(::shutdown(ours.front(), SHUT_WR), 0) << "nobody asks it any more";
  std::vector<std::uint64_t> ticks(recording.rows());
  EXPECT_THAT(refusal([&] { file.read_ticks(0, ticks); }),
              HasSubstr("r.h5: damaged HDF5 file (its reader ended with "));
}

TEST(Reader, ReadsForSeveralThreads) {
  const test::TemporaryFolder folder;
  const Recording recording = test::sample_recording();
  write_recording(folder / "r.h5", recording);
  const RecordingFile file(folder / "r.h5");
  std::vector<std::jthread> threads;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([&] {
      for (int turn = 0; turn < 50; ++turn) {
        std::vector<std::uint64_t> ticks(recording.rows());
        file.read_ticks(0, ticks);
        EXPECT_EQ(ticks, recording.tick);
      }
    });
  }
}

TEST(Reader, ReadsNoOtherFileThatAFileNames) {
  const test::TemporaryFolder folder;
  test::write_text(folder / "secret", std::string(1U << 16U, 's'));
  write_recording(folder / "other.h5", test::sample_recording());
  const auto with_values_elsewhere = test::ChangedFile([&](hid_t file) {
    const auto rows = h5::describe(h5::open(file, "/samples/time").id()).extent;
    H5Ldelete(file, "/samples/velocity", H5P_DEFAULT);
    const h5::Handle creation(H5Pcreate(H5P_DATASET_CREATE));
    H5Pset_external(creation.id(), (folder / "secret").c_str(), 0, H5F_UNLIMITED);
    const std::vector<hsize_t> extent{rows[0],
                                      h5::describe(h5::open(file, "/samples/position").id()).extent[1]};
    const h5::Handle space(H5Screate_simple(2, extent.data(), nullptr));
    const h5::Handle dataset(H5Dcreate2(file, "/samples/velocity", H5T_NATIVE_DOUBLE, space.id(), H5P_DEFAULT,
                                        creation.id(), H5P_DEFAULT));
  });
  EXPECT_THAT(refusal([&] { static_cast<void>(read_recording(with_values_elsewhere.path())); }),
              HasSubstr("/samples/velocity: found"));
  const auto with_a_link = test::ChangedFile([&](hid_t file) {
    H5Ldelete(file, "/samples/velocity", H5P_DEFAULT);
    H5Lcreate_external((folder / "other.h5").c_str(), "/samples/velocity", file, "/samples/velocity",
                       H5P_DEFAULT, H5P_DEFAULT);
  });
  EXPECT_THAT(refusal([&] { static_cast<void>(read_recording(with_a_link.path())); }),
              HasSubstr("damaged HDF5 file"));
}

/// What copies, disks and people do to files.
std::string damaged(std::string bytes, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  for (std::uint64_t change = 1 + random() % 4; change > 0; --change) {
    const std::size_t at = random() % bytes.size();
    for (std::size_t i = at; i < std::min(bytes.size(), at + 1 + random() % 8); ++i) {
      bytes[i] = static_cast<char>(random());
    }
  }
  return bytes;
}

TEST(Reader, NoDamagedFileEndsTheProgram) {
  const test::TemporaryFolder folder;
  write_recording(folder / "r.h5", test::sample_recording());
  std::ifstream stream(folder / "r.h5", std::ios::binary);
  const std::string sound{std::istreambuf_iterator<char>(stream), {}};
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    test::write_text(folder / "d.h5", damaged(sound, seed));
    const std::string why = refusal([&] { static_cast<void>(read_recording(folder / "d.h5")); });
    if (why.empty()) continue;
    EXPECT_THAT(why, HasSubstr("d.h5: ")) << seed;
    EXPECT_EQ(why.find('\n'), std::string::npos) << seed;
    EXPECT_EQ(why.find("/proc/"), std::string::npos) << seed << ": " << why;
  }
}

}  // namespace
}  // namespace kerf::schema
