// kerf-law-trial: opens a law of a shared object and steps it, for a program that it might bring down
// (kerf/plugins/load.h). Reads the file's name and tells what it found, by report.h.

#include <csignal>
#include <cstdlib>
#include <exception>
#include <sstream>
#include <stdexcept>
#include <string>

#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <kerf/models/foreign.h>
#include <kerf/plugins/open.h>

#include "trial/allocations.h"
#include "trial/guarded_state.h"
#include "trial/report.h"
#include "trial/steps.h"

namespace kerf::law_trial {
namespace {

constexpr int parent = 3;

std::string read_name() {
  std::string name;
  for (char c = 0; recv(parent, &c, 1, 0) == 1 && c != '\n';) name += c;
  return name;
}

const kerf_law_v1& described(const std::string& file) {
  report("at it was opened");
  const plugins::Describe describe = plugins::describing_function(file);
  report("at kerf_plugin_law() was called");
  const kerf_law_v1* const law = describe();
  if (law == nullptr) refuse("its kerf_plugin_law() returns nothing");
  return *law;
}

void try_file(const std::string& file) {
  const kerf_law_v1& description = described(file);
  report("at its description was read");
  const models::ForeignLaw law(description, {.path = file, .name = {}, .sha256 = {}});
  const TrialSteps steps = try_steps(law);
  if (law.has_derivatives()) try_derivatives(law, steps.force);
  std::ostringstream line;
  line << "done " << steps.step_s << ' ' << 2 * steps.force.size() << ' ';
  if (allocations()) {
    line << steps.allocations;
  } else {
    line << '?';
  }
  report(line.str());
}

void prepare() {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  const rlimit none{.rlim_cur = 0, .rlim_max = 0};
  setrlimit(RLIMIT_CORE, &none);
  sigset_t nothing;
  sigemptyset(&nothing);
  sigprocmask(SIG_SETMASK, &nothing, nullptr);
  watch_for_faults();
}

}  // namespace

void report(const std::string& line) {
  const std::string whole = line + '\n';
  (void)send(parent, whole.data(), whole.size(), MSG_NOSIGNAL);
}

void refuse(const std::string& why) {
  report("refused " + why);
  _exit(0);
}

}  // namespace kerf::law_trial

int main() {
  using namespace kerf::law_trial;
  prepare();
  try {
    try_file(read_name());
  } catch (const std::invalid_argument& error) {
    refuse(error.what());
  } catch (const std::exception& error) {
    refuse(std::string("it throws an exception: ") + error.what());
  } catch (...) {
    refuse("it throws an exception");
  }
  // Without the destructors of the plug-in.
  _exit(0);
}
