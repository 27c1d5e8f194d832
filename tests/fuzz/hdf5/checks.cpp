#include "fuzz/hdf5/checks.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <kerf/schema/live_recording.h>
#include <kerf/schema/recording.h>
#include <kerf/schema/recording_file.h>
#include <kerf/schema/regression.h>
#include <kerf/schema/repair.h>
#include <kerf/schema/session.h>
#include <kerf/schema/validate.h>

#include "fuzz/target.h"

namespace kerf::fuzz {
namespace {

using schema::FormatError;

/// Why `action` refuses; empty if it does not.
template <typename Action>
std::string refusal(const Action& action) {
  try {
    action();
    return {};
  } catch (const FormatError& error) {
    const std::string why = error.what();
    promise(!why.empty() && why.find('\n') == std::string::npos, "a file is refused in one line: " + why);
    return why;
  }
}

void require_valid(const std::filesystem::path& file, const std::string& what) {
  const auto violations = schema::validate(file);
  if (violations.empty()) return;
  const auto& [where, found, expected] = violations.front();
  promise(false, what + ": " + where + ": found " + found + ", expected " + expected);
}

bool are_same(const std::vector<double>& a, const std::vector<double>& b) {
  return std::ranges::equal(a, b,
                            [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); });
}

/// A recording piece by piece is what it is as a whole.
void check_pieces(const std::filesystem::path& path, const schema::Recording& whole) {
  const schema::RecordingFile file(path);
  promise(file.rows() == whole.rows(), "as many rows, by pieces and as a whole");
  const auto rows = whole.rows();
  const std::vector<std::pair<schema::Column, const std::vector<double>*>> columns{
      {schema::Column::time, &whole.time},
      {schema::Column::position, &whole.position},
      {schema::Column::velocity, &whole.velocity},
      {schema::Column::force_commanded, &whole.force_commanded},
      {schema::Column::force_measured, &whole.force_measured}};
  for (const auto& [column, expected] : columns) {
    std::vector<double> values(rows * file.width(column));
    if (!values.empty()) file.read(column, 0, rows, values);
    promise(are_same(values, *expected), "the same values, by pieces and as a whole");
  }
  for (std::size_t i = 0; i < whole.channels.size(); ++i) {
    std::vector<double> values(rows);
    file.read_channel(i, 0, values);
    promise(are_same(values, whole.channels[i].values), "the same channels, by pieces and as a whole");
  }
  std::vector<std::uint64_t> ticks(rows);
  file.read_ticks(0, ticks);
  promise(ticks == whole.tick, "the same ticks, by pieces and as a whole");
  std::vector<std::uint32_t> flags(file.has_flags() ? rows : 0);
  if (!flags.empty()) file.read_flags(0, flags);
  promise(flags == whole.flags, "the same flags, by pieces and as a whole");
}

void check_recording(const std::filesystem::path& file, bool is_valid) {
  schema::Recording recording;
  const std::string why = refusal([&] { recording = schema::read_recording(file); });
  if (!why.empty()) {
    promise(refusal([&] { const schema::RecordingFile opened(file); }) == why,
            "both readers refuse alike: " + why);
    return;
  }
  check_pieces(file, recording);
  const auto copy = file.parent_path() / "copy.h5";
  if (is_valid) {
    schema::write_recording(copy, recording);
    require_valid(copy, "a valid recording is written as one");
    promise(schema::read_recording(copy).time == recording.time, "a recording is written as it is read");
  }
  std::error_code ignored;
  std::filesystem::remove(copy, ignored);
  if (recording.header.status != "recording") return;
  try {
    const auto repaired = schema::repair(file, {.output = copy});
    promise(repaired.rows == recording.rows(), "every row is repaired");
    promise(schema::read_recording(copy).rows() == recording.rows(), "what is repaired can be read");
  } catch (const std::invalid_argument&) {
    promise(!is_valid, "a valid recording that was not closed is repaired");
  }
  std::filesystem::remove(copy, ignored);
}

void check_stored_forces(const std::filesystem::path& file, bool is_valid) {
  std::vector<schema::StoredForces> cases;
  const std::string why = refusal([&] { cases = schema::read_regression(file); });
  promise(why.empty() || !is_valid, "valid stored forces are read, not refused: " + why);
  if (!is_valid) return;
  for (const schema::StoredForces& one : cases)
    promise(one.force.size() == one.rows() * one.channels.size(), "forces fill their rows");
  const auto copy = file.parent_path() / "copy.h5";
  schema::write_regression(copy, cases);
  require_valid(copy, "valid stored forces are written as such");
  std::filesystem::remove(copy);
}

void check_session(const std::filesystem::path& file, bool is_valid) {
  schema::Session session;
  const std::string why = refusal([&] { session = schema::read_session(file); });
  promise(why.empty() || !is_valid, "a valid session is read, not refused: " + why);
  if (!why.empty()) return;
  schema::Session facts;
  promise(refusal([&] { facts = schema::read_session_facts(file); }).empty(),
          "of a session that is read so are the facts");
  promise(facts.entries.size() == session.entries.size(), "as many entries, with what is sealed and without");
  for (std::size_t i = 0; i < session.entries.size(); ++i)
    promise(schema::read_sealed(file, i) == session.entries[i].sealed, "one seal is that of the whole");
}

}  // namespace

void check_readers(const std::filesystem::path& file) {
  bool is_valid = false;
  (void)refusal([&] { is_valid = schema::validate(file).empty(); });
  const std::string schema = schema::schema_of(file);
  if (schema == schema::regression_schema_name) {
    check_stored_forces(file, is_valid);
    promise(!refusal([&] { (void)schema::read_session(file); }).empty(), "stored forces are no session");
  } else if (schema == schema::session_schema_name) {
    check_session(file, is_valid);
    promise(!refusal([&] { (void)schema::read_recording(file); }).empty(), "a session is no recording");
  } else {
    check_recording(file, is_valid);
    (void)refusal([&] { (void)schema::read_tail(file); });
    if (!is_valid) return;
    promise(!refusal([&] { (void)schema::read_regression(file); }).empty(),
            "a recording is no stored forces");
  }
}

}  // namespace kerf::fuzz
