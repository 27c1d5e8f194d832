#pragma once

#include <filesystem>

#include "fuzz/target.h"

namespace kerf::fuzz {

/// Puts a file out of order by HDF5 itself, as `bytes` say: objects and attributes that are taken away,
/// renamed, of other types, shapes and values, or new. What HDF5 refuses to do is left out.
void edit_hdf5(const std::filesystem::path& file, Bytes bytes);

}  // namespace kerf::fuzz
