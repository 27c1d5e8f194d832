#include "calibrate/measured_holds.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include <kerf/schema/recording.h>

#include "files/named_file.h"
#include "import/column_map.h"
#include "import/text/text_layout.h"
#include "import/text/text_table.h"
#include "inspect/signal_facts.h"
#include "recordings/whole_recording.h"
#include "signal/blocked_values.h"
#include "units/units.h"

namespace kerf::bench {
namespace {

/// Columns in SI by what they are.
struct NamedColumns {
  std::vector<std::string> names;
  std::vector<std::vector<double>> values;
  std::size_t first_line = 1;
  std::vector<std::size_t> lines;  ///< of each row; empty: they follow first_line

  [[nodiscard]] const std::vector<double>* find(std::string_view name) const {
    const auto found = std::ranges::find(names, name);
    return found == names.end() ? nullptr : &values[static_cast<std::size_t>(found - names.begin())];
  }
};

bool is_load(std::string_view name) {
  return std::ranges::find(wrench_components, name) != wrench_components.end();
}
bool is_signal_by_name(std::string_view name) {
  return name.starts_with("signal") ||
         (name.size() > 1 && name[0] == 'u' && name[1] >= '0' && name[1] <= '9');
}
bool is_known(std::string_view name) {
  return is_load(name) || name == "time" || name == "temperature" || name == "step" || name == "hold" ||
         name == "settled" || name.starts_with("noise_");
}

/// The unit that a quantity is kept in.
std::string_view si_of(std::string_view name) {
  if (name.starts_with("f")) return "N";
  return name.starts_with("t") && name.size() == 2 ? "N·m" : "";
}

struct Wanted {
  std::string name;
  std::size_t column = 0;
  Unit unit;
};

Wanted wanted(const std::string& name, std::size_t column, const std::string& unit, const std::string& file) {
  Wanted one{.name = name, .column = column, .unit = unit.empty() ? Unit{} : parse_unit(unit)};
  if (is_load(name) && !unit.empty() && one.unit.si != si_of(name))
    throw std::invalid_argument(
        fmt::format("{}: {} is in {}, expected a unit of {}", file, name, unit, si_of(name)));
  return one;
}

std::vector<Wanted> columns_wanted(const TextLayout& layout, const std::string& file,
                                   const std::string& map) {
  std::vector<Wanted> all;
  if (!map.empty()) {
    for (const MapEntry& entry : parse_map(map)) {
      const std::size_t column = find_column(entry, layout, file);
      all.push_back(
          wanted(entry.channel, column, entry.unit.empty() ? layout.columns[column].unit : entry.unit, file));
    }
    return all;
  }
  for (std::size_t i = 0; i < layout.columns.size(); ++i) {
    const std::string name = layout.columns[i].name == "time_s" ? "time" : layout.columns[i].name;
    if (is_known(name) || is_signal_by_name(name))
      all.push_back(wanted(name, i, layout.columns[i].unit, file));
  }
  return all;
}

NamedColumns read_text(const std::string& file, const std::string& map) {
  const std::string text = read_named_file(file, LargestInput::table);
  if (text.empty())
    throw std::invalid_argument(file + ": it is empty; expected a table of loads and signals");
  const TextLayout layout = find_layout(text, file);
  const std::vector<Wanted> all = columns_wanted(layout, file, map);
  std::vector<std::size_t> places;
  for (const Wanted& one : all) places.push_back(one.column);
  std::atomic<std::size_t> done{0};
  TextTable table = parse_table(text, layout, places, done);
  if (!table.bad_lines.empty()) {
    throw std::invalid_argument(fmt::format(
        "{}:{}: not every column is a number; mend the line or take it out", file, table.bad_lines.front()));
  }
  NamedColumns columns{.names = {}, .values = {}, .first_line = table.first_line, .lines = table.row_lines};
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (double& value : table.columns[i]) value = all[i].unit.factor * value + all[i].unit.offset;
    columns.names.push_back(all[i].name);
    columns.values.push_back(std::move(table.columns[i]));
  }
  return columns;
}

NamedColumns read_channels(const std::string& file, const std::string& map) {
  const schema::Recording recording = read_whole_recording(file);
  NamedColumns columns{.names = {"time"}, .values = {recording.time}, .first_line = 0, .lines = {}};
  const auto add = [&](const std::string& name, const schema::Channel& channel) {
    columns.names.push_back(name);
    columns.values.push_back(channel.values);
  };
  if (map.empty()) {
    for (const schema::Channel& channel : recording.channels) {
      if (is_known(channel.name) || is_signal_by_name(channel.name)) add(channel.name, channel);
    }
    return columns;
  }
  for (const MapEntry& entry : parse_map(map)) {
    const auto found = std::ranges::find(recording.channels, entry.column, &schema::Channel::name);
    if (found == recording.channels.end())
      throw std::invalid_argument(fmt::format("{}: it has no channel '{}'", file, entry.column));
    add(entry.channel, *found);
  }
  return columns;
}

/// Takes the rows of a file apart into holds.
class Rows {
 public:
  Rows(const NamedColumns& columns, std::string file) : columns_(columns), file_(std::move(file)) {
    for (std::size_t i = 0; i < columns.names.size(); ++i) {
      if (!is_known(columns.names[i])) signals_.push_back(i);
    }
    for (std::size_t k = 0; k < wrench_components.size(); ++k)
      loads_.at(k) = columns.find(wrench_components.at(k));
    rows_ = columns.values.empty() ? 0 : columns.values.front().size();
  }

