#include "prepare/prepare_file.h"

#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "prepare/prepared_text.h"
#include "recordings/provenance.h"
#include "support/program.h"
#include "support/recordings.h"

namespace kerf::bench {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class PreparedFile : public testing::Test {
 protected:
  PreparedFile() { schema::write_recording(file_, test::punch()); }

  test::TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_ / "r.h5";
};

TEST_F(PreparedFile, IsARecordingOfItsOwnThatNamesItsSource) {
  const schema::Recording before = schema::read_recording(file_);
  const Prepared prepared = prepare_file(file_, {.from_s = 1.0});
  EXPECT_NE(prepared.recording.header.uuid, before.header.uuid);
  EXPECT_EQ(prepared.recording.header.software, software());
  EXPECT_EQ(prepared.recording.header.source,
            "r.h5 " + before.header.uuid + " sha256:" + sha256_of(std::filesystem::path(file_)));
}

TEST_F(PreparedFile, NamesTheFileOnceInWhatItRefuses) {
  const auto refusal = [](const std::filesystem::path& file) -> std::string {
    try {
      (void)prepare_file(file, {});
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_THAT(refusal(file_), StartsWith(file_.string() + ": nothing"));
  const std::string none = (folder_ / "none.h5").string();
  EXPECT_THAT(refusal(none), StartsWith(none + ": there is no such file"));
}

TEST_F(PreparedFile, IsToldStepByStepWithTheFilterLast) {
  const Prepared prepared =
      prepare_file(file_, {.filter = parse_filter("butterworth2:20", false), .from_s = 1.0});
  const auto lines = prepared_lines(prepared);
  ASSERT_GE(lines.size(), 3U);
  EXPECT_THAT(lines[0], HasSubstr("1"));
  EXPECT_EQ(lines[1], "filter " + to_text(prepared.filter->filter) + " at 1000 Hz");
  EXPECT_THAT(lines[2], HasSubstr("gain dB"));
  EXPECT_EQ(lines.size(), 3U + prepared.filter->responses.size());
  const auto json = prepared_as_json(prepared);
  EXPECT_EQ(json.at("rows_before"), 4000);
  EXPECT_EQ(json.at("rows"), 3000);
  EXPECT_EQ(json.at("filter").at("response").size(), prepared.filter->responses.size());
  EXPECT_FALSE(json.contains("weight"));
}

TEST(Labels, AreAChannelAndAValue) {
  const Labels labels = parse_labels("a=b=-2.5");
  EXPECT_EQ(labels.channel, "a=b");
  EXPECT_EQ(labels.value, -2.5);
  for (const char* text : {"label", "label=", "=3", "label=3x"})
    EXPECT_THROW((void)parse_labels(text), std::invalid_argument) << text;
}

}  // namespace
}  // namespace kerf::bench
