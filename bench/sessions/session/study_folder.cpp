#include "session/study_folder.h"

#include <utility>

#include "sealed/journal.h"

namespace kerf::bench {
namespace {

// A name that is free is not held: that would put a journal beside the results of others, and leave it there
// if this process died.
std::vector<NewSessionName> hold(const std::filesystem::path& folder, const std::vector<std::string>& names,
                                 bool replace) {
  std::vector<NewSessionName> held;
  for (const std::string& name : names) {
    const std::filesystem::path file = folder / name;
    if (std::filesystem::exists(file) || std::filesystem::exists(journal_of(file)))
      held.emplace_back(file, replace);
  }
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
