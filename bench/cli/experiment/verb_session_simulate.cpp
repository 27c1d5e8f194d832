#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>

#include <fmt/core.h>

#include "experiment/verb_session.h"
#include "felt/felt_gains.h"
#include "felt/felt_remarks.h"
#include "files/json_file.h"
#include "files/whole_file.h"
#include "files/whole_folder.h"
#include "observers/simulated_design.h"
#include "observers/simulation_report.h"
#include "program/progress.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

struct SessionSimulateVerbArguments {
  std::string protocol;
  std::string output;
  SimulationOptions simulation;
  std::string by = "asked";
  double jnd_percent = 7.0;
  double jnd_criterion_percent = 75.0;
  std::size_t trials = 0;
  std::optional<double> d_prime;
  std::size_t jobs = 0;
  bool peak = false;
  bool no_curve = false;
  bool replace = false;
};

SimulationOptions options_of(const SessionSimulateVerbArguments& arguments, const Context& context) {
  SimulationOptions options = arguments.simulation;
  options.observer.jnd = 0.01 * arguments.jnd_percent;
  options.observer.criterion = 0.01 * arguments.jnd_criterion_percent;
  if (arguments.by == "strength") options.sensation.by = ToldBy::strength;
  if (arguments.by == "difference") options.sensation.by = ToldBy::difference;
  if (arguments.peak) options.sensation.strength = Loudest::peak;
  options.sensation.d_prime = arguments.d_prime;
  if (arguments.no_curve) options.curve_points = 0;
  options.jobs = arguments.jobs > 0 ? arguments.jobs : std::max(1U, std::thread::hardware_concurrency());
  options.seed = context.seed;
  return options;
}

void warn_of_what_has_no_bearing(const Protocol& protocol, const SimulationOptions& options) {
  const Judging judging = judging_of(protocol);
  const bool by_distances = judging == Judging::abx_independent || judging == Judging::abx_differencing ||
                            judging == Judging::odd_one_out;
  const bool of_numbers = asks_numbers(protocol.design);
  if (options.observer.bias != 0.0 && (by_distances || of_numbers))
    warn(
        fmt::format("--bias has no bearing on '{}': its observers favour no slot", name_of(protocol.design)));
  if (options.sensation.d_prime && (has_levels(protocol.design) || protocol.design == Design::magnitude))
    warn(fmt::format("--d-prime has no bearing on '{}', whose answers follow what is rendered",
                     name_of(protocol.design)));
  if (options.catch_right && protocol.catches.every == 0)
    throw std::invalid_argument("--catch-right is of catch trials, and the protocol has no [catch]");
  if (options.observer.share_feeling < 1.0 && protocol.design == Design::magnitude)
    warn("--share-feeling has no bearing on 'magnitude': give some an exponent by --exponent-spread");
  if (options.observer.preference != 0.0 && of_numbers)
    warn(
        fmt::format("--preference has no bearing on '{}', which asks for numbers", name_of(protocol.design)));
  if (options.observer.preference != 0.0 && !of_numbers && judging != Judging::preference)
    warn(fmt::format("--preference has no bearing on '{}', where an answer is right",
                     name_of(protocol.design)));
}

void write_files(const SessionSimulateVerbArguments& arguments, const Simulation& simulation,
                 Context& context) {
  const fs::path folder = arguments.output;
  WholeFolder whole(folder, schema::existing_if(arguments.replace));
  write_whole_file(whole.path() / "simulate.html", simulation_page(simulation));
  write_json_file(whole.path() / "simulate.json", simulation_json(simulation));
  write_whole_file(whole.path() / "simulate.csv", simulation_csv(simulation));
  for (const Figure& figure : simulation_charts(simulation))
    write_whole_file(whole.path() / (figure.name + ".svg"), draw(figure.chart) + "\n");
  whole.commit();
  context.say(
      fmt::format("{}: the charts, and all numbers as JSON and CSV", (folder / "simulate.html").string()));
}

void run(const SessionSimulateVerbArguments& arguments, Context& context) {
  SimulationOptions options = options_of(arguments, context);
  Protocol protocol = protocol_to_simulate(arguments.protocol, options);
  if (arguments.trials > 0) protocol = with_trials(std::move(protocol), arguments.trials);
  const std::string& device = options.sensation.felt.device_uri;
  for (const std::string& remark : find_gains(protocol, device)) warn(remark);
  for (const std::string& remark : felt_remarks(protocol, device, SamplesTold::by_name)) warn(remark);
  warn_of_what_has_no_bearing(protocol, options);
  if (!arguments.output.empty()) {
    for (const char* file : {"simulate.html", "simulate.json", "simulate.csv"})
      require_output(fs::path(arguments.output) / file, arguments.replace);
  }
  Simulation simulation;
  {
    Progress progress("simulating " + protocol.name, simulated_experiments(protocol, options));
    simulation = simulate(protocol, options, progress.done);
  }
  for (const std::string& line : simulation_lines(simulation)) context.say(line);
  context.result = simulation_json(simulation);
  if (!arguments.output.empty()) write_files(arguments, simulation, context);
}

}  // namespace

