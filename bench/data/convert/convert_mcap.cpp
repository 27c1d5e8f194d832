#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <kerf/version.h>

#include "convert/formats.h"
#include "convert/mcap_writer.h"
#include "convert/number_text.h"
#include "convert/output_file.h"

namespace kerf::bench {
namespace {

using Json = nlohmann::ordered_json;
using Group = RecordingColumn::Group;

std::string json_text(const Json& value) {
  return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// Seconds as nanoseconds since the epoch of the file: 1970 where the recording knows when it began, else
/// its own beginning. What lies before that, or is no number, has the moment `otherwise`.
class McapClock {
 public:
  explicit McapClock(const schema::Header& header)
      : start_ns_(static_cast<std::uint64_t>(std::max<std::int64_t>(header.start_ns.value_or(0), 0))) {}

  [[nodiscard]] std::uint64_t at(double time_s, std::uint64_t otherwise) const {
    constexpr double longest_s = 9e9;  // beyond which 64 bits would overflow
    if (std::isnan(time_s)) return otherwise;
    const auto offset = std::llround(1e9 * std::clamp(time_s, -longest_s, longest_s));
    if (offset >= 0) return start_ns_ + static_cast<std::uint64_t>(offset);
    const auto before = static_cast<std::uint64_t>(-offset);
    return start_ns_ > before ? start_ns_ - before : 0;
  }
  [[nodiscard]] std::uint64_t start_ns() const noexcept { return start_ns_; }

 private:
  std::uint64_t start_ns_;
};

/// Names within a message: an axis within its quantity, a channel by itself.
std::string_view outer_key(const RecordingColumn& column) {
  return column.part.empty() || column.group == Group::channels ? std::string_view() : column.quantity;
}
std::string_view inner_key(const RecordingColumn& column) {
  return column.part.empty() ? column.quantity : column.part;
}

/// A topic: some columns, one message a row.
class McapTopic {
 public:
  McapTopic(std::string name, Group group, const RecordingColumns& recording)
      : name_(std::move(name)), columns_(recording.columns()) {
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      if (columns_[i].group != group) continue;
      numbers_.push_back(i);
      keys_.push_back(json_text(std::string(inner_key(columns_[i]))) + ":");
    }
  }
  [[nodiscard]] bool is_empty() const noexcept { return numbers_.empty(); }

  void begin(McapWriter& writer) {
    const std::uint16_t schema = writer.add_schema("kerf." + name_, "jsonschema", schema_text());
    McapTexts units;
    for (const std::size_t i : numbers_) units[columns_[i].name()] = columns_[i].unit;
    channel_ = writer.add_channel({.schema = schema,
                                   .topic = "/kerf/" + name_,
                                   .message_encoding = "json",
                                   .metadata = std::move(units)});
  }

  void write(McapWriter& writer, const std::vector<ColumnValues>& values, std::size_t row,
             McapMessage message) {
    message.channel = channel_;
    text_.clear();
    text_.push_back('{');
    std::string_view open;  // the quantity whose axes are being written
    for (std::size_t k = 0; k < numbers_.size(); ++k) {
      const RecordingColumn& column = columns_[numbers_[k]];
      const ColumnValues& of = values[numbers_[k]];
      if (!column.is_whole() && !std::isfinite(of.real[row])) continue;  // JSON has no such number
      if (const std::string_view outer = outer_key(column); outer != open) {
        if (!open.empty()) text_.push_back('}');
        if (!outer.empty()) fmt::format_to(std::back_inserter(text_), "{}\"{}\":{{", comma(), outer);
        open = outer;
      }
      fmt::format_to(std::back_inserter(text_), "{}{}", comma(), keys_[k]);
      append_number(text_, column, of, row);
    }
    if (!open.empty()) text_.push_back('}');
    text_.push_back('}');
    writer.write(message, {text_.data(), text_.size()});
  }

 private:
  [[nodiscard]] std::string_view comma() const { return text_[text_.size() - 1] == '{' ? "" : ","; }

  [[nodiscard]] std::string schema_text() const {
    Json properties = Json::object();
    for (const std::size_t i : numbers_) {
      const RecordingColumn& column = columns_[i];
      Json* where = &properties;
      if (const std::string outer(outer_key(column)); !outer.empty()) {
        properties[outer]["type"] = "object";
        where = &properties[outer]["properties"];
      }
      (*where)[std::string(inner_key(column))] = {
          {"type", column.is_whole() ? "integer" : "number"},
          {"description", fmt::format("{} [{}]", column.meaning, column.unit)}};
    }
    return json_text({{"type", "object"}, {"properties", properties}});
  }

  std::string name_;
  const std::vector<RecordingColumn>& columns_;
  std::vector<std::size_t> numbers_;
  std::vector<std::string> keys_;
  std::uint16_t channel_ = 0;
  fmt::memory_buffer text_;
};

/// Events as messages of the schema that Foxglove shows as a log.
class McapEvents {
 public:
  McapEvents(const schema::Recording& about, const McapClock& clock) : clock_(clock) {
    for (const schema::Event& event : about.events)
      events_.push_back({clock.at(event.time_s, clock.start_ns()), &event});
    std::ranges::stable_sort(events_, {}, &Moment::time_ns);
  }

