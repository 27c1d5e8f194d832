#include <algorithm>
#include <array>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/core.h>
#include <poll.h>
#include <unistd.h>

#include <kerf/drivers/bench_file.h>

#include "experiment/key_arguments.h"
#include "experiment/session_log.h"
#include "experiment/verb_session.h"
#include "felt/led_hand.h"
#include "program/standard_streams.h"
#include "run/check.h"
#include "sealed/apparatus_record.h"
#include "sealed/trials/trial_counts.h"
#include "session/device_check.h"
#include "session/receipt.h"
#include "session/rehearsal.h"
#include "session/run_session.h"
#include "subject/subject_buttons.h"
#include "subject/subject_group.h"
#include "subject/subject_page.h"
#include "subject/subject_screen.h"
#include "subject/subject_terminal.h"

namespace kerf::bench {
namespace {

struct SessionRunVerbArguments {
  std::string file;
  std::string participant;  ///< of an experiment
  std::size_t visit = 0;    ///< 0: the first that is not finished
  std::string device;
  KeyArguments key;
  RunOptions loop;
  bool page = false;
  double port = 0.0;
  bool buttons = false;
  bool rehearse = false;
  RehearsalSubject::Mishaps mishaps;  ///< of a rehearsal
  bool no_check = false;
  std::vector<std::string> apparatus;  ///< NAME=yes, NAME=no
};

/// Where the subject sees and answers: a page, or the keyboard, and the buttons of the device beside them.
struct Answering {
  std::vector<std::unique_ptr<Subject>> parts;
  std::unique_ptr<SubjectGroup> group;
  ButtonSubject* buttons = nullptr;
  std::shared_ptr<LiveGuide> live_guide = std::make_shared<LiveGuide>();
};

/// A rehearsal has only those mishaps that the protocol provides for.
void require_mishaps(const SessionRunVerbArguments& arguments, const Protocol& protocol) {
  const auto& [slip, unexplored] = arguments.mishaps;
  if (slip == 0.0 && unexplored == 0.0) return;
  if (!arguments.rehearse)
    throw std::invalid_argument(
        "--slips and --unexplored are for a rehearsal: give --rehearse, or leave them out");
  if (slip > 0.0 && !protocol.rules.slip)
    throw std::invalid_argument(
        "--slips: the protocol does not permit to take a trial back: say slip = true in its [trial]");
  if (unexplored > 0.0 && !protocol.rules.explore.is_asked())
    throw std::invalid_argument(
        "--unexplored: the protocol asks for no exploration: say what in 'explore' of its [trial]");
  if (unexplored > 0.0 && protocol.presentation == Presentation::sequence)
    throw std::invalid_argument(
        "--unexplored: in a sequence every sample comes to the simulated hand; leave it out, or plan for it "
        "by "
        "'kerf session simulate'");
}

/// On a terminal nothing moves in step with the loop.
void require_guide_is_seen(const Protocol& protocol) {
  if (!protocol.guide) return;
  if (!protocol.guide->felt)
    throw std::invalid_argument(
        "the protocol's [guide] is seen on the subject's page alone: give --page (or --rehearse)");
  warn(
      "the protocol's [guide] is felt, and shown on the subject's page alone; give --page for it to be seen");
}

Answering answering_of(const SessionRunVerbArguments& arguments, SessionStore& store, std::uint64_t seed) {
  const MaskingNoise noise = store.protocol().apparatus.noise;
  Answering answering;
  if (arguments.rehearse) {
    answering.parts.push_back(
        std::make_unique<RehearsalSubject>(rehearsal_seed(seed, store.session()), arguments.mishaps));
  } else if (arguments.page) {
    auto page =
        std::make_unique<ServedSubject>(static_cast<std::uint16_t>(arguments.port), store.protocol().texts);
    page->page().use_noise(noise, noise_level_of(store.session()),
                           [&store](double level_db) { record_noise_level(store, level_db); });
    if (const auto& guide = store.protocol().guide)
      page->page().use_guide(*guide, [live = answering.live_guide] { return live->look(); });
    note(fmt::format("The subject's page: {}", page->url()));
    answering.parts.push_back(std::move(page));
  } else {
    if (noise != MaskingNoise::none)
      warn(fmt::format("{} noise is played by the subject's page; without --page nobody plays it",
                       name_of(noise)));
    answering.parts.push_back(std::make_unique<TerminalSubject>());
  }
  if (arguments.buttons) {
    auto buttons = std::make_unique<ButtonSubject>();
    answering.buttons = buttons.get();
    answering.parts.push_back(std::move(buttons));
  }
  std::vector<Subject*> all;
  for (const auto& part : answering.parts) all.push_back(part.get());
  answering.group = std::make_unique<SubjectGroup>(std::move(all));
  return answering;
}

/// Lines of the standard input, which nobody waits for: notes of the experimenter while the subject has the
/// page.
class NoteLines {
 public:
  [[nodiscard]] std::optional<std::string> next() {
    pollfd polled{.fd = 0, .events = POLLIN, .revents = 0};
    std::array<char, 256> buffer{};
    if (!ended_ && text_.size() < longest && ::poll(&polled, 1, 0) > 0) {
      const ssize_t count = ::read(0, buffer.data(), buffer.size());
      ended_ = count == 0;
      if (count > 0) text_.append(buffer.data(), static_cast<std::size_t>(count));
    }
    const std::size_t end = text_.find('\n');
    if (end == std::string::npos && text_.size() < longest) return std::nullopt;
    const auto lines =
        wrapped(text_.substr(0, std::min(end, longest)), longest);  // without control characters
    text_.erase(0, end == std::string::npos ? text_.size() : end + 1);
    return lines.empty() ? std::string() : lines.front();
  }

