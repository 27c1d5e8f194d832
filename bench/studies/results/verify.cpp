#include "results/verify.h"

#include <algorithm>
#include <stdexcept>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "files/named_file.h"
#include "files/whole_file.h"
#include "files/whole_folder.h"
#include "recordings/provenance.h"
#include "results/crate.h"
#include "run/recording_step.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;
using json = nlohmann::ordered_json;

void check_files(const fs::path& folder, StudyCheck& check) {
  const fs::path file = folder / crate_file;
  try {
    const json crate = json::parse(read_named_file(file, LargestInput::table));
    for (const json& entity : crate.at("@graph")) {
      if (entity.at("@type") != "File") continue;
      const auto name = entity.at("name").get<std::string>();
      const fs::path part(name);
      if (part.is_absolute() || std::ranges::find(part, fs::path("..")) != part.end())
        throw std::invalid_argument(fmt::format("{}: '{}' leaves the study", file.string(), name));
      ++check.files;
      if (!fs::is_regular_file(folder / part)) {
        check.changed.push_back(name + ": it is missing");
      } else if (sha256_of(folder / part) != entity.at("sha256").get<std::string>()) {
        check.changed.push_back(name + ": it is not what it was");
      }
    }
  } catch (const json::exception& error) {
    throw std::invalid_argument(fmt::format("{}: not the crate of a study: {}", file.string(), error.what()));
  }
}

/// A folder for what is made again, beside the study's own, which goes away.
class MadeAgain {
 public:
  explicit MadeAgain(const fs::path& folder) : whole_(folder / "made_again", schema::Existing::replace) {}
  [[nodiscard]] const fs::path& path() const noexcept { return whole_.path(); }

 private:
  WholeFolder whole_;  ///< is never committed
};

void rerun_one(const StudyPlan& plan, const DrawerFile& file, const std::string& name, const fs::path& folder,
               const std::atomic<bool>& stop, StudyCheck& check) {
  check.rerun.push_back(name);
  const fs::path made = folder / "recordings" / name;
  try {
    const std::string before = read_named_file(made / "result.json", LargestInput::table);
    const MadeAgain again(folder);
    const RecordingStep step = step_of(plan, file, folder);
    (void)run_recording_step(step, again.path(), stop);
    if (content_sha256_of(made / "recording.h5") != content_sha256_of(again.path() / "recording.h5")) {
      check.not_alike.push_back(name + ": its samples differ");
    } else if (read_whole_file(again.path() / "result.json") != before) {
      check.not_alike.push_back(name + ": its result.json differs");
    }
  } catch (const std::invalid_argument& error) {
    check.not_alike.push_back(fmt::format("{}: {}", name, error.what()));
  }
}

}  // namespace

StudyCheck verify_study(const fs::path& folder, const std::vector<std::string>& rerun, bool rerun_all,
                        const std::atomic<bool>& stop) {
  StudyCheck check;
  check_files(folder, check);
  const StudyPlan plan = read_study(folder / "study.toml");
  const std::vector<std::string> names = recording_names(plan);
  for (const std::string& asked : rerun) {
    if (std::ranges::find(names, asked) == names.end())
      throw std::invalid_argument(
          fmt::format("--rerun: there is no recording '{}' in {}", asked, folder.string()));
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!plan.files[i].ignored.empty()) continue;
    if (rerun_all || std::ranges::find(rerun, names[i]) != rerun.end())
      rerun_one(plan, plan.files[i], names[i], folder, stop, check);
  }
  return check;
}

}  // namespace kerf::bench
