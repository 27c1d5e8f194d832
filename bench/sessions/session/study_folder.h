#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "files/whole_folder.h"
#include "sealed/sealed_entries.h"

namespace kerf::bench {

/// The sessions of a study while they are made: all of them appear in their folder in one step, or none does.
/// What stands there under other names stays.
class StudyFolder {
 public:
  /// Sessions that stand there already are held until those that replace them do.
  /// @throws as NewSessionName and WholeFolder do.
  StudyFolder(std::filesystem::path folder, const std::vector<std::string>& names, bool replace);

  /// Where to make them.
  [[nodiscard]] const std::filesystem::path& path() const noexcept { return whole_.path(); }
  /// On the disk when it returns. @throws as WholeFolder does.
  void commit();

 private:
  std::filesystem::path folder_;
  std::vector<NewSessionName> held_;
  WholeFolder whole_;
};

}  // namespace kerf::bench
