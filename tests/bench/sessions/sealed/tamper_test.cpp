#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/sessions/sealed/sealed_session.h"
#include "sealed/sealed_entries.h"

// HDF5 1.10 itself forgets memory where a file is damaged.
extern "C" const char* __lsan_default_suppressions() { return "leak:libhdf5"; }

namespace kerf::bench {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

/// A whole session, into which somebody puts a hand.
class Tampered : public testing::Test {
 protected:
  void SetUp() override {
    auto run = session_.run();
    for (int i = 1; i <= 3; ++i) run.append("trial", fmt::format("trial {}", i), test::bytes_of("A"));
    run.append("opened", "we were curious", {});
    run.append("finished", "", {});
    run.close();
    original_ = schema::read_session(session_.file());
  }

  /// What is said when it is opened after a change; empty if nothing was noticed.
  std::string after(const std::function<void(schema::Session&)>& change) {
    schema::Session changed = original_;
    change(changed);
    std::filesystem::remove(session_.file());  // a new file need not be flushed
    schema::write_session(session_.file(), changed);
    try {
      (void)session_.entries();
      return "";
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
  }

  test::SealedSession session_;
  schema::Session original_;
};

TEST_F(Tampered, NotAtAllOpens) {
  EXPECT_THAT(after([](schema::Session&) {}), IsEmpty());
}

TEST_F(Tampered, InItsPublicPartDoesNotOpen) {
  const std::vector<std::function<void(schema::Session&)>> changes{
      [](auto& s) { s.uuid.back() = '2'; }, [](auto& s) { s.created = "2026-01-31T12:00:01Z"; },
      [](auto& s) { s.software += '1'; }, [](auto& s) { s.subject = "S3"; }, [](auto& s) { s.number = 3; },
      [](auto& s) { s.subjects = 4; }, [](auto& s) { s.protocol += '\n'; },
      [](auto& s) { std::swap(s.laws[0], s.laws[1]); },
      [](auto& s) { std::swap(s.laws[0].toml, s.laws[1].toml); }, [](auto& s) { s.laws[1].name += 'x'; },
      [](auto& s) { s.laws[0].toml += ' '; }, [](auto& s) { s.laws.pop_back(); },
      [](auto& s) { s.laws.push_back(s.laws[0]); }, [](auto& s) { s.key.kind = "passphrase"; },
      [](auto& s) { s.key.salt[7] = 1; }, [](auto& s) { s.key.operations = 1; },
      [](auto& s) { s.key.memory_bytes = 1; },
      // The same letters on both sides of a border.
      [](auto& s) {
        s.laws[0].name += s.laws[0].toml.front();
        s.laws[0].toml.erase(0, 1);
      }};
  for (std::size_t i = 0; i < changes.size(); ++i) {
    EXPECT_THAT(after(changes[i]), HasSubstr("does not open with this key")) << i;
  }
}

TEST_F(Tampered, InAnEntryNamesTheEntry) {
  for (std::size_t i = 1; i < original_.entries.size(); ++i) {
    const std::string named = fmt::format("entry {} ({})", i, original_.entries[i].kind);
    EXPECT_THAT(after([&](auto& s) { s.entries[i].time.back() = 'z'; }), HasSubstr(named));
    EXPECT_THAT(after([&](auto& s) { s.entries[i].text += '1'; }), HasSubstr(named));
    EXPECT_THAT(after([&](auto& s) { s.entries[i].kind = "note"; }),
                HasSubstr(fmt::format("entry {} (note)", i)));
    EXPECT_THAT(after([&](auto& s) {
                  s.entries[i].kind += s.entries[i].time.front();
                  s.entries[i].time.erase(0, 1);
                }),
                HasSubstr(fmt::format("entry {} (", i)));
  }
}

TEST_F(Tampered, InAnyBitOfWhatIsSealedNamesTheEntry) {
  for (std::size_t i = 0; i < original_.entries.size(); ++i) {
    for (std::size_t byte = 0; byte < original_.entries[i].sealed.size(); byte += 3) {
      const auto flip = [&](auto& s) {
        s.entries[i].sealed[byte] = static_cast<std::uint8_t>(s.entries[i].sealed[byte] ^ (1U << byte % 8));
      };
      EXPECT_THAT(after(flip), HasSubstr(i == 0 ? "does not open" : fmt::format("entry {} (", i))) << byte;
    }
  }
}

TEST_F(Tampered, ByAnEntryTakenOutNamesTheNext) {
  const std::size_t count = original_.entries.size();
  for (std::size_t i = 0; i + 1 < count; ++i) {
    EXPECT_THAT(after([&](auto& s) { s.entries.erase(s.entries.begin() + static_cast<std::ptrdiff_t>(i)); }),
                HasSubstr(i == 0 ? "does not open" : fmt::format("entry {} (", i)));
  }
}

TEST_F(Tampered, ByEntriesExchangedNamesTheFirst) {
  EXPECT_THAT(after([](auto& s) { std::swap(s.entries[1], s.entries[2]); }), HasSubstr("entry 1 (trial)"));
  EXPECT_THAT(after([](auto& s) { std::swap(s.entries[1].sealed, s.entries[3].sealed); }),
              HasSubstr("entry 1 (trial)"));
}

TEST_F(Tampered, ByAnEntryTwiceNamesTheSecond) {
  EXPECT_THAT(after([](auto& s) { s.entries.insert(s.entries.begin() + 2, s.entries[1]); }),
              HasSubstr("entry 2 (trial)"));
  EXPECT_THAT(after([](auto& s) { s.entries.push_back(s.entries.back()); }), HasSubstr("entry 6 (finished)"));
}

TEST_F(Tampered, ByAnEntryOfTheSameSessionRunAgainNamesIt) {
  schema::Session again = original_;
  again.entries.resize(2);  // after the first trial
  schema::write_session(session_.file(), again);
  auto run = session_.run();
  run.append("trial", "trial 2", test::bytes_of("B"));
  run.close();
  const auto other = schema::read_session(session_.file()).entries[2];
  EXPECT_THAT(after([&](auto& s) { s.entries[2] = other; }), HasSubstr("entry 3 (trial)"))
      << "it fits in its place, but what follows does not fit to it";
}

// What nobody can know from the file: docs/blinding.md says so.
TEST_F(Tampered, AtItsEndLooksLikeASessionThatStoppedThere) {
  EXPECT_THAT(after([](auto& s) { s.entries.resize(3); }), IsEmpty());
}

TEST_F(Tampered, AtRandomNeverCrashes) {
  const std::string bytes = kerf::test::read_text(session_.file());
  std::mt19937 generator(11);
  std::size_t unharmed = 0;
  for (int i = 0; i < 2000; ++i) {
    std::string changed = bytes;
    for (std::size_t hits = 1 + generator() % 4; hits > 0; --hits) {
      const std::size_t at = generator() % changed.size();
      switch (generator() % 4) {
        case 0:
          changed[at] = static_cast<char>(generator());
          break;
        case 1:
          changed[at] = static_cast<char>(changed[at] ^ (1 << generator() % 8));
          break;
        case 2:
          changed.replace(at, 8, 8, generator() % 2 == 0 ? '\xff' : '\0');
          break;
        default:
          changed.resize(changed.size() - generator() % 64);
          break;
      }
    }
    kerf::test::write_text(session_.file(), changed);
    try {
      (void)session_.entries();
      ASSERT_EQ(schema::read_session(session_.file()).entries.size(), original_.entries.size());
      ++unharmed;  // room between the objects
    } catch (const schema::FormatError& error) {
      ASSERT_THAT(error.what(), testing::Not(HasSubstr("\n")));
    } catch (const std::invalid_argument&) {
    }
  }
  EXPECT_LT(unharmed, 1500U);
}

}  // namespace
}  // namespace kerf::bench
