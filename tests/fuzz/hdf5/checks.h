#pragma once

#include <filesystem>

namespace kerf::fuzz {

/// Reads a file by every reader of the schemas. Each takes it or refuses it in one line; what is valid is
/// taken, and written it is valid again; and by pieces it is what it is as a whole.
/// Within this process, for files that HDF5 itself wrote.
void check_readers(const std::filesystem::path& file);

/// The same as the program reads, in a process of its own: damaged bytes make HDF5 1.10 read and write where
/// it must not. Each reader takes the file or refuses it in one line, whatever becomes of that process; what
/// is valid is taken by one.
void check_readers_apart(const std::filesystem::path& file);

}  // namespace kerf::fuzz
