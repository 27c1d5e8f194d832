#include "fit/fit_arguments.h"

#include <stdexcept>

#include <fmt/format.h>

#include "program/contact_arguments.h"
#include "program/jnd_arguments.h"

namespace kerf::bench {
namespace {

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
      .within(AskedFit::most_points.lower, AskedFit::most_points.upper)
      .with_default();
  verb.add_option("--breakpoints", arguments.breakpoints,
                  "Inner breakpoints of the piecewise law by hand, 3,7.5,12: positions on the axis as charts "
                  "show them, in mm or degrees, or with a unit (0.3cm)")
      .separated_by(',')
      .one_value_each();
  verb.add_option("--arms", arguments.arms,
                  "Arms of the Maxwell law (default: as many as lower the held-out error)")
      .within(AskedFit::most_arms.lower, AskedFit::most_arms.upper);
  verb.add_option("--memberships", arguments.memberships, "Memberships of the fuzzy laws, for each input")
      .within(AskedFit::most_memberships.lower, AskedFit::most_memberships.upper);
  verb.add_option("--thickness", arguments.thickness,
                  "Thickness of the sample, for the exponential and the fracture law [m or rad]")
      .positive();
  verb.add_option("--option", arguments.options.law_options,
                  "NAME=VALUE: an option of the laws that have it ('kerf laws NAME' lists them); repeatable")
      .one_value_each();
}

void add_data_options(Verb& verb, FitArguments& arguments) {
  verb.add_option("--axis", arguments.axis, "Axis to fit (default: that of the cycles, or the first)");
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
      .within(AskedFit::rates_hz.lower, AskedFit::rates_hz.upper)
      .with_default();
  verb.add_option("--noise", arguments.noise,
                  "Standard deviation of the force's noise, one or, between commas, one a recording [N] "
                  "(default: estimated)")
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
      .within(AskedFit::most_folds.lower, AskedFit::most_folds.upper)
      .with_default();
  verb.add_flag("--no-folds", arguments.no_folds, "No cross-validation");
  verb.add_option("--test-share", fit.test_share,
                  "Last share of the cycles, or of the time, that no fit sees and each is tested on")
      .within(AskedFit::test_shares.lower, AskedFit::test_shares.upper)
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
      .within(AskedFit::confidences.lower, AskedFit::confidences.upper)
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
  arguments.refuse_idle = verb.refuses_idle();
}

void check(const FitArguments& arguments) {
  const bool batch = !arguments.batch.empty();
  const std::size_t count = arguments.recordings.size();
  const auto refuse = [](const std::string& reason) { throw std::invalid_argument(reason); };
  if (batch && count > 0) refuse("--batch takes a folder; name recordings without it");
  if (!batch && count == 0) refuse("name a recording to fit, or a folder of them with --batch");
  if (!batch && arguments.jobs > 0) refuse("--jobs needs --batch");
  check(arguments, count);
  if (arguments.no_folds) arguments.refuse_idle({"--folds"}, "a fit without folds", "leave out --no-folds");
  if (!arguments.breakpoints.empty())
    arguments.refuse_idle({"--segments", "--points-per-segment"}, "breakpoints that are given",
                          "leave out --breakpoints");
  if (!arguments.fits_segments())
    arguments.refuse_idle({"--segments", "--points-per-segment"}, "the laws that are fitted",
                          "it is for piecewise");
}

}  // namespace kerf::bench
