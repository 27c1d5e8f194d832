#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "laws/law_file.h"

namespace kerf::test {

/// The example of every law.
[[nodiscard]] std::vector<bench::LawFile> every_law(const std::filesystem::path& examples);

/// What a schedule did, and the first promise that was broken in it.
struct ScheduleOutcome {
  std::string violation;  ///< with the seed, the tick and what happened to it; empty if there is none
  std::uint64_t ticks = 0;
  std::uint64_t with_force = 0;  ///< ticks, so that it is seen that there was something to keep from the hand
};

/// Runs a loop in virtual time in which all that goes wrong is drawn from the seed: law, device, ramp and
/// passivity control; stalls from 1 ms to 60 s in read and write, jumps, turned bits, readings that are no
/// numbers or do not come, delays, faults of reading and writing, a sensor that says nothing, laws that are
/// changed, zero that is asked for, confirmations, a law that gives no number, a device that is lost. Holds
/// it in every tick to what docs/safety.md promises:
///
/// - the force is within the limit of each axis, and changes by no more than its slew limit but to zero;
/// - it is zero in the tick of a fault that demands it, and the device has been let go within 10 ms of a
///   stall;
/// - after a zero it comes back along the ramp;
/// - once the rendering asks for none and the descent at the slew limit is over, it is zero, and up to then
///   the energy given is at most force times travel;
/// - zero is held after a jump until somebody confirms, and no motion of the hand is taken for a jump;
/// - the row of each tick holds the force that was sent, and a reason where that is zero.
[[nodiscard]] ScheduleOutcome run_schedule(std::uint64_t seed, const std::vector<bench::LawFile>& laws);

}  // namespace kerf::test
