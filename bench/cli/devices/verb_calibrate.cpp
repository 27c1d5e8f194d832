#include "devices/verb_calibrate.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include <kerf/drivers/bench_file.h>
#include <kerf/drivers/uri.h>

#include "calibrate/live_holds.h"
#include "calibrate/loads_script.h"
#include "calibrate/measured_holds.h"
#include "calibrate/sensor_calibration.h"
#include "files/json_file.h"
#include "files/whole_file.h"
#include "program/confirm_on_enter.h"
#include "run/run.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

struct CalibrateArguments {
  std::string sensor;
  std::string loads;
  std::string map;
  std::string resume;
  std::optional<double> hands_free_s;
  double settle_s = 30.0;
  std::optional<double> gravity;
  double tolerance = 0.0;
  double range = 0.0;
  std::vector<double> leave_out;
  std::vector<std::string> components;
  bool keep_misfits = false;
  std::string serial_number;
  std::string date;
  double stale_after_days = 365.0;
  std::string output;
  bool force = false;
};

/// The sensor that a name of the bench file stands for, without its frame: signals are calibrated, not what
/// is made of them. A table that there is comes before a name.
std::string sensor_of(const std::string& text) {
  std::error_code error;
  const std::string name = text.substr(0, text.find('?'));
  if (name.find_first_of(":/.") != std::string::npos || fs::exists(text, error)) return text;
  const auto file = drivers::find_bench_file();
  return file && file->find(name) != nullptr ? drivers::without_bench_name(drivers::named_uri(text)) : text;
}

bool is_sensor(const std::string& text) {
  return text.starts_with("sim:") || text.starts_with("u6:") || text.starts_with("hid:") ||
         text.starts_with("falcon:") || text.starts_with("spacemouse:") || drivers::names_a_place(text);
}

std::chrono::year_month_day today() {
  return std::chrono::floor<std::chrono::days>(std::chrono::system_clock::now());
}

/// The day of "2026-11-28". @throws std::invalid_argument
std::chrono::year_month_day day_of(const std::string& text) {
  const char* at = text.data();
  const char* const end = at + text.size();
  const auto number = [&](auto& value) {
    const auto [next, error] = std::from_chars(at, end, value);
    at = next;
    return error == std::errc{};
  };
  const auto dash = [&] { return at != end && *at++ == '-'; };
  int year = 0;
  unsigned month = 0;
  unsigned day = 0;
  const bool is_read = number(year) && dash() && number(month) && dash() && number(day) && at == end;
  const std::chrono::year_month_day date{std::chrono::year{year}, std::chrono::month{month},
                                         std::chrono::day{day}};
  if (!is_read || !date.ok())
    throw std::invalid_argument(fmt::format("--date '{}': expected a day, such as 2026-11-28", text));
  return date;
}

/// What is written beside ft.calibration.toml: ft.json, ft.csv, ft.holds.csv.
fs::path beside(const std::string& output, const char* ending) {
  fs::path path(output);
  std::string name = path.filename().string();
  for (const std::string_view end : {".toml", ".calibration"}) {
    if (name.ends_with(end)) name.resize(name.size() - end.size());
  }
  return path.replace_filename(name + ending);
}

std::vector<std::size_t> components_of(const std::vector<std::string>& names) {
  std::vector<std::size_t> all;
  for (const std::string& name : names) {
    const auto found = std::ranges::find(wrench_components, name);
    if (found == wrench_components.end())
      throw std::invalid_argument(fmt::format("--components: '{}' is none of fx, fy, fz, tx, ty, tz", name));
    all.push_back(static_cast<std::size_t>(found - wrench_components.begin()));
  }
  std::ranges::sort(all);
  return all;
}

