#include <limits>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/schema/regression.h>
#include <kerf/schema/session.h>
#include <kerf/schema/validate.h>

#include "datasets-schema/changed_file.h"
#include "datasets-schema/recording/sample_recording.h"
#include "hdf5/h5.h"
#include "support/program.h"

namespace kerf::schema {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;
using testing::ThrowsMessage;

Session sample_session() {
  Session session{.uuid = "0b5f1e0a-54bb-4c5e-9d55-6cf3f4d33c11",
                  .created = "2026-01-31T12:00:00Z",
                  .software = "kerf 0.1.0",
                  .subject = "S2",
                  .number = 2,
                  .subjects = 3,
                  .protocol = "name = \"Schärfe µ\"\n",
                  .laws = {{"laws/a.law.toml", "model = \"kelvin\"\n"}, {"../b.law.toml", ""}},
                  .key = {.kind = "passphrase", .salt = {}, .operations = 3, .memory_bytes = 268435456},
                  .entries = {}};
  for (std::size_t i = 0; i < session.key.salt.size(); ++i) {
    session.key.salt[i] = static_cast<std::uint8_t>(17 * i);
  }
  session.entries = {{"plan", "2026-01-31T12:00:00Z", "", std::vector<std::uint8_t>(100, 7)},
                     {"trial", "2026-01-31T12:01:00Z", "trial 1", std::vector<std::uint8_t>(70'000, 0)},
                     {"opened", "2026-01-31T12:02:00Z", "weil µ " + std::string(3000, 'x'),
                      std::vector<std::uint8_t>(40, 255)}};
  return session;
}

void expect_equal(const Session& one, const Session& other) {
  EXPECT_EQ(one.uuid, other.uuid);
  EXPECT_EQ(one.created, other.created);
  EXPECT_EQ(one.software, other.software);
  EXPECT_EQ(one.subject, other.subject);
  EXPECT_EQ(one.number, other.number);
  EXPECT_EQ(one.subjects, other.subjects);
  EXPECT_EQ(one.protocol, other.protocol);
  EXPECT_EQ(one.key.kind, other.key.kind);
  EXPECT_EQ(one.key.salt, other.key.salt);
  EXPECT_EQ(one.key.operations, other.key.operations);
  EXPECT_EQ(one.key.memory_bytes, other.key.memory_bytes);
  ASSERT_EQ(one.laws.size(), other.laws.size());
  for (std::size_t i = 0; i < one.laws.size(); ++i) {
    EXPECT_EQ(one.laws[i].name, other.laws[i].name);
    EXPECT_EQ(one.laws[i].toml, other.laws[i].toml);
  }
  ASSERT_EQ(one.entries.size(), other.entries.size());
  for (std::size_t i = 0; i < one.entries.size(); ++i) {
    EXPECT_EQ(one.entries[i].kind, other.entries[i].kind);
    EXPECT_EQ(one.entries[i].time, other.entries[i].time);
    EXPECT_EQ(one.entries[i].text, other.entries[i].text);
    EXPECT_EQ(one.entries[i].sealed, other.entries[i].sealed);
  }
}

void add_dataset(hid_t file, const std::string& path) {
  (void)h5::create_dataset(file, path, h5::native<std::uint8_t>(), {.extent = {40}, .contiguous = true});
}

class SessionFile : public testing::Test {
 protected:
  /// The line that reading gives after somebody put a hand in; empty if it was read.
  std::string refusal_after(const std::function<void(hid_t)>& change) {
    change_file(change);
    try {
      (void)read_session(file_);
      return "";
    } catch (const FormatError& error) {
      return error.what();
    }
  }
  std::vector<std::string> violations_after(const std::function<void(hid_t)>& change) {
    change_file(change);
    std::vector<std::string> lines;
    for (const auto& [where, found, expected] : validate(file_)) {
      lines.push_back(where + ": " + found + ", expected " + expected);
    }
    return lines;
  }
  void change_file(const std::function<void(hid_t)>& change) {
    write_session(file_, sample_session());
    auto file = h5::WritableFile::open(file_);
    change(file.id());
    file.close();
  }

  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "s.h5";
};

TEST_F(SessionFile, ComesBackAsItWas) {
  write_session(file_, sample_session());
  expect_equal(read_session(file_), sample_session());
  EXPECT_THAT(validate(file_), IsEmpty());
  Session empty = sample_session();
  empty.entries.clear();
  empty.laws.clear();
  empty.subject.clear();
  write_session(file_, empty);
  expect_equal(read_session(file_), empty);
}

TEST_F(SessionFile, IsReadWithoutWhatIsSealed) {
  write_session(file_, sample_session());
  Session facts = read_session_facts(file_);
  for (std::size_t i = 0; i < facts.entries.size(); ++i) {
    EXPECT_THAT(facts.entries[i].sealed, IsEmpty());
    facts.entries[i].sealed = read_sealed(file_, i);
  }
  expect_equal(facts, sample_session());
  EXPECT_THROW((void)read_sealed(file_, 3), FormatError);
}

TEST_F(SessionFile, IsWrittenEntryByEntry) {
  const Session session = sample_session();
  std::vector<std::size_t> asked;
  write_session(file_, session, [&](std::size_t entry) {
    asked.push_back(entry);
    return session.entries[entry].sealed;
  });
  EXPECT_THAT(asked, ElementsAre(0, 1, 2));
  expect_equal(read_session(file_), session);
}

// How well something is compressed would tell one law from another.
TEST_F(SessionFile, IsNotCompressed) {
  write_session(file_, sample_session());
  EXPECT_GT(std::filesystem::file_size(file_), 70'000U);
}

TEST_F(SessionFile, LeavesTheOldFileAloneWhenItCannotBeWritten) {
  write_session(file_, sample_session());
  Session other = sample_session();
  other.entries[1].text = std::string("a\0b", 3);
  EXPECT_THAT([&] { write_session(file_, other); },
              ThrowsMessage<std::invalid_argument>("session: an entry has a zero byte; expected a text"));
  EXPECT_THROW(write_session(file_, sample_session(),
                             [](std::size_t) -> std::vector<std::uint8_t> { throw FormatError("lost"); }),
               FormatError);
  EXPECT_THROW(write_session(folder_ / "no" / "s.h5", sample_session()), std::system_error);
  expect_equal(read_session(file_), sample_session());
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.path()), {}), 1);
}

TEST_F(SessionFile, ThatIsNoneIsRefusedInOneLine) {
  EXPECT_THAT([&] { (void)read_session(file_); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("there is no such file; expected a session")));
  EXPECT_THROW((void)read_session(folder_.path()), std::invalid_argument);
  test::write_text(file_, "name = 1\n");
  EXPECT_THAT([&] { (void)read_session(file_); },
              ThrowsMessage<FormatError>(HasSubstr("not an HDF5 file; expected a session")));
  write_recording(file_, test::sample_recording());
  EXPECT_THAT([&] { (void)read_session(file_); },
              ThrowsMessage<FormatError>(
                  HasSubstr("/ attribute 'schema': found 'kerf.recording', expected 'kerf.session'")));
}

TEST_F(SessionFile, OfAnotherVersionIsRefused) {
  EXPECT_THAT(
      refusal_after([](hid_t file) { test::set_number(file, "/", "schema_version", std::uint32_t{2}); }),
      HasSubstr("/ attribute 'schema_version': found 2, expected 1"));
}

TEST_F(SessionFile, WithoutAPartIsRefusedByItsName) {
  for (const char* path :
       {"/protocol", "/laws", "/key", "/entries", "/sealed", "/laws/000000", "/sealed/000001"}) {
    EXPECT_THAT(refusal_after([&](hid_t file) { test::remove_link(file, path); }),
                HasSubstr(std::string(path, 4)))
        << path;
  }
  for (const char* name : {"uuid", "created", "software", "subject", "number", "subjects"}) {
    EXPECT_THAT(refusal_after([&](hid_t file) { test::remove_attribute(file, "/", name); }),
                HasSubstr("/ attribute '" + std::string(name) + "': found nothing"));
  }
  for (const char* name : {"kind", "salt", "operations", "memory_bytes"}) {
    EXPECT_THAT(refusal_after([&](hid_t file) { test::remove_attribute(file, "/key", name); }),
                HasSubstr("/key attribute '" + std::string(name) + "'"));
  }
}

TEST_F(SessionFile, WithAPartOfAnotherTypeIsRefused) {
  EXPECT_THAT(refusal_after([](hid_t file) { test::set_number(file, "/", "number", 2.0); }),
              HasSubstr("/ attribute 'number': found float64, expected uint32"));
  EXPECT_THAT(refusal_after([](hid_t file) { test::set_text(file, "/key", "salt", "salt"); }),
              HasSubstr("/key attribute 'salt': found text, expected uint8 of 16"));
  EXPECT_THAT(refusal_after([](hid_t file) { test::replace_dataset<double>(file, "/entries", {3}); }),
              HasSubstr("/entries: found float64 of 3"));
  EXPECT_THAT(refusal_after([](hid_t file) {
                test::replace_dataset<std::uint8_t>(file, "/sealed/000002", {4, 4});
              }),
              HasSubstr("/sealed/000002: found uint8 of 4 x 4"));
  EXPECT_THAT(refusal_after([](hid_t file) {
                test::replace_dataset<std::uint8_t>(file, "/sealed/000002", {std::uint64_t{1} << 60U});
              }),
              HasSubstr("expected no more than the file can hold"));
  EXPECT_THAT(refusal_after([](hid_t file) { add_dataset(file, "/sealed/7"); }), HasSubstr("/sealed/7"));
}

TEST_F(SessionFile, IsReadDespiteWhatTheSchemaDoesNotKnow) {
  EXPECT_EQ(refusal_after([](hid_t file) {
              test::set_text(file, "/", "note", "x");
              add_dataset(file, "/more");
            }),
            "");
}

TEST_F(SessionFile, IsValidatedBeyondWhatReadingNeeds) {
  EXPECT_THAT(violations_after([](hid_t) {}), IsEmpty());
  EXPECT_THAT(violations_after([](hid_t file) {
                test::set_text(file, "/", "note", "x");
                test::set_text(file, "/", "uuid", "X");
                test::set_text(file, "/", "created", "yesterday");
                test::set_text(file, "/", "subject", "Jane Doe");
                test::set_number(file, "/", "number", std::uint32_t{4});
                test::set_text(file, "/key", "kind", "key file");
                add_dataset(file, "/more");
                test::replace_dataset<std::uint8_t>(file, "/sealed/000002", {39});
              }),
              testing::UnorderedElementsAre(
                  HasSubstr("/ attribute 'note'"), HasSubstr("/more"), HasSubstr("/ attribute 'uuid'"),
                  HasSubstr("/ attribute 'created'"), HasSubstr("'Jane Doe', expected a code"),
                  HasSubstr("'number': 4, expected from 1 to the 3"), HasSubstr("/key: 3 operations"),
                  HasSubstr("/sealed/000002: 39 bytes")));
  Session session = sample_session();
  std::swap(session.entries[0], session.entries[1]);
  session.entries[2].time = "late";
  write_session(file_, session);
  EXPECT_THAT(validate(file_), SizeIs(2));
}

TEST_F(SessionFile, CutShortAnywhereIsRefusedInOneLine) {
  write_session(file_, sample_session());
  const std::string bytes = test::read_text(file_);
  for (std::size_t length = 0; length < bytes.size(); length += 1009) {
    test::write_text(folder_ / "cut.h5", bytes.substr(0, length));
    try {
      (void)read_session(folder_ / "cut.h5");
      ADD_FAILURE() << length << " bytes";
    } catch (const FormatError& error) {
      ASSERT_THAT(error.what(), Not(HasSubstr("\n"))) << length;
    }
  }
}

TEST(SchemaOf, IsWhatAFileSaysOfItself) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(schema_of(folder / "none"), "");
  EXPECT_EQ(schema_of(folder.path()), "");
  test::write_text(folder / "text", "schema");
  EXPECT_EQ(schema_of(folder / "text"), "");
  write_session(folder / "s", sample_session());
  EXPECT_EQ(schema_of(folder / "s"), "kerf.session");
  write_recording(folder / "r", test::sample_recording());
  EXPECT_EQ(schema_of(folder / "r"), "kerf.recording");
  write_regression(folder / "f", {});
  EXPECT_EQ(schema_of(folder / "f"), "kerf.regression");
}

}  // namespace
}  // namespace kerf::schema
