#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "convert/output_file.h"

namespace kerf::bench {

using McapTexts = std::map<std::string, std::string>;

struct McapChannel {
  std::uint16_t schema = 0;  ///< as add_schema() numbered it; 0: none
  std::string topic;
  std::string message_encoding;
  McapTexts metadata;
};

struct McapMessage {
  std::uint16_t channel = 0;
  std::uint32_t sequence = 0;
  std::uint64_t log_time_ns = 0;
  std::uint64_t publish_time_ns = 0;
};

struct McapAttachment {
  std::uint64_t log_time_ns = 0;
  std::uint64_t create_time_ns = 0;
  std::string name;
  std::string media_type;
  std::string_view data;
};

/// Writes a file of MCAP, version 0 (mcap.dev/spec): messages in chunks, each with its index; checksums; and
/// a summary by which a reader finds a time without reading the rest. Keeps one chunk in memory, and of each
/// before it some 100 bytes.
class McapWriter {
 public:
  struct Options {
    std::string library;                              ///< what wrote it
    bool compress = true;                             ///< chunks by Zstandard
    std::size_t chunk_bytes = std::size_t{1} << 20U;  ///< of a chunk before it is compressed, about
  };

  McapWriter(OutputFile& file, Options options);

  /// Numbers from 1. `encoding` "jsonschema", ...
  std::uint16_t add_schema(const std::string& name, const std::string& encoding, std::string_view data);
  std::uint16_t add_channel(const McapChannel& channel);
  void write(const McapMessage& message, std::string_view data);
  void write_attachment(const McapAttachment& attachment);
  void write_metadata(const std::string& name, const McapTexts& texts);
  /// Writes the summary; nothing may be written after it, and the file is not closed.
  void finish();

 private:
  struct IndexOfChannel {
    std::vector<std::pair<std::uint64_t, std::uint64_t>> entries;  ///< time, offset in the chunk
    std::uint64_t messages = 0;                                    ///< in the whole file
  };

  void put(std::string_view bytes);
  void put_record(std::uint8_t opcode, std::string_view content);
  void end_chunk();
  void put_summary();

  OutputFile& file_;
  Options options_;
  std::uint32_t crc_ = 0;
  std::string chunk_;       ///< records, not yet compressed
  std::string compressed_;  ///< kept for its memory
  std::uint64_t chunk_begin_ns_ = 0;
  std::uint64_t chunk_end_ns_ = 0;
  bool chunk_has_messages_ = false;
  std::vector<IndexOfChannel> channels_;  ///< channel 1 first
  // Of the summary, in its order, whole records.
  std::string schemas_;
  std::string channel_records_;
  std::string metadata_index_;
  std::string attachment_index_;
  std::string chunk_index_;
  std::uint16_t schema_count_ = 0;
  std::uint32_t attachment_count_ = 0;
  std::uint32_t metadata_count_ = 0;
  std::uint32_t chunk_count_ = 0;
  std::uint64_t message_count_ = 0;
  std::uint64_t begin_ns_ = 0;
  std::uint64_t end_ns_ = 0;
};

}  // namespace kerf::bench
