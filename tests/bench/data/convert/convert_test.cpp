// What is converted is read by programs that are not Kerf's, and held against the recording as h5py reads it.

#include "convert/convert.h"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/schema/recorded_rows.h>
#include <kerf/schema/recording.h>
#include <kerf/schema/recording_file.h>

#include "datasets-schema/recording/sample_recording.h"
#include "import/import.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::ThrowsMessage;

// Debian's own Python, as its packages are not seen by others.
constexpr auto python = "/usr/bin/python3";
constexpr auto checker = KERF_SOURCE_DIR "/tests/bench/data/convert/check_conversion.py";

/// A sensor in space that had nothing for a while, and a gap; it says neither when it began nor what
/// happened.
schema::Recording three_axes(std::size_t rows) {
  schema::Recording recording;
  recording.header = schema::new_header("kerf test");
  recording.axes = {{.name = "x"}, {.name = "y"}, {.name = "z"}};
  for (std::size_t i = 0; i < rows; ++i) {
    const auto t = static_cast<double>(i < rows / 2 ? i : i + 50);
    recording.time.push_back(t / 1000.0);
    recording.tick.push_back(static_cast<std::uint64_t>(t));
    for (const double axis : {1.0, 2.0, 3.0}) {
      recording.position.push_back(std::sin(axis * t) / 100.0);
      recording.velocity.push_back(axis * std::cos(axis * t) / 100.0);
      recording.force_measured.push_back(i > 10 && i < 20 ? std::numeric_limits<double>::quiet_NaN()
                                                          : axis / (t + 1.0));
    }
  }
  return recording;
}

class Conversion : public testing::Test {
 protected:
  Converted convert_to(const schema::Recording& recording, const std::string& name) {
    return convert(schema::RowsInMemory(recording), {.output = folder_ / name});
  }
  [[nodiscard]] Imported import_of(const std::string& name, const std::string& map) const {
    ImportOptions options;
    options.map = parse_map(map);
    return import_text(folder_ / name, options);
  }
  [[nodiscard]] std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_.path()))
      names.push_back(entry.path().filename().string());
    return names;
  }
  test::TemporaryFolder folder_;
};

