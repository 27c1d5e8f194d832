#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "files/whole_file.h"
#include "prepare/prepare.h"
#include "prepare/rows.h"
#include "program/verbs.h"
#include "recordings/provenance.h"
#include "report/filter_charts.h"
#include "tables/json_number.h"

namespace kerf::bench {
namespace {

using nlohmann::ordered_json;

struct PrepareVerbArguments {
  std::string recording;
  std::string output;
  std::string free;
  std::string cycles;
  std::string filter;
  std::string filter_chart;
  std::string frame = "sensor";
  std::string labels;
  std::vector<double> centre;
  bool causal = false;
  bool force = false;
  PrepareOptions options;
};

ordered_json to_json(const Weight& weight) {
  return {{"mass_kg", weight.mass_kg},
          {"mass_error_kg", weight.mass_error_kg},
          {"centre_m", weight.centre_m},
          {"centre_error_m", weight.centre_error_m},
          {"force_bias_n", weight.force_bias_n},
          {"torque_bias_nm", weight.torque_bias_nm},
          {"estimated", weight.estimated},
          {"rows", weight.rows},
          {"condition", weight.condition},
          {"tilt_deg", weight.tilt_deg},
          {"force_noise_n", weight.force_noise_n}};
}

ordered_json to_json(const Bias& bias) {
  ordered_json axes = ordered_json::array();
  for (const AxisBias& axis : bias.axes) {
    axes.push_back({{"axis", axis.axis},
                    {"unit", axis.unit},
                    {"offset", axis.offset},
                    {"offset_error", axis.offset_error},
                    {"drift_per_minute", axis.drift_per_minute},
                    {"drift_per_minute_error", axis.drift_per_minute_error},
                    {"noise", axis.noise},
                    {"correlation_rows", axis.correlation_rows}});
  }
  return {{"rows", bias.rows}, {"axes", axes}};
}

ordered_json to_json(const ContactsFound& found, const std::string& signal) {
  ordered_json contacts = ordered_json::array();
  for (const ContactFound& contact : found.contacts) {
    contacts.push_back({{"onset_s", contact.onset_s},
                        {"onset_error_s", json_number(contact.onset_error_s)},
                        {"onset_position", json_number(contact.onset_position)},
                        {"onset_position_error", json_number(contact.onset_position_error)},
                        {"travel", contact.travel},
                        {"first_row", contact.rows.begin},
                        {"rows", contact.rows.end - contact.rows.begin},
                        {"peak", contact.peak},
                        {"refined", contact.refined}});
  }
  return {{"signal", signal},
          {"noise", found.noise},
          {"threshold", found.threshold},
          {"count", found.contacts.size()},
          {"found", contacts}};
}

ordered_json to_json(const FilterReport& report) {
  ordered_json responses = ordered_json::array();
  for (const Response& response : report.responses) {
    responses.push_back({{"frequency_hz", response.frequency_hz},
                         {"gain", response.gain},
                         {"phase_deg", response.phase_deg},
                         {"delay_ms", response.delay_ms}});
  }
  return {{"filter", to_text(report.filter)},
          {"rate_hz", report.rate_hz},
          {"stretches", report.stretches},
          {"response", responses}};
}

ordered_json to_json(const ErrorOf& error) {
  return {{"bias_s", error.bias_s}, {"median_s", error.median_s}, {"percentile_90_s", error.percentile_90_s}};
}

ordered_json to_json(const ContactScore& score) {
  return {{"labelled", score.labelled},
          {"detected", score.detected},
          {"found", score.found},
          {"missed", score.missed},
          {"false", score.false_ones},
          {"split_up", score.split_up},
          {"begin", to_json(score.begin)},
          {"end", to_json(score.end)},
          {"precision", score.precision},
          {"recall", score.recall},
          {"f1", score.f1}};
}

ordered_json to_json(const Prepared& prepared) {
  ordered_json result{{"recording", prepared.recording.header.uuid},
                      {"source", prepared.recording.header.source},
                      {"rows_before", prepared.rows_before},
                      {"rows", prepared.recording.rows()},
                      {"gap_rows", prepared.gap_rows}};
  if (prepared.weight) result["weight"] = to_json(*prepared.weight);
  if (prepared.bias) result["bias"] = to_json(*prepared.bias);
  if (prepared.contacts) result["contacts"] = to_json(*prepared.contacts, prepared.contact_signal);
  if (prepared.filter) result["filter"] = to_json(*prepared.filter);
  if (prepared.score) result["score"] = to_json(*prepared.score);
  result["steps"] = prepared.steps;
  result["warnings"] = prepared.warnings;
  return result;
}

void say_filter(const FilterReport& report) {
  say(fmt::format("  {:>9} {:>9} {:>10} {:>9}", "Hz", "gain dB", "phase deg", "delay ms"));
  for (const Response& response : report.responses) {
    say(fmt::format("  {:9g} {:9.2f} {:10.2f} {:9.3f}", response.frequency_hz,
                    20.0 * std::log10(std::max(response.gain, 1e-15)), response.phase_deg + 0.0,
                    response.delay_ms + 0.0));
  }
}

void say_score(const ContactScore& score) {
  say(fmt::format("  of {} labelled {} found, {} missed; of {} detected {} false, {} more on one label",
                  score.labelled, score.found, score.missed, score.detected, score.false_ones,
                  score.split_up));
  const auto say_error = [](const char* what, const ErrorOf& error) {
    say(fmt::format("  {} off by {:.3f} s (median), {:.3f} s (90th percentile), bias {:+.3f} s", what,
                    error.median_s, error.percentile_90_s, error.bias_s));
  };
  say_error("begin", score.begin);
  say_error("end  ", score.end);
  say(fmt::format("  rows: precision {:.3f}, recall {:.3f}, F1 {:.3f}", score.precision, score.recall,
                  score.f1));
}

/// One drawing above the other in one file.
std::string stacked(const Chart& upper, const Chart& lower) {
  const auto placed = [](std::string drawing, int y_px) {
    const auto at = drawing.find("<svg");
    return drawing.insert(at + 4, fmt::format(" y=\"{}\"", y_px));
  };
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}\" height=\"{}\">\n{}\n{}\n</svg>\n",
      upper.width_px, upper.height_px + lower.height_px, placed(draw(upper), 0),
      placed(draw(lower), upper.height_px));
}

