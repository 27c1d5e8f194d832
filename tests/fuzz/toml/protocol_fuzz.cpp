#include <stdexcept>

#include "fuzz/target.h"
#include "fuzz/toml/examples.h"
#include "protocol/plan.h"
#include "protocol/protocol.h"
#include "protocol/samples.h"

namespace kerf::fuzz {
namespace {

void check_trial(const bench::Protocol& protocol, const bench::TrialPlan& trial) {
  promise(trial.tissue < protocol.tissues.size(), "a trial is of a tissue of the protocol");
  for (const std::size_t sample : trial.pair)
    promise(sample < protocol.samples.size(), "a pair is of its samples");
  for (std::size_t slot = 0; slot < bench::slots_of(protocol); ++slot)
    promise(trial.slots.at(slot) < trial.pair.size(), "a slot plays one of the pair");
  promise(trial.right(protocol) < bench::answers_of(protocol.design), "what is right can be answered");
}

/// A protocol that is read can be planned, its plan kept, and its trials played.
void fuzz_protocol(Bytes bytes) {
  bench::Protocol protocol;
  const std::string text(text_of(bytes));
  if (!is_taken<std::invalid_argument>([&] { protocol = bench::parse_protocol(text, "fuzz", example_law); }))
    return;
  constexpr std::size_t trials_to_check = 200;
  if (protocol.trials * protocol.samples.size() > trials_to_check) return;
  for (const bench::Plan& plan : bench::make_plans(protocol, 2, 1)) {
    const std::string json = bench::to_json_text(plan);
    promise(bench::to_json_text(bench::plan_from_json(json)) == json, "a plan is read as it was written");
    for (const bench::TrialPlan& trial : plan) check_trial(protocol, trial);
    if (!plan.empty()) promise(bench::played(protocol, plan.front()).size() == 2, "a trial is played");
  }
}

const Registered registered("protocol", fuzz_protocol);

}  // namespace
}  // namespace kerf::fuzz
