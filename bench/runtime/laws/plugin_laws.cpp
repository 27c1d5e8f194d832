#include "laws/plugin_laws.h"

#include <utility>

#include <fmt/format.h>

#include <kerf/plugins/load.h>

#include "files/named_file.h"
#include "recordings/provenance.h"

namespace kerf::bench {
namespace {

constexpr double slow_step_s = 100e-6;  // a tenth of a tick at 1 kHz

void note_trial(const std::string& file, const plugins::Trial& trial) {
  if (trial.allocations.value_or(0) > 0) {
    note_of_plugin(
        fmt::format("{}: its step allocates memory, {} times in the {} steps of its trial: a tick that "
                    "waits for memory may be late",
                    file, *trial.allocations, trial.steps));
  }
  if (trial.step_s > slow_step_s) {
    note_of_plugin(fmt::format("{}: a step of it takes {:.3g} us, and a tick at 1 kHz has 1000 us for all",
                               file, 1e6 * trial.step_s));
  }
}

}  // namespace

bool is_plugin(std::string_view name) { return name.size() > 3 && name.ends_with(".so"); }

const models::ForeignLaw& load_plugin(const std::filesystem::path& file) {
  (void)NamedFile(file);  // says what is wrong with one that cannot be opened
  const std::string sha256 = sha256_of(file);
  for (const models::ForeignLaw* const law : models::foreign_laws()) {
    if (law->plugin().sha256 == sha256) return *law;
  }
  const plugins::Plugin plugin = plugins::load(file, sha256);
  note_trial(file.string(), plugin.trial);
  return *plugin.law;
}

std::vector<std::string> laws_named(std::vector<std::string> laws) {
  for (std::string& law : laws) {
    if (is_plugin(law)) law = load_plugin(law).info().name;
  }
  return laws;
}

LawFile law_of_plugin(const std::filesystem::path& file) {
  const models::ForeignLaw& law = load_plugin(file);
  const models::LawInfo info = law.info();
  return {.law = models::Law::make(info.name, law.initial()),
          .contact = {},
          .axis = {},
          .position_unit = info.position_unit.empty() ? "m" : std::string(info.position_unit),
          .force_unit = info.force_unit.empty() ? "N" : std::string(info.force_unit),
          .std_errors = {},
          .fit = {},
          .name = file.string()};
}

}  // namespace kerf::bench
