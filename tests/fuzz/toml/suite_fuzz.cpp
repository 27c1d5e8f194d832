#include <set>
#include <stdexcept>

#include "fuzz/scratch_folder.h"
#include "fuzz/target.h"
#include "fuzz/toml/examples.h"
#include "laws/placement.h"
#include "regress/suite.h"

namespace kerf::fuzz {
namespace {

/// The folder that a suite stands in, beside that of the laws as in the examples.
const std::filesystem::path& folder_of_suites() {
  static const ScratchFolder examples;
  static const std::filesystem::path suites = [] {
    for (const auto& [name, text] : example_laws()) (void)examples.write(name, text);
    std::filesystem::create_directory(examples.path() / "regress");
    return examples.path() / "regress";
  }();
  return suites;
}

/// A suite that is read has cases with names of their own, each of a trajectory on axes of its renderer,
/// or with the reason why it has none.
void fuzz_suite(Bytes bytes) {
  const auto file = folder_of_suites() / "fuzz.toml";
  std::ofstream(file, std::ios::binary | std::ios::trunc) << text_of(bytes);
  bench::Suite suite;
  if (!is_taken<std::invalid_argument>([&] { suite = bench::read_suite(file); })) return;
  promise(!suite.cases.empty(), "a suite has cases");
  std::set<std::string> names;
  for (const bench::RegressionCase& one : suite.cases) {
    promise(names.insert(one.name).second, "a case has a name of its own");
    if (!one.error.empty()) continue;
    const std::size_t axes = bench::axes_of(one).size();
    promise(axes > 0, "a renderer has axes");
    for (const bench::ScriptedAxis& motion : one.motion.axes)
      promise(motion.axis < axes, "an axis of the renderer moves");
    const bench::MotionSource& from = one.motion;
    promise(from.recording.empty() + from.scene.empty() + from.axes.empty() + one.trajectory.empty() == 3,
            "a case has one trajectory");
  }
  promise(bench::only(suite, {suite.cases.front().name}).cases.size() == 1, "a case is found by its name");
}

const Registered registered("suite", fuzz_suite);

}  // namespace
}  // namespace kerf::fuzz
