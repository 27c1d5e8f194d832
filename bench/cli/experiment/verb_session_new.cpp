#include <filesystem>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "experiment/key_arguments.h"
#include "experiment/new_experiment.h"
#include "experiment/verb_session.h"
#include "felt/felt_gains.h"
#include "felt/felt_remarks.h"
#include "files/whole_file.h"
#include "registered/assignment.h"
#include "run/run.h"
#include "sealed/session_store.h"
#include "session/device_check.h"
#include "session/study_folder.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

struct SessionNewVerbArguments {
  std::string protocol;
  std::string subject;
  std::string replaces;
  std::size_t subjects = 0;  ///< 0: one session, for `subject`
  std::string output;
  std::string device;
  std::string device_model;
  KeyArguments key;
  bool no_check = false;
  bool replace = false;
};

void check_arguments(const SessionNewVerbArguments& arguments) {
  if (arguments.subject.empty() == (arguments.subjects == 0))
    throw std::invalid_argument(
        "give the subject's code with --subject, or how many subjects the study has with --subjects");
  if (arguments.output.empty())
    throw std::invalid_argument("-o: say where the sessions are to stand; an experiment has its folder");
  if (!arguments.replaces.empty())
    throw std::invalid_argument("--replaces is for an experiment; 'kerf session plan' begins one");
}

void check_arguments_of_experiment(const SessionNewVerbArguments& arguments) {
  if (arguments.subjects > 0 || !arguments.output.empty() || arguments.replace)
    throw std::invalid_argument(
        "an experiment says how many participants it has, and its sessions stand beside it and are never "
        "replaced: leave out --subjects, -o and --force");
  if (!arguments.subject.empty() && arguments.replaces.empty())
    throw std::invalid_argument(
        "--subject: the participants of an experiment have the codes S01 and so on; "
        "one that takes another's place has its code with --replaces");
}

void check_on_device(const SessionNewVerbArguments& arguments, const Protocol& protocol) {
  const std::string uri = arguments.device.empty() ? protocol.device_uri : arguments.device;
  if (arguments.no_check) return;
  if (!uri.starts_with("sim:")) {
    warn(uri.empty() ? "no device is named, so that nothing was checked on it; 'kerf session run' does"
                     : fmt::format("{} is not moved now; 'kerf session run' checks the laws on it", uri));
    for (const std::string& remark : felt_remarks(protocol, uri, SamplesTold::by_name)) warn(remark);
    return;
  }
  const StopOnSignal signals;
  for (const std::string& remark :
       check_samples(protocol, uri, signals.requested(), SamplesTold::by_name, arguments.device_model))
    warn(remark);
}

/// Of the subjects; one that is named alone keeps the code.
std::vector<std::string> codes_of(const SessionNewVerbArguments& arguments) {
  if (arguments.subjects == 0) return {arguments.subject};
  std::vector<std::string> codes;
  for (std::size_t number = 1; number <= arguments.subjects; ++number)
    codes.push_back(code_of(number, arguments.subjects));
  return codes;
}

/// The sessions with these codes, one a subject, each under its own key.
void write_sessions(SessionNewVerbArguments& arguments, const Protocol& protocol,
                    const std::vector<Plan>& plans, const std::vector<std::string>& codes,
                    const std::vector<fs::path>& files) {
  for (std::size_t subject = 0; subject < codes.size(); ++subject) {
    const schema::KeyDerivation derivation = new_derivation(arguments.key.key_file.empty());
    SessionStore::create(files[subject],
                         {.protocol = protocol,
                          .subject = codes[subject],
                          .number = subject + 1,
                          .subjects = codes.size(),
                          .plan = plans[subject]},
                         new_key_for(arguments.key, derivation), derivation, arguments.replace);
  }
}

std::vector<std::string> file_names_of(const std::vector<std::string>& codes) {
  std::vector<std::string> names;
  for (const std::string& code : codes) names.push_back(code + ".h5");
  return names;
}

std::vector<fs::path> in_folder(const fs::path& folder, const std::vector<std::string>& names) {
  std::vector<fs::path> files;
  for (const std::string& name : names) files.push_back(folder / name);
  return files;
}

/// Makes the samples of a tissue as strong if they are to be, and tries all of them on the device.
void prepare(const SessionNewVerbArguments& arguments, Protocol& protocol, Context& context) {
  for (const std::string& remark : find_gains(protocol, arguments.device)) warn(remark);
  for (const SessionSample& sample : protocol.samples) {
    if (sample.gain != 1.0)
      context.say(fmt::format("  {:24} forces times {:.4g}, to be as strong", sample.name, sample.gain));
  }
  check_on_device(arguments, protocol);
}

std::uint64_t seed_of_orders(const Context& context) {
  if (!context.seed_given) return random_seed();
  warn("whoever knows the seed knows the order: keep --seed from subject and experimenter");
  return context.seed;
}

