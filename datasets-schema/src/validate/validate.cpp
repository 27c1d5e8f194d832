#include <algorithm>
#include <cmath>
#include <cstdint>
#include <new>
#include <optional>
#include <regex>
#include <span>
#include <string_view>
#include <utility>

#include <kerf/schema/validate.h>

#include "hdf5/text_heaps.h"
#include "in_process.h"
#include "validate/inspect.h"
#include "validate/validators.h"

namespace kerf::schema {
namespace {

bool is_status(const std::string& text) {
  static const std::regex pattern("recording|complete|aborted: [^]+");
  return std::regex_match(text, pattern);
}

/// What the tables cannot say: how values hang together.
class ContentCheck {
 public:
  ContentCheck(const in_process::OpenRecording& file, std::vector<Violation>& violations)
      : file_(file), recording_(file.facts().about), violations_(violations) {}

  void run() {
    check_header();
    check_axes();
    check_time();
    check_ticks();
    check_events();
    if (recording_.cycles) check_cycles(*recording_.cycles);
    if (recording_.cycle_flags) check_cycle_flags(*recording_.cycle_flags);
    check_cycle_edits(recording_.cycle_edits);
  }

 private:
  void add(std::string where, std::string found, std::string expected) {
    violations_.push_back({std::move(where), std::move(found), std::move(expected)});
  }

  void check_text(const std::string& name, const std::string& text, bool (*is_right)(const std::string&),
                  std::string_view expected) {
    // What is missing was told of before.
    if (text.empty() || is_right(text)) return;
    add("/ attribute '" + name + "'", "'" + text + "'", std::string(expected));
  }

  void check_header() {
    const auto& header = recording_.header;
    check_text("created", header.created, is_utc_time, expected_utc_time);
    check_text("uuid", header.uuid, is_uuid, expected_uuid);
    check_text("status", header.status, is_status, "'recording', 'complete' or 'aborted: WHY'");
    for (const auto& [name, text] :
         {std::pair{"created", header.created}, std::pair{"uuid", header.uuid},
          std::pair{"software", header.software}, std::pair{"status", header.status}}) {
      const std::string where = "/ attribute '" + std::string(name) + "'";
      const bool told = std::ranges::any_of(
          violations_, [&](const Violation& violation) { return violation.where == where; });
      if (text.empty() && !told) add(where, "an empty text", "a text");
    }
  }

  void check_axes() {
    for (const auto& axis : recording_.axes) {
      if (axis.position_unit != "m" && axis.position_unit != "rad") {
        add("/samples/position attribute 'units'", "'" + axis.position_unit + "'", "'m' or 'rad'");
      }
      if (axis.force_unit != "N" && axis.force_unit != "N·m") {
        add("/samples attribute 'force_units'", "'" + axis.force_unit + "'", "'N' or 'N·m'");
      }
    }
  }

  /// Tells of the first place that breaks a rule, and of how many others there are.
  template <typename Breaks, typename Describe>
  void check_rows(const std::string& where, std::size_t rows, Breaks breaks, Describe describe,
                  const std::string& expected) {
    std::size_t first = rows;
    std::size_t count = 0;
    for (std::size_t row = 0; row < rows; ++row) {
      if (!breaks(row)) continue;
      first = std::min(first, row);
      ++count;
    }
    if (count == 0) return;
    add(where, of_rows(describe(first), first, count), expected);
  }

  static std::string of_rows(const std::string& found, std::uint64_t first, std::uint64_t count) {
    const std::string others = count == 1 ? "" : ", and " + std::to_string(count - 1) + " more such rows";
    return found + " in row " + std::to_string(first) + others;
  }

