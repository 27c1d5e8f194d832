#include "formats/tdms/tdms.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <stdexcept>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "formats/tdms/tdms_segments.h"

namespace kerf::bench {
namespace {

/// From 1904-01-01 to 1970-01-01.
constexpr std::int64_t epoch_s = 2'082'844'800;
/// Years of which stamps are read: 1950 to 2149.
constexpr std::int64_t first_s = epoch_s - 631'152'000;
constexpr std::int64_t last_s = epoch_s + 5'680'281'600;

std::optional<TimeStamp> stamp_of(const TdmsMoment& moment) {
  if (moment.seconds < first_s || moment.seconds >= last_s) return std::nullopt;
  constexpr double of_second = 18446744073709551616.0;
  const auto ns = std::llround(static_cast<double>(moment.fractions) / of_second * 1e9);
  return TimeStamp{.ns = (moment.seconds - epoch_s) * 1'000'000'000 + ns, .has_zone = true};
}

const TdmsValue* property(const TdmsChannel& channel, const std::string& name) {
  const auto found = channel.properties.find(name);
  return found == channel.properties.end() ? nullptr : &found->second;
}

std::optional<double> number(const TdmsChannel& channel, const std::string& name) {
  const TdmsValue* value = property(channel, name);
  const auto* found = value == nullptr ? nullptr : std::get_if<double>(value);
  return found == nullptr || !std::isfinite(*found) ? std::nullopt : std::optional(*found);
}

std::string words(const TdmsChannel& channel, const std::string& name) {
  const TdmsValue* value = property(channel, name);
  const auto* found = value == nullptr ? nullptr : std::get_if<std::string>(value);
  return found == nullptr ? std::string() : *found;
}

/// The parts of /'group'/'channel', whose quotes are doubled.
std::vector<std::string> parts_of(const std::string& path) {
  std::vector<std::string> parts;
  bool in_quotes = false;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (path[i] != '\'') {
      if (in_quotes) parts.back() += path[i];
    } else if (!in_quotes) {
      parts.emplace_back();
      in_quotes = true;
    } else if (i + 1 < path.size() && path[i + 1] == '\'') {
      parts.back() += path[i++];
    } else {
      in_quotes = false;
    }
  }
  return parts;
}

/// What no heading may hold.
std::string in_one_field(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  }
  return text;
}

/// The scales of a channel, the last of which gives what it is.
class Scales {
 public:
  explicit Scales(const TdmsChannel& channel) : channel_(channel) {
    constexpr double most = 32;
    const double count = number(channel, "NI_Number_Of_Scales").value_or(0.0);
    if (words(channel, "NI_Scaling_Status") == "scaled" || !(count >= 1.0)) return;
    if (count > most) {
      fault_ = fmt::format("it has {} scales", count);
      return;
    }
    for (int n = 0; n < static_cast<int>(count) && fault_.empty(); ++n) add(n);
  }
  [[nodiscard]] const std::string& fault() const noexcept { return fault_; }
  [[nodiscard]] double apply(double raw) const {
    std::vector<double> results;
    for (const Scale& scale : scales_) {
      const double x = scale.source < 0 ? raw : results[static_cast<std::size_t>(scale.source)];
      double y = 0.0;
      for (auto c = scale.coefficients.rbegin(); c != scale.coefficients.rend(); ++c) y = y * x + *c;
      results.push_back(y);
    }
    return results.empty() ? raw : results.back();
  }

 private:
  struct Scale {
    std::vector<double> coefficients;
    int source = -1;  ///< the raw value
  };

  void add(int n) {
    const std::string prefix = fmt::format("NI_Scale[{}]_", n);
    const std::string type = words(channel_, prefix + "Scale_Type");
    Scale scale;
    if (type == "Linear") {
      take(scale, prefix + "Linear_Y_Intercept");
      take(scale, prefix + "Linear_Slope");
    } else if (type == "Polynomial") {
      const double size = number(channel_, prefix + "Polynomial_Coefficients_Size").value_or(4.0);
      for (int i = 0; i < std::min(size, 64.0); ++i)
        take(scale, fmt::format("{}Polynomial_Coefficients[{}]", prefix, i));
    } else {
      fault_ = fmt::format("its scale '{}' is neither linear nor polynomial", type);
    }
    constexpr double of_raw = 4294967295.0;
    const double source = number(channel_, fmt::format("{}{}_Input_Source", prefix, type)).value_or(of_raw);
    if (source >= 0.0 && source < n)
      scale.source = static_cast<int>(source);
    else if (source != of_raw)
      fault_ = "its scales take each other's values in a circle";
    scales_.push_back(std::move(scale));
  }
  void take(Scale& scale, const std::string& name) {
    const auto value = number(channel_, name);
    if (!value && fault_.empty()) fault_ = fmt::format("it has no {}", name);
    scale.coefficients.push_back(value.value_or(0.0));
  }

  const TdmsChannel& channel_;
  std::vector<Scale> scales_;
  std::string fault_;
};

/// A channel that becomes a column.
struct Column {
  const TdmsChannel* channel;
  std::string name;
  Scales scales;

