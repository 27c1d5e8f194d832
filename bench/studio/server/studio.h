#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "verbs/sweep_verb.h"
#include "verbs/verb_form.h"

namespace kerf::bench {

struct StudioOptions {
  std::filesystem::path folder = ".";       ///< the workspace
  std::string device_uri = "sim:scissors";  ///< offered where one is asked for
  std::string address = "127.0.0.1";        ///< to listen on
  std::uint16_t port = 0;                   ///< 0: any that is free
  std::filesystem::path key_file;           ///< for sessions that were sealed with one; empty: none
  std::filesystem::path program;            ///< whose verbs the page may run; empty: none
  std::vector<VerbForm> verbs = {};         ///< these
  /// Says what is wrong with a command line of the program; throws std::invalid_argument.
  std::function<void(const std::vector<std::string>&)> check_words = [](const std::vector<std::string>&) {};
  SweepVerbs swept = sweep_verbs();  ///< verbs that sweeps may be of
};

/// A workspace as a page in a browser of this machine: server, running loop, recordings, jobs and sessions.
/// Everything below /subject/ is for the subject of a session, who has a token for that alone.
class Studio {
 public:
  /// Serves from now on. @throws std::invalid_argument: no such folder, the address or port cannot be had.
  explicit Studio(const StudioOptions& options);
  Studio(const Studio&) = delete;
  Studio& operator=(const Studio&) = delete;
  /// Ends a session (it can be gone on with), a recording (it is closed), jobs and the loop.
  ~Studio();

  /// The address to open, with its token.
  [[nodiscard]] std::string url() const;
  /// Other machines cannot reach it.
  [[nodiscard]] bool is_loopback() const noexcept;

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace kerf::bench
