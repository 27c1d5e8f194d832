#include "choose/choose.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <tuple>

#include <fmt/core.h>

#include "choose/step_cost.h"
#include "fits/choice.h"
#include "fits/fit_series.h"

namespace kerf::bench {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

std::size_t cycles_in(const schema::Recording& recording, std::size_t axis) {
  if (!recording.cycles || recording.cycles->axis != axis) return 0;
  std::size_t most = 0;
  for (const schema::PhaseSpan& phase : recording.cycles->phases)
    most = std::max<std::size_t>(most, phase.cycle);
  return most;
}

/// One choice while it is made.
class Walk {
 public:
  Walk(const schema::Recording& recording, const ChooseOptions& options, const std::atomic<bool>& stop)
      : recording_(recording), options_(options), stop_(stop) {
    if (options.axis >= recording.dimensions()) throw std::invalid_argument("the recording has no such axis");
    if (options.fit.folds < 2)
      throw std::invalid_argument("a law is chosen by held-out data: at least 2 folds are needed");
    choice_.settings = options.fit;
    if (options.richer_too) segmented_memory_ = fitting::remember_segments(options.candidates.most_segments);
    choice_.contact = options.contact.value_or(contact_of(recording, options.axis));
    const FitSeries series = fit_series(recording, options.axis, choice_.contact);
    if (series.axis.force.empty()) throw std::invalid_argument("the recording has no row that is finite");
    look_at(series.axis);
    const std::size_t cycles = cycles_in(recording, options.axis);
    say_folds(cycles);
    const schema::Axis& axis = recording.axes[options.axis];
    for (CandidateLaw& law : candidates_for(axis, cycles > 0, options.candidates))
      choice_.candidates.push_back(
          {.law = std::move(law), .fit = {}, .deadline = {}, .stable = {}, .why = {}});
  }

  LawChoice make() {
    std::vector<Candidate>& all = choice_.candidates;
    if (options_.richer_too) fit_all(all);
    std::size_t begin = 0;
    while (begin < all.size() && !(choice_.taken && !options_.richer_too)) {
      const std::size_t end = end_of_group(begin);
      const auto group = std::span(all).subspan(begin, end - begin);
      if (!options_.richer_too) fit_all(group);
      walk(group, begin);
      begin = end;
    }
    all.resize(begin);
    if (std::ranges::none_of(all, [](const Candidate& one) { return one.fit.has_value(); }))
      throw std::invalid_argument(all.empty() ? "no law fits the axis" : all.front().why);
    choice_.serves = choice_.taken.has_value() && !choice_.in_doubt;
    choice_.effects = judge_effects(all, choice_.taken, choice_.jnd_n);
    if (!choice_.taken) take_the_best();
    explain();
    if (choice_.taken) fit_with_intervals(all[*choice_.taken]);
    return std::move(choice_);
  }

 private:
  void look_at(const AxisSeries& series) {
    choice_.jnd_n = jnd_of(series.force, options_.fit.jnd);
    const double squares =
        std::inner_product(series.force.begin(), series.force.end(), series.force.begin(), 0.0);
    choice_.force_rms_n = std::sqrt(squares / static_cast<double>(series.force.size()));
    const double duration_s = series.time_s.back() - series.time_s.front();
    period_s_ =
        std::max(1e-6, duration_s / static_cast<double>(std::max<std::size_t>(series.time_s.size() - 1, 1)));
    for (std::size_t i = 0; i < series.force.size(); ++i)
      motion_.push_back({.penetration = series.penetration[i], .velocity = series.velocity[i]});
  }

  void say_folds(std::size_t cycles) {
    const std::size_t folds = options_.fit.folds;
    if (cycles >= 2) {
      choice_.held_out = fmt::format("{} cycles in {} folds", cycles, std::min(folds, cycles));
      return;
    }
    choice_.held_out = fmt::format("{} blocks of time", folds);
    if (cycles > 0) return;
    choice_.warnings.emplace_back(
        "the recording has no cycles along this axis: errors are held out by blocks of time, and laws with a "
        "branch for each way are left out; 'kerf segment' finds cycles");
  }

  [[nodiscard]] std::size_t end_of_group(std::size_t begin) const {
    std::size_t end = begin;
    while (end < choice_.candidates.size() &&
           choice_.candidates[end].law.parameters == choice_.candidates[begin].law.parameters)
      ++end;
    return end;
  }

