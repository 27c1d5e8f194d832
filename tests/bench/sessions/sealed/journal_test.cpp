#include "sealed/journal.h"

#include <random>
#include <system_error>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include "bench/sessions/sealed/sealed_session.h"

namespace kerf::bench {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing::ThrowsMessage;

using For = SealedEntries::For;

std::vector<std::uint8_t> chance(std::size_t size) {
  std::mt19937 generator(5);
  std::vector<std::uint8_t> bytes(size);
  for (auto& byte : bytes) byte = static_cast<std::uint8_t>(generator());
  return bytes;
}

/// A session with two entries in its journal, as a process leaves it that dies.
void leave_journal(const test::SealedSession& session) {
  auto run = session.run();
  run.append("run", "on sim:scissors", {});
  run.append("trial", "trial 1", test::bytes_of("B"));
}

TEST(Journal, HoldsWhatACrashLeftUntilTheNextRunEnds) {
  const test::SealedSession session;
  leave_journal(session);
  EXPECT_TRUE(session.has_journal());
  EXPECT_THAT(schema::read_session_facts(session.file()).entries, SizeIs(1));
  EXPECT_THAT(session.entries(),
              ElementsAre("plan: : the order", "run: on sim:scissors: ", "trial: trial 1: B"));
  {
    auto run = session.run();
    EXPECT_THAT(run.warnings(), IsEmpty());
    run.append("trial", "trial 2", test::bytes_of("A"));
    run.close();
  }
  EXPECT_FALSE(session.has_journal());
  EXPECT_THAT(session.entries(), SizeIs(4));
  EXPECT_THAT(schema::read_session(session.file()).entries, SizeIs(4));
}

TEST(Journal, CutOffAnywhereLosesTheLastEntryAlone) {
  const test::SealedSession session;
  leave_journal(session);
  const auto whole = std::filesystem::file_size(session.journal());
  const auto shorter = whole + 48 + 12 + 4 + 20 + 40;  // head, lengths, "quit", time, nonce and tag
  {
    auto run = session.run();
    run.append("trial", "trial 2", test::bytes_of("AB"));
  }
  const std::string all = kerf::test::read_text(session.journal());
  for (std::size_t length = whole; length < all.size(); ++length) {
    kerf::test::write_text(session.journal(), all.substr(0, length));
    ASSERT_THAT(session.entries(), SizeIs(3)) << length;
    auto run = session.run();
    ASSERT_THAT(run.warnings(), SizeIs(length == whole ? 0 : 1)) << length;
    run.append("quit", "", {});
    ASSERT_THAT(session.entries(), SizeIs(4)) << length;
    EXPECT_EQ(std::filesystem::file_size(session.journal()), shorter) << "nothing of it is left";
  }
}

TEST(Journal, CutOffInItsHeadHoldsNothingAndIsBegunAnew) {
  const test::SealedSession session;
  leave_journal(session);
  const std::string all = kerf::test::read_text(session.journal());
  for (std::size_t length = 0; length <= 76; ++length) {
    kerf::test::write_text(session.journal(), all.substr(0, length));
    ASSERT_THAT(session.entries(), SizeIs(1)) << length;
    auto run = session.run();
    run.append("run", "", {});
    ASSERT_THAT(session.entries(), SizeIs(2)) << length;
  }
}

// Of a file that grew before its content came to the disk, the rest reads as zeros.
TEST(Journal, WhoseLastSectorsNeverCameToTheDiskLosesTheLastEntryAlone) {
  const test::SealedSession session;
  leave_journal(session);
  const std::size_t whole = kerf::test::read_text(session.journal()).size();
  {
    auto run = session.run();
    run.append("trial", "trial 2", chance(3000));
  }
  const std::string all = kerf::test::read_text(session.journal());
  for (std::size_t sector = whole / 512; sector * 512 < all.size(); ++sector) {
    std::string holed = all;
    for (std::size_t i = std::max(whole, sector * 512); i < std::min(all.size(), (sector + 1) * 512); ++i) {
      holed[i] = '\0';
    }
    kerf::test::write_text(session.journal(), holed);
    ASSERT_THAT(session.entries(), SizeIs(3)) << sector;
  }
}

TEST(Journal, RefusesEveryChangedByteOfItsRecords) {
  const test::SealedSession session;
  leave_journal(session);
  const std::string all = kerf::test::read_text(session.journal());
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (i >= 68 && i < 76) continue;  // the process that runs it
    std::string changed = all;
    changed[i] = static_cast<char>(changed[i] ^ 0x10);
    kerf::test::write_text(session.journal(), changed);
    EXPECT_THROW((void)session.entries(), schema::FormatError) << i;
  }
  kerf::test::write_text(session.journal(), all + "more");
  EXPECT_THAT(session.entries(), SizeIs(3)) << "a record that never was whole";
}

