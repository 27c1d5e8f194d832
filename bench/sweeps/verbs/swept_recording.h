#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <kerf/schema/recording.h>

#include "plan/sweep_plan.h"

namespace kerf::bench {

/// `recording`, with what it is for ("to fit"), and what of it counts: `axis`, `rows`, `cycles`.
[[nodiscard]] std::vector<SweepInput> recording_inputs(const std::string& what_for);

/// `noise` and `seed`: white noise that is added to the force that counts.
[[nodiscard]] std::vector<SweepInput> noise_inputs();

/// The recording of a cell: read once for all neighbours that share it, with the noise of the cell.
class SweptRecording {
 public:
  using Reader = schema::Recording (*)(const std::filesystem::path& file);
  SweptRecording(std::filesystem::path folder, Reader read) : folder_(std::move(folder)), read_(read) {}

  /// Holds until the next call. @throws as the reader does.
  [[nodiscard]] const schema::Recording& of(const SweepCell& cell);

 private:
  std::filesystem::path folder_;
  Reader read_;
  std::string name_;
  schema::Recording recording_;
  schema::Recording noisy_;
};

}  // namespace kerf::bench
