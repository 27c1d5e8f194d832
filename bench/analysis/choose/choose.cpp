#include "choose/choose.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "chart/cost/tick_cost.h"
#include "chart/cost/timed_stretch.h"
#include "fits/fit_series.h"
#include "fits/row_doubts.h"
#include "recordings/axis_series.h"
#include "threads/for_each_index.h"

namespace kerf::bench {
namespace {

constexpr std::size_t timing_rounds = 9;
constexpr double timing_s = 0.01;  // a law, at most: laws are told apart by whole microseconds

/// A choice while it is made.
class LawSelection {
 public:
  LawSelection(const schema::Recording& recording, const ChooseOptions& options,
               const std::atomic<bool>& stop)
      : recording_(recording),
        options_(options),
        stop_(stop),
        search_(choice_, options.search, recording, stop) {
    if (options.axis >= recording.dimensions()) throw std::invalid_argument("the recording has no such axis");
    if (options.fit.folds < 2)
      throw std::invalid_argument("a law is chosen by held-out data: at least 2 folds are needed");
    choice_.settings = options.fit;
    choice_.force_unit = recording.axes[options.axis].force_unit;
    choice_.contact = options.contact.value_or(contact_of(recording, options.axis));
    if (options.richer_too)
      memory_ = fitting::remember_segments(options.candidates.max_segments, options.fit.points_per_segment);
    AxisSeries series = fit_series(recording, options.axis, choice_.contact);
    if (series.force.empty()) throw std::invalid_argument("the recording has no row that is finite");
    const std::size_t cycles = count_rows(series);
    measure(series);
    describe_folds(cycles);
    const schema::Axis& axis = recording.axes[options.axis];
    for (CandidateLaw& law : candidates_for(axis, cycles > 0, options.candidates)) {
      choice_.candidates.emplace_back();
      choice_.candidates.back().law = std::move(law);
    }
  }

  LawChoice select() {
    std::vector<Candidate>& all = choice_.candidates;
    if (options_.of != nullptr) *options_.of = all.size();
    if (options_.richer_too) fit_all(all);
    std::size_t begin = 0;
    while (begin < all.size() && !(choice_.taken && !options_.richer_too)) {
      const std::size_t end = search_.end_of_group(begin);
      const auto group = std::span(all).subspan(begin, end - begin);
      if (!options_.richer_too) fit_all(group);
      time(group);
      search_.search_group(begin, end);
      begin = end;
    }
    all.resize(begin);
    if (std::ranges::none_of(all, [](const Candidate& one) { return one.file.has_value(); }))
      throw std::invalid_argument(all.empty() ? "no law fits the axis" : all.front().why);
    choice_.effects = judge_effects(all, choice_.taken, choice_.jnd_n);
    take_what_all_say(all);
    search_.finish();
    if (choice_.taken) {
      for (const Candidate& one : all) choice_.floor->lower_to(one.fitted_n);
      const Candidate& taken = all[*choice_.taken];
      choice_.blame = fitting::blame(taken.error_n, taken.fitted_n, *choice_.floor, choice_.jnd_n);
      fit_thoroughly(all[*choice_.taken]);
    }
    return std::move(choice_);
  }

 private:
  /// What a tick of each costs in the loop.
  void time(std::span<Candidate> group) const {
    if (!options_.time_ticks) return;
    std::vector<TimedLaw> timed;
    for (const Candidate& one : group) {
      if (one.file) timed.push_back({LawRendering(one.file->law, {}, {0}), &path_});
    }
    const std::vector<TickCost> costs =
        tick_costs(timed, {.rounds = timing_rounds, .cold_ticks = 0, .max_seconds = timing_s});
    auto cost = costs.begin();
    for (Candidate& one : group) {
      if (one.file) one.tick_us = 1e-3 * (cost++)->p50_ns;
    }
  }

