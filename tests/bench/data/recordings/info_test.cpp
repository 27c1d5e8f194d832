#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <kerf/schema/recording_writer.h>
#include <kerf/schema/validate.h>

#include "bench/data/recordings/small_recording.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

TEST(Info, PrintsOneJsonObject) {
  const test::TemporaryFolder folder;
  auto recording = test::small_recording();
  recording.events = {{.time_s = 0.0, .kind = "start", .text = ""}};
  schema::write_recording(folder / "r.h5", recording);
  const auto outcome = test::run_kerf({"info", (folder / "r.h5").string(), "--json"});
  ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
  const auto json = nlohmann::json::parse(outcome.output);
  EXPECT_EQ(json["samples"], 11);
  EXPECT_EQ(json["schema"], "kerf.recording");
  EXPECT_EQ(json["uuid"], recording.header.uuid);
  EXPECT_EQ(json["status"], "complete");
  EXPECT_EQ(json["axes"][0]["name"], "theta");
  EXPECT_EQ(json["events"], 1);
}

TEST(Info, ShowsPeopleATable) {
  const test::TemporaryFolder folder;
  schema::write_recording(folder / "r.h5", test::small_recording());
  const auto outcome = test::run_kerf({"info", (folder / "r.h5").string()});
  EXPECT_EQ(outcome.exit_status, 0);
  EXPECT_THAT(outcome.errors, IsEmpty());
  EXPECT_THAT(outcome.output, HasSubstr("11 over 0.010 s at 1000 Hz"));
  EXPECT_THAT(outcome.output, HasSubstr("force_measured"));
}

TEST(Info, LooksIntoARecordingThatIsStillWritten) {
  const test::TemporaryFolder folder;
  schema::RecordingWriter writer(folder / "r.h5", schema::new_header("kerf test"), {schema::Axis{}}, {});
  writer.append(std::vector<schema::Row>{{.tick = 0, .time_s = 0.0}, {.tick = 1, .time_s = 0.001}});
  writer.flush();
  const auto outcome = test::run_kerf({"info", writer.path().string(), "--json"});
  ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
  const auto json = nlohmann::json::parse(outcome.output);
  EXPECT_EQ(json["samples"], 2);
  EXPECT_EQ(json["status"], "recording");
}

TEST(Info, PrintsTheSchemaAsMarkdown) {
  const auto outcome = test::run_kerf({"info", "--schema"});
  EXPECT_EQ(outcome.exit_status, 0);
  EXPECT_EQ(outcome.output, schema::schema_as_markdown());
}

TEST(Info, RefusesWhatIsNoRecordingInOneLine) {
  const test::TemporaryFolder folder;
  test::write_text(folder / "notes.h5", "time,position\n");
  const auto outcome = test::run_kerf({"info", (folder / "notes.h5").string(), "--json"});
  EXPECT_EQ(outcome.exit_status, 2);
  EXPECT_THAT(outcome.output, IsEmpty());
  EXPECT_THAT(outcome.errors, HasSubstr("notes.h5: not an HDF5 file"));
  EXPECT_EQ(std::ranges::count(outcome.errors, '\n'), 1);
}

TEST(Info, NeedsARecordingThatIsThere) {
  EXPECT_EQ(test::run_kerf({"info"}).exit_status, 2);
  const test::TemporaryFolder folder;
  const auto outcome = test::run_kerf({"info", (folder / "r.h5").string()});
  EXPECT_EQ(outcome.exit_status, 2);
  EXPECT_THAT(outcome.errors, HasSubstr("there is no such file"));
  EXPECT_THAT(outcome.errors, Not(HasSubstr("partial")));
}

TEST(Info, PointsToThePartialFileOfARecordingThatWasNotClosed) {
  const test::TemporaryFolder folder;
  test::write_text(folder / "r.h5.partial", "");
  const auto outcome = test::run_kerf({"info", (folder / "r.h5").string()});
  EXPECT_EQ(outcome.exit_status, 2);
  EXPECT_THAT(outcome.errors, HasSubstr("r.h5.partial holds a recording that was not closed"));
}

}  // namespace
}  // namespace kerf::bench
