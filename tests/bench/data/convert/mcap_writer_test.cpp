// Files of the conformance suite of foxglove/mcap (tests/conformance, by their SHA-256): a writer that
// follows the specification writes them byte by byte.

#include "convert/mcap_writer.h"

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "convert/output_file.h"
#include "recordings/provenance.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

class McapConformance : public testing::Test {
 protected:
  McapWriter& writer() { return writer_; }
  std::string sha256() {
    writer_.finish();
    file_.close();
    file_.commit(schema::Existing::replace);
    return sha256_of(folder_ / "x.mcap");
  }
  /// The suite's only schema and channel.
  std::uint16_t example() {
    const std::uint16_t schema = writer_.add_schema("Example", "c", "\4\5\6");
    return writer_.add_channel(
        {.schema = schema, .topic = "example", .message_encoding = "a", .metadata = {{"foo", "bar"}}});
  }

 private:
  test::TemporaryFolder folder_;
  OutputFile file_{folder_ / "x.mcap"};
  McapWriter writer_{file_, {.library = "", .compress = false}};
};

TEST_F(McapConformance, NoData) {
  EXPECT_EQ(sha256(), "78aed9973f50c4ebc30a8eab27453f6e42b2984c4f402d57e002dafdf217b744");
}

TEST_F(McapConformance, OneAttachment) {
  writer().write_attachment({.log_time_ns = 2,
                             .create_time_ns = 1,
                             .name = "myFile",
                             .media_type = "application/octet-stream",
                             .data = "\1\2\3"});
  EXPECT_EQ(sha256(), "14c5896f47973ccec3482a4dbb990d3a438da72a16cdeeb470b701cd90f7af65");
}

TEST_F(McapConformance, OneMetadata) {
  writer().write_metadata("myMetadata", {{"foo", "bar"}});
  EXPECT_EQ(sha256(), "6d7681e1536e3c61a0d9755b1b10b9a7ad4c2042855a839ce96c8c024bc64316");
}

TEST_F(McapConformance, OneMessage) {
  writer().write({.channel = example(), .sequence = 10, .log_time_ns = 2, .publish_time_ns = 1}, "\1\2\3");
  EXPECT_EQ(sha256(), "c2dc0d4ef3f1ee615eccc5753b4c401878865d05fb58c12aa7086c3e5e147165");
}

TEST_F(McapConformance, OneSchemalessMessage) {
  const std::uint16_t channel =
      writer().add_channel({.schema = 0, .topic = "example", .message_encoding = "text", .metadata = {}});
  writer().write({.channel = channel, .sequence = 10, .log_time_ns = 2, .publish_time_ns = 1}, "\1\2\3");
  EXPECT_EQ(sha256(), "e9b4aa6f672b611783230a6d642e50dcdf8620ee938226f8e86ca9f22ec64848");
}

TEST_F(McapConformance, TenMessages) {
  const std::uint16_t channel = example();
  std::uint32_t sequence = 0;
  for (const std::uint64_t time : {0U, 2U, 1U, 3U, 3U, 5U, 4U, 7U, 8U, 9U})
    writer().write({.channel = channel, .sequence = sequence++, .log_time_ns = time, .publish_time_ns = time},
                   "\1\2\3");
  EXPECT_EQ(sha256(), "813c4eb55e1195e5af9482f60d9b214cd083a8805720ec1663812637d716e4d5");
}

}  // namespace
}  // namespace kerf::bench
