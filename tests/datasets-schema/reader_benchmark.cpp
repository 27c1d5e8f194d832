// reader_benchmark FOLDER MUTATED SEED: what it costs to read files in a process of their own, by turns with
// reading them in this one, and whether any of so many damaged files ends this program. Prints JSON.

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include <kerf/schema/recording.h>
#include <kerf/schema/recording_writer.h>
#include <kerf/schema/regression.h>
#include <kerf/schema/session.h>
#include <kerf/schema/validate.h>

#include "in_process.h"

namespace {

using namespace kerf::schema;
namespace fs = std::filesystem;

Recording recording_of(std::size_t rows) {
  Recording recording{.header = new_header("benchmark"), .axes = {{.name = "theta"}, {.name = "x"}}};
  std::mt19937_64 random(1);
  std::normal_distribution<double> noise;
  for (std::size_t row = 0; row < rows; ++row) {
    recording.time.push_back(1e-3 * static_cast<double>(row));
    recording.tick.push_back(row);
    for (auto* column : {&recording.position, &recording.velocity, &recording.force_commanded}) {
      column->push_back(noise(random));
      column->push_back(noise(random));
    }
    recording.flags.push_back(0);
  }
  return recording;
}

/// As read_recording() does it in the other process, and as it keeps what it reads.
std::size_t read_in_this_process(const fs::path& file) {
  const in_process::OpenRecording recording(file, true);
  std::vector<std::vector<std::byte>> columns;
  for (std::size_t dataset = 0; dataset < in_process::first_channel; ++dataset) {
    auto& values = columns.emplace_back(recording.facts().rows * recording.row_bytes(dataset));
    if (!values.empty()) recording.read(dataset, 0, recording.facts().rows, values);
  }
  return columns.size();
}

template <typename Action>
double ms_of(const Action& action) {
  const auto begin = std::chrono::steady_clock::now();
  action();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

void compare(const fs::path& file, std::size_t rows, int turns) {
  write_recording(file, recording_of(rows));
  std::vector<double> apart;
  std::vector<double> here;
  for (int turn = 0; turn < turns; ++turn) {
    apart.push_back(ms_of([&] { static_cast<void>(read_recording(file)); }));
    here.push_back(ms_of([&] { static_cast<void>(read_in_this_process(file)); }));
  }
  std::printf("{\"rows\": %zu, \"apart_ms\": %.3f, \"here_ms\": %.3f},\n", rows, median(apart), median(here));
}

/// As a recorder writes it.
void write_live(const fs::path& file, const Recording& like) {
  fs::remove(file);
  RecordingWriter writer(file, new_header("benchmark"), like.axes, {.channels = like.channels});
  std::vector<Row> rows(like.rows());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].tick = i;
    rows[i].time_s = like.time[i];
  }
  writer.append(rows);
  for (const Event& event : like.events) writer.append_event(event);
  writer.close("complete", {});
}

std::string bytes_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Overwrites, inserts, removes or cuts off: what copies, disks and people do to files.
std::string damaged(std::string bytes, std::mt19937_64& random) {
  const auto below = [&](std::size_t end) {
    return static_cast<std::size_t>(random() % std::max<std::size_t>(end, 1));
  };
  for (std::size_t change = 1 + below(4); change > 0; --change) {
    const std::size_t at = below(bytes.size());
    switch (below(5)) {
      case 0:
        bytes.at(at) = static_cast<char>(random());
        break;
      case 1:
        for (std::size_t i = at; i < std::min(bytes.size(), at + 8); ++i)
          bytes[i] = static_cast<char>(random());
        break;
      case 2:
        bytes.insert(at, below(64), static_cast<char>(random()));
        break;
      case 3:
        bytes.erase(at, below(64));
        break;
      default:
        if (below(8) == 0) bytes.resize(at + 1);
    }
  }
  return bytes;
}

void break_files(const fs::path& folder, const std::vector<fs::path>& sound, std::uint64_t count,
                 std::uint64_t seed) {
  std::vector<std::string> bytes;
  for (const fs::path& file : sound) bytes.push_back(bytes_of(file));
  const fs::path broken = folder / "broken.h5";
  std::uint64_t fell_over = 0;
  std::uint64_t refused = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    std::mt19937_64 random(seed + i);
    const std::size_t which = i % bytes.size();
    std::ofstream(broken, std::ios::binary) << damaged(bytes[which], random);
    std::string why;
    try {
      if (which == 0 || which == 3) static_cast<void>(read_recording(broken));
      if (which == 1) static_cast<void>(read_session(broken));
      if (which == 2) static_cast<void>(read_regression(broken));
      if (i % 8 == 7) static_cast<void>(validate(broken));
    } catch (const FormatError& error) {
      why = error.what();
    }
    if (!why.empty()) ++refused;
    if (why.find("fell over") == std::string::npos) continue;
    ++fell_over;
    fs::copy_file(broken, folder / ("fell-over-" + std::to_string(seed + i) + ".h5"),
                  fs::copy_options::overwrite_existing);
  }
  std::printf("{\"damaged\": %lu, \"refused\": %lu, \"readers_that_fell_over\": %lu}\n", count, refused,
              fell_over);
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 4) return 2;
  const fs::path folder(arguments[1]);
  std::printf("[");
  for (const std::size_t rows : {std::size_t{100}, std::size_t{100'000}, std::size_t{3'000'000}}) {
    compare(folder / "recording.h5", rows, rows > 1'000'000 ? 7 : 31);
  }
  Recording small = recording_of(200);
  small.events = {{.time_s = 0.0, .kind = "start", .text = "begin"}};
  small.channels = {{.name = "temperature", .unit = "K", .values = std::vector<double>(200, 300.0)}};
  write_recording(folder / "recording.h5", small);
  write_live(folder / "live.h5", small);
  Session session{.uuid = small.header.uuid,
                  .created = small.header.created,
                  .software = "benchmark",
                  .subject = "a",
                  .protocol = "x = 1"};
  session.laws = {{.name = "a", .toml = "b"}};
  session.entries = {{.kind = "plan",
                      .time = small.header.created,
                      .text = "t",
                      .sealed = std::vector<std::uint8_t>(64, 7)}};
  write_session(folder / "session.h5", session);
  StoredForces forces{.name = "one", .model = "kelvin", .date = small.header.created};
  forces.channels = {{.name = "x", .unit = "N"}};
  forces.force.assign(200, 1.0);
  write_regression(folder / "forces.h5", {forces});
  break_files(folder,
              {folder / "live.h5", folder / "session.h5", folder / "forces.h5", folder / "recording.h5"},
              std::stoull(arguments[2]), std::stoull(arguments[3]));
  std::printf("]\n");
  return 0;
}
