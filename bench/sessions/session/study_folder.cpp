#include "session/study_folder.h"

#include <utility>

#include "sealed/journal.h"

namespace kerf::bench {
namespace {

std::vector<NewSessionName> hold(const std::filesystem::path& folder, const std::vector<std::string>& names,
                                 bool replace) {
  std::vector<NewSessionName> held;
  if (!std::filesystem::is_directory(folder)) return held;
  for (const std::string& name : names) held.emplace_back(folder / name, replace);
  return held;
}

}  // namespace

StudyFolder::StudyFolder(std::filesystem::path folder, const std::vector<std::string>& names, bool replace)
    : folder_(std::move(folder)),
      held_(hold(folder_, names, replace)),
      whole_(folder_, schema::existing_if(replace)) {}

void StudyFolder::commit() {
  whole_.commit();
  bring_to_disk(folder_);
  for (NewSessionName& name : held_) name.taken();
}

}  // namespace kerf::bench