  /// The same for a column of the file, a block at a time. `breaks` and `describe` get a value and the one
  /// before it, which is none in the first row.
  template <typename T, typename Breaks, typename Describe>
  void check_column(std::size_t dataset, const Breaks& breaks, const Describe& describe,
                    const std::string& expected) {
    constexpr std::uint64_t block_rows = 65536;
    const std::uint64_t rows = file_.facts().rows;
    std::optional<std::uint64_t> first_row;
    std::uint64_t count = 0;
    std::string found;
    std::optional<T> before;
    std::vector<T> values;
    for (std::uint64_t begin = 0; begin < rows; begin += block_rows) {
      values.resize(std::min(block_rows, rows - begin));
      file_.read(dataset, begin, values.size(), std::as_writable_bytes(std::span(values)));
      for (std::size_t i = 0; i < values.size(); before = values[i++]) {
        if (!breaks(values[i], before)) continue;
        if (count++ == 0) {
          first_row = begin + i;
          found = describe(values[i], before);
        }
      }
    }
    if (first_row)
      add(std::string(in_process::dataset_paths.at(dataset)), of_rows(found, *first_row, count), expected);
  }

  void check_time() {
    const auto seconds = [](double value) { return std::to_string(value) + " s"; };
    using Before = std::optional<double>;
    check_column<double>(
        in_process::time_dataset, [](double value, const Before&) { return !std::isfinite(value); },
        [&](double value, const Before&) { return seconds(value); }, "finite times");
    check_column<double>(
        in_process::time_dataset,
        [](double value, const Before& before) { return before && value <= *before; },
        [&](double value, const Before& before) { return seconds(value) + " after " + seconds(*before); },
        "times that increase strictly");
  }

  void check_ticks() {
    using Before = std::optional<std::uint64_t>;
    check_column<std::uint64_t>(
        in_process::tick_dataset,
        [](std::uint64_t value, const Before& before) { return before && value <= *before; },
        [](std::uint64_t value, const Before& before) {
          return std::to_string(value) + " after " + std::to_string(*before);
        },
        "ticks that increase strictly");
  }

  void check_events() {
    const auto& events = recording_.events;
    check_rows(
        "/events", events.size(), [&](std::size_t row) { return !std::isfinite(events[row].time_s); },
        [&](std::size_t row) { return std::to_string(events[row].time_s) + " s"; }, "finite times");
  }

  void check_cycles(const Cycles& cycles) {
    if (cycles.axis >= recording_.dimensions()) {
      add("/cycles attribute 'axis'", std::to_string(cycles.axis),
          "less than " + std::to_string(recording_.dimensions()));
    }
    if (std::abs(cycles.closing_direction) != 1.0) {
      add("/cycles attribute 'closing_direction'", std::to_string(cycles.closing_direction), "+1 or -1");
    }
    check_rows(
        "/cycles/phases", cycles.phases.size(),
        [&](std::size_t row) {
          const auto& span = cycles.phases[row];
          return span.begin > span.end || span.end > file_.facts().rows;
        },
        [&](std::size_t row) {
          return "rows [" + std::to_string(cycles.phases[row].begin) + ", " +
                 std::to_string(cycles.phases[row].end) + ")";
        },
        "rows within [0, " + std::to_string(file_.facts().rows) + ")");
    const auto number = [&](std::size_t row) {
      return std::to_string(static_cast<int>(cycles.phases[row].phase));
    };
    check_rows(
        "/cycles/phases", cycles.phases.size(),
        [&](std::size_t row) {
          return cycles.phases[row].phase < Phase::opening || cycles.phases[row].phase > Phase::close_to_open;
        },
        [&](std::size_t row) { return "phase " + number(row); }, "a phase from 1 to 4");
    check_rows(
        "/cycles/grid", cycles.grid.size(),
        [&](std::size_t row) { return row > 0 && !(cycles.grid[row] > cycles.grid[row - 1]); },
        [&](std::size_t row) {
          return std::to_string(cycles.grid[row]) + " after " + std::to_string(cycles.grid[row - 1]);
        },
        "positions that increase strictly");
  }

  void check_cycle_flags(const CycleFlags& flags) {
    std::uint32_t last = 0;
    if (recording_.cycles) {
      for (const PhaseSpan& phase : recording_.cycles->phases) last = std::max(last, phase.cycle);
    }
    check_rows(
        "/cycle_flags/flags", flags.flags.size(),
        [&](std::size_t row) { return flags.flags[row].cycle < 1 || flags.flags[row].cycle > last; },
        [&](std::size_t row) { return "cycle " + std::to_string(flags.flags[row].cycle); },
        last == 0 ? "cycles in /cycles" : "a cycle from 1 to " + std::to_string(last));
  }

