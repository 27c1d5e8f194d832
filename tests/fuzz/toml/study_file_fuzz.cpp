#include <stdexcept>

#include "drawer/study_file.h"
#include "fuzz/scratch_folder.h"
#include "fuzz/target.h"

namespace kerf::fuzz {
namespace {

/// A study that is read has laws, leaves its drawer by no path, and names every recording by itself; written
/// out, it is read again as the same.
void fuzz_study_file(Bytes bytes) {
  static const ScratchFolder folder;
  const auto file = folder.write("study.toml", text_of(bytes));
  bench::StudyPlan plan;
  if (!is_taken<std::invalid_argument>([&] { plan = bench::read_study(file); })) return;
  promise(!plan.laws.empty(), "a study has laws");
  const std::vector<std::string> names = bench::recording_names(plan);
  for (std::size_t i = 0; i < names.size(); ++i) {
    promise(names[i].empty() == !plan.files[i].ignored.empty(), "what takes part has a name");
    promise(names[i].find('/') == std::string::npos && !names[i].starts_with('.'), "a name is in its folder");
  }
  const bench::StudyPlan again = bench::read_study(folder.write("again.toml", bench::study_text(plan)));
  promise(bench::study_text(again) == bench::study_text(plan), "a study is read as it was written");
}

const Registered registered("study_file", fuzz_study_file);

}  // namespace
}  // namespace kerf::fuzz