  [[nodiscard]] std::size_t length() const {
    return channel->moments.empty() ? channel->values.size() : channel->moments.size();
  }
  [[nodiscard]] std::string heading() const {
    std::string unit = words(*channel, "unit_string");
    if (unit.empty()) unit = words(*channel, "NI_UnitDescription");
    return in_one_field(unit.empty() || !channel->moments.empty() ? name
                                                                  : fmt::format("{} [{}]", name, unit));
  }
};

class TextMaker {
 public:
  TextMaker(const TdmsFile& file, const std::string& name)
      : made_{.text = {}, .notes = file.notes, .begin = {}} {
    made_.notes.insert(made_.notes.begin(), "a TDMS file");
    choose(file);
    if (columns_.empty() || (columns_.size() < 2 && !has_times()))
      throw std::invalid_argument(
          fmt::format("{}: a TDMS file without two columns of numbers of one length{}", name,
                      left_out_.empty() ? "" : fmt::format(" (left out: {})", fmt::join(left_out_, "; "))));
    if (!left_out_.empty()) made_.notes.push_back(fmt::format("left out: {}", fmt::join(left_out_, "; ")));
  }

  TdmsText make() {
    const bool times = has_times();
    if (times) take_begin();
    std::string& text = made_.text;
    if (times) text += fmt::format("{} [s]", tdms_time_column);
    for (const Column& column : columns_) text += (text.empty() ? "" : "\t") + column.heading();
    text += '\n';
    auto end = std::back_inserter(text);
    for (std::size_t row = 0; row < columns_.front().length(); ++row) {
      if (times) fmt::format_to(end, "{}\t", offset_ + increment_ * static_cast<double>(row));
      for (std::size_t i = 0; i < columns_.size(); ++i) {
        if (i > 0) text += '\t';
        put(columns_[i], row);
      }
      text += '\n';
    }
    return std::move(made_);
  }

 private:
  void choose(const TdmsFile& file) {
    std::set<std::string> groups;
    for (const TdmsChannel& channel : file.channels) groups.insert(parts_of(channel.path).front());
    std::map<std::size_t, std::size_t> columns_of_length;
    std::vector<Column> all;
    for (const TdmsChannel& channel : file.channels) {
      const auto parts = parts_of(channel.path);
      const std::string name = groups.size() > 1 ? fmt::format("{}", fmt::join(parts, "/")) : parts.back();
      Column column{.channel = &channel, .name = name, .scales = Scales(channel)};
      std::string fault = channel.unread.empty() ? column.scales.fault() : "it holds " + channel.unread;
      if (channel.is_beyond_double) fault = "it holds whole numbers beyond 2^53, which no double holds";
      if (!channel.moments.empty() && !channel.values.empty()) fault = "it holds numbers and moments";
      if (!fault.empty()) {
        left_out_.push_back(fmt::format("'{}': {}", name, fault));
        continue;
      }
      ++columns_of_length[column.length()];
      all.push_back(std::move(column));
    }
    const auto most = std::ranges::max_element(columns_of_length, {},
                                               [](const auto& entry) { return entry.first * entry.second; });
    for (Column& column : all) {
      if (column.length() == most->first)
        columns_.push_back(std::move(column));
      else
        left_out_.push_back(
            fmt::format("'{}': it has {} values and not {}", column.name, column.length(), most->first));
    }
  }

  /// Whether all columns say one increment and one offset.
  bool has_times() {
    std::set<std::pair<double, double>> said;
    for (const Column& column : columns_) {
      const double increment = number(*column.channel, "wf_increment").value_or(0.0);
      if (!(increment > 0.0)) continue;
      said.emplace(increment, number(*column.channel, "wf_start_offset").value_or(0.0));
    }
    if (said.size() != 1) {
      if (said.size() > 1 && !told_of_rates_)
        made_.notes.emplace_back(
            "its channels have different wf_increment or wf_start_offset: there is no column of times");
      told_of_rates_ = true;
      return false;
    }
    std::tie(increment_, offset_) = *said.begin();
    return true;
  }

  void take_begin() {
    std::set<std::int64_t> begins;
    for (const Column& column : columns_) {
      const TdmsValue* start = property(*column.channel, "wf_start_time");
      const auto* moment = start == nullptr ? nullptr : std::get_if<TdmsMoment>(start);
      const auto stamp = moment == nullptr ? std::nullopt : stamp_of(*moment);
      if (stamp) begins.insert(stamp->ns);
    }
    if (begins.size() == 1) made_.begin = TimeStamp{.ns = *begins.begin(), .has_zone = true};
    if (begins.size() > 1)
      made_.notes.emplace_back("its channels began at different moments (wf_start_time): none is kept");
  }

  void put(const Column& column, std::size_t row) {
    std::string& text = made_.text;
    if (!column.channel->moments.empty()) {
      const auto stamp = stamp_of(column.channel->moments[row]);
      text += stamp ? time_stamp_text(*stamp) : "none";
      return;
    }
    const double value = column.scales.apply(column.channel->values[row]);
    if (std::isnan(value))
      text += "nan";
    else
      fmt::format_to(std::back_inserter(text), "{}", value);
  }

  TdmsText made_;
  std::vector<Column> columns_;
  std::vector<std::string> left_out_;
  double increment_ = 0.0;
  double offset_ = 0.0;
  bool told_of_rates_ = false;
};

}  // namespace

TdmsText tdms_text(std::string_view bytes, const std::string& name) {
  TdmsFile file = tdms_segments(bytes, name);
  for (const TdmsChannel& channel : file.channels) {
    if (parts_of(channel.path).empty())
      throw std::invalid_argument(fmt::format("{}: a damaged TDMS file: data of '{}', which is no channel",
                                              name, in_one_field(channel.path)));
  }
  return TextMaker(file, name).make();
}

}  // namespace kerf::bench
