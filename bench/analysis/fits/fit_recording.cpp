#include "fits/fit_recording.h"

#include <algorithm>
#include <cmath>
#include <future>
#include <map>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <variant>

#include <fmt/core.h>

#include <kerf/fitting/checked_recordings.h>

#include "fits/fit_series.h"
#include "fits/law_options.h"
#include "fits/rendered_series.h"
#include "fits/row_doubts.h"
#include "recordings/provenance.h"
#include "segment/cycle_edit.h"
#include "signal/quantiles.h"
#include "threads/for_each_index.h"

namespace kerf::bench {
namespace {

constexpr double velocity_corner_rad_s = 10.0;  // [Okamura2003], section 2.2
constexpr double ramp_share = 0.05;             // of the 95th percentile of the speed
constexpr double reversal_share = 0.05;  // of the range of the penetration, until the full force is back

/// Recordings and their series, side by side.
struct Sources {
  std::span<const FitSource> all;
  std::vector<AxisSeries> series;
  std::vector<std::shared_future<RenderedSeries>> rendered;  ///< made beside what does not need it yet
  AxisSeries together;                                       ///< of several

  [[nodiscard]] const AxisSeries& pool() const { return series.size() == 1 ? series.front() : together; }
  [[nodiscard]] std::vector<fitting::Series> views() const {
    std::vector<fitting::Series> views;
    for (std::size_t i = 0; i < all.size(); ++i)
      views.push_back(fitted_view(series[i], all[i].noise_n, contact_error_of(all[i]).value_or(0.0)));
    return views;
  }
};

/// Where the rows lie that a law was fitted to.
std::optional<FittedRange> range_of(const AxisSeries& series) {
  std::optional<FittedRange> range;
  for (std::size_t row = 0; row < series.penetration.size(); ++row) {
    const double x = series.penetration[row];
    const double speed = std::abs(series.velocity[row]);
    if ((!series.counts.empty() && series.counts[row] == 0) || !std::isfinite(x) || !std::isfinite(speed))
      continue;
    if (!range) range = FittedRange{.least = x, .most = x, .fastest = speed};
    range->least = std::min(range->least, x);
    range->most = std::max(range->most, x);
    range->fastest = std::max(range->fastest, speed);
  }
  return range;
}

LawFile file_of(const fitting::FitResult& result, const Sources& sources, std::size_t at) {
  const FitSource& source = sources.all[at];
  const schema::Axis& axis = source.recording->axes[source.axis];
  std::vector<double> std_errors;
  for (const fitting::Estimate& estimate : result.parameters) {
    std_errors.push_back(estimate.std_error);
    for (const fitting::Estimate& other : result.others) {
      if (other.info.name == estimate.info.name && other.recording == at) std_errors.back() = other.std_error;
    }
  }
  const models::Law law = result.law(at);
  return {.law = models::Law::make(result.model, law.values(),
                                   with_rendering_aids(result.law_options, sources.pool())),
          .contact = source.contact,
          .axis = axis.name,
          .position_unit = axis.position_unit,
          .force_unit = axis.force_unit,
          .std_errors = std::move(std_errors),
          .fit = {.recording_uuid = source.recording->header.uuid,
                  .recording_sha256 = {},
                  .recording_content = {},
                  .rmse_n = result.rmse,
                  .date = schema::new_header("").created,
                  .software = software(),
                  .range = range_of(sources.series[at])}};
}

FittedLaw finished(fitting::FitResult result, const Sources& sources) {
  LawFile file = file_of(result, sources, 0);
  FittedLaw fitted{.result = std::move(result), .file = std::move(file), .others = {}};
  const auto differs = [&](const FitSource& source) {
    return source.contact.position != sources.all[0].contact.position ||
           source.contact.direction != sources.all[0].contact.direction;
  };
  const bool own =
      !fitted.result.others.empty() || std::any_of(sources.all.begin(), sources.all.end(), differs);
  for (std::size_t i = 1; own && i < sources.all.size(); ++i) {
    fitted.others.push_back(file_of(fitted.result, sources, i));
  }
  return fitted;
}

/// How far the fit of one law is; at the end of its scope all of it is done.
class LawProgress {
 public:
  LawProgress(std::atomic<std::size_t>* done, std::size_t parts) : done_(done), left_(parts) {}
  LawProgress(const LawProgress&) = delete;
  LawProgress& operator=(const LawProgress&) = delete;
  ~LawProgress() { add(left_); }
  /// By whichever thread.
  void part_done() {
    std::size_t left = left_;
    while (left > 0 && !left_.compare_exchange_weak(left, left - 1)) continue;
    if (left > 0) add(1);
  }

