#include "convert/mcap_writer.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include <zlib.h>
#include <zstd.h>

namespace kerf::bench {
namespace {

enum Opcode : std::uint8_t {
  op_header = 0x01,
  op_footer = 0x02,
  op_schema = 0x03,
  op_channel = 0x04,
  op_message = 0x05,
  op_chunk = 0x06,
  op_message_index = 0x07,
  op_chunk_index = 0x08,
  op_attachment = 0x09,
  op_attachment_index = 0x0A,
  op_statistics = 0x0B,
  op_metadata = 0x0C,
  op_metadata_index = 0x0D,
  op_summary_offset = 0x0E,
  op_data_end = 0x0F
};

constexpr std::string_view magic("\x89MCAP0\r\n", 8);
constexpr std::size_t record_head = 9;  ///< opcode and length
/// Digits and names of JSON: higher levels take longer and save little.
constexpr int compression_level = 1;

template <typename Number>
void put_number(std::string& to, Number number) {
  std::array<char, sizeof(Number)> bytes{};
  for (std::size_t byte = 0; byte < bytes.size(); ++byte)
    bytes[byte] = static_cast<char>(static_cast<std::uint64_t>(number) >> (8 * byte) & 0xFFU);
  to.append(bytes.data(), bytes.size());
}
void put_u16(std::string& to, std::uint16_t number) { put_number(to, number); }
void put_u32(std::string& to, std::uint32_t number) { put_number(to, number); }
void put_u64(std::string& to, std::uint64_t number) { put_number(to, number); }
/// A text or bytes whose length is told in 32 bits.
void put_text(std::string& to, std::string_view text) {
  put_u32(to, static_cast<std::uint32_t>(text.size()));
  to += text;
}
void put_texts(std::string& to, const McapTexts& texts) {
  std::string all;
  for (const auto& [name, value] : texts) {
    put_text(all, name);
    put_text(all, value);
  }
  put_text(to, all);
}
void append_record(std::string& to, std::uint8_t opcode, std::string_view content) {
  to += static_cast<char>(opcode);
  put_u64(to, content.size());
  to += content;
}

std::uint32_t crc_of(std::string_view bytes, std::uint32_t before = 0) {
  return static_cast<std::uint32_t>(
      ::crc32_z(before, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()));
}

}  // namespace

McapWriter::McapWriter(OutputFile& file, Options options) : file_(file), options_(std::move(options)) {
  put(magic);
  std::string header;
  put_text(header, "");  // no profile
  put_text(header, options_.library);
  put_record(op_header, header);
}

void McapWriter::put(std::string_view bytes) {
  file_.write(bytes);
  crc_ = crc_of(bytes, crc_);
}

void McapWriter::put_record(std::uint8_t opcode, std::string_view content) {
  std::string head(1, static_cast<char>(opcode));
  put_u64(head, content.size());
  put(head);
  put(content);
}

std::uint16_t McapWriter::add_schema(const std::string& name, const std::string& encoding,
                                     std::string_view data) {
  std::string content;
  put_u16(content, ++schema_count_);
  put_text(content, name);
  put_text(content, encoding);
  put_text(content, data);
  append_record(chunk_, op_schema, content);
  append_record(schemas_, op_schema, content);
  return schema_count_;
}

std::uint16_t McapWriter::add_channel(const McapChannel& channel) {
  channels_.emplace_back();
  const auto number = static_cast<std::uint16_t>(channels_.size());
  std::string content;
  put_u16(content, number);
  put_u16(content, channel.schema);
  put_text(content, channel.topic);
  put_text(content, channel.message_encoding);
  put_texts(content, channel.metadata);
  append_record(chunk_, op_channel, content);
  append_record(channel_records_, op_channel, content);
  return number;
}

void McapWriter::write(const McapMessage& message, std::string_view data) {
  IndexOfChannel& channel = channels_.at(message.channel - std::size_t{1});
  channel.entries.emplace_back(message.log_time_ns, chunk_.size());
  ++channel.messages;
  const auto extend = [&](bool is_first, std::uint64_t& begin, std::uint64_t& end) {
    begin = is_first ? message.log_time_ns : std::min(begin, message.log_time_ns);
    end = is_first ? message.log_time_ns : std::max(end, message.log_time_ns);
  };
  extend(!chunk_has_messages_, chunk_begin_ns_, chunk_end_ns_);
  extend(message_count_ == 0, begin_ns_, end_ns_);
  chunk_has_messages_ = true;
  ++message_count_;
  constexpr std::size_t fields = 22;
  chunk_ += static_cast<char>(op_message);
  put_u64(chunk_, fields + data.size());
  put_u16(chunk_, message.channel);
  put_u32(chunk_, message.sequence);
  put_u64(chunk_, message.log_time_ns);
  put_u64(chunk_, message.publish_time_ns);
  chunk_ += data;
  if (chunk_.size() >= options_.chunk_bytes) end_chunk();
}

void McapWriter::end_chunk() {
  std::string_view records = chunk_;
  if (options_.compress) {
    compressed_.resize(ZSTD_compressBound(chunk_.size()));
    const std::size_t size = ZSTD_compress(compressed_.data(), compressed_.size(), chunk_.data(),
                                           chunk_.size(), compression_level);
    if (ZSTD_isError(size) != 0) throw std::runtime_error(ZSTD_getErrorName(size));
    records = std::string_view(compressed_).substr(0, size);
  }
  const std::string_view compression = options_.compress ? "zstd" : "";
  const std::uint64_t chunk_begins = file_.size();
  std::string head;
  put_u64(head, chunk_begin_ns_);
  put_u64(head, chunk_end_ns_);
  put_u64(head, chunk_.size());
  put_u32(head, crc_of(chunk_));
  put_text(head, compression);
  put_u64(head, records.size());
  std::string opening(1, static_cast<char>(op_chunk));
  put_u64(opening, head.size() + records.size());
  put(opening + head);
  put(records);

  const std::uint64_t indexes_begin = file_.size();
  std::string offsets;
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    auto& entries = channels_[i].entries;
    if (entries.empty()) continue;
    const auto number = static_cast<std::uint16_t>(i + 1);
    put_u16(offsets, number);
    put_u64(offsets, file_.size());
    std::string index;
    put_u16(index, number);
    constexpr std::size_t entry_bytes = 16;
    put_u32(index, static_cast<std::uint32_t>(entry_bytes * entries.size()));
    for (const auto& [time, offset] : entries) {
      put_u64(index, time);
      put_u64(index, offset);
    }
    put_record(op_message_index, index);
    entries.clear();
  }

