#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include <fmt/core.h>

#include <kerf/schema/recording_writer.h>

#include "views/recording_view.h"

// What it takes to look at an hour. Prints JSON.
//   make FILE [ROWS AXES]  writes an hour of 6 axes, the measured force and 2 channels at 1 kHz; or so much
//   open FILE CACHE      opens it and sees position, velocity and force of one axis as a whole
//   move FILE CACHE N    then N views of random stretches
//   long FILE CACHE N    the same of a recording that is gone through beside: N views meanwhile, and N
//   afterwards

namespace {

using namespace kerf;
using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

constexpr std::size_t hour = 3'600'000;
constexpr std::size_t columns = 1200;

void make(const std::filesystem::path& file, std::size_t rows_in_all, std::size_t axes_in_all) {
  std::vector<schema::Axis> axes;
  for (const char* name : {"x", "y", "z", "rx", "ry", "rz"}) {
    if (axes.size() < axes_in_all) axes.push_back({.name = name});
  }
  schema::RecordingWriter writer(file, schema::new_header("kerf benchmark"), axes,
                                 {.channels = {{.name = "temperature", .unit = "K", .values = {}},
                                               {.name = "grip", .unit = "N", .values = {}}},
                                  .replace = true});
  std::mt19937_64 random(1);
  std::normal_distribution<double> noise(0.0, 1e-3);
  std::vector<schema::Row> rows(1000);
  for (std::size_t first = 0; first < rows_in_all; first += rows.size()) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      schema::Row& row = rows[i];
      row.tick = first + i;
      row.time_s = 1e-3 * static_cast<double>(row.tick);
      for (std::size_t axis = 0; axis < axes.size(); ++axis) {
        const double turns = row.time_s * static_cast<double>(axis + 1);
        row.position[axis] = std::sin(turns) + noise(random);
        row.velocity[axis] = std::cos(turns) + noise(random);
        row.force_commanded[axis] = 3.0 * row.position[axis];
      }
      row.channels[0] = 293.0 + noise(random);
      row.channels[1] = noise(random);
      row.wake_latency_s = 5e-6F;
      row.compute_time_s = 2e-6F;
    }
    writer.append(rows);
  }
  writer.close("complete");
}

/// Position, velocity and force of the first axis.
std::vector<std::size_t> first_shown(const bench::RecordingView& recording) {
  const std::string along = " " + recording.file().about().axes.front().name;
  std::vector<std::size_t> shown;
  for (std::size_t i = 0; i < recording.traces().size() && shown.size() < 3; ++i) {
    if (recording.traces()[i].name.ends_with(along)) shown.push_back(i);
  }
  return shown;
}

void print_times(std::vector<double> times_ms) {
  std::sort(times_ms.begin(), times_ms.end());
  fmt::print(R"("views": {}, "p50_ms": {:.3f}, "p99_ms": {:.3f}, "max_ms": {:.3f})", times_ms.size(),
             times_ms[times_ms.size() / 2], times_ms[times_ms.size() * 99 / 100], times_ms.back());
}

std::vector<double> times_of_moves(bench::RecordingView& recording, std::size_t moves) {
  const double end_s = recording.file().last_time_s();
  const auto shown = first_shown(recording);
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> share;
  std::vector<double> times_ms;
  for (std::size_t i = 0; i < moves; ++i) {
    const double width_s = end_s * std::pow(10.0, -5.0 * share(random));  // from the hour to 36 ms
    const double from_s = (end_s - width_s) * share(random);
    const auto start = Clock::now();
    const std::string bytes = bytes_of(recording.view(shown, from_s, from_s + width_s, columns));
    times_ms.push_back(ms_since(start));
  }
  return times_ms;
}

void look_at_long(const std::filesystem::path& file, const std::filesystem::path& cache, std::size_t moves) {
  const auto begin = Clock::now();
  bench::RecordingView recording(file, bench::ViewCache(cache));
  const double open_ms = ms_since(begin);
  const auto shown = first_shown(recording);
  const auto whole = recording.view(shown, 0.0, recording.file().last_time_s(), columns);
  fmt::print(
      R"({{"rows": {}, "open_ms": {:.3f}, "first_view_ms": {:.3f}, "prepared": {:.3f}, "meanwhile": {{)",
      recording.file().rows(), open_ms, ms_since(begin), whole.prepared);
  print_times(times_of_moves(recording, moves));
  const bool was_meanwhile = recording.prepared() < 1.0;
  while (recording.prepared() < 1.0) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  fmt::print(R"(}}, "all_meanwhile": {}, "prepared_s": {:.3f}, "afterwards": {{)", was_meanwhile,
             1e-3 * ms_since(begin));
  print_times(times_of_moves(recording, moves));
  fmt::print("}}}}\n");
}

void look(const std::filesystem::path& file, const std::filesystem::path& cache, std::size_t moves) {
  const std::clock_t cpu = std::clock();
  const auto begin = Clock::now();
  bench::RecordingView recording(file, bench::ViewCache(cache));
  const double open_ms = ms_since(begin);
  const double end_s = recording.file().last_time_s();
  const auto shown = first_shown(recording);
  const auto whole = recording.view(shown, 0.0, end_s, columns);
  const double first_view_ms = ms_since(begin);
  const double cpu_ms = 1e3 * static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC;
  fmt::print(R"({{"open_ms": {:.3f}, "first_view_ms": {:.3f}, "first_view_cpu_ms": {:.3f}, "columns": {})",
             open_ms, first_view_ms, cpu_ms, whole.time_s.size());
  if (moves > 0) {
    fmt::print(", ");
    print_times(times_of_moves(recording, moves));
  }
  fmt::print("}}\n");
}

}  // namespace

int main(int count, char** words) {
  const std::string verb = count > 1 ? words[1] : "";
  if (verb == "make" && count == 3) {
    make(words[2], hour, 6);
  } else if (verb == "make" && count == 5) {
    make(words[2], std::stoul(words[3]), std::stoul(words[4]));
  } else if (verb == "open" && count == 4) {
    look(words[2], words[3], 0);
  } else if (verb == "move" && count == 5) {
    look(words[2], words[3], std::stoul(words[4]));
  } else if (verb == "long" && count == 5) {
    look_at_long(words[2], words[3], std::stoul(words[4]));
  } else {
    fmt::print(
        stderr,
        "usage: make FILE [ROWS AXES] | open FILE CACHE | move FILE CACHE VIEWS | long FILE CACHE VIEWS\n");
    return 2;
  }
  return 0;
}