TEST(Journal, OfAnotherSessionIsRefused) {
  const test::SealedSession session;
  schema::Session other = test::public_part();
  other.uuid = "ffffffff-54bb-4c5e-9d55-6cf3f4d33c11";
  const test::SealedSession stranger(other);
  leave_journal(stranger);
  std::filesystem::copy_file(stranger.journal(), session.journal());
  EXPECT_THAT([&] { (void)session.run(); },
              ThrowsMessage<schema::FormatError>(HasSubstr("belongs to another session (ffffffff-")));
  EXPECT_THROW((void)session.entries(), schema::FormatError);
}

TEST(Journal, ThatIsInTheFileAlreadyIsNotTakenTwice) {
  const test::SealedSession session;
  leave_journal(session);
  const std::string journal = kerf::test::read_text(session.journal());
  session.run().close();
  ASSERT_THAT(session.entries(), SizeIs(3));
  kerf::test::write_text(session.journal(), journal);  // a crash just before it was removed
  EXPECT_THAT(session.entries(), SizeIs(3));
  auto run = session.run();
  run.append("trial", "trial 2", {});
  run.close();
  EXPECT_THAT(session.entries(), SizeIs(4));
  EXPECT_FALSE(session.has_journal());
}

TEST(Journal, BesideAnOlderCopyOfItsFileIsRefused) {
  const test::SealedSession session;
  const std::string older = kerf::test::read_text(session.file());
  leave_journal(session);
  session.run().close();
  leave_journal(session);
  kerf::test::write_text(session.file(), older);
  EXPECT_THAT([&] { (void)session.entries(); },
              ThrowsMessage<schema::FormatError>(HasSubstr("it is an older copy")));
}

TEST(SecondRun, IsRefusedAndNamesTheFirst) {
  const test::SealedSession session;
  auto first = session.run();
  const auto refusal = ThrowsMessage<std::invalid_argument>(
      AllOf(HasSubstr("is being run by another process"), HasSubstr(fmt::format("(pid {})", ::getpid()))));
  EXPECT_THAT([&] { (void)session.run(); }, refusal);
  first.append("trial", "trial 1", {});
  EXPECT_THAT([&] { (void)session.run(); }, refusal);
  EXPECT_THAT([&] { SealedEntries::create(session.file(), test::public_part(), {}, session.key(), true); },
              refusal);
  first.close();
  EXPECT_NO_THROW((void)session.run());
}

TEST(SecondRun, OfAnotherNameOfTheFileIsRefused) {
  const test::SealedSession session;
  const auto other = session.file().parent_path() / "other.h5";
  std::filesystem::create_symlink(session.file(), other);
  auto first = session.run();
  EXPECT_THROW((SealedEntries(other, session.key(), For::run, test::ignore)), std::invalid_argument);
}

TEST(SecondRun, OfAnotherProcessIsRefusedAndGoesWithIt) {
  const test::SealedSession session;
  int ready[2];
  int end[2];
  ASSERT_EQ(::pipe(ready), 0);
  ASSERT_EQ(::pipe(end), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    auto run = session.run();
    run.append("trial", "trial 1", {});
    char byte = 'x';
    (void)!::write(ready[1], &byte, 1);
    (void)!::read(end[0], &byte, 1);
    ::_exit(0);  // as a kill: nothing is closed
  }
  char byte = 0;
  ASSERT_EQ(::read(ready[0], &byte, 1), 1);
  EXPECT_THAT([&] { (void)session.run(); },
              ThrowsMessage<std::invalid_argument>(HasSubstr(fmt::format("(pid {})", child))));
  EXPECT_THAT(session.entries(), SizeIs(2)) << "reading is allowed meanwhile";
  ASSERT_EQ(::write(end[1], &byte, 1), 1);
  ::waitpid(child, nullptr, 0);
  for (const int descriptor : {ready[0], ready[1], end[0], end[1]}) ::close(descriptor);
  auto run = session.run();
  EXPECT_THAT(run.session().entries, SizeIs(2));
}