  /// Marks the rows that count; returns how many cycles do.
  std::size_t count_rows(AxisSeries& series) {
    const double felt = options_.fit.jnd.threshold;
    const FitSource source{
        .recording = &recording_, .name = "", .axis = options_.axis, .contact = choice_.contact};
    const CountedRows counted = mark_rows(source, options_.rows, felt, series);  // as each fit does
    rows_ = {.rows = options_.rows.rows,
             .cycles = counted.none_is_good ? CycleChoice{.by = CycleChoice::By::all}
                                            : settled(options_.rows.cycles, recording_, options_.axis, felt)};
    choice_.rows = options_.rows;
    choice_.cycles_left_out = counted.left_out;
    const std::size_t rows = series.force.size();
    if (2 * counted.contact < rows) {
      choice_.warnings.push_back(
          fmt::format("{} of {} rows are out of contact and do not count (--rows all takes all)",
                      rows - counted.contact, rows));
    }
    if (std::string left_out = cycles_left_out(counted); !left_out.empty())
      choice_.warnings.push_back(std::move(left_out));
    return counted.cycles - counted.left_out.size();
  }

  void measure(const AxisSeries& series) {
    const fitting::Series view = fitted_view(series);
    choice_.force_rms_n = fitting::rms_of(view);
    choice_.floor = fitting::floor_of(std::span(&view, 1), options_.fit);
    choice_.jnd_n = options_.fit.jnd.at(choice_.force_rms_n);
    if (choice_.force_rms_n <= choice_.jnd_n)
      throw std::invalid_argument(
          fmt::format("no force at all is within the JND of {:.3g} {} too, at a root mean square force of "
                      "{:.3g} {}: there is nothing to choose by (--threshold sets another JND)",
                      choice_.jnd_n, choice_.force_unit, choice_.force_rms_n, choice_.force_unit));
    const double duration_s = series.time_s.back() - series.time_s.front();
    const auto periods = static_cast<double>(std::max<std::size_t>(series.time_s.size() - 1, 1));
    path_ = timed_stretch(series, std::max(1e-6, duration_s / periods));
  }

  void describe_folds(std::size_t cycles) {
    const std::size_t folds = options_.fit.folds;
    if (cycles >= 2) {
      choice_.held_out = fmt::format("{} cycles, held out in {} folds", cycles, std::min(folds, cycles));
      return;
    }
    choice_.held_out = fmt::format("{} folds of blocks of time, held out by turns", folds);
    if (cycles > 0) return;
    choice_.warnings.emplace_back(
        "the recording has no cycles along this axis: errors are held out by blocks of time, and laws with a "
        "branch for each direction are left out; 'kerf segment' finds cycles");
  }

  [[nodiscard]] RecordingFit fit_of(const CandidateLaw& law, fitting::FitOptions settings) const {
    return fit_recording(recording_, {.models = {law.model},
                                      .axis = options_.axis,
                                      .contact = choice_.contact,
                                      .law_options = law.law_options,
                                      .rows = rows_,
                                      .loop_rate_hz = options_.loop_rate_hz,
                                      .floor = false,
                                      .fit = std::move(settings)});
  }

  void fit_one(Candidate& candidate, std::size_t threads) const {
    fitting::FitOptions settings = options_.fit;
    settings.threads = threads;
    settings.intervals = fitting::Intervals::white;  // the law that is taken is found anew
    settings.brief = true;
    settings.profile = false;
    settings.segmented_memory = memory_;
    RecordingFit fit = fit_of(candidate.law, std::move(settings));
    if (fit.laws.empty()) {
      candidate.why = fit.refusals.empty() ? "it could not be fitted" : fit.refusals.front().why;
      return;
    }
    candidate.file = fit.laws.front().file;
    candidate.fit = std::move(fit.laws.front());
    const fitting::FitResult& result = candidate.fit->result;
    candidate.converged = result.converged;
    if (!result.converged) candidate.why = fmt::format("its fit did not converge: {}", result.message);
    if (std::isfinite(result.held_out_rmse())) candidate.error_n = result.held_out_rmse();
    candidate.fitted_n = result.cv_rmse;
    candidate.error_jnd = candidate.error_n / choice_.jnd_n;
    if (result.converged && !result.can_be_chosen())
      candidate.why =
          result.is_felt_in_free_air()
              ? fmt::format("it is felt where the tool is free, in {:.0f} % of the rows without a force",
                            100.0 * result.free_fraction)
              : fmt::format("it fits worse than the mean of the force does (R2 {:.2g})", result.r2);
    candidate.within_jnd = result.can_be_chosen() && candidate.error_n <= choice_.jnd_n;
  }