  MeasuredHolds holds() {
    if (signals_.empty() || rows_ == 0) {
      throw std::invalid_argument(fmt::format(
          "{}: {}; say which columns are what, for example --map 'signal_1=U1[V],fx=Fx[N],time=t[s]'", file_,
          rows_ == 0 ? "it has no rows" : "no column of it is a signal"));
    }
    MeasuredHolds measured{.source = file_, .signals = {}, .components = {}, .quantum = {}, .holds = {}};
    measured.has_time = columns_.find("time") != nullptr;
    for (const std::size_t at : signals_) measured.signals.push_back(columns_.names[at]);
    for (std::size_t k = 0; k < loads_.size(); ++k) {
      if (loads_.at(k) != nullptr) measured.components.push_back(k);
    }
    for (std::size_t begin = 0; begin < rows_;) {
      std::size_t end = begin + 1;
      while (end < rows_ && is_same(begin, end)) ++end;
      measured.holds.push_back(hold(begin, end));
      begin = end;
    }
    for (std::size_t i = 0; i < signals_.size(); ++i) {
      const std::vector<double>& values = columns_.values[signals_[i]];
      const BlockedValues blocks(values.size(), [&](std::uint64_t first, std::span<double> some) {
        std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(first), some.size(), some.begin());
      });
      measured.quantum.push_back(rows_ > 3 * measured.holds.size() ? quantum_of(blocks).value_or(0.0) : 0.0);
    }
    return measured;
  }

 private:
  [[nodiscard]] std::size_t line(std::size_t row) const {
    return columns_.lines.empty() ? columns_.first_line + row : columns_.lines[row];
  }
  [[nodiscard]] bool is_same(std::size_t row, std::size_t other) const {
    const auto same = [&](const std::vector<double>* values) {
      return values == nullptr || (*values)[row] == (*values)[other];
    };
    return std::ranges::all_of(loads_, same) && same(columns_.find("hold")) && same(columns_.find("step"));
  }
  [[nodiscard]] double mean(const std::vector<double>& values, std::size_t begin, std::size_t end) const {
    double sum = 0.0;
    for (std::size_t row = begin; row < end; ++row) {
      if (!std::isfinite(values[row]))
        throw std::invalid_argument(
            fmt::format("{}: row {}: not every number is finite; mend it or take it out", file_, line(row)));
      sum += values[row];
    }
    return sum / static_cast<double>(end - begin);
  }

