#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "laws/law_file.h"

namespace kerf::bench {

/// A law on its way into another program.
struct ExportedLaw {
  std::string name;  ///< of its files and functions, a C identifier in lower case: "liver"
  LawFile file;
  std::string text;     ///< of the law file, byte for byte
  std::string sha256;   ///< of that text, 64 digits
  std::string plain_c;  ///< the law as one file of C99, NAME.c; empty for a host that calls libkerf
};

/// A file that a host takes, beside others of the same folder.
struct HostFile {
  std::string name;     ///< below the folder of the export: "liver.c", "sources/liver.c"
  std::string content;  ///< bytes
};

/// One tick, in the sense of the axis that the law was fitted on.
struct HostSample {
  double position = 0.0;   ///< [m or rad]
  double velocity = 0.0;   ///< [m/s or rad/s]
  double elapsed_s = 0.0;  ///< since the last tick, > 0
};

/// A program that takes a law over.
struct Host {
  std::string_view name;  ///< as `kerf export --as` has it: "fmu"
  std::string_view what;  ///< in a few words: "FMI 3.0 Co-Simulation for Linux"
  bool takes_c = true;    ///< carries the law as C; else its file calls libkerf, which takes every law

  /// Its files. What needs a compiler is compiled here.
  /// @throws std::invalid_argument with the reason for a law that this host cannot carry (axes that it has
  /// not); std::system_error without a compiler that is needed.
  std::vector<HostFile> (*files)(const ExportedLaw& law) = nullptr;

  /// Runs those files, which stand in `folder`, in that host or in what stands for it, and gives back the
  /// force of each tick on the axis [N or N·m], from a fresh state, bit for bit as the host had it; not a
  /// number where it told a fault.
  /// @throws std::system_error that names the program and the package where the host is not installed.
  std::vector<double> (*forces)(const ExportedLaw& law, const std::filesystem::path& folder,
                                std::span<const HostSample> samples) = nullptr;

  std::string_view in_its_place{};  ///< what forces() runs in place of the host itself; empty: the host
};

// Each in a folder of its own.
[[nodiscard]] Host plain_c_host();
[[nodiscard]] Host fmu_host();
[[nodiscard]] Host octave_host();
[[nodiscard]] Host python_host();
[[nodiscard]] Host chai3d_host();
[[nodiscard]] Host sofa_host();
[[nodiscard]] Host unity_host();

}  // namespace kerf::bench
