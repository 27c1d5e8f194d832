#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

#include "registered/experiment.h"

namespace kerf::bench {
namespace {

bool ranks(const Protocol& protocol) {
  return protocol.design == Design::preference &&
         std::ranges::any_of(protocol.tissues, [](const auto& each) { return each.samples.size() > 2; });
}

std::string quoted(const std::vector<std::string>& texts) {
  std::vector<std::string> each;
  for (const std::string& text : texts) each.push_back(fmt::format("{:?}", text));
  return fmt::format("[{}]", fmt::join(each, ", "));
}

std::string margin_lines(const AnalysisPlan& plan) {
  std::string text;
  if (plan.margin)
    text += fmt::format("margin = {}   # a preference counts as none within 50 % +- this\n", *plan.margin);
  if (plan.d_prime)
    text += fmt::format("d_prime = {}   # renderings count as equal below this d'\n", *plan.d_prime);
  if (plan.jnd_margins)
    text += fmt::format("jnd_margins = [{}, {}]\n", plan.jnd_margins->lower, plan.jnd_margins->upper);
  return text;
}

std::string exclusion_lines(const ExclusionPlan& plan) {
  std::string text =
      "\n[analysis.exclude]   # participants with a larger share of such trials, or of whom a rule holds\n";
  if (plan.faulty) text += fmt::format("faulty = {}\n", *plan.faulty);
  if (plan.unfelt) text += fmt::format("unfelt = {}\n", *plan.unfelt);
  if (plan.catch_right)
    text += fmt::format("catch_right = {}   # or a smaller one of right catch trials\n", *plan.catch_right);
  return text + fmt::format("rules = {}   # in words: 'kerf session drop --rule'\n", quoted(plan.rules));
}

std::string stopping_lines(const StoppingRule& rule) {
  std::string text = fmt::format(
      "\n[analysis.stopping]\nrule = \"{}\"   # one of \"fixed\", \"alpha-spending\", \"bayes-factor\"\n",
      name_of(rule.kind));
  if (rule.kind == StoppingKind::alpha_spending)
    text +=
        fmt::format("spending = \"{}\"   # one of \"obrien-fleming\", \"pocock\"\n", name_of(rule.spending));
  if (rule.kind == StoppingKind::bayes_factor)
    text += fmt::format("evidence = {}   # ends at this Bayes factor, or at one over it\n", rule.evidence);
  if (!rule.looks.empty())
    text += fmt::format("looks = [{}]   # participants; the last look is at the target\n",
                        fmt::join(rule.looks, ", "));
  return text;
}

}  // namespace

std::string experiment_text(const Experiment& experiment) {
  const ParticipantPlan& people = experiment.participants;
  std::string text = fmt::format(
      "name = {:?}\nprotocol = {:?}\n\n[participants]\ntarget = {}\nvisits = {}   # sessions of each\n",
      experiment.name, experiment.protocol, people.target, people.visits);
  if (!people.groups.empty()) text += fmt::format("groups = {}   # of equal size\n", quoted(people.groups));
  text += fmt::format("replace = \"{}\"   # one of \"never\", \"dropped\", \"dropped-or-excluded\"\n",
                      name_of(people.replace));
  const AnalysisPlan& plan = experiment.analysis;
  text += fmt::format("\n[analysis]\ntest = \"{}\"   # one of \"difference\", \"equivalence\"\nalpha = {}\n",
                      name_of(plan.test), plan.alpha);
  return text + margin_lines(plan) + exclusion_lines(plan.exclude) + stopping_lines(plan.stopping);
}

void require_fits(const Experiment& experiment, const Protocol& protocol, const std::string& file) {
  const auto refuse = [&](const std::string& what) {
    throw std::invalid_argument(fmt::format("{}: [analysis] and the design \"{}\" of {}: {}", file,
                                            name_of(protocol.design), experiment.protocol, what));
  };
  const AnalysisPlan& plan = experiment.analysis;
  const bool of_levels = has_levels(protocol.design);
  const bool prefers = protocol.design == Design::preference;
  if (plan.margin && !prefers) refuse("'margin' is of a preference; leave it out");
  const bool of_numbers = asks_numbers(protocol.design);
  if (plan.d_prime && (prefers || of_levels || of_numbers || has_two_rates(protocol.design)))
    refuse("'d_prime' is of abx, 2ifc and 3ifc; leave it out");
  if (plan.jnd_margins && !of_levels) refuse("'jnd_margins' are of levels; leave them out");
  if (plan.exclude.catch_right && protocol.catches.every == 0)
    refuse("'catch_right' needs catch trials, and the protocol has no [catch]; leave it out, or add them");
  if (plan.test == PrimaryTest::equivalence && (of_numbers || has_two_rates(protocol.design)))
    refuse(fmt::format("\"{}\" has no test of equivalence; expected test = \"difference\"",
                       name_of(protocol.design)));
  if (plan.test == PrimaryTest::equivalence && !plan.margin && !plan.d_prime && !plan.jnd_margins)
    refuse(fmt::format("the test \"equivalence\" needs {}", prefers     ? "'margin'"
                                                            : of_levels ? "'jnd_margins'"
                                                                        : "'d_prime'"));
  if (plan.test == PrimaryTest::equivalence && ranks(protocol))
    refuse("more than two samples of a tissue have no test of equivalence");
  if (plan.test == PrimaryTest::difference && ends_by_answers(protocol.design, protocol.scale))
    refuse(fmt::format(
        "{} has no test of a difference; expected test = \"equivalence\" with 'jnd_margins'",
        protocol.design == Design::staircase ? "a staircase" : "QUEST+ that ends by an interval"));
  if (plan.stopping.kind == StoppingKind::fixed) return;
  if (is_adaptive(protocol.design) || plan.jnd_margins)
    refuse("levels that follow the answers and margins of a JND take the rule \"fixed\"");
  if (plan.stopping.kind == StoppingKind::bayes_factor &&
      (plan.test == PrimaryTest::equivalence || ranks(protocol) || of_numbers))
    refuse("a Bayes factor is of a difference of the subjects' shares; take another rule");
}

}  // namespace kerf::bench
