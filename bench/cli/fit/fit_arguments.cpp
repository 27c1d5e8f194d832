#include "fit/fit_arguments.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "fits/law_options.h"
#include "recordings/axes.h"
#include "report/charts.h"
#include "units/units.h"

namespace kerf::bench {
namespace {

constexpr std::size_t max_segments = 16;

struct Segments {
  fitting::CountBy by = fitting::CountBy::given;
  std::size_t count = 5;
};

Segments parse_segments(const std::string& text) {
  if (text == "bic") return {.by = fitting::CountBy::bic};
  if (text == "jnd") return {.by = fitting::CountBy::jnd};
  std::size_t count = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  if (error != std::errc() || end != text.data() + text.size() || count < 1 || count > max_segments) {
    throw std::invalid_argument(
        fmt::format("--segments: '{}' is not a number from 1 to {}, bic or jnd", text, max_segments));
  }
  return {.count = count};
}

fitting::Loss loss_of(const std::string& name) {
  if (name == "huber") return fitting::Loss::huber;
  if (name == "soft_l1") return fitting::Loss::soft_l1;
  if (name == "cauchy") return fitting::Loss::cauchy;
  return fitting::Loss::squares;
}

/// "7.5" in the unit that charts show, or "7.5mm".
double position_of(const std::string& text, const schema::Axis& axis) {
  double value = 0.0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || !std::isfinite(value)) {
    throw std::invalid_argument(
        fmt::format("--breakpoints: '{}' is not a position, for example 7.5 or 7.5mm", text));
  }
  if (rest == end) return value / drawn_position(axis).factor;
  const Unit unit = parse_unit(std::string(rest, end));
  if (unit.si == axis.position_unit) return value * unit.factor;
  throw std::invalid_argument(fmt::format("--breakpoints: '{}' is in {}, and axis '{}' is in {}", text,
                                          unit.si, axis.name, axis.position_unit));
}

/// Positions on the axis as penetrations, in order.
std::vector<double> breakpoints_of(const FitArguments& arguments, const FitSource& source) {
  std::vector<double> penetrations;
  for (const std::string& text : arguments.breakpoints) {
    const double position = position_of(text, source.recording->axes[source.axis]);
    penetrations.push_back(source.contact.motion(position, 0.0).penetration);
  }
  std::sort(penetrations.begin(), penetrations.end());
  return penetrations;
}

std::vector<std::string> law_options_of(const FitArguments& arguments) {
  std::vector<std::string> all;
  if (arguments.arms > 0) all.push_back(fmt::format("arms={}", arguments.arms));
  if (arguments.memberships > 0) all.push_back(fmt::format("memberships={}", arguments.memberships));
  if (arguments.thickness) all.push_back(fmt::format("thickness={}", *arguments.thickness));
  all.insert(all.end(), arguments.options.law_options.begin(), arguments.options.law_options.end());
  return all;
}

void add_law_options(Verb& verb, FitArguments& arguments) {
  verb.add_option("--models", arguments.options.models,
                  fmt::format("Laws, separated by commas, or all whose units fit the axis (default: {})",
                              fmt::join(usual_laws(), ", ")))
      .separated_by(',')
      .one_value_each();
  verb.add_option("--segments", arguments.segments,
                  "Segments of the piecewise law: a number from 1 to 16, bic (least BIC) or jnd (the fewest "
                  "within the force JND)")
      .with_default();
  verb.add_option("--points-per-segment", arguments.options.fit.points_per_segment,
                  "Fewest samples in a segment of the piecewise law, on each branch")
      .within(1, 1'000'000)
      .with_default();
  verb.add_option("--breakpoints", arguments.breakpoints,
                  "Inner breakpoints of the piecewise law by hand, 3,7.5,12: positions on the axis as charts "
                  "show them, in mm or degrees, or with a unit (0.3cm)")
      .separated_by(',')
      .one_value_each();
  verb.add_option("--arms", arguments.arms,
                  "Arms of the Maxwell law (default: as many as lower the held-out error)")
      .within(1, 6);
  verb.add_option("--memberships", arguments.memberships, "Memberships of the fuzzy laws, for each input")
      .within(1, 5);
  verb.add_option("--thickness", arguments.thickness,
                  "Thickness of the sample, for the exponential and the fracture law [m or rad]")
      .positive();
  verb.add_option("--option", arguments.options.law_options,
                  "NAME=VALUE: an option of the laws that have it ('kerf laws NAME' lists them); repeatable")
      .one_value_each();
}

void add_data_options(Verb& verb, FitArguments& arguments) {
  verb.add_option("--axis", arguments.axis, "Axis to fit (default: the first)");
  add_contact_options(verb, arguments.contact, "from the recording");
  verb.add_option("--rows", arguments.rows, "Rows that laws are fitted to and judged by")
      .one_of({"contact", "all"})
      .with_default();
  verb.add_option(
          "--cycles", arguments.cycles,
          "Cycles that laws are fitted to and judged by: good (without a flag of 'kerf inspect'), all, or "
          "a list: 2-8,10")
      .with_default();
  verb.add_option("--rate", arguments.options.loop_rate_hz,
                  "Rate of the loop that errors as rendered are of [Hz]")
      .within(100.0, 10000.0)
      .with_default();
  verb.add_option("--noise", arguments.noise,
                  "Standard deviation of the force's noise, one or one a recording [N] (default: estimated)")
      .separated_by(',')
      .one_value_each()
      .positive();
  verb.add_option("--per-recording", arguments.options.fit.per_recording,
                  "Parameters that each of several recordings has of its own, separated by commas")
      .separated_by(',')
      .one_value_each();
}

void add_estimation_options(Verb& verb, FitArguments& arguments) {
  fitting::FitOptions& fit = arguments.options.fit;
  verb.add_option("--folds", fit.folds, "Folds of the cross-validation, by cycle or by blocks of time")
      .within(2, 100)
      .with_default();
  verb.add_flag("--no-folds", arguments.no_folds, "No cross-validation");
  verb.add_option("--test-share", fit.test_share,
                  "Last share of the cycles, or of the time, that no fit sees and each is tested on")
      .within(0.0, 0.9)
      .with_default();
  verb.add_option("--loss", arguments.loss, "Loss function of the residuals")
      .one_of({"squares", "huber", "soft_l1", "cauchy"})
      .with_default();
  verb.add_option("--loss-scale", fit.loss_scale_n,
                  "Scale of a robust loss: the residual above which it grows more slowly [N] (default: 1.345 "
                  "robust standard "
                  "deviations)")
      .positive();
  verb.add_option("--confidence", fit.confidence, "Confidence of the intervals")
      .within(0.5, 0.9999)
      .with_default();
  verb.add_flag("--profile", fit.profile, "Also intervals from the profile of the sum of squares");
  add_jnd_options(verb, arguments.jnd);
}

}  // namespace

