#include "sealed/sealed_entries.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/sessions/sealed/sealed_session.h"

namespace kerf::bench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing::ThrowsMessage;

using For = SealedEntries::For;

TEST(SealedEntries, ComeBackInTheirOrder) {
  const test::SealedSession session;
  auto run = session.run();
  run.append("run", "on sim:scissors", {});
  run.append("trial", "trial 1", test::bytes_of("B"));
  run.append("finished", "", {});
  EXPECT_EQ(run.content(2), test::bytes_of("B"));
  run.close();
  EXPECT_EQ(run.content(2), test::bytes_of("B"));
  EXPECT_THROW((void)run.content(4), std::out_of_range);
  EXPECT_THAT(session.entries(), ElementsAre("plan: : the order",
                                             "run: on sim:scissors: ", "trial: trial 1: B", "finished: : "));
  EXPECT_THAT(run.session().entries[2].time, HasSubstr("T"));
}

TEST(SealedEntries, OfTwoSessionsWithOneKeyDoNotOpenInEachOther) {
  const test::SealedSession one;
  schema::Session other = test::public_part();
  other.subject = "S3";
  const test::SealedSession two(other);
  schema::Session mixed = schema::read_session(two.file());
  mixed.entries = schema::read_session(one.file()).entries;
  schema::write_session(two.file(), mixed);
  EXPECT_THROW((void)two.entries(), std::invalid_argument);
}

TEST(SealedEntries, DoNotOpenWithAnotherKey) {
  const test::SealedSession session;
  EXPECT_THAT([&] { (void)test::entries_in(session.file(), test::key_of('x')); },
              ThrowsMessage<std::invalid_argument>(HasSubstr(
                  "it is the key of another session, or the file was changed after it was written")));
}

TEST(SealedEntries, AreNotMadeOverASessionUnlessToldTo) {
  const test::SealedSession session;
  const auto create = [&](bool replace) {
    SealedEntries::create(session.file(), test::public_part(), test::bytes_of("anew"), session.key(),
                          replace);
  };
  EXPECT_THAT([&] { create(false); }, ThrowsMessage<std::invalid_argument>(HasSubstr("--force replaces it")));
  {
    auto run = session.run();
    run.append("trial", "trial 1", {});
  }
  create(true);
  EXPECT_THAT(session.entries(), ElementsAre("plan: : anew"));
  EXPECT_FALSE(session.has_journal());
}

TEST(SealedEntries, AreNotMadeBesideTheAnswersOfALostSession) {
  const test::SealedSession session;
  {
    auto run = session.run();
    run.append("trial", "trial 1", {});
  }
  std::filesystem::remove(session.file());
  const auto create = [&](bool replace) {
    SealedEntries::create(session.file(), test::public_part(), {}, session.key(), replace);
  };
  EXPECT_THAT([&] { create(false); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("holds the answers of an earlier session")));
  EXPECT_TRUE(session.has_journal());
  create(true);
  EXPECT_THAT(session.entries(), SizeIs(1));
}

TEST(SealedEntries, ThatCannotBeWrittenLeaveNothing) {
  const kerf::test::TemporaryFolder folder;
  const auto create = [&](const std::filesystem::path& file) {
    SealedEntries::create(file, test::public_part(), {}, test::key_of('k'), false);
  };
  EXPECT_THROW(create(folder / "none/s.h5"), std::system_error);
  {
    const kerf::test::FullDisk disk(100);
    EXPECT_THROW(create(folder / "s.h5"), std::system_error);
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(SealedEntries, OfNoFileAreRefused) {
  const kerf::test::TemporaryFolder folder;
  for (const auto purpose : {For::run, For::read}) {
    EXPECT_THAT(
        [&] { SealedEntries(folder / "s.h5", test::key_of('k'), purpose, test::ignore); },
        ThrowsMessage<std::invalid_argument>(HasSubstr("s.h5: there is no such file; expected a session")));
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(SealedEntries, ThatAreOnlyReadOrAreClosedTakeNoMore) {
  const test::SealedSession session;
  SealedEntries reader(session.file(), session.key(), For::read, test::ignore);
  EXPECT_THROW(reader.append("run", "", {}), std::logic_error);
  auto run = session.run();
  run.append("run", "", {});
  reader.close();
  run.close();
  EXPECT_THROW(run.append("run", "", {}), std::logic_error);
  EXPECT_THAT(session.entries(), SizeIs(2));
}

TEST(SealedEntries, MayHaveLongTexts) {
  const test::SealedSession session;
  const std::string why = std::string(5000, 'y') + " – because";
  auto run = session.run();
  run.append("opened", why, {});
  run.close();
  EXPECT_THAT(session.entries(), ElementsAre("plan: : the order", "opened: " + why + ": "));
  EXPECT_THROW(session.run().append("opened", std::string("a\0b", 3), {}), std::invalid_argument);
  EXPECT_THROW(session.run().append("", "", {}), std::invalid_argument);
}

}  // namespace
}  // namespace kerf::bench