  void begin(McapWriter& writer) {
    if (events_.empty()) return;
    const Json whole{{"type", "integer"}};
    const Json text{{"type", "string"}};
    const Json schema{
        {"type", "object"},
        {"title", "foxglove.Log"},
        {"properties",
         {{"timestamp",
           {{"type", "object"}, {"title", "time"}, {"properties", {{"sec", whole}, {"nsec", whole}}}}},
          {"level", whole},
          {"message", text},
          {"name", text},
          {"file", text},
          {"line", whole}}}};
    const std::uint16_t number = writer.add_schema("foxglove.Log", "jsonschema", json_text(schema));
    channel_ = writer.add_channel(
        {.schema = number, .topic = "/kerf/events", .message_encoding = "json", .metadata = {}});
  }

  /// Those up to a moment that were not yet written.
  void write_until(McapWriter& writer, std::uint64_t time_ns) {
    for (; next_ < events_.size() && events_[next_].time_ns <= time_ns; ++next_) {
      const Moment& moment = events_[next_];
      const schema::Event& event = *moment.event;
      constexpr std::uint64_t second = 1'000'000'000;
      const Json message{{"timestamp", {{"sec", moment.time_ns / second}, {"nsec", moment.time_ns % second}}},
                         {"level", level_of(event)},
                         {"message", event.text.empty() ? event.kind : event.kind + ": " + event.text},
                         {"name", "kerf"},
                         {"file", ""},
                         {"line", 0}};
      writer.write({.channel = channel_,
                    .sequence = static_cast<std::uint32_t>(next_),
                    .log_time_ns = moment.time_ns,
                    .publish_time_ns = moment.time_ns},
                   json_text(message));
    }
  }

 private:
  struct Moment {
    std::uint64_t time_ns = 0;
    const schema::Event* event = nullptr;
  };
  static int level_of(const schema::Event& event) {
    constexpr int information = 2;
    constexpr int warning = 3;
    const bool is_flag = std::ranges::any_of(
        schema::flag_table, [&](const schema::FlagInfo& flag) { return flag.name == event.kind; });
    return is_flag || event.kind == "gap" || event.kind == "fault" || event.kind == "output" ? warning
                                                                                             : information;
  }

  McapClock clock_;
  std::vector<Moment> events_;
  std::size_t next_ = 0;
  std::uint16_t channel_ = 0;
};

void write_texts(const schema::Recording& about, std::uint64_t start_ns, McapWriter& writer) {
  writer.write_metadata("kerf.recording", facts_of(about));
  const auto attach = [&](const char* name, const std::string& text) {
    if (!text.empty())
      writer.write_attachment({.log_time_ns = start_ns,
                               .create_time_ns = start_ns,
                               .name = name,
                               .media_type = "application/toml",
                               .data = text});
  };
  attach("device.toml", about.header.device_toml);
  attach("scene.toml", about.header.scene_toml);
}

}  // namespace

void convert_to_mcap(const RecordingColumns& recording, const ConversionTarget& target) {
  OutputFile file(target.file);
  McapWriter writer(file, {.library = software()});
  const McapClock clock(recording.about().header);
  write_texts(recording.about(), clock.start_ns(), writer);
  std::vector<McapTopic> topics;
  const std::array<std::pair<const char*, Group>, 4> groups{{{"motion", Group::motion},
                                                             {"force", Group::force},
                                                             {"channels", Group::channels},
                                                             {"timing", Group::timing}}};
  for (const auto& [name, group] : groups) {
    McapTopic topic(name, group, recording);
    if (topic.is_empty()) continue;
    topic.begin(writer);
    topics.push_back(std::move(topic));
  }
  McapEvents events(recording.about(), clock);
  events.begin(writer);

  std::vector<ColumnValues> values;
  std::uint64_t now = clock.start_ns();
  for (std::uint64_t first = 0; first < recording.rows(); first += recording.rows_of_a_block()) {
    const auto count = static_cast<std::size_t>(
        std::min<std::uint64_t>(recording.rows_of_a_block(), recording.rows() - first));
    recording.read_all(first, count, values);
    for (std::size_t row = 0; row < count; ++row) {
      now = clock.at(values[0].real[row], now);
      events.write_until(writer, now);
      // The low half of the tick: a jump of the one is a jump of the other.
      const McapMessage message{.sequence = static_cast<std::uint32_t>(values[1].whole[row]),
                                .log_time_ns = now,
                                .publish_time_ns = now};
      for (McapTopic& topic : topics) topic.write(writer, values, row, message);
    }
    *target.rows_done += count;
  }
  events.write_until(writer, std::numeric_limits<std::uint64_t>::max());
  writer.finish();
  file.close();
  file.commit(target.existing);
}

}  // namespace kerf::bench
