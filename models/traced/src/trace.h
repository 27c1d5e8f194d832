#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <unordered_map>
#include <vector>

#include "kerf/traced/program.h"

namespace kerf::traced {

/// What the traced numbers of this thread note in. One at a time.
class Trace {
 public:
  Trace();
  Trace(const Trace&) = delete;
  Trace& operator=(const Trace&) = delete;
  ~Trace();
  static Trace& running() noexcept;

  Node add(Noted noted);
  Node add_table(std::vector<double> values, bool single);
  bool decide(Node condition) noexcept;
  void refuse(const char* why) noexcept;

  /// Runs a tick along every way, `run` again and again, until each condition that it met has been answered
  /// both ways. @throws std::invalid_argument with what was refused, or if there are too many.
  template <typename Run>
  Tick along_all_ways(Run&& run) {
    Tick tick;
    answers_.clear();
    do {
      begin_run();
      Outcome outcome = run();
      end_run(tick, std::move(outcome));
    } while (next_answers());
    return tick;
  }

  Program program;

 private:
  void begin_run();
  void end_run(Tick& tick, Outcome outcome);
  bool next_answers();
  void know(Node condition, bool answer);

  std::unordered_map<std::size_t, std::vector<Node>> by_hash_;
  std::vector<bool> answers_;  ///< of the conditions that are met, in order
  std::vector<Node> met_;
  std::map<Node, bool> known_;
  std::string refusal_;
  std::size_t runs_ = 0;
};

}  // namespace kerf::traced
