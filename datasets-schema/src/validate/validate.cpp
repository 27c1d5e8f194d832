#include <algorithm>
#include <cmath>
#include <new>
#include <regex>
#include <string_view>

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
  ContentCheck(const Recording& recording, std::vector<Violation>& violations)
      : recording_(recording), violations_(violations) {}

  void run() {
    check_header();
    check_axes();
    check_time();
    check_ticks();
    check_events();
    if (recording_.cycles) check_cycles(*recording_.cycles);
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
    const std::string others = count == 1 ? "" : ", and " + std::to_string(count - 1) + " more such rows";
    add(where, describe(first) + " in row " + std::to_string(first) + others, expected);
  }

  void check_time() {
    const auto& time = recording_.time;
    const auto value = [&](std::size_t row) { return std::to_string(time[row]) + " s"; };
    check_rows(
        "/samples/time", time.size(), [&](std::size_t row) { return !std::isfinite(time[row]); }, value,
        "finite times");
    check_rows(
        "/samples/time", time.size(), [&](std::size_t row) { return row > 0 && time[row] <= time[row - 1]; },
        [&](std::size_t row) { return value(row) + " after " + value(row - 1); },
        "times that increase strictly");
  }

  void check_ticks() {
    const auto& tick = recording_.tick;
    check_rows(
        "/samples/tick", tick.size(), [&](std::size_t row) { return row > 0 && tick[row] <= tick[row - 1]; },
        [&](std::size_t row) {
          return std::to_string(tick[row]) + " after " + std::to_string(tick[row - 1]);
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
          return span.begin > span.end || span.end > recording_.rows();
        },
        [&](std::size_t row) {
          return "rows [" + std::to_string(cycles.phases[row].begin) + ", " +
                 std::to_string(cycles.phases[row].end) + ")";
        },
        "rows within [0, " + std::to_string(recording_.rows()) + ")");
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

  const Recording& recording_;
  std::vector<Violation>& violations_;
};

void validate_recording(const std::filesystem::path& file, std::vector<Violation>& violations) {
  const auto inspection = inspect(file);
  for (const auto& finding : inspection.findings) violations.push_back(finding.violation);
  if (inspection.first_fatal() != nullptr) return;
  ContentCheck(read_inspected(inspection), violations).run();
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
