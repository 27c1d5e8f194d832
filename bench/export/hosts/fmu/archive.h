#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "exported_law.h"

namespace kerf::bench {

/// A zip archive as FMI takes it: deflated or stored, no data descriptors, no zip64. The same files give the
/// same bytes: they are of 1980. @throws std::runtime_error
[[nodiscard]] std::string zipped(const std::vector<HostFile>& files);

/// The files of a zip archive. @throws std::invalid_argument for what is none.
[[nodiscard]] std::vector<HostFile> unzipped(std::string_view archive);

}  // namespace kerf::bench