Labels parse_labels(const std::string& text) {
  const auto equals = text.rfind('=');
  Labels labels;
  if (equals != std::string::npos) {
    labels.channel = text.substr(0, equals);
    const char* const end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data() + equals + 1, end, labels.value);
    if (error == std::errc{} && rest == end && !labels.channel.empty()) return labels;
  }
  throw std::invalid_argument(
      fmt::format("--score-labels: '{}' is not CHANNEL=VALUE, for example label=3", text));
}

PrepareOptions options_of(const PrepareVerbArguments& arguments) {
  PrepareOptions options = arguments.options;
  WeightOptions& weight = options.weight_options;
  if (!arguments.free.empty()) options.contact.free = parse_spans(arguments.free);
  if (!arguments.cycles.empty()) options.cycles = parse_cycles(arguments.cycles);
  if (!arguments.filter.empty()) options.filter = parse_filter(arguments.filter, arguments.causal);
  if (!arguments.labels.empty()) options.labels = parse_labels(arguments.labels);
  if (!arguments.filter_chart.empty() || options.filter_position || arguments.causal) {
    if (!options.filter) {
      throw std::invalid_argument("--causal, --filter-position and --filter-chart need --filter");
    }
  }
  if (options.drift && !options.bias) throw std::invalid_argument("--drift needs --bias");
  weight.base_frame = arguments.frame == "base";
  if (weight.mass_kg || !arguments.centre.empty()) {
    if (!options.weight) throw std::invalid_argument("--mass and --centre need --weight");
    if (!weight.mass_kg) throw std::invalid_argument("--centre needs --mass; without it both are estimated");
  }
  if (arguments.centre.size() == 3) std::copy_n(arguments.centre.begin(), 3, weight.centre_m.begin());
  return options;
}

void run_prepare(const PrepareVerbArguments& arguments, Context& context) {
  const PrepareOptions options = options_of(arguments);
  std::error_code absent;
  if (std::filesystem::equivalent(arguments.recording, arguments.output, absent)) {
    throw std::invalid_argument(
        fmt::format("{}: -o names the recording itself; give another name", arguments.recording));
  }
  refuse_to_replace(arguments.output, arguments.force);
  if (!arguments.filter_chart.empty()) refuse_to_replace(arguments.filter_chart, arguments.force);
  Prepared prepared;
  try {
    schema::Recording recording = schema::read_recording(arguments.recording);
    schema::Header& header = recording.header;
    header.source =
        fmt::format("{} {} sha256:{}", std::filesystem::path(arguments.recording).filename().string(),
                    header.uuid, sha256_of(std::filesystem::path(arguments.recording)));
    prepared = prepare(std::move(recording), options);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(fmt::format("{}: {}", arguments.recording, error.what()));
  }
  prepared.recording.header.uuid = schema::new_header("").uuid;
  prepared.recording.header.software = software();
  if (!arguments.filter_chart.empty()) {
    write_whole_file(arguments.filter_chart,
                     stacked(gain_chart(*prepared.filter), phase_chart(*prepared.filter)));
  }
  schema::write_recording(arguments.output, prepared.recording);
  context.result = to_json(prepared);
  for (const std::string& warning : prepared.warnings) warn(warning);
  for (const std::string& step : prepared.steps) {
    if (!step.starts_with("filter ")) say(step);
  }
  if (prepared.filter) {
    say(fmt::format("filter {} at {:.6g} Hz", to_text(prepared.filter->filter), prepared.filter->rate_hz));
    say_filter(*prepared.filter);
  }
  if (prepared.score) say_score(*prepared.score);
  say(fmt::format("{}: {} of {} rows", arguments.output, prepared.recording.rows(), prepared.rows_before));
}

