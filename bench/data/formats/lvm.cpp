#include "formats/lvm.h"

#include <algorithm>
#include <charconv>
#include <map>
#include <stdexcept>

#include <fmt/format.h>

#include "files/trimmed.h"

namespace kerf::bench {
namespace {

constexpr std::string_view first_words = "LabVIEW Measurement";
constexpr std::string_view end_of_header = "***End_of_Header***";

/// The fields behind a tag, with the empty ones at the end of the line left out.
using Fields = std::vector<std::string>;

class LvmReader {
 public:
  LvmReader(char separator, const std::string& name) : separator_(separator), name_(name) {}

  void take(std::string_view line) {
    const Fields fields = split(line);
    const std::string& tag = fields.front();
    std::string out;
    if (is_special_ || tag == "***Start_Special***") {
      is_special_ = tag != "***End_Special***";
    } else if (in_header_) {
      if (tag == end_of_header)
        end_header();
      else if (!tag.empty())
        header_[tag] = Fields(fields.begin() + 1, fields.end());
    } else if (tag == "Channels") {
      in_header_ = true;
      ++segments_;
      header_[tag] = Fields(fields.begin() + 1, fields.end());
    } else if (awaits_names_ && !trimmed(line).empty()) {
      awaits_names_ = false;
      if (segments_ <= 1) out = names_of(fields);
    } else {
      out = row_of(line);
    }
    text_ += out;
    text_ += '\n';
  }

  LvmText finished() {
    if (in_header_)
      throw std::invalid_argument(
          fmt::format("{}: a LabVIEW file whose header has no {}", name_, end_of_header));
    LvmText made{.text = std::move(text_),
                 .notes = {fmt::format("a LabVIEW measurement file{}", begin_)},
                 .begin = {}};
    made.begin = begin_stamp_;
    if (segments_ > 1) made.notes.push_back(fmt::format("its {} segments follow each other", segments_));
    return made;
  }

 private:
  [[nodiscard]] Fields split(std::string_view line) const {
    Fields fields;
    while (true) {
      const std::size_t end = line.find(separator_);
      fields.emplace_back(trimmed(line.substr(0, end)));
      if (end == std::string_view::npos) break;
      line.remove_prefix(end + 1);
    }
    while (fields.size() > 1 && fields.back().empty()) fields.pop_back();
    return fields;
  }

  [[nodiscard]] std::string value(const std::string& tag, std::size_t i = 0) const {
    const auto found = header_.find(tag);
    return found == header_.end() || i >= found->second.size() ? "" : found->second[i];
  }

  [[nodiscard]] double number(const std::string& tag, std::size_t i = 0) const {
    std::string text = value(tag, i);
    std::ranges::replace(text, ',', '.');
    double result = 0.0;
    std::from_chars(text.data(), text.data() + text.size(), result);
    return result;
  }

  /// Of the file the first, of a segment any other.
  void end_header() {
    in_header_ = false;
    has_times_ = value("X_Columns") != "No";
    if (segments_ == 0) return;
    awaits_names_ = true;
    if (segments_ == 1 && !value("Date").empty() && value("Time_Pref") != "Absolute")
      begin_stamp_ = stamp_of(value("Date"), value("Time"));
    if (segments_ == 1 && !value("Date").empty())
      begin_ = fmt::format(", begun {} {}", value("Date"), value("Time"));
    row_ = 0;
    if (has_times_) return;
    const std::size_t channels = header_["Delta_X"].size();
    for (std::size_t i = 1; i < channels; ++i) {
      if (number("Delta_X", i) != number("Delta_X") || number("X0", i) != number("X0"))
        throw std::invalid_argument(fmt::format(
            "{}: a LabVIEW file without times whose channels have different ones (X0, Delta_X); expected "
            "one rate: write it with X_Columns One or Multi",
            name_));
    }
    if (!(number("Delta_X") > 0.0))
      throw std::invalid_argument(fmt::format("{}: a LabVIEW file without times and without Delta_X", name_));
  }

  /// LabVIEW writes more digits of a second than it knows: those behind the nanosecond are left out.
  static std::optional<TimeStamp> stamp_of(std::string date, std::string time) {
    std::ranges::replace(date, '/', '-');
    std::ranges::replace(time, ',', '.');
    constexpr std::size_t to_nanosecond = std::string_view("hh:mm:ss.123456789").size();
    TimeStamp stamp;
    if (!is_time_stamp(date + "T" + time.substr(0, to_nanosecond), stamp)) return std::nullopt;
    return stamp;
  }

  [[nodiscard]] std::string names_of(const Fields& fields) const {
    std::string line;
    std::size_t channel = 0;
    for (const std::string& field : fields) {
      const bool is_x = field.starts_with("X_Value");
      const std::string dimension = value("X_Dimension");
      const std::string unit = is_x                 ? (dimension.empty() || dimension == "Time" ? "s" : "")
                               : field == "Comment" ? ""
                                                    : value("Y_Unit_Label", channel++);
      if (!line.empty()) line += separator_;
      line += unit.empty() ? field : fmt::format("{} [{}]", field, unit);
    }
    return line;
  }

  [[nodiscard]] std::string row_of(std::string_view line) {
    if (has_times_ || line.empty() || line.front() != separator_) return std::string(line);
    std::string time = fmt::format("{}", number("X0") + number("Delta_X") * static_cast<double>(row_++));
    if (value("Decimal_Separator") == ",") std::ranges::replace(time, '.', ',');
    return time + std::string(line);
  }

  char separator_;
  const std::string& name_;
  std::map<std::string, Fields> header_;
  bool in_header_ = true;
  bool is_special_ = false;
  bool awaits_names_ = false;
  bool has_times_ = true;
  std::size_t segments_ = 0;
  std::size_t row_ = 0;
  std::string begin_;
  std::optional<TimeStamp> begin_stamp_;
  std::string text_;
};

}  // namespace

bool is_lvm(std::string_view text) noexcept { return text.starts_with(first_words); }

LvmText lvm_text(std::string_view text, const std::string& name) {
  const std::string_view behind = text.substr(first_words.size());
  LvmReader reader(behind.starts_with(',') ? ',' : '\t', name);
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    while (line.ends_with('\r')) line.remove_suffix(1);
    reader.take(line);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return reader.finished();
}

}  // namespace kerf::bench