  std::string index;
  put_u64(index, chunk_begin_ns_);
  put_u64(index, chunk_end_ns_);
  put_u64(index, chunk_begins);
  put_u64(index, indexes_begin - chunk_begins);
  put_text(index, offsets);
  put_u64(index, file_.size() - indexes_begin);
  put_text(index, compression);
  put_u64(index, records.size());
  put_u64(index, chunk_.size());
  append_record(chunk_index_, op_chunk_index, index);
  ++chunk_count_;
  chunk_.clear();
  chunk_has_messages_ = false;
  chunk_begin_ns_ = chunk_end_ns_ = 0;
}

void McapWriter::write_attachment(const McapAttachment& attachment) {
  std::string content;
  put_u64(content, attachment.log_time_ns);
  put_u64(content, attachment.create_time_ns);
  put_text(content, attachment.name);
  put_text(content, attachment.media_type);
  put_u64(content, attachment.data.size());
  content += attachment.data;
  put_u32(content, crc_of(content));
  std::string index;
  put_u64(index, file_.size());
  put_u64(index, record_head + content.size());
  put_u64(index, attachment.log_time_ns);
  put_u64(index, attachment.create_time_ns);
  put_u64(index, attachment.data.size());
  put_text(index, attachment.name);
  put_text(index, attachment.media_type);
  append_record(attachment_index_, op_attachment_index, index);
  put_record(op_attachment, content);
  ++attachment_count_;
}

void McapWriter::write_metadata(const std::string& name, const McapTexts& texts) {
  std::string content;
  put_text(content, name);
  put_texts(content, texts);
  std::string index;
  put_u64(index, file_.size());
  put_u64(index, record_head + content.size());
  put_text(index, name);
  append_record(metadata_index_, op_metadata_index, index);
  put_record(op_metadata, content);
  ++metadata_count_;
}

void McapWriter::finish() {
  if (!chunk_.empty()) end_chunk();
  std::string end;
  put_u32(end, crc_);
  put_record(op_data_end, end);
  put_summary();
}

void McapWriter::put_summary() {
  std::string statistics;
  put_u64(statistics, message_count_);
  put_u16(statistics, schema_count_);
  put_u32(statistics, static_cast<std::uint32_t>(channels_.size()));
  put_u32(statistics, attachment_count_);
  put_u32(statistics, metadata_count_);
  put_u32(statistics, chunk_count_);
  put_u64(statistics, begin_ns_);
  put_u64(statistics, end_ns_);
  std::string counts;
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    if (channels_[i].messages == 0) continue;
    put_u16(counts, static_cast<std::uint16_t>(i + 1));
    put_u64(counts, channels_[i].messages);
  }
  put_text(statistics, counts);
  std::string statistics_record;
  append_record(statistics_record, op_statistics, statistics);

  const std::uint64_t begins = file_.size();
  crc_ = 0;
  std::string offsets;
  const std::array<std::pair<Opcode, const std::string*>, 6> groups{
      {{op_schema, &schemas_},
       {op_channel, &channel_records_},
       {op_statistics, &statistics_record},
       {op_metadata_index, &metadata_index_},
       {op_attachment_index, &attachment_index_},
       {op_chunk_index, &chunk_index_}}};
  for (const auto& [opcode, records] : groups) {
    if (records->empty()) continue;
    std::string offset(1, static_cast<char>(opcode));
    put_u64(offset, file_.size());
    put_u64(offset, records->size());
    append_record(offsets, op_summary_offset, offset);
    put(*records);
  }
  const std::uint64_t offsets_begin = file_.size();
  put(offsets);
  // The checksum takes in the footer up to itself.
  constexpr std::size_t footer_bytes = 20;
  std::string footer(1, static_cast<char>(op_footer));
  put_u64(footer, footer_bytes);
  put_u64(footer, begins);
  put_u64(footer, offsets_begin);
  put_u32(footer, crc_of(footer, crc_));
  put(footer);
  put(magic);
}

}  // namespace kerf::bench
