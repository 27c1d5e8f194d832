#pragma once

#include <cstdint>
#include <filesystem>

#include "verbs/sweep_verb.h"

namespace kerf::bench {

/// What a worker is told to compute: cells [begin, end).
struct CellOrder {
  std::uint64_t begin = 0;
  std::uint64_t end = 0;
};

/// The whole of a worker's life: reads orders from a connection until its other end is closed, computes cell
/// by cell, and answers each with frames as soon as it is done. What a cell throws is its failure. The
/// process takes no more memory than the plan allows beside what it has already, and ends with the one that
/// started it.
/// For trials, KERF_SWEEP_FAULT names cells that go wrong: "crash@17,hang@23,memory@42".
/// @throws as read_plan(); std::system_error.
void serve_cells(const std::filesystem::path& plan, int connection, SweepVerbs verbs = sweep_verbs());

}  // namespace kerf::bench