 private:
  void add(std::size_t parts) {
    if (done_ != nullptr) *done_ += parts;
  }

  std::atomic<std::size_t>* done_;
  std::atomic<std::size_t> left_;
};

/// Of a law: its fit, or why there is none; nothing where it was not asked for by name and is of another
/// axis.
using LawOutcome = std::variant<std::monostate, FittedLaw, Refusal>;

bool asked_for(const std::string& model, const FitRecordingOptions& options) {
  return options.models.empty() || std::ranges::find(options.models, model) != options.models.end();
}

bool fits_axis(const std::string& model, const schema::Axis& axis) {
  return units_fit(models::law_info(model), axis.position_unit, axis.force_unit);
}

/// @throws std::invalid_argument.
void check_units(const std::string& model, const schema::Axis& axis) {
  if (fits_axis(model, axis)) return;
  const models::LawInfo info = models::law_info(model);
  throw std::invalid_argument(fmt::format("its force is in {} over {}, and axis '{}' has {} over {}",
                                          info.force_unit, info.position_unit, axis.name, axis.force_unit,
                                          axis.position_unit));
}

/// One law cannot serve an angle and a length. @throws std::invalid_argument.
void check_same_units(std::span<const FitSource> sources) {
  const schema::Axis& first = sources[0].recording->axes[sources[0].axis];
  for (const FitSource& source : sources) {
    const schema::Axis& axis = source.recording->axes[source.axis];
    if (axis.position_unit == first.position_unit && axis.force_unit == first.force_unit) continue;
    throw std::invalid_argument(fmt::format("{}: axis '{}' has {} over {}, and that of {} has {} over {}",
                                            source.name, axis.name, axis.force_unit, axis.position_unit,
                                            sources[0].name, first.force_unit, first.position_unit));
  }
}

fitting::FitOptions options_for(const std::string& model, const FitRecordingOptions& options,
                                const fitting::FitOptions& settings, const Sources& sources) {
  fitting::FitOptions fit = settings;
  fit.render = [&sources](const models::Law& law, std::size_t recording) {
    const std::shared_future<RenderedSeries> rendered = sources.rendered[recording];  // threads ask at once
    return rendered.get().force(
        models::Law::make(law.model(), law.values(), with_rendering_aids(law.options(), sources.pool())));
  };
  for (const auto& [name, value] : options_of_law(model, options.law_options)) fit.law_options[name] = value;
  const models::LawFacts& facts = models::law_facts(model);
  if (facts.search == models::Search::segments)
    fit.law_options.try_emplace(std::string(facts.size.option), static_cast<double>(options.segments));
  for (const models::DataOption& option : facts.from_data) {
    if (option.from == models::From::contact)
      fit.law_options.try_emplace(std::string(option.name), sources.all[0].contact.position);
  }
  return fit;
}

/// Which rows count, and what is to be known of it.
CountedRows rows_that_count(AxisSeries& series, const FitSource& source, const std::string& whose,
                            RecordingFit& fit) {
  const std::size_t rows = series.force.size();
  CountedRows counted = mark_rows(source, fit.rows, fit.settings.jnd.threshold, series);
  if (2 * counted.contact < rows) {
    fit.warnings.push_back(
        fmt::format("{}{} of {} rows are out of contact: laws are fitted to and judged by the other {} alone "
                    "(--rows all takes all)",
                    whose, rows - counted.contact, rows, counted.contact));
  }
  if (const std::string left_out = cycles_left_out(counted); !left_out.empty())
    fit.warnings.push_back(whose + left_out);
  return counted;
}

/// Of which cycles a fit is.
std::string cycles_along(const FitSource& source) {
  const auto& cycles = source.recording->cycles;
  return cycles && cycles->axis == source.axis ? cycles_sha256_of(*source.recording) : "";
}

Sources sources_of(std::span<const FitSource> all, RecordingFit& fit) {
  Sources sources{.all = all, .series = {}, .rendered = {}, .together = {}};
  sources.series.reserve(all.size());
  const auto when = fit.settings.threads > 1 ? std::launch::async : std::launch::deferred;
  for (const FitSource& source : all) {
    sources.series.push_back(fit_series(*source.recording, source.axis, source.contact));
    const std::size_t left_out = sources.series.back().left_out;
    const std::string whose = all.size() > 1 ? source.name + ": " : "";
    CountedRows counted = rows_that_count(sources.series.back(), source, whose, fit);
    const std::size_t rows = source.recording->rows();
    if (source.taken) source.taken();
    sources.rendered.push_back(
        std::async(when, [&series = sources.series.back(), rate_hz = fit.loop_rate_hz] {
          return RenderedSeries(series, rate_hz);
        }));
    fit.recordings.push_back({.name = source.name,
                              .uuid = source.recording->header.uuid,
                              .cycles_sha256 = cycles_along(source),
                              .axis = source.recording->axes[source.axis].name,
                              .contact = source.contact,
                              .contact_error = contact_error_of(source),
                              .samples = rows,
                              .left_out = left_out,
                              .counted = counted.rows,
                              .cycles_left_out = std::move(counted.left_out),
                              .noise_n = source.noise_n});
    if (left_out > 0) fit.warnings.push_back(whose + rows_left_out(sources.series.back()));
    for (const std::string& doubt : doubts_of(sources.series.back(), fit.settings))
      fit.warnings.push_back(whose + doubt);
    if (const std::string unknown = contact_without_error(source);
        !unknown.empty() && fit.settings.intervals == fitting::Intervals::correlated)
      fit.warnings.push_back(whose + unknown);
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t k = i + 1; k < all.size(); ++k) {
      if (sources.series[i].time_s == sources.series[k].time_s &&
          sources.series[i].force == sources.series[k].force)
        fit.warnings.push_back(
            fmt::format("{} and {} hold the same rows, which count twice: intervals are too narrow",
                        all[i].name, all[k].name));
    }
  }
  if (all.size() > 1) sources.together = pooled(sources.series);
  return sources;
}

/// The fits of all laws, with information criteria by one number of independent samples.
std::vector<fitting::FitResult> weighed_alike(std::vector<FittedLaw>& laws) {
  double independent = 0.0;
  for (const FittedLaw& law : laws) independent = std::max(independent, law.result.effective_samples);
  std::vector<fitting::FitResult> results;
  for (FittedLaw& law : laws) {
    law.result.weigh_information(independent);
    results.push_back(law.result);
  }
  return results;
}

}  // namespace

