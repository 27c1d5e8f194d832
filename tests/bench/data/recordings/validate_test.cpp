#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/data/recordings/small_recording.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

TEST(ValidateVerb, PassesASoundRecording) {
  const test::TemporaryFolder folder;
  schema::write_recording(folder / "r.h5", test::small_recording());
  const auto outcome = test::run_kerf({"validate", (folder / "r.h5").string(), "--json"});
  EXPECT_EQ(outcome.exit_status, 0) << outcome.errors;
  const auto json = nlohmann::json::parse(outcome.output);
  EXPECT_EQ(json["valid"], true);
  EXPECT_TRUE(json["violations"].empty());
}

TEST(ValidateVerb, FailsWithEveryViolationOnItsLine) {
  const test::TemporaryFolder folder;
  auto recording = test::small_recording();
  recording.tick[5] = 4;
  recording.header.uuid = "none";
  schema::write_recording(folder / "r.h5", recording);
  const auto outcome = test::run_kerf({"validate", (folder / "r.h5").string(), "--json"});
  EXPECT_EQ(outcome.exit_status, 1);
  const auto json = nlohmann::json::parse(outcome.output);
  EXPECT_EQ(json["valid"], false);
  ASSERT_EQ(json["violations"].size(), 2U);
  EXPECT_EQ(json["violations"][0]["where"], "/ attribute 'uuid'");
  EXPECT_EQ(json["violations"][0]["found"], "'none'");
  EXPECT_EQ(json["violations"][1]["where"], "/samples/tick");
  EXPECT_EQ(json["violations"][1]["expected"], "ticks that increase strictly");
  EXPECT_THAT(test::run_kerf({"validate", (folder / "r.h5").string()}).output,
              HasSubstr("r.h5: /samples/tick: found 4 after 4 in row 5, expected ticks"));
}

TEST(ValidateVerb, FailsAFileThatWasCutShort) {
  const test::TemporaryFolder folder;
  schema::write_recording(folder / "r.h5", test::small_recording());
  test::write_text(folder / "r.h5", test::read_text(folder / "r.h5").substr(0, 5000));
  EXPECT_EQ(test::run_kerf({"validate", (folder / "r.h5").string()}).exit_status, 1);
}

TEST(ValidateVerb, RefusesWhatIsNoHdf5FileAtAll) {
  const test::TemporaryFolder folder;
  test::write_text(folder / "notes.h5", "time,position\n");
  const auto outcome = test::run_kerf({"validate", (folder / "notes.h5").string(), "--json"});
  EXPECT_EQ(outcome.exit_status, 2);
  EXPECT_THAT(outcome.output, IsEmpty());
  EXPECT_EQ(test::run_kerf({"validate", (folder / "none.h5").string()}).exit_status, 2);
}

}  // namespace
}  // namespace kerf::bench
