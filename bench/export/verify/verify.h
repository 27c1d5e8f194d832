#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "exported_law.h"

namespace kerf::bench {

/// How far a host's forces are from the law's own.
struct Verified {
  std::size_t samples = 0;
  double largest_ulp = 0.0;  ///< in units in the last place, of single precision for a law in it
  double largest = 0.0;      ///< [N or N·m]
  std::size_t at = 0;        ///< sample of the largest in ulp, from 0 on
  std::size_t faults = 0;    ///< samples at which one told a fault and the other none
  double most_force = 0.0;   ///< largest force among the samples [N or N·m]

  /// What is promised.
  [[nodiscard]] bool holds() const noexcept { return faults == 0 && largest_ulp <= 1.0; }
};

/// Ticks that lead a law through all that it has: into the tissue and out of it, fast and slowly, to and fro,
/// at rest, at 1 kHz with late ticks and with a stall; the same for the same law. As far as its fit went, and
/// a little further.
[[nodiscard]] std::vector<HostSample> samples_for(const LawFile& law, std::size_t count);

/// The law's own forces, as `kerf replay` has them.
[[nodiscard]] std::vector<double> own_forces(const LawFile& law, const std::vector<HostSample>& samples);

[[nodiscard]] Verified compared(const std::vector<double>& own, const std::vector<double>& host, bool single);

/// Both for the files in a folder. @throws as Host::forces
[[nodiscard]] Verified verify(const Host& host, const ExportedLaw& law, const std::filesystem::path& folder,
                              std::size_t count);

}  // namespace kerf::bench