  [[nodiscard]] MeasuredHold hold(std::size_t begin, std::size_t end) const {
    MeasuredHold hold{.row = line(begin)};
    hold.readings = end - begin;
    for (std::size_t k = 0; k < loads_.size(); ++k) {
      if (loads_.at(k) != nullptr) hold.load(static_cast<Eigen::Index>(k)) = mean(*loads_.at(k), begin, end);
    }
    const std::vector<double>* time = columns_.find("time");
    hold.time_s = time != nullptr ? mean(*time, begin, end) : 0.0;
    if (const auto* values = columns_.find("temperature")) {
      if (std::isfinite((*values)[begin])) hold.temperature = mean(*values, begin, end);
    }
    if (const auto* values = columns_.find("step"))
      hold.step = static_cast<std::size_t>(std::max(0.0, (*values)[begin]));
    if (const auto* values = columns_.find("settled")) hold.settled = (*values)[begin] != 0.0;
    for (const std::size_t at : signals_) {
      const std::vector<double>& values = columns_.values[at];
      hold.signal.push_back(mean(values, begin, end));
      const std::vector<double>* known = columns_.find("noise_" + columns_.names[at]);
      hold.noise.push_back(known != nullptr ? (*known)[begin] : noise(values, begin, end));
    }
    return hold;
  }

  static double noise(const std::vector<double>& all, std::size_t begin, std::size_t end) {
    if (end - begin < 20) return std::nan("");
    const std::span values(all.data() + begin, end - begin);
    const BlockedValues blocks(values.size(), [&](std::uint64_t first, std::span<double> some) {
      std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(first), some.size(), some.begin());
    });
    return noise_of(blocks, quantum_of(blocks)).value_or(std::nan(""));
  }

  const NamedColumns& columns_;
  std::string file_;
  std::vector<std::size_t> signals_;
  std::array<const std::vector<double>*, 6> loads_{};
  std::size_t rows_ = 0;
};

}  // namespace

MeasuredHolds read_measured_holds(const std::string& file, const std::string& map) {
  const bool recorded = file.ends_with(".h5") || file.ends_with(".hdf5");
  const NamedColumns columns = recorded ? read_channels(file, map) : read_text(file, map);
  return Rows(columns, file).holds();
}

void take_loads(MeasuredHolds& measured, const LoadScript& script) {
  measured.components.clear();
  for (MeasuredHold& hold : measured.holds) {
    if (hold.step == 0 || hold.step > script.steps.size()) {
      throw std::invalid_argument(fmt::format("{}: row {}: it names no step of the script (1 to {})",
                                              measured.source, hold.row, script.steps.size()));
    }
    hold.load = script.steps[hold.step - 1].load;
  }
  for (std::size_t k = 0; k < wrench_components.size(); ++k) {
    const bool any = std::ranges::any_of(script.steps, [&](const LoadStep& step) {
      return std::abs(step.load(static_cast<Eigen::Index>(k))) > 0.0;
    });
    if (any) measured.components.push_back(k);
  }
}

std::string holds_as_csv(const MeasuredHolds& measured) {
  std::string text = "step,time,temperature,settled";
  for (const std::string_view name : wrench_components) text += fmt::format(",{}", name);
  for (const std::string& name : measured.signals) text += fmt::format(",{}", name);
  for (const std::string& name : measured.signals) text += fmt::format(",noise_{}", name);
  text += "\n";
  for (const MeasuredHold& hold : measured.holds) {
    text += fmt::format("{},{},{},{}", hold.step, hold.time_s, hold.temperature, hold.settled ? 1 : 0);
    for (const double one : hold.load) text += fmt::format(",{}", one);
    for (const double one : hold.signal) text += fmt::format(",{}", one);
    for (const double one : hold.noise) text += fmt::format(",{}", one);
    text += "\n";
  }
  return text;
}

}  // namespace kerf::bench