/// Everything of one run of the verb.
class Calibrating {
 public:
  Calibrating(const CalibrateArguments& given, Context& context) : given_(given), context_(context) {
    options_.tolerance = given.tolerance;
    options_.range = given.range;
    options_.keep_misfits = given.keep_misfits;
    options_.date = given.date.empty() ? today() : day_of(given.date);
    options_.stale_after_days = given.stale_after_days;
    options_.components = components_of(given.components);
    for (const double row : given.leave_out) options_.leave_out.push_back(static_cast<std::size_t>(row));
    if (given.output.empty()) return;
    require_output(given.output, given.force);
    for (const char* ending : {".json", ".csv"}) require_output(beside(given.output, ending), given.force);
    const fs::path holds = beside(given.output, ".holds.csv");
    if (is_sensor(given.sensor)) require_output(holds, given.force || holds == fs::path(given.resume));
  }

  void run() {
    if (!given_.loads.empty()) script_ = read_load_script(given_.loads, {.gravity = given_.gravity});
    MeasuredHolds measured;
    if (is_sensor(given_.sensor)) {
      if (!script_)
        throw std::invalid_argument(
            "a sensor needs --loads FILE.toml, what is put on it and how; docs/calibrating.md has an "
            "example");
      if (!measure(measured)) return;
    } else {
      measured = read_measured_holds(given_.sensor, given_.map);
      if (script_) take_loads(measured, *script_);
    }
    finish(std::move(measured));
  }

 private:
  /// False: it was stopped, and what was measured is kept.
  bool measure(MeasuredHolds& measured) {
    MeasuredHolds before;
    if (!given_.resume.empty()) {
      before = read_measured_holds(given_.resume, "");
      take_loads(before, *script_);
    }
    const StopOnSignal signals;
    const bool asks = !given_.sensor.starts_with("sim:") && !given_.hands_free_s;
    if (asks && !is_at_terminal())
      throw std::invalid_argument("nobody is at a terminal here to press Enter: give --hands-free SECONDS");
    LiveHoldsOptions live{.uri = given_.sensor,
                          .hands_free_s = given_.hands_free_s,
                          .settle_timeout_s = given_.settle_s,
                          .seed = context_.seed,
                          .say = note,
                          .wait = [&] {
                            note("  Enter when it hangs still, Ctrl-C gives up and keeps what was measured.");
                            return wait_for_enter(signals.requested());
                          }};
    LiveHolds found = measure_holds(*script_, live, before, signals.requested());
    measured = std::move(found.measured);
    take_loads(measured, *script_);
    options_.labjack = found.labjack;
    if (!(options_.range > 0.0)) options_.range = 0.9999 * found.range_v;
    if (!found.truth.empty()) truth_ = nlohmann::ordered_json::parse(found.truth);
    keep_holds(measured);
    if (found.finished) return true;
    const std::string kept = given_.output.empty()
                                 ? std::string("name an output (-o), and they are kept")
                                 : fmt::format("they are kept in {}: go on by --resume",
                                               beside(given_.output, ".holds.csv").string());
    const std::string line =
        fmt::format("{} after {} of {} loads; {}", found.problem.empty() ? "stopped" : found.problem,
                    measured.holds.size(), script_->steps.size(), kept);
    if (!found.problem.empty()) throw drivers::DeviceError(line);
    warn(line);
    context_.result = {{"finished", false}, {"holds", measured.holds.size()}};
    context_.exit = Exit::check_failed;
    return false;
  }

  void keep_holds(const MeasuredHolds& measured) const {
    if (!given_.output.empty()) write_whole_file(beside(given_.output, ".holds.csv"), holds_as_csv(measured));
  }

  void finish(MeasuredHolds measured) {
    options_.serial_number =
        !given_.serial_number.empty() || !script_ ? given_.serial_number : script_->serial_number;
    if (script_) options_.provenance = script_->provenance;
    if (options_.components.empty() && script_ && measured.signals.size() >= 6)
      options_.components = {0, 1, 2, 3, 4, 5};
    SensorCalibrationFiles files =
        calibrate_sensor(std::move(measured), script_ ? &*script_ : nullptr, options_);
    files.json["finished"] = true;
    if (!truth_.is_null()) files.json["truth"] = truth_;
    context_.result = files.json;
    for (const std::string& line : files.warnings) warn(line);
    for (const std::string& line : files.lines) context_.say(line);
    if (given_.output.empty()) return;
    if (files.toml.empty())
      throw std::invalid_argument(
          "a calibration file holds six signals at most: leave out -o, and take the matrix from --json");
    const auto existing = schema::existing_if(given_.force);
    write_json_file(beside(given_.output, ".json"), files.json, existing);
    write_whole_file(beside(given_.output, ".csv"), files.residuals, existing);
    write_whole_file(given_.output, files.toml, existing);
    context_.say(fmt::format("the calibration is in {}, the report in {}, residuals in {}", given_.output,
                             beside(given_.output, ".json").string(),
                             beside(given_.output, ".csv").string()));
  }