  [[nodiscard]] RecordingFit fit_of(const CandidateLaw& law, fitting::FitOptions settings) const {
    return fit_recording(recording_, {.models = {law.model},
                                      .axis = options_.axis,
                                      .contact = choice_.contact,
                                      .law_options = law.law_options,
                                      .fit = std::move(settings)});
  }

  void fit_one(Candidate& candidate) const {
    fitting::FitOptions settings = options_.fit;
    settings.threads = 1;
    settings.intervals = fitting::Intervals::white;  // those of the law that is taken follow
    settings.profile = false;
    settings.segmented_memory = segmented_memory_;
    RecordingFit fit = fit_of(candidate.law, std::move(settings));
    if (fit.laws.empty()) {
      candidate.why = fit.refusals.empty() ? "it could not be fitted" : fit.refusals.front().why;
      return;
    }
    candidate.fit = std::move(fit.laws.front());
    const fitting::FitResult& result = candidate.fit->result;
    candidate.error_n = std::isfinite(result.cv_rmse) ? result.cv_rmse : infinite;
    candidate.error_jnd = candidate.error_n / choice_.jnd_n;
    candidate.within_jnd = result.converged && candidate.error_n <= choice_.jnd_n;
  }

  /// The richest first: they take longest.
  void fit_all(std::span<Candidate> candidates) const {
    std::atomic<std::size_t> begun{0};
    const auto work = [&] {
      for (std::size_t i = begun++; i < candidates.size() && !stop_; i = begun++)
        fit_one(candidates[candidates.size() - 1 - i]);
    };
    {
      std::vector<std::jthread> others;
      for (std::size_t i = 1; i < std::min(options_.threads, candidates.size()); ++i)
        others.emplace_back(work);
      work();
    }
    end_if_stopped();
  }

  void end_if_stopped() const {
    if (stop_) throw std::system_error(std::make_error_code(std::errc::interrupted), "no law was chosen");
  }

  void walk(std::span<Candidate> group, std::size_t begin) {
    for (Candidate& candidate : group) {
      if (candidate.fit) candidate.tick_us = step_cost_us(candidate.fit->file.law, motion_, period_s_);
    }
    std::ranges::stable_sort(group, {}, [](const Candidate& one) {
      return std::tuple(std::floor(one.tick_us), one.law.effects.size(), one.error_n);
    });
    for (std::size_t i = 0; i < group.size(); ++i) consider(group[i], begin + i);
  }

  void consider(Candidate& candidate, std::size_t place) {
    if (!candidate.fit) return;
    if (!candidate.fit->result.converged) {
      candidate.why = fmt::format("its fit did not converge: {}", candidate.fit->result.message);
    } else if (!std::isfinite(candidate.error_n)) {
      candidate.why = "it could not be fitted to what is left when data are held out";
    } else if (!candidate.within_jnd) {
      candidate.why = fmt::format("{:.2g} JND off on held-out data, {:.2g} N more than the JND",
                                  candidate.error_jnd, candidate.error_n - choice_.jnd_n);
    } else if (choice_.taken) {
      candidate.why = why_not_instead(candidate, choice_.candidates[*choice_.taken]);
    } else if (passes_checks(candidate)) {
      choice_.taken = place;
    }
  }

  [[nodiscard]] static std::string why_not_instead(const Candidate& one, const Candidate& taken) {
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
    return fmt::format("as simple as {}, and off by more", taken.law.name);
  }

  bool passes_checks(Candidate& candidate) {
    end_if_stopped();
    if (options_.begins && (options_.deadline || options_.stability)) options_.begins(candidate.law.name);
    const LawFile& file = candidate.fit->file;
    if (options_.stability) {
      const std::optional<std::string> why = options_.stability(file, recording_);
      candidate.stable = !why;
      if (why) candidate.why = *why;
    }
    if (options_.deadline && candidate.stable.value_or(true)) {
      candidate.deadline = options_.deadline(file);
      if (!candidate.deadline->held && !candidate.deadline->machine_late)
        candidate.why = candidate.deadline->why;
    }
    end_if_stopped();
    if (!candidate.why.empty()) return false;
    choice_.in_doubt = candidate.deadline && candidate.deadline->machine_late;
    return true;
  }