 private:
  static constexpr std::size_t longest = 1000;
  std::string text_;
  bool ended_ = false;
};

std::string uri_of(const SessionRunVerbArguments& arguments, const Protocol& protocol) {
  std::string uri = drivers::named_uri(arguments.device.empty() ? protocol.device_uri : arguments.device);
  if (uri.empty()) throw std::invalid_argument("the protocol names no device; give one with --device");
  if (arguments.rehearse && !uri.starts_with("sim:"))
    throw std::invalid_argument(
        fmt::format("--rehearse is for simulated devices, in virtual time; {} is none", uri));
  return uri;
}

SessionRunOptions run_options_of(const SessionRunVerbArguments& arguments, const Protocol& protocol,
                                 ButtonSubject* buttons) {
  SessionRunOptions options{.loop = arguments.loop};
  options.loop.device_uri = uri_of(arguments, protocol);
  options.loop.sensor_uri = drivers::sensor_beside(options.loop.device_uri, options.loop.sensor_uri);
  options.loop.virtual_time = arguments.rehearse;
  if (arguments.rehearse) options.loop.device_uri = led_hand(options.loop.device_uri, protocol);
  options.loop.warn = warn;
  if (!options.loop.passivity_control) options.loop.device_model.clear();  // the checks have taken it
  // The subject's terminal is no place for progress: it is on the screen there already.
  if (arguments.page) {
    options.notes = [lines = std::make_shared<NoteLines>()] { return lines->next(); };
    const std::string_view of = is_adaptive(protocol.design) ? "at most " : "";
    options.progress = [of](std::size_t answered, std::size_t at_most) {
      note(fmt::format("{} of {}{} trials are done", answered, of, at_most));
    };
  }
  if (buttons != nullptr) {
    const auto channel = buttons_channel(drivers::open_device(options.loop.device_uri)->info());
    if (!channel)
      throw std::invalid_argument(fmt::format("--buttons: {} has no buttons", options.loop.device_uri));
    options.each_sample = [buttons, at = *channel](const drivers::Sample& sample) {
      buttons->sample(sample.channels[at]);
    };
  }
  return options;
}

void report(const SessionRunVerbArguments& arguments, Context& context, const SessionRunResult& result) {
  context.result = {{"file", arguments.file},
                    {"finished", result.end == SessionEnd::finished},
                    {"answered", result.answered},
                    {"at_most", result.at_most},
                    {"ticks", result.run.report.ticks()},
                    {"missed", result.run.report.missed()}};
  switch (result.end) {
    case SessionEnd::finished:
      context.say(fmt::format("The session is finished: {} trials. 'kerf session analyze' opens it.",
                              result.answered));
      break;
    case SessionEnd::declined:
      context.say("Consent was not given; nothing was felt.");
      break;
    default:
      context.say(fmt::format("{} of {} trials are done; 'kerf session run {}' goes on", result.answered,
                              result.at_most, arguments.file));
  }
  if (!arguments.rehearse)
    context.say(
        fmt::format("{} ticks, {} deadlines missed", result.run.report.ticks(), result.run.report.missed()));
}

/// What proves later that nothing was taken from the session; also where a run has failed.
void give_receipt(const SessionRunVerbArguments& arguments, const SessionStore& store, Context& context) {
  const Receipt receipt = receipt_of(store);
  context.result["receipt"] = receipt.in_full();
  if (store.protocol().rules.may_void()) {
    const TrialCounts counts = counts_of(store);
    context.result["void"] = counts.voided;
    context.result["left_out"] = counts.left_out;
    context.say(fmt::format("{}.", in_words(counts)));
  }
  note(fmt::format("Receipt {}: keep it away from the file, on paper or a photograph; {} has it in full",
                   receipt.in_short(), receipts_of(arguments.file).string()));
  try {
    keep_receipt(arguments.file, receipt,
                 store.protocol().rules.may_void() ? in_words(counts_of(store)) : "");
  } catch (const std::system_error& error) {
    warn(error.what());
  }
}

/// The session of a participant of an experiment: by its code, lest somebody go on with another's.
std::string session_of(SessionRunVerbArguments& arguments) {
  const OpenedExperiment opened = open_experiment(arguments.file, arguments.key);
  const auto& all = opened.state.participants;
  if (arguments.participant.empty()) {
    const auto next =
        std::ranges::find_if(all, [](const Participant& each) { return !each.is_out() && !each.begun(); });
    throw std::invalid_argument(
        fmt::format("say with --subject whose session it is{}",
                    next == all.end() ? std::string("; nobody is still to come")
                                      : fmt::format("; {} is the next who has not begun", next->code)));
  }
  const Participant* who = opened.state.find(arguments.participant);
  if (who == nullptr)
    throw std::invalid_argument(
        fmt::format("--subject: there is no participant {} in this experiment", arguments.participant));
  for (const AssignedSession& session : who->sessions) {
    const bool is_asked = arguments.visit == 0 ? !session.finished : session.visit == arguments.visit;
    if (is_asked) return session.file.string();
  }
  throw std::invalid_argument(
      arguments.visit == 0 ? fmt::format("{} is through: every session of theirs is finished", who->code)
                           : fmt::format("--visit: {} has {}", who->code, who->sessions.size()));
}

/// Their number alone: the address of the subject's page may be among them.
void note_unprinted(SessionStore& store) {
  const std::size_t lines = unprinted_errors().size();
  if (lines > 0 && !store.finished())
    store.note("output", fmt::format("{} lines could not be printed", lines));
}

/// What the experimenter says of the set-up: by the options, else asked at the terminal, else not known.
Confirmations confirmed_apparatus(const SessionRunVerbArguments& arguments, const Apparatus& apparatus) {
  Confirmations confirmed = confirmations_in(arguments.apparatus, apparatus);
  if (arguments.rehearse) return confirmed;
  const bool asks = isatty(STDIN_FILENO) == 1 && isatty(STDERR_FILENO) == 1;
  for (const ApparatusItem& item : apparatus.items) {
    if (confirmed.contains(item.name)) continue;
    if (!asks) {
      warn(fmt::format("{} ({}): nobody has confirmed it; say --apparatus '{}=yes' or =no", item.name,
                       item.what, item.name));
      continue;
    }
    std::string answer;
    while (answer != "y" && answer != "n") {
      note(fmt::format("{}: {}. Is it so? y or n, then Enter", item.name, item.what));
      if (!std::getline(std::cin, answer)) throw std::invalid_argument("the set-up was not confirmed");
    }
    if (answer == "n")
      throw std::invalid_argument(fmt::format(
          "{}: {}: is not so; mend it, or run without it by --apparatus '{}=no', which the session keeps",
          item.name, item.what, item.name));
    confirmed[item.name] = true;
  }
  return confirmed;
}

void run(SessionRunVerbArguments& arguments, Context& context) {
  if (arguments.rehearse && (arguments.page || arguments.buttons))
    throw std::invalid_argument("--rehearse needs nobody to answer: leave out --page and --buttons");
  if (is_experiment(arguments.file)) arguments.file = session_of(arguments);
  const SealKey key = key_for(arguments.key, derivation_of(arguments.file));
  SessionStore store(arguments.file, key, SessionStore::Purpose::run);
  for (const std::string& warning : store.warnings()) warn(warning);
  if (store.finished())
    throw std::invalid_argument(
        fmt::format("{}: the session is finished; 'kerf session analyze' opens it", arguments.file));
  require_mishaps(arguments, store.protocol());
  if (!arguments.page && !arguments.rehearse) require_guide_is_seen(store.protocol());
  std::optional<ExperimentLog> log = log_beside(arguments.file, store.session(), arguments.key);
  if (log) require_takes_part(arguments.file, *log, store.session());
  const StopOnSignal signals;
  if (!arguments.no_check) {
    for (const std::string& remark :
         check_samples(store.protocol(), uri_of(arguments, store.protocol()), signals.requested(),
                       SamplesTold::without_names, arguments.loop.device_model))
      warn(remark);
  }
  record_apparatus(store, confirmed_apparatus(arguments, store.protocol().apparatus));
  if (arguments.rehearse) store.note("rehearsal", "answers by chance, in virtual time");
  SessionRunResult result;
  {
    Answering answering = answering_of(arguments, store, context.seed);
    SessionRunOptions options = run_options_of(arguments, store.protocol(), answering.buttons);
    options.live_guide = answering.live_guide.get();
    try {
      result = run_session(store, *answering.group, options, signals.requested());
    } catch (const std::exception&) {
      answering = {};  // the subject's screen
      give_receipt(arguments, store, context);
      if (log) log->append("run", run_facts(store, arguments.rehearse));
      throw;
    }
  }
  note_unprinted(store);
  store.close();
  report(arguments, context, result);
  give_receipt(arguments, store, context);
  if (log) log->append("run", run_facts(store, arguments.rehearse));
}

}  // namespace

void add_session_run(CLI::App& session, Context& context) {
  auto arguments = std::make_shared<SessionRunVerbArguments>();
  Verb verb = add_verb(
      session, context, "run", "Run a session with its subject, or go on with it",
      "kerf session run S01.h5 --key-file keeper.key --device falcon:0 --page\n"
      "  kerf session run study --subject S01 --key-file keeper.key --page\n\n"
      "Whoever keeps the blinding gives the key; nothing on the screen tells the samples apart. The\n"
      "subject answers at this keyboard, on a page (--page), or by the buttons of the device\n"
      "(--buttons). Ctrl-C, a crash or a pulled cable lose at most the trial at work. The receipt that is\n"
      "printed at the end finds later whether the file was replaced, cut short or restored: see\n"
      "'kerf session analyze --receipt'.",
      [arguments, &context] { run(*arguments, context); });
  verb.takes_laws(context);
  verb.add_option("FILE", arguments->file, "The session, or an experiment (with --subject)").required();
  verb.add_option("--subject", arguments->participant, "Whose session of the experiment it is");
  verb.add_option("--visit", arguments->visit, "Which visit (default: the first that is not finished)");
  verb.add_uri("--device", arguments->device,
               "Device URI, or its name in bench.toml (default: the protocol's)");
  verb.add_option(
      "--device-model", arguments->loop.device_model,
      "NAME.device.toml: the device as measured, for its checks and --passivity-control (default: what is "
      "kept of it)");
  verb.add_uri("--sensor", arguments->loop.sensor_uri, "URI or name of a force sensor beside the device");
  add_key_options(verb, arguments->key);
  verb.add_flag("--page", arguments->page,
                "The subject answers on a page in a browser of this machine; a line typed here is a note, "
                "kept in the session");
  verb.add_option("--port", arguments->port, "Port of the page (default: any that is free)")
      .within(0.0, 65535.0);
  verb.add_flag("--buttons", arguments->buttons, "The subject answers by the buttons of the device too");
  verb.add_flag("--passivity-control", arguments->loop.passivity_control,
                "Add damping wherever the rendering has given energy");
  verb.add_flag("--rehearse", arguments->rehearse,
                "Rehearsal: answers by chance, in virtual time, on a simulated device; the file is marked");
  verb.add_option("--slips", arguments->mishaps.slip, "Rehearsal: share of the trials that are taken back")
      .within(0.0, 0.99);
  verb.add_option("--unexplored", arguments->mishaps.unexplored,
                  "Rehearsal: share of the other trials in which one slot alone is felt")
      .within(0.0, 0.99);
  verb.add_flag("--no-check", arguments->no_check, "Do not check the laws on the device first");
  verb.add_option(
          "--apparatus", arguments->apparatus,
          "What of the protocol's [apparatus] is so: NAME=yes or NAME=no (may be repeated; default: asked)")
      .one_value_each();
}

}  // namespace kerf::bench
