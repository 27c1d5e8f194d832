#include "server/session_host.h"

#include <chrono>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include <kerf/drivers/bench_file.h>

#include "http/routes.h"
#include "loop/without_signals.h"
#include "protocol/protocol.h"
#include "registered/logged_run.h"
#include "sealed/apparatus_record.h"
#include "sealed/session_store.h"
#include "sealed/trials/quality_tally.h"
#include "session/device_check.h"
#include "session/receipt.h"
#include "session/run_session.h"
#include "subject/subject_words.h"

namespace kerf::bench {
namespace {

SealKey key_of(const SessionHost::Order& order, const schema::KeyDerivation& derivation) {
  if (derivation.kind == "passphrase") {
    if (order.passphrase.empty())
      throw RequestError(400, "the session was sealed with a passphrase; give it");
    return SealKey::from_passphrase(order.passphrase, derivation);
  }
  if (order.key_file.empty())
    throw RequestError(400,
                       "the session was sealed with a key file; start the studio with --key-file to run it");
  return SealKey::from_file(order.key_file, derivation);
}

std::string end_in_words(const SessionRunResult& result) {
  switch (result.end) {
    case SessionEnd::finished:
      return fmt::format("finished: {} trials", result.answered);
    case SessionEnd::declined:
      return "consent was not given; nothing was felt";
    default:
      return fmt::format("stopped after {} of {} trials; it can be continued", result.answered,
                         result.at_most);
  }
}

/// Of a session of an experiment the log beside it; a session without one runs as any other does.
std::optional<ExperimentLog> open_log(const SessionHost::Order& order, const SessionStore& store) {
  const auto file = log_of_session(order.file, store.session());
  std::error_code ignored;
  if (!file || !std::filesystem::exists(*file, ignored)) return std::nullopt;
  ExperimentLog log(*file, key_of(order, ExperimentLog::derivation_of(*file)));
  require_takes_part(order.file, log, store.session());
  return log;
}

}  // namespace

nlohmann::ordered_json to_json(const std::vector<SessionNote>& notes) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const SessionNote& note : notes) all.push_back({{"time", note.time}, {"text", note.text}});
  return all;
}

/// A session that is open, until its thread has ended.
class SessionHost::Running {
 public:
  explicit Running(const Order& order)
      : order_(order),
        store_(order.file, key_of(order, derivation_of(order.file)), SessionStore::Purpose::run),
        log_(open_log(order, store_)) {
    order_.passphrase.assign(order_.passphrase.size(), '\0');
    if (store_.finished())
      throw RequestError(409, "the session is finished; 'kerf session analyze' opens it");
    if (order_.device_uri.empty()) order_.device_uri = store_.protocol().device_uri;
    if (order_.device_uri.empty()) throw RequestError(400, "the protocol names no device; give one");
    confirmed_ = confirmations_in(order_.apparatus, store_.protocol().apparatus);
  }

  Order order_;
  SessionStore store_;
  std::optional<ExperimentLog> log_;
  Confirmations confirmed_;
  /// The page may be asked for it after the session's end.
  std::shared_ptr<LiveGuide> live_guide_ = std::make_shared<LiveGuide>();
};

SessionHost::SessionHost(std::vector<std::string> hosts, std::function<void()> wake,
                         std::function<void(const std::string&)> tell_fault)
    : hosts_(std::move(hosts)), wake_(std::move(wake)), tell_fault_(std::move(tell_fault)) {}

SessionHost::~SessionHost() { close(); }

void SessionHost::start(const Order& order, const std::function<void()>& prepare) {
  {
    const std::lock_guard lock(mutex_);
    if (running_) throw RequestError(409, "a session is running");
    require_patience();
    stop_ = false;  // before anybody can mean this session by stop()
    running_ = true;
  }
  std::shared_ptr<Running> running;
  try {
    prepare();
    running = std::make_shared<Running>(order);
    if (stop_ || closed_) throw RequestError(409, "the session was stopped before it had begun");
  } catch (const std::invalid_argument&) {  // another key, or a file that was changed
    const std::lock_guard lock(mutex_);
    failed_starts_.note_failure(AttemptLimit::Clock::now());
    running_ = false;
    throw;
  } catch (...) {
    running_ = false;
    throw;
  }
  if (thread_.joinable()) thread_.join();
  const std::lock_guard lock(mutex_);
  page_ = std::make_shared<PageSubject>(AccessControl(hosts_), wake_, running->store_.protocol().texts);
  page_->use_noise(running->store_.protocol().apparatus.noise, noise_level_of(running->store_.session()),
                   [store = &running->store_](double level_db) { record_noise_level(*store, level_db); });
  if (const auto& guide = running->store_.protocol().guide)
    page_->use_guide(*guide, [live = running->live_guide_] { return live->look(); });
  progress_ = {.running = true,
               .name = order.name,
               .subject_url = page_->access().url("/subject/"),
               .answered = running->store_.trials().size(),
               .at_most = running->store_.plan().size(),
               .adaptive = is_adaptive(running->store_.protocol().design),
               .stage = "checking",
               .ended = {},
               .warnings = running->store_.warnings(),
               .quality = nullptr,
               .notes = notes_of(running->store_.session())};
  written_.clear();
  const WithoutSignals none;
  thread_ = std::jthread([this, running] { run(*running); });
}

