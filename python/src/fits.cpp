#include <algorithm>
#include <atomic>
#include <chrono>
#include <future>
#include <memory>
#include <optional>
#include <regex>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include <kerf/version.h>

#include "files/whole_folder.h"
#include "fits/asked_fit.h"
#include "fits/fit_files.h"
#include "held_law.h"
#include "laws/plugin_laws.h"
#include "module.h"
#include "recordings/whole_recording.h"
#include "replay/replay.h"
#include "replay/replay_files.h"

namespace kerf::python {
namespace {

/// Options of the command line in a sentence, as arguments of Python: "--test-share" is test_share.
std::string as_arguments(const std::string& sentence) {
  static const std::regex option("--([a-z]+(-[a-z]+)*)");
  std::string words;
  std::size_t after = 0;
  for (std::sregex_iterator at(sentence.begin(), sentence.end(), option), end; at != end; ++at) {
    words += sentence.substr(after, static_cast<std::size_t>(at->position()) - after);
    std::string name = (*at)[1].str();
    std::replace(name.begin(), name.end(), '-', '_');
    words += name;
    after = static_cast<std::size_t>(at->position() + at->length());
  }
  return words + sentence.substr(after);
}

/// Also where a name in a file is no UTF-8.
std::string as_text(const nlohmann::ordered_json& json) {
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

/// Works on a thread of its own, so that Ctrl-C reaches who waits for it.
template <typename Work>
auto interruptible(std::atomic<bool>& stop, const Work& work) {
  auto result = std::async(std::launch::async, work);
  const auto is_ready = [&] {
    const py::gil_scoped_release others_may_run;
    return result.wait_for(std::chrono::milliseconds(50)) == std::future_status::ready;
  };
  while (!is_ready()) {
    if (PyErr_CheckSignals() == 0) continue;
    stop = true;
    {
      const py::gil_scoped_release others_may_run;
      result.wait();
    }
    throw py::error_already_set();
  }
  return result.get();
}

template <typename Value>
void take(const py::dict& given, const char* name, Value& value) {
  if (given.contains(name)) value = given[name].cast<std::remove_cvref_t<decltype(value)>>();
}

/// What was given and is not None; its types are those that ../kerf/fits.py has checked.
bench::AskedFit asked_of(const py::dict& given) {
  bench::AskedFit asked;
  fitting::FitOptions& fit = asked.options.fit;
  take(given, "laws", asked.options.models);
  take(given, "axis", asked.axis);
  take(given, "contact", asked.contact.position);
  take(given, "direction", asked.contact.direction);
  take(given, "noise", asked.noise);
  take(given, "weber", asked.jnd.weber_fraction);
  take(given, "threshold", asked.jnd.threshold);
  take(given, "jnd_source", asked.jnd.source);
  take(given, "rows", asked.rows);
  take(given, "cycles", asked.cycles);
  take(given, "segments", asked.segments);
  take(given, "points_per_segment", fit.points_per_segment);
  take(given, "breakpoints", asked.breakpoints);
  take(given, "arms", asked.arms);
  take(given, "memberships", asked.memberships);
  take(given, "thickness", asked.thickness);
  take(given, "option", asked.options.law_options);
  take(given, "rate", asked.options.loop_rate_hz);
  take(given, "per_recording", fit.per_recording);
  take(given, "folds", fit.folds);
  asked.no_folds = fit.folds == 0;
  take(given, "test_share", fit.test_share);
  take(given, "loss", asked.loss);
  take(given, "loss_scale", fit.loss_scale_n);
  take(given, "confidence", fit.confidence);
  take(given, "profile", fit.profile);
  return asked;
}

/// Fits with the files that they are of.
struct HeldFit {
  std::vector<std::filesystem::path> files;
  bench::RecordingFit fit;
};

std::unique_ptr<HeldFit> fit_recordings(const std::vector<std::string>& files, const py::dict& given) {
  bench::AskedFit asked = asked_of(given);
  asked.options.models = bench::laws_named(std::move(asked.options.models));
  std::atomic<bool> stop = false;
  asked.options.stop = &stop;
  asked.options.fit.threads = std::max(1U, std::thread::hardware_concurrency());
  try {
    bench::check(asked, files.size());
    return interruptible(stop, [&] {
      auto fit = std::make_unique<HeldFit>();
      fit->fit = bench::fit_files(files, asked);
      fit->files.assign(files.begin(), files.end());
      return fit;
    });
  } catch (const std::invalid_argument& refused) {
    throw std::invalid_argument(as_arguments(refused.what()));
  }
}

void refuse_to_replace(const bench::RecordingFit& fit, const std::filesystem::path& folder) {
  bench::FitRecordingOptions written;
  for (const bench::FittedLaw& law : fit.laws) written.models.push_back(law.result.model);
  try {
    bench::refuse_to_replace_fits(written, folder);
  } catch (const std::invalid_argument& exists) {
    std::string words = exists.what();
    constexpr std::string_view option = "--force";
    if (const auto at = words.find(option); at != std::string::npos)
      words.replace(at, option.size(), "replace=True");
    throw std::invalid_argument(words);
  }
}

void write_fits(HeldFit& held, const std::filesystem::path& folder, bool replace) {
  const py::gil_scoped_release others_may_run;
  if (!replace) refuse_to_replace(held.fit, folder);
  auto named = bench::name_meanwhile(held.files);
  bench::RecordingFit fit = held.fit;
  bench::WholeFolder whole(folder, schema::existing_if(replace));
  bench::write_fits(fit, named.get(), whole.path());
  whole.commit();
}

py::tuple replay(const std::string& file, const SharedLaw& law, const std::string& name,
                 const std::optional<double>& from_s, const std::optional<double>& to_s,
                 const std::vector<std::uint32_t>& cycles, bool bridge, double speed) {
  if (!(speed >= 0.1 && speed <= 10.0))
    throw std::invalid_argument("speed: expected a number from 0.1 to 10");
  const std::vector<bench::NamedLaw> laws{{.name = name, .file = law->file}};
  bench::SelectOptions select{.from_s = from_s, .to_s = to_s, .cycles = cycles};
  std::atomic<bool> stop = false;
  const bench::ThroughReplay replay = interruptible(stop, [&] {
    return bench::replay_through(bench::select_rows(bench::read_whole_recording(file), select, file), laws,
                                 {.bridge = bridge, .speed = speed, .open_loop = {}}, stop);
  });
  const schema::Recording& played = replay.source.recording;
  const bench::LawTrace& trace = replay.result.laws.front();
  const auto rows = static_cast<py::ssize_t>(replay.result.rows);
  Numbers time(rows, played.time.data());
  Numbers force(std::vector<py::ssize_t>{rows, static_cast<py::ssize_t>(played.dimensions())});
  py::array_t<std::uint32_t> flags(rows, trace.flags.data());
  for (py::ssize_t row = 0; row < rows; ++row)
    std::copy_n(trace.force[static_cast<std::size_t>(row)].begin(), played.dimensions(),
                force.mutable_data(row));
  nlohmann::ordered_json figures = bench::open_loop_as_json(replay.source, replay.result);
  figures["recording"] = file;
  figures["speed"] = speed;
  figures["notes"] = replay.notes;
  return py::make_tuple(time, force, flags, text_of(as_text(figures)));
}

}  // namespace

void add_fits(py::module_& module) {
  py::class_<HeldFit>(module, "HeldFit")
      .def("json",
           [](const HeldFit& held) {
             nlohmann::ordered_json fits = bench::fits_as_json(held.fit);
             fits["software"] = software();  // as of any verb
             return text_of(as_text(fits));
           })
      .def("laws",
           [](const HeldFit& held) {
             py::list all;
             for (const bench::FittedLaw& law : held.fit.laws) {
               py::list files{};
               files.append(text_of(bench::to_toml(law.file)));
               for (const bench::LawFile& other : law.others) files.append(text_of(bench::to_toml(other)));
               all.append(files);
             }
             return all;
           })
      .def("write", &write_fits);
  module.def("fit", &fit_recordings);
  module.def("replay", &replay);
}

}  // namespace kerf::python
