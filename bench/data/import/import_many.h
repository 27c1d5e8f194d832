#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "import/import.h"

namespace kerf::bench {

/// What became of one file, or of one trial of it.
struct ImportEntry {
  std::string file;              ///< as it was named
  std::string trial;             ///< empty where the file is one
  std::string recording;         ///< its path in the folder of recordings; empty if there is none
  std::string failure;           ///< why there is none, in one line
  nlohmann::ordered_json about;  ///< as imported_as_json() gives it
};

/// A file to import, and what its recording is called, without an extension.
struct FileToImport {
  std::filesystem::path file;
  std::filesystem::path name;
};

/// The files that are named, and all files in folders that are named and in those within, but for hidden ones
/// and for what lies in `output`, sorted. Recordings are called as their files, those of folders by their
/// path in it, with a number behind the name where two would have one.
/// @throws std::invalid_argument for a folder that cannot be listed or holds no file.
[[nodiscard]] std::vector<FileToImport> files_to_import(const std::vector<std::string>& named,
                                                        const std::filesystem::path& output);

struct ImportManyOptions {
  ImportOptions each;
  std::string trial_column;      ///< empty: a file is a recording
  std::filesystem::path folder;  ///< for the recordings, which it must not hold yet
  /// Further warnings of a recording that came in, if anybody has some.
  std::function<std::vector<std::string>(const schema::Recording&)> look = {};
};

/// Imports one file after the other. What is wrong with one, or with one trial, is its entry's failure, and
/// the others go on; after `stop` no other is begun. `done` counts files.
/// @throws std::system_error if a recording cannot be written.
[[nodiscard]] std::vector<ImportEntry> import_many(const std::vector<FileToImport>& files,
                                                   const ImportManyOptions& options,
                                                   const std::atomic<bool>& stop,
                                                   std::atomic<std::size_t>& done);

/// The JSON of an import of several files.
[[nodiscard]] nlohmann::ordered_json imports_as_json(const std::vector<ImportEntry>& entries);

}  // namespace kerf::bench