void make_sessions(SessionNewVerbArguments& arguments, Context& context) {
  if (is_experiment(arguments.protocol)) {
    check_arguments_of_experiment(arguments);
    make_experiment({.experiment = arguments.protocol,
                     .replaces = arguments.replaces,
                     .participant = arguments.subject,
                     .seed = arguments.replaces.empty() ? seed_of_orders(context) : 0,
                     .prepare = [&](Protocol& protocol) { prepare(arguments, protocol, context); }},
                    arguments.key, context);
    return;
  }
  check_arguments(arguments);
  Protocol protocol = read_protocol(arguments.protocol);
  prepare(arguments, protocol, context);
  const std::uint64_t seed = seed_of_orders(context);
  const std::vector<std::string> codes = codes_of(arguments);
  const auto plans = make_plans(protocol, codes.size(), seed);

  const bool is_study = arguments.subjects > 0;
  const std::vector<std::string> names = file_names_of(codes);
  const std::vector<fs::path> files =
      is_study ? in_folder(arguments.output, names) : std::vector<fs::path>{arguments.output};
  for (const fs::path& file : files) require_output(file, arguments.replace);
  if (is_study) {
    StudyFolder study(arguments.output, names, arguments.replace);
    write_sessions(arguments, protocol, plans, codes, in_folder(study.path(), names));
    study.commit();
  } else {
    write_sessions(arguments, protocol, plans, codes, files);
  }
  context.result = {{"protocol", arguments.protocol}, {"sessions", nlohmann::ordered_json::array()}};
  for (std::size_t subject = 0; subject < codes.size(); ++subject) {
    const std::string file = files[subject].string();
    context.result["sessions"].push_back(
        {{"file", file}, {"subject", codes[subject]}, {"trials", plans[subject].size()}});
    context.say(fmt::format("{}: subject {}, {}{} trials, sealed", file, codes[subject],
                            is_adaptive(protocol.design) ? "at most " : "", plans[subject].size()));
  }
}

}  // namespace

void add_session_key(CLI::App& session, Context& context) {
  auto file = std::make_shared<std::string>();
  Verb verb = add_verb(
      session, context, "key", "Make a key file for whoever keeps the blinding",
      "kerf session key /media/keeper/study.key\n\n"
      "Keep it where neither subject nor experimenter reads it, and a copy of it: without the key no\n"
      "answer of a session can be read, by nobody.",
      [file, &context] {
        require_change(*file);  // which a key that is there refuses itself
        write_new_key_file(*file);
        context.result = {{"key_file", *file}};
        context.say(fmt::format("{}: 32 random bytes, readable by you alone", *file));
      });
  verb.add_option("FILE", *file, "The key file to be made").required();
}

void add_session_new(CLI::App& session, Context& context) {
  auto arguments = std::make_shared<SessionNewVerbArguments>();
  Verb verb = add_verb(
      session, context, "new", "Make the sealed session of a subject, or of all subjects of a study",
      "kerf session new abx.protocol.toml --subject S01 --key-file keeper.key -o S01.h5\n"
      "  kerf session new abx.protocol.toml --subjects 12 --key-file keeper.key -o study\n"
      "  kerf session new study/experiment.toml --key-file keeper.key\n\n"
      "Sessions of one study made together are counterbalanced over its subjects. Protocol, laws and the\n"
      "subjects' texts are copied into the session; docs/sessions-protocol.md has the protocol's format. Of\n"
      "an experiment ('kerf session plan') it registers the plan and makes the sessions of all participants\n"
      "beside it.",
      [arguments, &context] { make_sessions(*arguments, context); });
  verb.takes_laws(context);
  verb.add_option("PROTOCOL", arguments->protocol, "The protocol, NAME.protocol.toml, or an experiment")
      .required();
  verb.add_option(
      "--subject", arguments->subject,
      "Code of the subject, no name: letters, digits, _ and -, 16 at most; a protocol needs this or "
      "--subjects");
  verb.add_option(
      "--subjects", arguments->subjects,
      "Number of sessions to make, S01.h5 and so on, in the folder -o; a protocol needs this or --subject");
  verb.add_option("-o,--output", arguments->output,
                  "The session file, or with --subjects a folder; an experiment has its own");
  verb.add_option("--replaces", arguments->replaces,
                  "Of an experiment: a session in the order of this participant, who was dropped");
  verb.add_option("--device-model", arguments->device_model,
                  "NAME.device.toml: the device as measured, for its checks (default: what is kept of it)");
  verb.add_uri("--device", arguments->device,
               "Check the laws on this simulated device (default: the protocol's)");
  add_key_options(verb, arguments->key);
  verb.add_flag("--no-check", arguments->no_check, "Do not check the laws on a simulated device");
  verb.add_flag("--force", arguments->replace, "Replace existing sessions, with all their answers");
}

}  // namespace kerf::bench