models::Options with_rendering_aids(models::Options options, const AxisSeries& series) {
  const auto loop = options.find("loop");
  if (loop == options.end() || !std::get<bool>(loop->second)) return options;
  std::vector<double> speeds;
  for (const double velocity : series.velocity) speeds.push_back(std::abs(velocity));
  const auto [least, most] = std::minmax_element(series.penetration.begin(), series.penetration.end());
  options["velocity_corner"] = velocity_corner_rad_s;
  options["ramp_band"] = ramp_share * quantile(std::move(speeds), 0.95);
  options["reversal_scale"] = 1.0 / (reversal_share * (*most - *least));
  return options;
}

std::size_t RecordingFit::samples() const {
  return std::accumulate(recordings.begin(), recordings.end(), std::size_t{0},
                         [](std::size_t sum, const auto& one) { return sum + one.samples; });
}

std::string RecordingFit::blame(const FittedLaw& law) const {
  if (!floor) return "";
  return fitting::blame(law.result.held_out_rmse(), law.result.cv_rmse, *floor, jnd_n);
}

std::string RecordingFit::refusal() const {
  const bool one_reason = laws.empty() && !refusals.empty() &&
                          std::all_of(refusals.begin(), refusals.end(),
                                      [&](const Refusal& other) { return other.why == refusals[0].why; });
  return one_reason ? refusals[0].why : "";
}

std::vector<std::string> usual_laws() {
  std::multimap<int, std::string> usual;
  for (const models::LawInfo& law : models::registry()) {
    if (const int place = models::law_facts(law.name).usual; place > 0) usual.emplace(place, law.name);
  }
  std::vector<std::string> names;
  for (const auto& [place, name] : usual) names.push_back(name);
  return names;
}

std::vector<std::string> models_of(const FitRecordingOptions& options) {
  if (options.models.empty()) return usual_laws();
  std::vector<std::string> models;
  const auto add = [&](std::string_view model) {
    if (std::find(models.begin(), models.end(), model) == models.end()) models.emplace_back(model);
  };
  for (const std::string& model : options.models) {
    if (model != "all") add(model);
    for (const std::string_view one : fitting::fitted_laws()) {
      if (model == "all") add(one);
    }
  }
  return models;
}

