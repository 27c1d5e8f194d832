#pragma once

#include <filesystem>

#include <kerf/schema/final_name.h>
#include <kerf/schema/unfinished.h>

namespace kerf::bench {

/// A folder of results that appears whole or not at all. What is written goes to a folder beside it; commit()
/// gives that its name in one step. What a folder that is there already holds besides, results of other
/// verbs, is taken over. Where the system cannot exchange two folders (another file system, no right to the
/// folder above), or somebody is in the old one, what is new is moved into it file by file.
class WholeFolder {
 public:
  /// Makes the folder to write to. @throws std::system_error
  WholeFolder(std::filesystem::path folder, schema::Existing existing);
  WholeFolder(const WholeFolder&) = delete;
  WholeFolder& operator=(const WholeFolder&) = delete;
  /// Removes what was not committed.
  ~WholeFolder();

  /// Where to write.
  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
  /// @throws as schema::take_name() does: then everything is kept.
  void commit();

 private:
  [[nodiscard]] bool has_name_of_ours() const;

  std::filesystem::path folder_;
  schema::Existing existing_;
  std::filesystem::path path_;
  schema::WriteMark mark_;
};

}  // namespace kerf::bench
