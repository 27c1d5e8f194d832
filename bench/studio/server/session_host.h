#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

#include "http/http_server.h"
#include "pages/attempt_limit.h"
#include "run/run.h"
#include "sealed/trials/session_notes.h"
#include "subject/subject_page.h"

namespace kerf::bench {

/// What the experimenter may see of a session: how far it is, and nothing of what was felt or answered.
// NOLINTNEXTLINE(bugprone-exception-escape): of what moves JSON, which does not throw
struct SessionProgress {
  bool running = false;
  std::string name;         ///< of the file
  std::string subject_url;  ///< of the page for the subject; empty before the session has begun
  std::size_t answered = 0;
  std::size_t at_most = 0;
  bool adaptive = false;
  std::string stage;  ///< "checking", "welcome", "trial", ...
  std::string ended;  ///< why it is not running any more; empty before one ran
  std::vector<std::string> warnings;
  nlohmann::ordered_json
      quality;  ///< sums over its trials, as SessionQuality; null before a session has begun
  std::vector<SessionNote> notes;
};
[[nodiscard]] nlohmann::ordered_json to_json(const std::vector<SessionNote>& notes);

/// Runs one blind session at a time in a thread of its own, its subject on a page below /subject/ with a
/// token of its own: who has it gets at nothing else of the studio.
class SessionHost {
 public:
  struct Order {
    std::filesystem::path file;
    std::string name;
    std::string device_uri;  ///< empty: the protocol's
    std::string sensor_uri;
    std::filesystem::path key_file;        ///< for a session that was sealed with one
    std::string passphrase;                ///< for one that was sealed with a passphrase
    bool check = true;                     ///< the laws on the device first
    std::vector<std::string> apparatus{};  ///< what was confirmed of it, NAME=yes or NAME=no
  };

  /// `hosts` and `wake` are the server's; `tell_fault` is called when a session loses its device.
  SessionHost(std::vector<std::string> hosts, std::function<void()> wake,
              std::function<void(const std::string&)> tell_fault);
  SessionHost(const SessionHost&) = delete;
  SessionHost& operator=(const SessionHost&) = delete;
  ~SessionHost();  ///< ends a session as stop() does

  /// Opens the session and begins it. Once no other can begin, `prepare` has to free the device, and may
  /// throw to refuse. @throws RequestError 409 while one runs, or if it was stopped meanwhile; as
  /// SessionStore and SealKey.
  void start(const Order& order, const std::function<void()>& prepare);
  /// Asks the session to end for now; it can be gone on with.
  void stop() noexcept { stop_ = true; }
  /// For the end of the program: stop(), and none is begun any more.
  void close() noexcept {
    closed_ = true;
    stop_ = true;
  }
  [[nodiscard]] bool is_running() const noexcept { return running_; }
  [[nodiscard]] SessionProgress progress() const;
  /// Keeps what the experimenter wrote in the session that runs. @throws std::invalid_argument: no note;
  ///         RequestError 409: no session runs.
  void note(const std::string& text);
  /// How the trials of a session's file went, also of one that is run elsewhere: {"subject", "finished",
  /// "planned", "quality", "notes"}, of no sample, slot, level or answer. Nothing is noted in the file, since
  /// nothing is unblinded. @throws as start() of a key that is another; schema::FormatError.
  [[nodiscard]] nlohmann::ordered_json look(const Order& order);

  /// What is asked for below /subject, with that taken off the path. Server's thread.
  [[nodiscard]] std::optional<HttpResponse> respond(const HttpRequest& request, bool overdue);

 private:
  class Running;
  void run(Running& running);
  void require_patience();  ///< @throws RequestError 429 after too many failures; under the lock
  [[nodiscard]] std::optional<std::string> next_note();
  [[nodiscard]] std::shared_ptr<PageSubject> page() const;

  std::vector<std::string> hosts_;
  std::function<void()> wake_;
  std::function<void(const std::string&)> tell_fault_;
  std::atomic<bool> stop_{false};
  std::atomic<bool> closed_{false};
  std::atomic<bool> running_{false};
  mutable std::mutex mutex_;  ///< of what follows
  AttemptLimit failed_starts_{5, std::chrono::minutes(1)};
  SessionProgress progress_;
  std::deque<std::string> written_;    ///< notes that are not kept yet
  std::shared_ptr<PageSubject> page_;  ///< kept after the end, so that it can show the last screen
  std::jthread thread_;
};

}  // namespace kerf::bench