void add_fit_options(Verb& verb, FitArguments& arguments) {
  verb.add_option("RECORDING", arguments.recordings,
                  "Recordings; several are fitted at once and share their parameters");
  verb.add_option("-o,--output", arguments.output, "Folder for law files, fit.json and fit.csv").required();
  verb.add_option("--batch", arguments.batch,
                  "Fit every recording (*.h5) of a folder and of those in it, each by itself");
  verb.add_option("--jobs", arguments.jobs, "Recordings of a batch at a time (default: one a processor)")
      .within(1, 1024);
  add_law_options(verb, arguments);
  add_data_options(verb, arguments);
  add_estimation_options(verb, arguments);
  verb.add_flag("--force", arguments.force, "Replace an existing fit");
}

void check(const FitArguments& arguments) {
  const bool batch = !arguments.batch.empty();
  const std::size_t count = arguments.recordings.size();
  const auto refuse = [](const std::string& reason) { throw std::invalid_argument(reason); };
  if (batch && count > 0) refuse("--batch takes a folder; name recordings without it");
  if (!batch && count == 0) refuse("name a recording to fit, or a folder of them with --batch");
  if (!batch && arguments.jobs > 0) refuse("--jobs needs --batch");
  if (arguments.noise.size() > 1 && arguments.noise.size() != count) {
    refuse(fmt::format("--noise: {} values for {} recordings; give one, or one a recording",
                       arguments.noise.size(), batch ? "a batch of" : std::to_string(count)));
  }
  if (!arguments.options.fit.per_recording.empty() && count < 2)
    refuse("--per-recording needs several recordings in one fit");
  if (arguments.options.fit.loss_scale_n > 0.0 && arguments.loss == "squares")
    refuse("--loss-scale needs a robust --loss: huber, soft_l1 or cauchy");
  (void)parse_segments(arguments.segments);
  const auto models = models_of(arguments.options);
  for (const std::string& model : models) fitting::check_model(model);
  check_law_options(models, law_options_of(arguments));
}

FitSource source_of(const FitArguments& arguments, const schema::Recording& recording,
                    const std::string& name, std::size_t place) {
  FitSource source{.recording = &recording, .name = name, .axis = find_axis(recording, arguments.axis)};
  source.contact = arguments.contact.over(contact_of(recording, source.axis));
  const auto& noise = arguments.noise;
  if (!noise.empty()) source.noise_n = noise.size() == 1 ? noise.front() : noise.at(place);
  return source;
}

FitRecordingOptions options_of(const FitArguments& arguments, const FitSource& source) {
  FitRecordingOptions options = arguments.options;
  const Segments segments = parse_segments(arguments.segments);
  options.segments = segments.count;
  options.fit.segments = segments.by;
  options.fit.breakpoints = breakpoints_of(arguments, source);
  options.fit.loss = loss_of(arguments.loss);
  if (arguments.no_folds) options.fit.folds = 0;
  options.rows = {.rows = arguments.rows == "all" ? Counted::all : Counted::contact,
                  .cycles = parse_cycle_choice(arguments.cycles)};
  arguments.jnd.put_into(options.fit, source.recording->axes[source.axis]);
  options.law_options = law_options_of(arguments);
  return options;
}

}  // namespace kerf::bench
