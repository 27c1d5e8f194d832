#include "sealed/trials/trial_bytes.h"

#include <cmath>
#include <stdexcept>

#include <fmt/core.h>

#include "files/json_number.h"
#include "sealed/bytes.h"
#include "sealed/plan_json.h"

namespace kerf::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t head_bytes = 4096;

Json head_of(const RecordedTrial& trial) {
  Json head{{"what", to_json(trial.what)},
            {"answer", trial.answer == no_answer ? Json(nullptr) : Json(trial.answer)},
            {"response_s", json_number(trial.response_s)},
            {"answerable_s", json_number(trial.answerable_s)},
            {"switches", trial.switches},
            {"at", trial.at},
            {"ticks", trial.trace.size()},
            {"axes", Json::array()},
            {"channels", Json::array()}};
  if (std::isfinite(trial.number)) head["number"] = trial.number;
  if (trial.is_void()) head["void"] = joined(trial.void_reasons);
  for (const schema::Axis& axis : trial.axes) {
    head["axes"].push_back({axis.name, axis.position_unit, axis.force_unit, axis.lever,
                            json_number(axis.contact_position), json_number(axis.contact_direction)});
  }
  for (const schema::Channel& channel : trial.channels) {
    head["channels"].push_back({channel.name, channel.unit});
  }
  return head;
}

RecordedTrial trial_of(const Json& head) {
  RecordedTrial trial;
  trial.what = trial_plan_from(head.at("what"));
  trial.answer = head.at("answer").is_null() ? no_answer : head["answer"].get<std::size_t>();
  if (head.contains("number")) trial.number = head["number"].get<double>();
  trial.response_s = number_from(head.at("response_s"));
  if (head.contains("answerable_s")) trial.answerable_s = number_from(head.at("answerable_s"));
  trial.switches = head.at("switches").get<std::size_t>();
  if (head.contains("void")) trial.void_reasons = void_reasons_in(head["void"].get<std::string>());
  trial.at = head.at("at").get<std::string>();
  for (const Json& axis : head.at("axes")) {
    trial.axes.push_back({.name = axis.at(0).get<std::string>(),
                          .position_unit = axis.at(1).get<std::string>(),
                          .force_unit = axis.at(2).get<std::string>(),
                          .lever = axis.at(3).get<double>(),
                          .contact_position = number_from(axis.at(4)),
                          .contact_direction = number_from(axis.at(5))});
  }
  for (const Json& channel : head.at("channels")) {
    trial.channels.push_back(
        {.name = channel.at(0).get<std::string>(), .unit = channel.at(1).get<std::string>(), .values = {}});
  }
  return trial;
}

std::size_t bytes_of_row(std::size_t axes, std::size_t channels) {
  return sizeof(std::uint64_t) + sizeof(double) + sizeof(std::uint32_t) + 4 * sizeof(float) + 1 +
         (4 * axes + channels) * sizeof(double);
}

void put(ByteWriter& writer, const TraceRow& tick, std::size_t axes, std::size_t channels) {
  const schema::Row& row = tick.row;
  writer.number(row.tick);
  writer.number(row.time_s);
  writer.number(row.flags);
  for (const float time_s : {row.wake_latency_s, row.read_time_s, row.compute_time_s, row.write_time_s}) {
    writer.number(time_s);
  }
  writer.number(tick.slot);
  for (const auto* values : {&row.position, &row.velocity, &row.force_commanded, &row.force_measured}) {
    for (std::size_t axis = 0; axis < axes; ++axis) writer.number((*values)[axis]);
  }
  for (std::size_t i = 0; i < channels; ++i) writer.number(row.channels[i]);
}

TraceRow take(ByteReader& reader, std::size_t axes, std::size_t channels) {
  TraceRow tick;
  schema::Row& row = tick.row;
  row.tick = reader.number<std::uint64_t>();
  row.time_s = reader.number<double>();
  row.flags = reader.number<std::uint32_t>();
  for (float* time_s : {&row.wake_latency_s, &row.read_time_s, &row.compute_time_s, &row.write_time_s}) {
    *time_s = reader.number<float>();
  }
  tick.slot = reader.number<std::uint8_t>();
  for (auto* values : {&row.position, &row.velocity, &row.force_commanded, &row.force_measured}) {
    for (std::size_t axis = 0; axis < axes; ++axis) (*values)[axis] = reader.number<double>();
  }
  for (std::size_t i = 0; i < channels; ++i) row.channels[i] = reader.number<double>();
  return tick;
}

}  // namespace

std::vector<std::uint8_t> trial_bytes(const RecordedTrial& trial) {
  std::string head = head_of(trial).dump();
  if (head.size() > head_bytes || trial.axes.size() > schema::max_axes ||
      trial.channels.size() > schema::max_channels) {
    throw std::invalid_argument(fmt::format(
        "{} axes and {} channels with names of {} characters do not fit into a sealed trial; expected "
        "shorter names",
        trial.axes.size(), trial.channels.size(), head.size()));
  }
  head.resize(head_bytes, ' ');
  ByteWriter writer;
  writer.reserve(head_bytes + trial.trace.size() * bytes_of_row(trial.axes.size(), trial.channels.size()));
  writer.bytes({reinterpret_cast<const std::uint8_t*>(head.data()), head.size()});
  for (const TraceRow& tick : trial.trace) put(writer, tick, trial.axes.size(), trial.channels.size());
  return std::move(writer.written());
}

RecordedTrial trial_from(std::span<const std::uint8_t> bytes, TraceToo trace) {
  try {
    ByteReader reader(bytes);
    const auto text = reader.bytes(head_bytes);
    const Json head = Json::parse(text.begin(), text.end());
    RecordedTrial trial = trial_of(head);
    const auto ticks = head.at("ticks").get<std::size_t>();
    if (trial.axes.size() > schema::max_axes || trial.channels.size() > schema::max_channels ||
        reader.rest().size() / bytes_of_row(trial.axes.size(), trial.channels.size()) != ticks) {
      throw std::out_of_range("another number of ticks than it says");
    }
    if (trace == TraceToo::no) return trial;
    trial.trace.reserve(ticks);
    for (std::size_t i = 0; i < ticks; ++i) {
      trial.trace.push_back(take(reader, trial.axes.size(), trial.channels.size()));
    }
    return trial;
  } catch (const Json::exception& error) {
    throw std::invalid_argument(fmt::format("a sealed trial is none: {}", error.what()));
  } catch (const std::out_of_range& error) {
    throw std::invalid_argument(fmt::format("a sealed trial is none: {}", error.what()));
  }
}

}  // namespace kerf::bench