  /// None serves. Where none is even within the JND, the best is named all the same, and checked.
  void take_the_best() {
    std::vector<Candidate>& all = choice_.candidates;
    const auto fitted = [](const Candidate& one) {
      return one.fit && one.fit->result.converged && std::isfinite(one.error_n);
    };
    if (std::ranges::any_of(all, &Candidate::within_jnd) || std::ranges::none_of(all, fitted)) return;
    const auto best = std::ranges::min_element(
        all, {}, [&](const Candidate& one) { return fitted(one) ? one.error_n : infinite; });
    choice_.taken = static_cast<std::size_t>(best - all.begin());
    const auto good = std::ranges::find_if(all, [&](const Candidate& one) {
      return fitted(one) && left_out(one.error_n, best->error_n) <= choice_.jnd_n;
    });
    choice_.as_good = static_cast<std::size_t>(good - all.begin());
    check_all_the_same(*best);
    if (good != best) check_all_the_same(*good);
  }

  /// A law that was passed over already.
  void check_all_the_same(Candidate& candidate) {
    const std::string before = std::move(candidate.why);
    candidate.why.clear();
    (void)passes_checks(candidate);
    candidate.why = candidate.why.empty() ? before : before + "; " + candidate.why;
    choice_.in_doubt = false;
  }

  void explain() {
    const std::vector<Candidate>& all = choice_.candidates;
    const std::string limit = fmt::format("the JND of {:.3g} N (at the root mean square force of {:.3g} N)",
                                          choice_.jnd_n, choice_.force_rms_n);
    if (!choice_.taken) {
      const auto within = std::ranges::count_if(all, &Candidate::within_jnd);
      choice_.why =
          within > 0
              ? fmt::format("none of the {} laws within {} holds its deadlines and is stable", within, limit)
              : "no law could be fitted";
      return;
    }
    const Candidate& taken = all[*choice_.taken];
    const std::string error =
        fmt::format("{:.3g} N on held-out data, {:.2g} JND", taken.error_n, taken.error_jnd);
    if (choice_.as_good) {
      choice_.why = fmt::format("none is within {}; the best is {} with {}", limit, taken.law.name, error);
      const Candidate& good = all[*choice_.as_good];
      if (&good == &taken) return;
      choice_.why += fmt::format(
          ". Against it {} with {} parameters leaves out {:.2g} JND, which nobody would feel beside the rest",
          good.law.name, good.law.parameters, left_out(good.error_n, taken.error_n) / choice_.jnd_n);
      return;
    }
    choice_.why = fmt::format("{} with {} parameters is the simplest law within {}: {}", taken.law.name,
                              taken.law.parameters, limit, error);
    if (*choice_.taken > 0)
      choice_.why += fmt::format("; {} as simple or simpler were passed over", *choice_.taken);
    if (choice_.in_doubt)
      choice_.why += fmt::format(". The machine was too late to tell whether it holds its deadlines: {}",
                                 taken.deadline->why);
  }

  void fit_with_intervals(Candidate& taken) const {
    if (options_.fit.intervals == fitting::Intervals::white) return;
    fitting::FitOptions settings = options_.fit;
    settings.folds = 0;
    settings.threads = options_.threads;
    RecordingFit fit = fit_of(taken.law, std::move(settings));
    if (fit.laws.empty()) return;
    fit.laws.front().result.cv_rmse = taken.fit->result.cv_rmse;
    taken.fit = std::move(fit.laws.front());
  }

  const schema::Recording& recording_;
  const ChooseOptions& options_;
  const std::atomic<bool>& stop_;
  LawChoice choice_;
  std::vector<models::Motion> motion_;
  double period_s_ = 1e-3;
  std::shared_ptr<fitting::SegmentedMemory> segmented_memory_;
};

}  // namespace

double left_out(double error_n, double better_n) noexcept {
  return error_n > better_n ? std::sqrt(error_n * error_n - better_n * better_n) : 0.0;
}

LawChoice choose_law(const schema::Recording& recording, const ChooseOptions& options,
                     const std::atomic<bool>& stop) {
  return Walk(recording, options, stop).make();
}

}  // namespace kerf::bench
