#pragma once

#include <filesystem>

namespace kerf::bench {

/// Of verbs that look at any file: that this one is no plan and no shard of a sweep, by how it begins.
/// @throws std::invalid_argument that says what looks at those.
void refuse_file_of_sweep(const std::filesystem::path& file);

}  // namespace kerf::bench
