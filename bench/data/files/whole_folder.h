#pragma once

#include <filesystem>

#include <kerf/schema/final_name.h>
#include <kerf/schema/unfinished.h>

namespace kerf::bench {

/// A folder of results that appears whole or not at all. What is written goes to a folder beside it; commit()
/// gives that its name in one step. A folder that is there already, with results of other verbs, stays: what
/// is new is then moved into it, file by file, once all of it is written.
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
