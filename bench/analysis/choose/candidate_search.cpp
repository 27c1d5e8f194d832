#include "choose/candidate_search.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <system_error>
#include <tuple>

#include <fmt/core.h>

namespace kerf::bench {
namespace {

/// Than a simpler law does.
bool says_no_more(const Candidate& one) { return one.fit && one.fit->result.undetermined_arms > 0; }

bool is_judged(const Candidate& one) {
  return one.file && one.converged && std::isfinite(one.error_n) &&
         (!one.fit || one.fit->result.can_be_chosen()) && !says_no_more(one);
}

bool does_as_well(const Candidate& one, const Candidate& best, double jnd_n) {
  if (one.fit && best.fit) return fitting::as_good_as(one.fit->result, best.fit->result, jnd_n);
  return fitting::left_out(one.error_n, best.error_n) <= jnd_n;
}

std::string why_not_instead(const Candidate& one, const Candidate& taken) {
  if (one.law.parameters > taken.law.parameters) {
    return fmt::format("{} parameters, where {} does with {}", one.law.parameters, taken.law.name,
                       taken.law.parameters);
  }
  if (std::floor(one.tick_us) > std::floor(taken.tick_us)) {
    return fmt::format("a tick costs {:.1f} us, and that of {}, as simple, {:.1f} us", one.tick_us,
                       taken.law.name, taken.tick_us);
  }
  if (one.law.effects.size() > taken.law.effects.size())
    return fmt::format("as many parameters as {}, and an effect more", taken.law.name);
  return fmt::format("as simple as {}, and no nearer", taken.law.name);
}

}  // namespace

std::string_view taken_in_words(const LawChoice& choice) noexcept {
  if (choice.serves) return "taken";
  return choice.in_doubt ? "in doubt: the machine was too late to tell" : "does not serve";
}

CandidateSearch::CandidateSearch(LawChoice& choice, const CandidateSearchOptions& options,
                                 const schema::Recording& recording, const std::atomic<bool>& stop)
    : choice_(choice), options_(options), recording_(recording), stop_(stop) {}

void CandidateSearch::end_if_stopped() const {
  if (stop_) throw std::system_error(std::make_error_code(std::errc::interrupted), "no law was chosen");
}

std::size_t CandidateSearch::end_of_group(std::size_t begin) const {
  const std::vector<Candidate>& all = choice_.candidates;
  std::size_t end = begin;
  while (end < all.size() && all[end].law.parameters == all[begin].law.parameters) ++end;
  return end;
}

void CandidateSearch::search_group(std::size_t begin, std::size_t end) {
  std::ranges::stable_sort(
      std::span(choice_.candidates).subspan(begin, end - begin), {}, [](const Candidate& one) {
        return std::tuple(std::floor(one.tick_us), one.law.effects.size(), one.error_jnd);
      });
  for (std::size_t place = begin; place < end; ++place) consider(place);
}

void CandidateSearch::consider(std::size_t place) {
  Candidate& candidate = choice_.candidates[place];
  if (!candidate.file || !candidate.why.empty()) return;
  if (!std::isfinite(candidate.error_n)) {
    candidate.why = "it could not be fitted to what is left when data are held out";
  } else if (!candidate.within_jnd) {
    candidate.why = fmt::format("{:.2g} JND off", candidate.error_jnd);
    if (const double more_n = candidate.error_n - choice_.jnd_n; more_n > 0.0)
      candidate.why += fmt::format(", {:.2g} {} more than the JND", more_n, choice_.force_unit);
  } else if (choice_.taken) {
    candidate.why = why_not_instead(candidate, choice_.candidates[*choice_.taken]);
  } else if (says_no_more(candidate)) {
    candidate.why = "the data do not tell it from a law with fewer arms";
  } else if (passes_checks(candidate)) {
    choice_.taken = place;
  }
}

bool CandidateSearch::passes_checks(Candidate& candidate) {
  end_if_stopped();
  if (options_.begins && (options_.deadline || options_.stability)) options_.begins(candidate.law.name);
  if (options_.stability) {
    candidate.stability = options_.stability(*candidate.file, recording_);
    if (candidate.stability.stable == Stable::no) candidate.why = candidate.stability.why;
  }
  if (options_.deadline && candidate.stability.stable != Stable::no) {
    candidate.deadline = options_.deadline(*candidate.file);
    if (!candidate.deadline->held && !candidate.deadline->machine_late)
      candidate.why = candidate.deadline->why;
  }
  end_if_stopped();
  if (!candidate.why.empty()) return false;
  choice_.in_doubt = candidate.deadline && candidate.deadline->machine_late;
  return true;
}

void CandidateSearch::check_all_the_same(Candidate& candidate) {
  const std::string before = std::move(candidate.why);
  candidate.why.clear();
  (void)passes_checks(candidate);
  candidate.why = candidate.why.empty() ? before : before + "; " + candidate.why;
  choice_.in_doubt = false;
}

void CandidateSearch::take_the_best() {
  std::vector<Candidate>& all = choice_.candidates;
  if (std::ranges::any_of(all, &Candidate::within_jnd) || std::ranges::none_of(all, is_judged)) return;
  const auto best = std::ranges::min_element(all, {}, [](const Candidate& one) {
    return is_judged(one) ? one.error_n : std::numeric_limits<double>::infinity();
  });
  const auto good = std::ranges::find_if(
      all, [&](const Candidate& one) { return is_judged(one) && does_as_well(one, *best, choice_.jnd_n); });
  choice_.taken = static_cast<std::size_t>(best - all.begin());
  choice_.as_good = static_cast<std::size_t>(good - all.begin());
  check_all_the_same(*best);
  if (good != best) check_all_the_same(*good);
}

void CandidateSearch::finish() {
  choice_.serves = choice_.taken.has_value() && !choice_.in_doubt;
  if (!choice_.taken) take_the_best();
  look_for_a_controller();
  explain();
  explain_the_controller();
}

void CandidateSearch::look_for_a_controller() {
  if (!options_.controlled) return;
  const std::size_t end = choice_.serves ? *choice_.taken : choice_.candidates.size();
  for (std::size_t place = 0; place < end; ++place) {
    const Candidate& one = choice_.candidates[place];
    if (!one.within_jnd || one.stability.stable != Stable::no) continue;
    end_if_stopped();
    if (options_.begins) options_.begins(one.law.name + " under the passivity controller");
    const ControlledInHand found = options_.controlled(*one.file);
    if (found.verdict.stable != Stable::yes) continue;
    if (options_.deadline && !options_.deadline(*one.file).held) continue;
    choice_.advice = {.candidate = place, .added_n = found.added_n};
    return;
  }
}

void CandidateSearch::explain_the_controller() {
  if (!choice_.advice) return;
  const Candidate& one = choice_.candidates[choice_.advice->candidate];
  const double added_jnd = choice_.advice->added_n / choice_.jnd_n;
  choice_.why += fmt::format(
      ". Under the passivity controller (--passivity-control) {} with {} parameters is stable too: while a "
      "hand presses, the controller adds {:.2g} {} (rms), {:.2g} JND, {}",
      one.law.name, one.law.parameters, choice_.advice->added_n, choice_.force_unit, added_jnd,
      added_jnd <= 1.0 ? "less than would be felt" : "which is felt");
}

void CandidateSearch::explain() {
  const std::string limit =
      fmt::format("the JND of {:.3g} {} (at the root mean square force of {:.3g} {})", choice_.jnd_n,
                  choice_.force_unit, choice_.force_rms_n, choice_.force_unit);
  if (choice_.as_good) return explain_the_best(limit);
  if (!choice_.taken) {
    const auto within = std::ranges::count_if(choice_.candidates, &Candidate::within_jnd);
    choice_.why = "no law could be fitted";
    if (within > 0) {
      choice_.why =
          fmt::format("none of the {} laws within {} holds its deadlines and is stable", within, limit);
    }
    return;
  }
  const Candidate& taken = choice_.candidates[*choice_.taken];
  choice_.why = fmt::format(
      "{} with {} parameters is the simplest law within {}: {:.3g} {} on {}, {:.2g} JND", taken.law.name,
      taken.law.parameters, limit, taken.error_n, choice_.force_unit, choice_.held_out, taken.error_jnd);
  if (*choice_.taken > 0)
    choice_.why += fmt::format("; {} as simple or simpler were passed over", *choice_.taken);
  if (choice_.in_doubt) {
    choice_.why += fmt::format(". The machine was too late to tell whether it holds its deadlines: {}",
                               taken.deadline->why);
  }
  explain_stability(taken);
}

void CandidateSearch::explain_stability(const Candidate& candidate) {
  if (candidate.stability.stable == Stable::not_judged) {
    choice_.why +=
        fmt::format(". The stability of {} was not judged: {}", candidate.law.name, candidate.stability.why);
  }
}

void CandidateSearch::explain_the_best(const std::string& limit) {
  const Candidate& best = choice_.candidates[*choice_.taken];
  const Candidate& good = choice_.candidates[*choice_.as_good];
  choice_.why =
      fmt::format("None is within {}; the best is {} with {:.3g} {} on {}, {:.2g} JND", limit, best.law.name,
                  best.error_n, choice_.force_unit, choice_.held_out, best.error_jnd);
  if (&good == &best) return explain_stability(best);
  const double more_n = fitting::left_out(good.error_n, best.error_n);
  choice_.why += fmt::format(". Against it {} with {} parameters leaves out {:.2g} JND, {}", good.law.name,
                             good.law.parameters, more_n / choice_.jnd_n,
                             more_n <= choice_.jnd_n ? "which nobody would feel beside the rest"
                                                     : "less than that differs from fold to fold");
  explain_stability(best);
  explain_stability(good);
}

}  // namespace kerf::bench