void add_contact_options(Verb& verb, PrepareVerbArguments& arguments) {
  PrepareOptions& options = arguments.options;
  verb.add_flag("--onset", options.onset, "Find contacts; events, and the contact position of the axis");
  verb.add_option("--axis", options.axis,
                  "Axis along which contact is told (default: the only one, or none)");
  verb.add_option("--signal", options.signal,
                  "Axes or channels whose vector tells a contact (default: --axis, or every axis in N)")
      .separated_by(',');
  verb.add_option("--free", arguments.free,
                  "Times without contact, 0:1.5,30:32 (default: what --onset finds)");
  verb.add_option("--sigmas", options.contact.sigmas, "Threshold of contact, in sigmas of the free noise")
      .positive()
      .with_default();
  verb.add_option("--least", options.contact.least, "Smallest threshold of contact, in the signal's unit")
      .not_negative()
      .with_default();
  verb.add_option("--shortest", options.contact.shortest_s, "Shortest contact, and shortest release [s]")
      .positive()
      .with_default();
  verb.add_option("--level-time", options.contact.baseline_s, "Time constant of the free level [s]")
      .positive()
      .with_default();
  verb.add_option("--score-labels", arguments.labels, "CHANNEL=VALUE: score the contacts against labels");
}

void add_filter_options(Verb& verb, PrepareVerbArguments& arguments) {
  verb.add_option(
      "--filter", arguments.filter,
      "butterworth2:HZ, butterworth4:HZ, critically-damped:HZ, first-order:10rad/s, moving-mean:S, "
      "savitzky-golay:S");
  verb.add_flag("--causal", arguments.causal, "Run the filter forward only (default: zero phase)");
  verb.add_flag("--filter-position", arguments.options.filter_position,
                "Filter position and velocity as well");
  verb.add_option("--filter-chart", arguments.filter_chart, "Chart of gain and phase to write, an SVG");
}

}  // namespace

void add_prepare(CLI::App& app, Context& context) {
  auto arguments = std::make_shared<PrepareVerbArguments>();
  PrepareOptions& options = arguments->options;
  Verb verb = add_verb(
      app, context, "prepare",
      "Prepare a recording for a fit: bias, weight, contacts, filter, choice of rows",
      "kerf prepare cut.h5 -o clean.h5 --drop-gaps --bias --drift --onset --filter butterworth2:20\n\n"
      "Steps run in this order, whatever the order of the options: gaps, weight, bias and drift, onset, "
      "filter,\n"
      "time span, cycles. Each is noted in the history of the new recording ('kerf info').",
      [arguments, &context] { run_prepare(*arguments, context); });
  verb.add_option("RECORDING", arguments->recording, "Recording; it stays as it is").required();
  verb.add_option("-o,--output", arguments->output, "Recording to write").required();
  verb.add_flag("--drop-gaps", options.drop_gaps, "Leave out rows that are not finite");
  verb.add_flag("--weight", options.weight, "Take the tool's weight off a sensor with six axes");
  verb.add_option("--mass", options.weight_options.mass_kg, "Its mass [kg] (default: estimated)");
  verb.add_option("--centre", arguments->centre, "Its centre of mass x,y,z [m], in the sensor's frame")
      .separated_by(',')
      .taking(3);
  verb.add_option("--frame", arguments->frame, "Axes in which the forces stand")
      .one_of({"sensor", "base"})
      .with_default();
  verb.add_flag("--bias", options.bias, "Take off the force's mean without contact");
  verb.add_flag("--drift", options.drift, "With --bias: a straight line in time");
  add_contact_options(verb, *arguments);
  add_filter_options(verb, *arguments);
  verb.add_option("--from", options.from_s, "Keep rows from this time on [s]");
  verb.add_option("--to", options.to_s, "Keep rows up to this time [s]");
  verb.add_option("--cycles", arguments->cycles, "Keep these cycles, 2-8,10; they are numbered anew");
  verb.add_flag("--force", arguments->force, "Replace an existing output");
}

}  // namespace kerf::bench
