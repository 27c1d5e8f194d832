#include "choose/fidelity.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

#include <fmt/core.h>

#include "chart/cost/tick_cost.h"
#include "laws/placement.h"
#include "laws/render.h"

namespace kerf::bench {
namespace {

constexpr std::array strip_counts{1, 2, 4, 8, 16, 32, 64};

LawFile with_fidelity(const LawFile& law, const std::string& kind, int strips) {
  models::Options options = law.law.options();
  options["fidelity"] = kind;
  options["strips"] = static_cast<double>(strips);
  LawFile other = law;
  other.law = models::Law::make(law.law.model(), law.law.values(), options);
  return other;
}

/// What a tick of each costs in the loop.
void time(std::vector<Candidate>& all, const SampledMotion& path, const std::vector<std::size_t>& axes) {
  std::vector<TimedLaw> timed;
  for (const Candidate& one : all) timed.push_back({{one.file->law, one.file->contact, axes}, &path});
  const std::vector<TickCost> costs = tick_costs(timed, {.rounds = 9, .cold_ticks = 0});
  for (std::size_t i = 0; i < all.size(); ++i) all[i].tick_us = 1e-3 * costs[i].p50_ns;
}

/// Root mean squares of a force and a torque, or of their differences.
struct Size {
  double force_n = 0.0;
  double torque_n_m = 0.0;
};

/// By the blade's own axes, which are those of the device.
Size size_of(const std::vector<drivers::Axes>& force, const std::vector<drivers::Axes>& less,
             const std::vector<bool>& counts, const std::vector<std::size_t>& axes) {
  Size squares;
  double ticks = 0.0;
  for (std::size_t tick = 0; tick < force.size(); ++tick) {
    if (!counts[tick]) continue;
    ticks += 1.0;
    for (std::size_t i = 0; i < axes.size(); ++i) {
      const double value = force[tick][axes[i]] - (less.empty() ? 0.0 : less[tick][axes[i]]);
      (i < 3 ? squares.force_n : squares.torque_n_m) += value * value;
    }
  }
  return {.force_n = std::sqrt(squares.force_n / ticks), .torque_n_m = std::sqrt(squares.torque_n_m / ticks)};
}

EffectVerdict rotation_of(const Candidate& paper, const Candidate& exact, bool matters) {
  return {
      .effect = Effect::rotation,
      .matter = matters ? Matter::matters : Matter::does_not,
      .without_n = paper.error_n,
      .with_n = exact.error_n,
      .without_law = paper.law.name,
      .with_law = exact.law.name,
      .why = fmt::format("{:.2g} JND ({}: {:.3g} N and {:.3g} N·m) without, 0 JND ({}) with", paper.error_jnd,
                         paper.law.name, paper.error_n, paper.error_torque_n_m, exact.law.name)};
}

Candidate candidate(const LawFile& file, const std::string& kind, int strips) {
  Candidate one;
  one.law.name = kind == "exact" ? "blade-exact" : fmt::format("blade-{}-{}", kind, strips);
  one.law.model = file.law.model();
  one.law.law_options = {fmt::format("fidelity={}", kind)};
  if (kind != "exact") one.law.law_options.push_back(fmt::format("strips={}", strips));
  one.law.parameters = file.law.values().size();
  if (kind != "paper") one.law.effects = {Effect::rotation};
  one.file = with_fidelity(file, kind, strips);
  one.converged = true;
  return one;
}

}  // namespace

LawChoice choose_fidelity(const Scene& scene, const FidelityOptions& options, const std::atomic<bool>& stop) {
  if (models::law_facts(scene.tissue.law.model()).fineness != models::Fineness::strips) {
    throw std::invalid_argument(
        fmt::format("law '{}' acts on several axes and has no fidelities to choose among; of such laws only "
                    "'blade' has",
                    scene.tissue.law.model()));
  }
  const SampledMotion path = tool_path(scene, options.rate_hz);
  const std::vector<std::size_t> axes =
      axes_for(scene.tissue, drivers::open_device(device_of(scene))->info());
  if (path.ticks() == 0) throw std::invalid_argument("the scene's path is over before its first tick");
  LawChoice choice;
  choice.settings.jnd = options.jnd;
  choice.candidates.push_back(candidate(scene.tissue, "exact", 16));
  for (const char* kind : {"paper", "strips"}) {
    for (const int strips : strip_counts) choice.candidates.push_back(candidate(scene.tissue, kind, strips));
  }
  const auto reference = render(*choice.candidates.front().file, axes, path).force;
  std::vector<bool> pushes;
  for (const drivers::Axes& force : reference)
    pushes.push_back(std::ranges::any_of(force, [](double value) { return value != 0.0; }));
  const auto ticks = std::ranges::count(pushes, true);
  if (ticks == 0) throw std::invalid_argument("along the scene's path the blade never pushes on anything");
  const Size whole = size_of(reference, {}, pushes, axes);
  choice.force_rms_n = whole.force_n;
  choice.jnd_n = options.jnd.at(whole.force_n);
  const double jnd_n_m = options.torque_jnd.at(whole.torque_n_m);
  choice.held_out = fmt::format("the scene's path, {} ticks of {} in the tissue", ticks, pushes.size());
  time(choice.candidates, path, axes);
  for (Candidate& one : choice.candidates) {
    const Size error = size_of(render(*one.file, axes, path).force, reference, pushes, axes);
    one.error_n = error.force_n;
    one.error_torque_n_m = error.torque_n_m;
    one.error_jnd = std::max(error.force_n / choice.jnd_n, error.torque_n_m / jnd_n_m);
    one.within_jnd = one.error_jnd <= 1.0;
  }
  choice.warnings.push_back(
      fmt::format("errors are those to the exact blade: forces against a JND of {:.3g} N, torques against "
                  "one of {:.3g} N·m "
                  "(root mean square torque {:.3g} N·m), and the larger counts; other effects than rotation "
                  "are not judged",
                  choice.jnd_n, jnd_n_m, whole.torque_n_m));
  const auto named = [&](const char* name) {
    return *std::ranges::find_if(choice.candidates,
                                 [&](const Candidate& one) { return one.law.name == name; });
  };
  const Candidate paper = named("blade-paper-64");
  choice.effects = {rotation_of(paper, named("blade-exact"), !paper.within_jnd)};
  const schema::Recording none;
  CandidateSearch search(choice, options.search, none, stop);
  search.search_group(0, choice.candidates.size());
  search.finish();
  return choice;
}

}  // namespace kerf::bench