// Runs that begin while others end: each entry that was appended has to be there at the end.
TEST(SecondRun, ThatBeginsWhileTheFirstEndsLosesNothing) {
  const test::SealedSession session;
  constexpr int processes = 4;
  constexpr int runs = 12;
  std::vector<pid_t> children;
  for (int process = 0; process < processes; ++process) {
    const pid_t child = ::fork();
    if (child != 0) {
      children.push_back(child);
      continue;
    }
    int done = 0;
    while (done < runs) {
      try {
        auto run = session.run();
        run.append("run", fmt::format("{} {}", process, done), {});
        if (done % 3 != 0) run.close();
        ++done;
      } catch (const std::invalid_argument&) {
        ::sched_yield();  // another one runs
      } catch (const std::exception& error) {
        (void)std::fputs(error.what(), stderr);
        ::_exit(1);
      }
    }
    ::_exit(0);
  }
  for (const pid_t child : children) {
    int status = 0;
    ::waitpid(child, &status, 0);
    EXPECT_EQ(status, 0);
  }
  EXPECT_THAT(session.entries(), SizeIs(1 + processes * runs));
}

TEST(FullDisk, RefusesAnEntryAndGoesOnWhenThereIsRoomAgain) {
  const test::SealedSession session;
  auto run = session.run();
  run.append("trial", "trial 1", test::bytes_of("A"));
  const auto size = std::filesystem::file_size(session.journal());
  for (const rlim_t room : {0U, 1U, 30U, 100U, 4000U}) {
    const kerf::test::FullDisk disk(size + room);
    try {
      run.append("trial", "trial 2", chance(5000));
      FAIL() << room;
    } catch (const std::system_error& error) {
      EXPECT_EQ(error.code().value(), EFBIG);
      EXPECT_THAT(error.what(), HasSubstr("s.session.h5.journal: cannot write"));
    }
    EXPECT_EQ(std::filesystem::file_size(session.journal()), size);
    EXPECT_THAT(run.session().entries, SizeIs(2));
  }
  run.append("trial", "trial 2", test::bytes_of("B"));
  EXPECT_THAT(session.entries(), ElementsAre("plan: : the order", "trial: trial 1: A", "trial: trial 2: B"));
}

TEST(FullDisk, LeavesTheJournalWhenARunCannotBeClosed) {
  const test::SealedSession session;
  auto run = session.run();
  run.append("trial", "trial 1", chance(20'000));
  {
    const kerf::test::FullDisk disk(10'000);
    EXPECT_THROW(run.close(), std::system_error);
  }
  EXPECT_TRUE(session.has_journal());
  EXPECT_THAT(session.entries(), SizeIs(2));
  EXPECT_THAT(std::distance(std::filesystem::directory_iterator(session.file().parent_path()), {}), 2);
  run.append("quit", "", {});
  run.close();
  EXPECT_FALSE(session.has_journal());
  EXPECT_THAT(session.entries(), SizeIs(3));
}

TEST(FullDisk, AtTheBeginningOfARunLeavesNothing) {
  const test::SealedSession session;
  {
    const kerf::test::FullDisk disk(10);
    EXPECT_THROW((void)session.run(), std::system_error);
  }
  EXPECT_FALSE(session.has_journal());
}

TEST(Journal, ThatCannotBeOpenedIsNamed) {
  const test::SealedSession session;
  std::filesystem::create_directory(session.journal());
  EXPECT_THAT([&] { (void)session.run(); },
              ThrowsMessage<std::system_error>(HasSubstr("s.session.h5.journal: cannot open")));
}

TEST(Journal, OfARunWithoutAnEntryLeavesNothing) {
  const test::SealedSession session;
  (void)session.run();
  EXPECT_FALSE(session.has_journal());
  EXPECT_THROW((SealedEntries(session.file(), test::key_of('x'), For::run, test::ignore)),
               std::invalid_argument);
  EXPECT_FALSE(session.has_journal());
}

}  // namespace
}  // namespace kerf::bench