class ConversionReadByOthers : public Conversion {
 protected:
  void expect_the_recordings_in(const std::string& ending, const std::string& reader) {
    if (!fs::exists(python)) GTEST_SKIP() << "no " << python;
    std::vector<std::string> command{python, "-B", checker, reader, folder_.path().string()};
    const std::vector<std::pair<std::string, schema::Recording>> recordings{
        {"everything", test::sample_recording(20'000)},  // two blocks of rows, and several chunks of MCAP
        {"three axes", three_axes(300)},
        {"no rows", three_axes(0)},
        {"one row", test::sample_recording(1)}};
    for (const auto& [name, recording] : recordings) {
      schema::write_recording(folder_ / (name + ".h5"), recording);
      static_cast<void>(convert(schema::RecordingFile(folder_ / (name + ".h5")),
                                {.output = folder_ / (name + "." + ending)}));
      command.push_back(name);
    }
    const auto outcome = test::run(command);
    if (outcome.exit_status == 77) GTEST_SKIP() << outcome.output;
    EXPECT_EQ(outcome.exit_status, 0) << outcome.output << outcome.errors;
  }
};

TEST_F(ConversionReadByOthers, IsToPandasTheRecordingToTheBit) { expect_the_recordings_in("csv", "pandas"); }
TEST_F(ConversionReadByOthers, IsToSciPyTheRecordingToTheBit) { expect_the_recordings_in("mat", "scipy"); }
TEST_F(ConversionReadByOthers, IsToOctaveTheRecordingToTheBit) { expect_the_recordings_in("mat", "octave"); }
TEST_F(ConversionReadByOthers, IsToAReaderOfMcapTheRecordingToTheBit) {
  expect_the_recordings_in("mcap", "mcap");
}
#ifdef KERF_NODE
TEST_F(ConversionReadByOthers, IsToFoxglovesReaderTheRecordingToTheBit) {
  expect_the_recordings_in("mcap", "mcap_core:" KERF_NODE ":" KERF_NODE_MODULES);
}
#endif

bool same_bits(const std::vector<double>& left, const std::vector<double>& right) {
  return left.size() == right.size() &&
         (left.empty() || std::memcmp(left.data(), right.data(), left.size() * sizeof(double)) == 0);
}

TEST_F(Conversion, IsImportedAgainWithItsUnits) {
  schema::Recording recording = three_axes(300);
  recording.axes[0] = {.name = "theta", .position_unit = "rad", .force_unit = "N·m"};
  convert_to(recording, "r.csv");
  convert_to(recording, "r.mat");
  std::vector<double> position;
  std::vector<double> velocity;
  for (std::size_t i = 0; i < recording.rows(); ++i) {
    position.push_back(recording.position[3 * i]);
    velocity.push_back(recording.velocity[3 * i]);
  }
  for (const auto& [name, map] : std::vector<std::pair<std::string, std::string>>{
           {"r.csv", "time=time,position=position.theta,velocity=velocity.theta,force=force_measured.theta"},
           {"r.mat",
            "time=time,position=position_theta,velocity=velocity_theta,force=force_measured_theta"}}) {
    const schema::Recording again = import_of(name, map).recording;
    EXPECT_TRUE(same_bits(again.time, recording.time)) << name;
    EXPECT_TRUE(same_bits(again.position, position)) << name;
    EXPECT_TRUE(same_bits(again.velocity, velocity)) << name;
    EXPECT_EQ(again.axes[0].position_unit, "rad") << name;
    EXPECT_EQ(again.axes[0].force_unit, "N·m") << name;
    ASSERT_EQ(again.force_measured.size(), 300U) << name;
    for (std::size_t i = 0; i < 300; ++i) {
      const double force = recording.force_measured[3 * i];
      EXPECT_TRUE(std::isnan(force) ? std::isnan(again.force_measured[i]) : again.force_measured[i] == force)
          << name << ", row " << i;
    }
  }
}

TEST_F(Conversion, SaysItsFormatByItsEndingInAnyCase) {
  EXPECT_EQ(convert_to(three_axes(3), "r.MCAP").format, "mcap");
  EXPECT_THAT([&] { convert_to(three_axes(3), "r.txt"); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("'.txt' is no format to convert to; expected")));
  EXPECT_THAT([&] { convert_to(three_axes(3), "r"); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("its name has no ending")));
}

TEST_F(Conversion, KeepsAFileThatHasItsName) {
  test::write_text(folder_ / "r.csv", "mine");
  EXPECT_THROW(convert_to(three_axes(3), "r.csv"), schema::NameTaken);
  EXPECT_EQ(test::read_text(folder_ / "r.csv"), "mine");
}

/// Rows of which only the first ones can be read.
class FailingRows final : public schema::RecordedRows {
 public:
  FailingRows(const schema::Recording& recording, std::uint64_t count) : rows_(recording), count_(count) {}
  [[nodiscard]] const schema::Recording& about() const noexcept override { return rows_.about(); }
  [[nodiscard]] std::uint64_t rows() const noexcept override { return count_; }
  [[nodiscard]] std::size_t width(schema::Column column) const override { return rows_.width(column); }
  [[nodiscard]] bool has_flags() const noexcept override { return rows_.has_flags(); }
  void read(schema::Column column, std::uint64_t first, std::uint64_t rows,
            std::span<double> values) const override {
    if (first > 0) throw schema::FormatError("a damaged row");
    rows_.read(column, first, rows, values);
  }
  void read_channel(std::size_t channel, std::uint64_t first, std::span<double> values) const override {
    rows_.read_channel(channel, first, values);
  }
  void read_ticks(std::uint64_t first, std::span<std::uint64_t> values) const override {
    rows_.read_ticks(first, values);
  }
  void read_flags(std::uint64_t first, std::span<std::uint32_t> values) const override {
    rows_.read_flags(first, values);
  }

 private:
  schema::RowsInMemory rows_;
  std::uint64_t count_;
};

TEST_F(Conversion, LeavesNothingWhereARowCannotBeRead) {
  const schema::Recording recording = test::sample_recording(40'000);
  for (const char* name : {"r.csv", "r.mat", "r.mcap"}) {
    EXPECT_THROW((void)convert(FailingRows(recording, recording.rows()), {.output = folder_ / name}),
                 schema::FormatError);
    EXPECT_THAT(files(), IsEmpty()) << name;
  }
}

TEST_F(Conversion, IsNoMatFileWhereAColumnHasTwoGibibytes) {
  const schema::Recording recording = three_axes(3);
  EXPECT_THAT([&] { (void)convert(FailingRows(recording, 300'000'000), {.output = folder_ / "r.mat"}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("300000000 rows; expected at most 268435424")));
  EXPECT_THAT(files(), IsEmpty());
}

TEST_F(Conversion, IsRefusedWhereAFolderCannotBeWritten) {
  EXPECT_THAT([&] { convert_to(three_axes(3), "nowhere/r.mat"); },
              ThrowsMessage<std::system_error>(HasSubstr("nowhere/r.mat")));
}

}  // namespace
}  // namespace kerf::bench