void SessionHost::run(Running& running) {
  std::string ended;
  try {
    if (running.order_.check) {
      auto remarks = check_samples(running.store_.protocol(), running.order_.device_uri, stop_);
      const std::lock_guard lock(mutex_);
      progress_.warnings.insert(progress_.warnings.end(), remarks.begin(), remarks.end());
    }
    record_apparatus(running.store_, running.confirmed_);
    SessionRunOptions options;
    options.loop.device_uri = running.order_.device_uri;
    options.loop.sensor_uri = drivers::sensor_beside(running.order_.device_uri, running.order_.sensor_uri);
    options.loop.warn = [this](std::string_view line) {
      const std::lock_guard lock(mutex_);
      progress_.warnings.emplace_back(line);
    };
    QualityTally tally(running.store_);
    const auto tell_quality = [&] {
      nlohmann::ordered_json quality = to_json(tally.quality(running.store_.finished()));
      const std::lock_guard lock(mutex_);
      progress_.quality = std::move(quality);
      progress_.notes = notes_of(running.store_.session());
    };
    tell_quality();
    options.recorded = [&](const RecordedTrial& trial, bool is_left_out) {
      tally.add(trial, is_left_out);
      tell_quality();
    };
    options.notes = [this] { return next_note(); };
    options.noted = tell_quality;
    options.progress = [this](std::size_t answered, std::size_t at_most) {
      const std::lock_guard lock(mutex_);
      progress_.answered = answered;
      progress_.at_most = at_most;
    };
    options.live_guide = running.live_guide_.get();
    ended = end_in_words(run_session(running.store_, *page(), options, stop_));
    tell_quality();
    running.store_.close();
    const Receipt receipt = receipt_of(running.store_);
    ended += fmt::format(". Receipt {}: keep it away from the file", receipt.in_short());
    keep_receipt(running.order_.file, receipt);
    if (running.log_) running.log_->append("run", run_facts(running.store_, false));
  } catch (const drivers::DeviceError& error) {
    ended = error.what();
    tell_fault_(ended);
  } catch (const std::exception& error) {
    ended = error.what();
  }
  // One that ended in its check has shown nothing yet.
  if (const auto page = this->page(); !page->stage()) page->show(stopped_view(running.store_.protocol()));
  const std::lock_guard lock(mutex_);
  progress_.running = false;
  progress_.ended = ended;
  running_ = false;
}

void SessionHost::require_patience() {
  const auto wait = failed_starts_.wait(AttemptLimit::Clock::now());
  if (wait > AttemptLimit::Clock::duration::zero())
    throw RequestError(429, fmt::format("too many starts have failed: wait {} s before the next",
                                        std::chrono::ceil<std::chrono::seconds>(wait).count()));
}

void SessionHost::note(const std::string& text) {
  std::string written = note_text(text);
  const std::lock_guard lock(mutex_);
  if (!running_ || progress_.quality.is_null())
    throw RequestError(409, "no session is running; 'kerf session note FILE TEXT' keeps a note of any other");
  written_.push_back(std::move(written));
}

std::optional<std::string> SessionHost::next_note() {
  const std::lock_guard lock(mutex_);
  if (written_.empty()) return std::nullopt;
  std::string next = std::move(written_.front());
  written_.pop_front();
  return next;
}

nlohmann::ordered_json SessionHost::look(const Order& order) {
  {
    const std::lock_guard lock(mutex_);
    require_patience();
  }
  try {
    const SessionStore store(order.file, key_of(order, derivation_of(order.file)),
                             SessionStore::Purpose::read);
    return {{"subject", store.session().subject},
            {"finished", store.finished()},
            {"planned", store.plan().size()},
            {"quality", to_json(session_quality(store))},
            {"notes", to_json(notes_of(store.session()))}};
  } catch (const std::invalid_argument&) {  // another key, or a file that was changed
    const std::lock_guard lock(mutex_);
    failed_starts_.note_failure(AttemptLimit::Clock::now());
    throw;
  }
}

std::shared_ptr<PageSubject> SessionHost::page() const {
  const std::lock_guard lock(mutex_);
  return page_;
}

SessionProgress SessionHost::progress() const {
  const std::lock_guard lock(mutex_);
  SessionProgress progress = progress_;
  if (page_ && page_->stage()) progress.stage = name_of(*page_->stage());
  return progress;
}

std::optional<HttpResponse> SessionHost::respond(const HttpRequest& request, bool overdue) {
  const std::shared_ptr<PageSubject> page = this->page();
  if (!page) return refusal(404);
  return page->respond(request, overdue);
}

}  // namespace kerf::bench
