#include "fuzz/hdf5/checks.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <kerf/schema/live_recording.h>
#include <kerf/schema/recording.h>
#include <kerf/schema/regression.h>
#include <kerf/schema/repair.h>
#include <kerf/schema/session.h>
#include <kerf/schema/sweep_tables_file.h>
#include <kerf/schema/validate.h>

#include "fuzz/target.h"
#include "in_process.h"
#include "open_sweep_tables.h"

namespace kerf::fuzz {
namespace {

using schema::FormatError;
// Within this process, where the sanitizers and the fuzzer's counters see it.
namespace in_process = schema::in_process;

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
  const auto violations = in_process::validate(file);
  if (violations.empty()) return;
  const auto& [where, found, expected] = violations.front();
  promise(false, what + ": " + where + ": found " + found + ", expected " + expected);
}

bool are_same(const std::vector<double>& a, const std::vector<double>& b) {
  return std::ranges::equal(a, b,
                            [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); });
}

/// A column, so many rows at once.
template <typename Number>
std::vector<Number> column_of(const in_process::OpenRecording& file, std::size_t dataset,
                              std::uint64_t at_once) {
  const std::uint64_t rows = file.row_bytes(dataset) > 0 ? file.facts().rows : 0;
  const std::size_t width = file.row_bytes(dataset) / sizeof(Number);
  std::vector<Number> values(rows * width);
  for (std::uint64_t first = 0; first < rows; first += at_once) {
    const std::uint64_t piece = std::min(at_once, rows - first);
    file.read(dataset, first, piece,
              std::as_writable_bytes(std::span(values).subspan(first * width, piece * width)));
  }
  return values;
}

schema::Recording read_by(const in_process::OpenRecording& file, std::uint64_t at_once) {
  schema::Recording all = file.facts().about;
  std::size_t dataset = 0;
  for (auto column : {&schema::Recording::time, &schema::Recording::position, &schema::Recording::velocity,
                      &schema::Recording::force_commanded, &schema::Recording::force_measured}) {
    all.*column = column_of<double>(file, dataset++, at_once);
  }
  for (auto column : {&schema::Recording::wake_latency, &schema::Recording::read_time,
                      &schema::Recording::compute_time, &schema::Recording::write_time}) {
    all.*column = column_of<float>(file, dataset++, at_once);
  }
  all.tick = column_of<std::uint64_t>(file, in_process::tick_dataset, at_once);
  all.flags = column_of<std::uint32_t>(file, in_process::flags_dataset, at_once);
  dataset = in_process::first_channel;
  for (schema::Channel& channel : all.channels) channel.values = column_of<double>(file, dataset++, at_once);
  return all;
}

/// A recording piece by piece is what it is as a whole.
schema::Recording read_both_ways(const std::filesystem::path& path) {
  const in_process::OpenRecording file(path, true);
  schema::Recording whole = read_by(file, std::numeric_limits<std::uint32_t>::max());
  const schema::Recording pieces = read_by(file, 3);
  for (auto column : {&schema::Recording::time, &schema::Recording::position, &schema::Recording::velocity,
                      &schema::Recording::force_commanded, &schema::Recording::force_measured}) {
    promise(are_same(whole.*column, pieces.*column), "the same values, by pieces and as a whole");
  }
  promise(whole.tick == pieces.tick, "the same ticks, by pieces and as a whole");
  promise(whole.flags == pieces.flags, "the same flags, by pieces and as a whole");
  for (std::size_t i = 0; i < whole.channels.size(); ++i) {
    promise(are_same(whole.channels[i].values, pieces.channels[i].values),
            "the same channels, by pieces and as a whole");
  }
  return whole;
}

void check_recording(const std::filesystem::path& file, bool is_valid) {
  schema::Recording recording;
  if (!refusal([&] { recording = read_both_ways(file); }).empty()) return;
  const auto copy = file.parent_path() / "copy.h5";
  if (is_valid) {
    schema::write_recording(copy, recording);
    require_valid(copy, "a valid recording is written as one");
    promise(read_both_ways(copy).time == recording.time, "a recording is written as it is read");
  }
  std::error_code ignored;
  std::filesystem::remove(copy, ignored);
  if (recording.header.status != "recording") return;
  try {
    const auto repaired = schema::repair(file, {.output = copy});
    promise(repaired.rows == recording.rows(), "every row is repaired");
    promise(read_both_ways(copy).rows() == recording.rows(), "what is repaired can be read");
  } catch (const std::invalid_argument&) {
    promise(!is_valid, "a valid recording that was not closed is repaired");
  }
  std::filesystem::remove(copy, ignored);
}

void check_stored_forces(const std::filesystem::path& file, bool is_valid) {
  std::vector<schema::StoredForces> cases;
  const std::string why = refusal([&] { cases = in_process::read_regression(file); });
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
  const std::string why = refusal([&] { session = in_process::read_session(file); });
  promise(why.empty() || !is_valid, "a valid session is read, not refused: " + why);
  if (!why.empty()) return;
  schema::Session facts;
  promise(refusal([&] { facts = in_process::read_session_facts(file); }).empty(),
          "of a session that is read so are the facts");
  promise(facts.entries.size() == session.entries.size(), "as many entries, with what is sealed and without");
  for (std::size_t i = 0; i < session.entries.size(); ++i)
    promise(in_process::read_sealed(file, i) == session.entries[i].sealed, "one seal is that of the whole");
}

}  // namespace

void check_readers(const std::filesystem::path& file) {
  bool is_valid = false;
  (void)refusal([&] { is_valid = in_process::validate(file).empty(); });
  const std::string schema = in_process::schema_of(file);
  if (schema == schema::regression_schema_name) {
    check_stored_forces(file, is_valid);
    promise(!refusal([&] { (void)in_process::read_session(file); }).empty(), "stored forces are no session");
  } else if (schema == schema::session_schema_name) {
    check_session(file, is_valid);
    promise(!refusal([&] { in_process::OpenRecording(file, true); }).empty(), "a session is no recording");
  } else if (schema == schema::sweep_tables_name) {
    const std::string why = refusal([&] { const in_process::OpenSweepTables opened(file); });
    promise(why.empty() || !is_valid, "valid tables of a sweep are read, not refused: " + why);
  } else {
    check_recording(file, is_valid);
    (void)refusal([&] { (void)in_process::read_tail(file); });
    if (!is_valid) return;
    promise(!refusal([&] { (void)in_process::read_regression(file); }).empty(),
            "a recording is no stored forces");
  }
}

void check_readers_apart(const std::filesystem::path& file) {
  bool is_valid = false;
  (void)refusal([&] { is_valid = schema::validate(file).empty(); });
  const auto reads = [](const auto& read) { return refusal(read).empty() ? 1 : 0; };
  const int taken = reads([&] { (void)schema::read_recording(file); }) +
                    reads([&] { (void)schema::read_regression(file); }) +
                    reads([&] { (void)schema::read_session(file); }) +
                    reads([&] { const schema::SweepTablesFile opened(file); });
  promise(taken <= 1, "a file is of one schema");
  promise(taken == 1 || !is_valid, "a valid file is read");
  (void)refusal([&] { (void)schema::read_tail(file); });
}

}  // namespace kerf::fuzz