  /// What every law is warned of is of the recording.
  void take_what_all_say(const std::vector<Candidate>& all) {
    std::optional<std::vector<std::string>> said;
    std::size_t fitted = 0;
    for (const Candidate& one : all) {
      if (!one.fit) continue;
      ++fitted;
      const std::vector<std::string>& own = one.fit->result.warnings;
      if (!said) said = own;
      std::erase_if(*said,
                    [&](const std::string& text) { return std::ranges::find(own, text) == own.end(); });
    }
    if (fitted > 1) choice_.warnings.insert(choice_.warnings.end(), said->begin(), said->end());
  }

  /// Laws that find the same segments, by what they are but for the number of these.
  [[nodiscard]] static std::vector<std::string> segments_of(const CandidateLaw& law) {
    const models::LawFacts& facts = models::law_facts(law.model);
    if (facts.search != models::Search::segments) return {};
    std::vector<std::string> same{law.model};
    std::ranges::remove_copy_if(law.law_options, std::back_inserter(same), [&](const std::string& option) {
      return option.starts_with(fmt::format("{}=", facts.size.option));
    });
    return same;
  }

  /// The richest first: they take longest. Of laws that find the same segments all but the richest wait for
  /// it, and have less to do then; its folds are shared out among the threads.
  void fit_all(std::span<Candidate> candidates) const {
    std::vector<std::size_t> first, at_once, later;
    std::set<std::vector<std::string>> found;
    for (std::size_t i = candidates.size(); i-- > 0;) {
      const std::vector<std::string> segments = segments_of(candidates[i].law);
      const bool finds = memory_ && !segments.empty();
      (!finds ? at_once : found.insert(segments).second ? first : later).push_back(i);
    }
    const std::size_t finders = first.size();
    first.insert(first.end(), at_once.begin(), at_once.end());
    const auto fit = [&](std::span<const std::size_t> part, std::size_t sharing) {
      for_each_index(part.size(), options_.threads, [&](std::size_t i) {
        if (stop_) return;
        fit_one(candidates[part[i]], i < sharing ? options_.threads : 1);
        if (options_.done != nullptr) ++*options_.done;
      });
    };
    fit(first, finders);
    fit(later, 0);
    search_.end_if_stopped();
  }

  void fit_thoroughly(Candidate& taken) const {
    fitting::FitOptions settings = options_.fit;
    settings.folds = 0;
    settings.threads = options_.threads;
    settings.segmented_memory = memory_;
    RecordingFit fit = fit_of(taken.law, std::move(settings));
    if (fit.laws.empty()) return;
    fit.laws.front().result.cv_rmse = taken.fit->result.cv_rmse;
    fit.laws.front().result.cv_std_error = taken.fit->result.cv_std_error;
    fit.laws.front().result.cv_folds = taken.fit->result.cv_folds;
    fit.laws.front().result.rendered = taken.fit->result.rendered;
    taken.file = fit.laws.front().file;
    taken.fit = std::move(fit.laws.front());
  }

  const schema::Recording& recording_;
  const ChooseOptions& options_;
  const std::atomic<bool>& stop_;
  LawChoice choice_;
  CandidateSearch search_;
  RowChoice rows_;      ///< with its cycles by number
  SampledMotion path_;  ///< that laws are timed along
  std::shared_ptr<fitting::SegmentedMemory> memory_;
};

}  // namespace

LawChoice choose_law(const schema::Recording& recording, const ChooseOptions& options,
                     const std::atomic<bool>& stop) {
  return LawSelection(recording, options, stop).select();
}

}  // namespace kerf::bench
