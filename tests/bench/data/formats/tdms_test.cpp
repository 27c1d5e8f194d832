#include "formats/tdms/tdms.h"

#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "formats/tdms/tdms_segments.h"
#include "import/import.h"
#include "support/program.h"

// files/make_tdms.py wrote the files, by NI's description of the format.

namespace kerf::bench {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

std::filesystem::path made(const std::string& name) {
  return std::filesystem::path(KERF_SOURCE_DIR) / "tests/bench/data/formats/files" / name;
}

Imported imported(const std::filesystem::path& file, const std::string& map, double rate_hz = 0.0) {
  ImportOptions options{.map = parse_map(map)};
  options.rate_hz = rate_hz;
  return import_text(file, options);
}

double position_at(std::size_t row) { return 0.01 * std::sin(7.0 * static_cast<double>(row) / 100.0); }

constexpr std::int64_t quarter_past_noon = 1769860800'250'000'000;  // date -u -d 2026-01-31T12:00:00Z +%s

TEST(Tdms, OfSeveralSegmentsAndChunksIsOneTable) {
  const Imported one = imported(made("punch.tdms"), "time=wf_time,position=position,force=load 'A'");
  const schema::Recording& recording = one.recording;
  ASSERT_EQ(recording.rows(), 40U);
  for (std::size_t row = 0; row < 40; ++row) {
    EXPECT_NEAR(recording.time[row], static_cast<double>(row) / 100.0, 1e-15);
    EXPECT_NEAR(recording.position[row], position_at(row), 4e-18);
    EXPECT_NEAR(recording.force_measured[row], 300.0 * recording.position[row] + 0.1, 1e-15);
  }
  EXPECT_EQ(recording.header.start_ns, quarter_past_noon);
  EXPECT_EQ(recording.header.start_clock, "UTC");
  EXPECT_THAT(one.warnings, Contains("a TDMS file"));
}

TEST(Tdms, OfTheOtherByteOrderMayBeInterleavedWithMoments) {
  const Imported one = imported(made("punch-big.tdms"), "time=at,position=position,force=load 'A'");
  ASSERT_EQ(one.recording.rows(), 40U);
  for (std::size_t row = 0; row < 40; ++row) {
    EXPECT_NEAR(one.recording.time[row], static_cast<double>(row) / 100.0, 1e-9)
        << "stamps are of nanoseconds";
    EXPECT_NEAR(one.recording.position[row], position_at(row), 4e-18);
    EXPECT_EQ(one.recording.force_measured[row],
              static_cast<double>(static_cast<float>(300.0 * position_at(row) + 0.1)));
  }
  EXPECT_EQ(one.recording.header.start_ns, quarter_past_noon - 250'000'000);
}

TEST(Tdms, AppliesScalesAndNamesWhatIsLeftOut) {
  const Imported one = imported(made("counts.tdms"), "position=a/way,force=b/F", 100.0);
  ASSERT_EQ(one.recording.rows(), 40U);
  for (std::size_t row = 0; row < 40; ++row)
    EXPECT_NEAR(one.recording.position[row], 1e-3 * (5.0 + 1000.0 * position_at(row)), 1.01e-6 / 2)
        << "a count is a micrometre";
  EXPECT_THAT(one.warnings, Contains(testing::AllOf(HasSubstr("'b/wide': it holds whole numbers beyond 2^53"),
                                                    HasSubstr("'b/said': it holds texts"),
                                                    HasSubstr("'b/few': it has 3 values and not 40"))));
}

/// By hand, as the description has it: lead-in, two objects of which one has data, and three numbers.
TEST(Tdms, IsReadByteForByte) {
  std::string bytes("TDSm\x0E\0\0\0\x69\x12\0\0\x4B\0\0\0\0\0\0\0\x3F\0\0\0\0\0\0\0", 28);
  bytes += std::string("\x02\0\0\0", 4);
  bytes += std::string("\x01\0\0\0/\xFF\xFF\xFF\xFF\0\0\0\0", 13);
  bytes += std::string("\x0A\0\0\0/'G'/'one'", 14) +
           std::string("\x14\0\0\0\x03\0\0\0\x01\0\0\0\x03\0\0\0\0\0\0\0", 20);
  bytes += std::string("\x01\0\0\0", 4);
  const std::string unit("\x0B\0\0\0unit_string\x20\0\0\0\x01\0\0\0N", 24);
  const std::string values("\x01\0\0\0\xFE\xFF\xFF\xFF\x03\0\0\0", 12);
  bytes += unit + values;
  const std::size_t metadata = bytes.size() - 28 - values.size();
  bytes[12] = static_cast<char>(metadata + values.size());
  bytes[20] = static_cast<char>(metadata);
  const TdmsFile file = tdms_segments(bytes, "by hand");
  ASSERT_EQ(file.channels.size(), 1U);
  EXPECT_EQ(file.channels[0].path, "/'G'/'one'");
  EXPECT_THAT(file.channels[0].values, ElementsAre(1.0, -2.0, 3.0));
  EXPECT_EQ(std::get<std::string>(file.channels[0].properties.at("unit_string")), "N");
  EXPECT_TRUE(file.notes.empty());
}

class BadTdms : public testing::Test {
 protected:
  static std::size_t rows_of(const std::string& bytes) {
    const TdmsFile file = tdms_segments(bytes, "cut.tdms");
    if (file.channels.size() < 2) return 0;
    EXPECT_EQ(file.channels[0].values.size(), file.channels[1].values.size()) << bytes.size();
    EXPECT_TRUE(bytes.size() == 1229U || !file.notes.empty()) << "who lost rows says so: " << bytes.size();
    return file.channels[0].values.size();
  }
  void expect_refused(std::size_t at, char byte, const char* why) const {
    std::string bytes = whole_;
    bytes[at] = byte;
    EXPECT_THAT([&] { (void)tdms_segments(bytes, "bad.tdms"); },
                ThrowsMessage<std::invalid_argument>(testing::AllOf(HasSubstr("bad.tdms"), HasSubstr(why))));
  }
  std::string whole_ = test::read_text(made("punch.tdms"));
};

TEST_F(BadTdms, ThatIsCutAnywhereKeepsItsWholeRows) {
  EXPECT_EQ(rows_of(whole_), 40U);
  EXPECT_EQ(rows_of(whole_.substr(0, whole_.size() - 12)), 38U) << "one value and a half of the last channel";
  EXPECT_EQ(rows_of(whole_.substr(0, whole_.size() - 60)), 35U) << "the last channel has none of this chunk";
  std::size_t before = 0;
  for (std::size_t length = 1; length < whole_.size(); ++length) {
    std::size_t rows = before;
    const std::string cut = whole_.substr(0, length);
    if (whole_.compare(length, 4, "TDSm") == 0) continue;  // a whole file by itself
    EXPECT_NO_THROW(rows = rows_of(cut)) << length;
    EXPECT_GE(rows, before) << length;
    before = rows;
  }
  std::string open = whole_;
  open.replace(whole_.rfind("TDSm") + 12, 8, 8, '\xFF');
  EXPECT_EQ(rows_of(open), 40U);
}

TEST_F(BadTdms, IsRefusedByItsByte) {
  expect_refused(4, '\x8E', "DAQmx's raw counts");
  expect_refused(8, '\x01', "version 4609; expected 4712 or 4713");
  expect_refused(whole_.rfind("TDSm"), 'X', "it has no segment");
  expect_refused(28, '\x7F', "bytes more than there are");
  const auto index = whole_.find("position'") + 9;
  expect_refused(index + 4, '\x7A', "whose values have no known size");
  expect_refused(index + 8, '\x02', "more than one dimension");
  std::string daqmx = whole_;
  daqmx.replace(index, 4, std::string("\x69\x12\0\0", 4));
  EXPECT_THAT([&] { (void)tdms_segments(daqmx, "bad.tdms"); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("/'run'/'position'")));
  const test::TemporaryFolder folder;
  test::write_text(folder / "a.tdms_index", "TDSh");
  EXPECT_THAT([&] { (void)imported(folder / "a.tdms_index", "position=1[mm]"); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("the index of a TDMS file")));
}

}  // namespace
}  // namespace kerf::bench