  /// Cycles and rows are of the recording as it was: how many it has now bounds neither.
  void check_cycle_edits(const std::vector<CycleChange>& changes) {
    const std::string where = "/cycle_edits/changes";
    const auto check = [&](const auto& is_right, const auto& describe, const std::string& expected) {
      check_rows(
          where, changes.size(), [&](std::size_t row) { return !is_right(row); }, describe, expected);
    };
    check([&](std::size_t row) { return std::ranges::count(cycle_change_kinds, changes[row].kind) == 1; },
          [&](std::size_t row) { return "kind '" + changes[row].kind + "'"; },
          "a kind as in the description");
    check([&](std::size_t row) { return is_utc_time(changes[row].time); },
          [&](std::size_t row) { return "time '" + changes[row].time + "'"; },
          std::string(expected_utc_time));
    check([&](std::size_t row) { return !changes[row].author.empty(); },
          [](std::size_t) { return "no author"; }, "an author");
    check([&](std::size_t row) { return changes[row].phase <= static_cast<int>(Phase::close_to_open); },
          [&](std::size_t row) { return "phase " + std::to_string(changes[row].phase); },
          "a phase from 1 to 4, or 0");
    check([&](std::size_t row) { return std::min(changes[row].row_before, changes[row].row_after) >= -1; },
          [](std::size_t) { return "a row below -1"; }, "rows, or -1");
    const auto before = [&](std::size_t row) { return row == 0 ? CycleChange{} : changes[row - 1]; };
    check(
        [&](std::size_t row) {
          const CycleChange was = before(row);
          if (row == 0 || changes[row].edit == was.edit + 1) return row > 0 || changes[row].edit == 1;
          return changes[row].edit == was.edit && changes[row].time == was.time &&
                 changes[row].author == was.author;
        },
        [&](std::size_t row) { return "edit " + std::to_string(changes[row].edit); },
        "edits counted from 1, each with one time and one author");
  }

  const in_process::OpenRecording& file_;
  const Recording& recording_;  ///< without its rows
  std::vector<Violation>& violations_;
};

void validate_recording(const std::filesystem::path& file, std::vector<Violation>& violations) {
  auto inspection = inspect(file);
  for (const auto& finding : inspection.findings) violations.push_back(finding.violation);
  if (inspection.first_fatal() != nullptr) return;
  ContentCheck(in_process::OpenRecording(file, std::move(inspection)), violations).run();
}

}  // namespace

std::string in_process::schema_of(const std::filesystem::path& file) {
  try {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(file, ignored) || !h5::is_hdf5(file)) return {};
    if (!are_text_heaps_sound(file)) return {};
    const auto opened = h5::open_file(file);
    const auto root = h5::open(opened.id(), "/");
    if (!h5::has_attribute(root.id(), "schema")) return {};
    if (h5::describe_attribute(root.id(), "schema").type != "text") return {};
    const auto texts = h5::read_texts(root.id(), "schema");
    return texts.empty() ? std::string() : texts.front();
  } catch (const std::exception&) {
    return {};  // whoever reads it says why
  }
}

std::vector<Violation> in_process::validate(const std::filesystem::path& file) {
  std::vector<Violation> violations;
  const std::string schema = schema_of(file);
  try {
    if (schema == session_schema_name) {
      validate_session(file, violations);
    } else if (schema == regression_schema_name) {
      validate_regression(file, violations);
    } else if (schema == sweep_tables_name) {
      validate_sweep_tables(file, violations);
    } else {
      validate_recording(file, violations);
    }
  } catch (const DamageError& error) {
    violations.push_back({"the file", "damage (" + error.reason + ')', "a sound HDF5 file"});
  } catch (const h5::Error& error) {
    violations.push_back({"the file", std::string("damage (") + error.what() + ')', "a sound HDF5 file"});
  } catch (const std::bad_alloc&) {
    violations.push_back({"the file", "more rows than fit into the memory", "fewer rows"});
  }
  return violations;
}

}  // namespace kerf::schema