void add_session_simulate(CLI::App& session, Context& context) {
  auto arguments = std::make_shared<SessionSimulateVerbArguments>();
  Verb verb = add_verb(
      session, context, "simulate", "Let simulated observers feel the laws: the power of a design",
      "kerf session simulate abx.protocol.toml --jnd 7 --subjects 12 -o power\n"
      "  kerf session simulate study/experiment.toml -o power\n\n"
      "The observers feel what the laws really render on a simulated device, limits included, and go\n"
      "through whole sessions, whose answers are analysed as real ones: how often is a difference\n"
      "found, how many trials does it take, do intervals cover the truth, are false alarms as rare as\n"
      "the test says. An experiment brings its number of participants, its test and its looks.",
      [arguments, &context] { run(*arguments, context); });
  verb.takes_laws(context);
  Observer& observer = arguments->simulation.observer;
  verb.add_option("PROTOCOL", arguments->protocol, "The protocol, NAME.protocol.toml, or an experiment")
      .required();
  verb.add_option("--jnd", arguments->jnd_percent, "The observers' JND of force [%]")
      .positive()
      .with_default();
  verb.add_option("--least-jnd", observer.least_jnd_n, "Smallest JND of force [N]").positive().with_default();
  verb.add_option("--jnd-criterion", arguments->jnd_criterion_percent,
                  "Share of right answers in two intervals one JND apart [%]")
      .with_default();
  verb.add_option("--lapse", observer.lapse, "Lapse rate: share of answers by chance")
      .within(0.0, 1.0)
      .with_default();
  verb.add_option(
          "--slips", observer.slip,
          "Share of the trials that are taken back before the answer ('slip' of the protocol's [trial])")
      .within(0.0, 0.99)
      .with_default();
  verb.add_option("--unexplored", observer.unexplored,
                  "Share of the other trials that are not felt as the protocol's 'explore' asks")
      .within(0.0, 0.99)
      .with_default();
  verb.add_option("--bias", observer.bias, "Response bias to the first slot [d']").with_default();
  verb.add_option("--spread", observer.spread, "Between subjects: standard deviation of ln(JND)")
      .not_negative()
      .with_default();
  verb.add_option("--preference-spread", observer.preference_spread,
                  "Between subjects: standard deviation of --preference [d']; of numbers of a taste for each "
                  "sample")
      .not_negative()
      .with_default();
  verb.add_option("--exponent", observer.exponent, "Of magnitudes: mean exponent of what is felt")
      .with_default();
  verb.add_option("--exponent-spread", observer.exponent_spread,
                  "Between subjects: standard deviation of the exponent")
      .not_negative()
      .with_default();
  verb.add_option("--number-noise", observer.number_noise, "Standard deviation of ln of a magnitude")
      .not_negative()
      .with_default();
  verb.add_option(
          "--modulus-spread", observer.modulus_spread,
          "Between subjects: standard deviation of ln of the size of magnitudes; of ratings where all of "
          "them lie [d']")
      .not_negative()
      .with_default();
  verb.add_option("--share-feeling", observer.share_feeling,
                  "Share of the subjects who feel any difference; the others guess")
      .within(0.0, 1.0)
      .with_default();
  verb.add_option("--inattentive", observer.share_inattentive, "Share of the subjects who do not attend")
      .within(0.0, 1.0)
      .with_default();
  verb.add_option("--inattention", observer.inattention,
                  "Share of the answers of those who do not attend that come by chance")
      .within(0.0, 1.0)
      .with_default();
  verb.add_option("--catch-right", arguments->simulation.catch_right,
                  "Leave out who has less than this share of the catch trials right (an experiment has its "
                  "own)")
      .within(0.0, 1.0);
  AnalysisOptions& analysis = arguments->simulation.analysis;
  verb.add_option("--margin", analysis.margin,
                  "How often a preference is shown to lie within 50 % +- this (default: not asked)")
      .within(0.001, 0.5);
  verb.add_option("--equal-below", analysis.d_prime_bound,
                  "How often d' is shown to lie below this (default: not asked)")
      .positive();
  verb.add_option("--preference", observer.preference,
                  "Of a preference: how much better the second of a pair is liked, if it is told apart [d']")
      .with_default();
  verb.add_option("--by", arguments->by,
                  "What renderings are told apart by: what the design asks for (levels by strength, all else "
                  "by difference), or always one of them")
      .one_of({"asked", "strength", "difference"})
      .with_default();
  verb.add_option("--d-prime", arguments->d_prime,
                  "Distance of all pairs of samples in d', whatever their laws render");
  verb.add_flag("--peak", arguments->peak, "Strength is the peak of the force, not its root mean square");
  verb.add_option("--subjects", arguments->simulation.subjects, "Subjects of each experiment").with_default();
  verb.add_option("--experiments", arguments->simulation.experiments, "Number of simulated experiments")
      .with_default();
  verb.add_option("--trials", arguments->trials, "Trials, in place of the protocol's");
  verb.add_option("--power", arguments->simulation.power, "Power for which the number of trials is found")
      .with_default();
  verb.add_uri("--device", arguments->simulation.sensation.felt.device_uri,
               "Simulated device that the laws are felt on (default: the protocol's)");
  verb.add_option("--seconds", arguments->simulation.sensation.felt.seconds,
                  "Duration of a rendering (default: the protocol's [motion])");
  verb.add_option("--renderings", arguments->simulation.sensation.felt.renderings,
                  "Number of renderings, each with other strokes of the simulated hand")
      .with_default();
  verb.add_flag("--open-loop", arguments->simulation.sensation.felt.open_loop,
                "Forces along the protocol's [motion], without a device");
  verb.add_option("-o,--output", arguments->output, "Folder for simulate.html, charts, JSON and CSV");
  verb.add_flag("--no-curve", arguments->no_curve, "Leave out the curve over numbers of trials");
  verb.add_option("--jobs", arguments->jobs, "Threads (default: one a processor)");
  verb.add_flag("--force", arguments->replace, "Replace existing files");
}

}  // namespace kerf::bench