std::size_t steps_of(const FitRecordingOptions& options) {
  return models_of(options).size() * fitting::parts_of_a_fit(options.fit) + 1;
}

RecordingFit fit_recordings(std::span<const FitSource> all, const FitRecordingOptions& options) {
  if (all.empty()) throw std::invalid_argument("there is no recording to fit");
  check_same_units(all);
  const auto models = models_of(options);
  for (const std::string& model : models) fitting::check_model(model);  // a mistake of the caller
  check_law_options(models, options.law_options);
  const schema::Axis& axis = all[0].recording->axes[all[0].axis];
  RecordingFit fit{.recordings = {}, .choice = {}, .settings = options.fit};
  fit.settings.part_done = {};  // what it calls need not outlive the fit
  fit.rows = options.rows;
  fit.loop_rate_hz = options.loop_rate_hz;
  fit.settings.force_unit = axis.force_unit;
  const Sources sources = sources_of(all, fit);
  const bool beside = options.floor && options.fit.threads > 1;
  std::optional<fitting::CheckedRecordings> checked;
  std::future<fitting::Floor> floor;
  std::string why_not;
  try {
    checked.emplace(sources.views(), fit.settings);
    floor = std::async(beside ? std::launch::async : std::launch::deferred,
                       [&checked] { return fitting::floor_of(*checked); });
  } catch (const std::invalid_argument& error) {
    why_not = error.what();
  }
  const auto fit_law = [&](const std::string& model) -> LawOutcome {
    if (options.stop != nullptr && *options.stop)
      throw std::system_error(std::make_error_code(std::errc::interrupted), "not all laws were fitted");
    LawProgress progress(options.done, fitting::parts_of_a_fit(options.fit));
    if (!asked_for(model, options) && !fits_axis(model, axis)) return {};
    try {
      check_units(model, axis);
      if (!checked) throw std::invalid_argument(why_not);
      fitting::FitOptions of_law = options_for(model, options, fit.settings, sources);
      of_law.part_done = [&] {
        progress.part_done();
        if (options.fit.part_done) options.fit.part_done();
      };
      fitting::FitResult result = fitting::fit(model, *checked, of_law);
      if (result.parameters.empty()) throw std::invalid_argument(result.message);
      return finished(std::move(result), sources);
    } catch (const std::invalid_argument& error) {
      return Refusal{.model = model, .why = error.what()};
    }
  };
  // Beside each other while there is room, since each takes memory for every sample; from the last on, which
  // take longest.
  constexpr std::size_t most_samples_beside = 250'000;
  const std::size_t beside_each_other = fit.samples() <= most_samples_beside ? options.fit.threads : 1;
  std::vector<LawOutcome> found(models.size());
  for_each_index(models.size(), beside_each_other, [&](std::size_t i) {
    const std::size_t law = beside_each_other > 1 ? models.size() - 1 - i : i;
    found[law] = fit_law(models[law]);
  });
  for (LawOutcome& one : found) {
    if (auto* law = std::get_if<FittedLaw>(&one)) fit.laws.push_back(std::move(*law));
    if (auto* refusal = std::get_if<Refusal>(&one)) fit.refusals.push_back(std::move(*refusal));
  }
  if (fit.laws.empty()) return fit;
  const fitting::Series pool = fitted_view(sources.pool());
  fit.line_rmse_n = fitting::line_rmse(pool);
  fit.line_cv_rmse_n = fitting::held_out_line_rmse(*checked);
  fit.jnd_n = options.fit.jnd.at(fitting::rms_of(pool));
  if (options.floor) {
    fit.floor = floor.get();
    for (const FittedLaw& law : fit.laws) fit.floor->lower_to(law.result.cv_rmse);
  }
  fit.choice = fitting::choose_simplest(weighed_alike(fit.laws), pool, fit.settings, fit.line_cv_rmse_n);
  if (options.done != nullptr) *options.done = steps_of(options);
  return fit;
}

RecordingFit fit_recording(const schema::Recording& recording, const FitRecordingOptions& options) {
  if (options.axis >= recording.dimensions()) throw std::invalid_argument("the recording has no such axis");
  const FitSource source{.recording = &recording,
                         .name = "recording",
                         .axis = options.axis,
                         .contact = options.contact.value_or(contact_of(recording, options.axis))};
  return fit_recordings(std::span(&source, 1), options);
}

}  // namespace kerf::bench
