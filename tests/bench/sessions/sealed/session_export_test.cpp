#include "sealed/session_export.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/schema/validate.h>

#include "bench/sessions/sealed/stored_session.h"

namespace kerf::bench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing::ThrowsMessage;

class SessionExport : public testing::Test {
 protected:
  explicit SessionExport(const SessionSetUp& up = test::set_up()) : session_(up) {
    SessionStore run = session_.run();
    run.append(test::answered(up.plan[0], 1));
    run.append(test::answered(up.plan[1], 1));
    run.append(test::answered(up.plan[2], 0, 0));
    run.close();
  }
  test::StoredSession session_;
  std::filesystem::path folder_ = session_.folder() / "opened";
};

TEST_F(SessionExport, IsATableOfAllTrials) {
  export_session(session_.read(), folder_, false);
  std::istringstream table(kerf::test::read_text(folder_ / "trials.csv"));
  std::vector<std::string> lines;
  for (std::string line; std::getline(table, line);) lines.push_back(line);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "questionnaire.csv")) << "none is asked";
  ASSERT_THAT(lines, SizeIs(7));
  EXPECT_EQ(lines[0], "# name = \"two laws\"");
  EXPECT_EQ(lines[1], "# design = \"abx\"");
  EXPECT_THAT(lines[2], HasSubstr("answerable_s [s]"));
  EXPECT_EQ(lines[3],
            "subject,number,trial,practice,tissue,first,second,level,slots,right,answer,correct,response_s,"
            "switches,at,answerable_s,void,catch");
  EXPECT_EQ(lines[4], "S2,2,1,1,,soft,stiff,,first/second/first,A,B,0,3.25,1,2026-01-31T12:00:00Z,,,0");
  EXPECT_EQ(lines[5], "S2,2,2,0,,soft,stiff,,second/first/second,A,B,0,3.25,1,2026-01-31T12:00:00Z,,,0");
  EXPECT_EQ(lines[6], "S2,2,3,0,,soft,stiff,,first/second/second,B,A,0,3.25,1,2026-01-31T12:00:00Z,,,0");
}

TEST_F(SessionExport, HasARecordingOfEachTrialThatHasTicks) {
  export_session(session_.read(), folder_, false);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "trial-003.h5"));
  EXPECT_THAT(schema::validate(folder_ / "trial-001.h5"), IsEmpty());
  const schema::Recording recording = schema::read_recording(folder_ / "trial-001.h5");
  EXPECT_EQ(recording.rows(), 40U);
  EXPECT_EQ(recording.force_commanded[39], 13.0);
  EXPECT_THAT(recording.force_measured, IsEmpty()) << "there was no sensor";
  ASSERT_THAT(recording.events, SizeIs(2));
  EXPECT_EQ(recording.events[0].time_s, 0.01);
  EXPECT_EQ(recording.events[0].kind, "slot");
  EXPECT_EQ(recording.events[0].text, "A: 'soft' (soft.law.toml)");
  EXPECT_EQ(recording.events[1].text, "B: 'stiff' (stiff.law.toml, force x 0.3)");
  EXPECT_EQ(recording.header.created, "2026-01-31T12:00:00Z");
  EXPECT_THAT(recording.header.history, HasSubstr("trial 1 of session"));
  EXPECT_THAT(recording.header.history, HasSubstr("X: 'soft' (soft.law.toml); answered B"));
}

TEST_F(SessionExport, ReplacesNothingUnlessToldTo) {
  export_session(session_.read(), folder_, false);
  EXPECT_THAT([&] { export_session(session_.read(), folder_, false); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("--force replaces it")));
  EXPECT_NO_THROW(export_session(session_.read(), folder_, true));
  std::filesystem::remove(folder_ / "trials.csv");
  EXPECT_THROW(export_session(session_.read(), folder_, false), std::invalid_argument);
}

class ExportOfPreferences : public SessionExport {
 protected:
  ExportOfPreferences() : SessionExport(test::set_up("design = \"preference\"\n")) {}
};

TEST_F(ExportOfPreferences, SaysWhichSlotPlayedTheSecondAndCallsNothingCorrect) {
  export_session(session_.read(), folder_, false);
  EXPECT_THAT(kerf::test::read_text(folder_ / "trials.csv"),
              HasSubstr("S2,2,2,0,,soft,stiff,,second/first,A,B,,3.25,1,"));
}

}  // namespace
}  // namespace kerf::bench