  const CalibrateArguments& given_;
  Context& context_;
  SensorCalibrationOptions options_;
  std::optional<LoadScript> script_;
  nlohmann::ordered_json truth_;
};

}  // namespace

void add_calibrate(CLI::App& app, Context& context) {
  auto arguments = std::make_shared<CalibrateArguments>();
  Verb verb = add_verb(
      app, context, "calibrate", "Calibrate a force sensor by known loads",
      "kerf calibrate u6:0 --loads loads.toml -o ft.calibration.toml\n"
      "  kerf calibrate loads.csv --map 'signal_1=U1[V],fz=Load[N],time=t[s]' --tolerance 0.001 -o "
      "cell.calibration.toml\n\n"
      "A person is walked through a script of weights, directions and levers, and presses Enter when each "
      "hangs\n"
      "still; or a table or recording of signals and loads is taken. Out come the matrix with its "
      "cross-talk, each\n"
      "number with its 95 % interval, hysteresis, drift, noise, resolution, and the next load that would "
      "tell most.\n"
      "Loads that do not determine the matrix, signals that are dead or at the end of their range, and loads "
      "that\n"
      "contradict the others are refused in a line (2). Stopped by Ctrl-C it keeps what was measured (1).\n"
      "docs/calibrating.md says how it is done and what the numbers mean.",
      [arguments, &context] {
        arguments->sensor = sensor_of(arguments->sensor);
        Calibrating(*arguments, context).run();
      });
  CalibrateArguments& given = *arguments;
  verb.add_option("SENSOR", given.sensor,
                  "Sensor (u6:0, t7:HOST, sim:sensor, or its name in bench.toml), or a table or recording of "
                  "signals and loads")
      .required();
  verb.add_option("--loads", given.loads, "Script of the loads (TOML)");
  verb.add_option("--map", given.map, "Columns of a table: 'signal_1=U1[V],fx=2[N],time=t[s]'");
  verb.add_option("--resume", given.resume, "Loads that an earlier run has measured: NAME.holds.csv");
  verb.add_option("--hands-free", given.hands_free_s, "Wait so long for each load in place of Enter [s]");
  verb.add_option("--settle", given.settle_s, "Longest wait until the signals are steady [s]")
      .positive()
      .with_default();
  verb.add_option("--gravity", given.gravity,
                  "Gravity where it is done (default: 9.80665, with its uncertainty) [m/s²]");
  verb.add_option("--tolerance", given.tolerance, "Limits of the loads of a table, in shares of each: 0.001")
      .within(0.0, 0.5);
  verb.add_option("--range", given.range,
                  "Where a signal ends (default: of a sensor 10 V) [unit of the signals]")
      .not_negative();
  verb.add_option("--leave-out", given.leave_out, "Rows, or steps of the script, that do not count: 7,12")
      .separated_by(',');
  verb.add_option("--components", given.components,
                  "Components to tell: fx,fy,fz (default: all that were loaded)")
      .separated_by(',');
  verb.add_flag("--keep-misfits", given.keep_misfits,
                "Warn of loads that contradict the others in place of refusing them");
  verb.add_option("--serial-number", given.serial_number, "Of the transducer (default: the script's)");
  verb.add_option("--date", given.date, "Day of the calibration, 2026-11-28 (default: today)");
  verb.add_option("--stale-after", given.stale_after_days, "Days after which it is warned of")
      .positive()
      .with_default();
  verb.add_option("-o,--output", given.output,
                  "NAME.calibration.toml; beside it NAME.json, .csv and .holds.csv");
  verb.add_flag("--force", given.force, "Replace earlier files");
}

}  // namespace kerf::bench
