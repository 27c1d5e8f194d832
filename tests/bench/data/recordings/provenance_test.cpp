#include "recordings/provenance.h"

#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "bench/data/recordings/small_recording.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

// FIPS 180-4: the examples that come with the standard, and nothing at all.
TEST(Sha256, IsThatOfTheStandard) {
  EXPECT_EQ(sha256_of(std::string_view("abc")),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256_of(std::string_view("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq")),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256_of(std::string_view("")),
            "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

TEST(Sha256, OfAFileOfManyPiecesIsThatOfItsText) {
  const test::TemporaryFolder folder;
  std::string text(std::size_t{33} << 20U, 'k');
  for (std::size_t i = 0; i < text.size(); i += 4093) text[i] = static_cast<char>('a' + i % 26);
  test::write_text(folder / "long", text);
  EXPECT_EQ(sha256_of(folder / "long"), sha256_of(std::string_view(text)));
  test::write_text(folder / "empty", "");
  EXPECT_EQ(sha256_of(folder / "empty"), sha256_of(std::string_view("")));
}

// Its definition written anew in Python: hashlib.sha256(b"kerf.samples 1\0" + struct.pack("<d", 1) +
// b"theta\0rad\0N\xc2\xb7m\0"
// + struct.pack("<d", 1) + b"time\0" + ... ), with the columns as NumPy has their bytes.
TEST(ContentHash, IsOfWhatWasSampledAndOfNothingElse) {
  const schema::Recording recording = test::small_recording();
  const std::string hash = content_sha256_of(schema::RowsInMemory(recording));
  EXPECT_EQ(hash, "8850ac7b227808c784658d776dfba92a0419eaca5f58a78e4cbd08eb75aba6b5");
  schema::Recording said = recording;
  said.header = schema::new_header("another");
  said.axes[0].contact_position = 0.3;
  said.events.push_back({.time_s = 0.001, .kind = "stop", .text = "enough"});
  said.cycles.emplace();
  said.cycle_flags.emplace();
  EXPECT_EQ(content_sha256_of(schema::RowsInMemory(said)), hash);
  schema::Recording other = recording;
  other.force_measured[3] += 1e-15;
  EXPECT_NE(content_sha256_of(schema::RowsInMemory(other)), hash);
  other = recording;
  other.axes[0].position_unit = "m";
  EXPECT_NE(content_sha256_of(schema::RowsInMemory(other)), hash);
  other = recording;
  other.channels.push_back({.name = "label", .unit = "1", .values = std::vector<double>(11, 0.0)});
  EXPECT_NE(content_sha256_of(schema::RowsInMemory(other)), hash);
}

TEST(ContentHash, IsTheSameInAFileAndInMemory) {
  schema::Recording recording = test::small_recording();
  recording.compute_time.assign(11, 1e-6F);
  recording.flags.assign(11, 2);
  recording.channels = {{.name = "b", .unit = "N", .values = std::vector<double>(11, 2.0)},
                        {.name = "a", .unit = "m", .values = std::vector<double>(11, 1.0)}};
  const test::TemporaryFolder folder;
  schema::write_recording(folder / "r.h5", recording);
  EXPECT_EQ(content_sha256_of(folder / "r.h5"), content_sha256_of(schema::RowsInMemory(recording)));
}

}  // namespace
}  // namespace kerf::bench
