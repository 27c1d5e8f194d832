#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <pty.h>
#include <unistd.h>

#include "sealed/session_store.h"
#include "session/rehearsal.h"
#include "subject/subject_page.h"
#include "subject/subject_terminal.h"
#include "support/disks/full_disk.h"
#include "support/plain_client.h"

namespace kerf::test {

/// A disk that is full when the second answer is given.
class FullAsItAnswers : public bench::RehearsalSubject {
 public:
  FullAsItAnswers(bench::SessionStore& store, std::filesystem::path journal)
      : bench::RehearsalSubject(7), store_(store), journal_(std::move(journal)) {}
  std::optional<bench::SubjectAction> next() override {
    const auto action = bench::RehearsalSubject::next();
    if (action && action->kind == bench::SubjectAction::Kind::answer && store_.trials().size() == 1 && !disk_)
      disk_.emplace(std::filesystem::file_size(journal_) + 100);
    return action;
  }

 protected:
  [[nodiscard]] std::size_t answered() const { return store_.trials().size(); }
  void make_room() { disk_.reset(); }

 private:
  bench::SessionStore& store_;
  std::filesystem::path journal_;
  std::optional<FullDisk> disk_;
};

/// And is full for two more.
class FullWhileItAnswers : public FullAsItAnswers {
 public:
  using FullAsItAnswers::FullAsItAnswers;
  void show(const bench::SubjectView& view) override {
    notice_ = view.notice;
    may_answer_ = view.may_answer;
    bench::RehearsalSubject::show(view);
  }
  std::optional<bench::SubjectAction> next() override {
    return notice_.empty() ? FullAsItAnswers::next() : answer_again();
  }
  [[nodiscard]] int refusals() const { return refusals_; }

 private:
  std::optional<bench::SubjectAction> answer_again() {
    EXPECT_THAT(notice_,
                testing::HasSubstr("could not be stored (File too large). Please call the experimenter"));
    EXPECT_TRUE(may_answer_);
    EXPECT_EQ(answered(), 1U);
    if (++refusals_ == 3) make_room();
    return bench::SubjectAction{.kind = bench::SubjectAction::Kind::answer, .slot = 1};
  }

  std::string notice_;
  bool may_answer_ = false;
  int refusals_ = 0;
};

struct PseudoTerminal {
  PseudoTerminal() {
    setenv("TERM", "xterm", 1);
    winsize size{.ws_row = 24, .ws_col = 120, .ws_xpixel = 0, .ws_ypixel = 0};
    if (openpty(&keyboard, &terminal, nullptr, nullptr, &size) != 0)
      throw std::runtime_error("no pseudo terminal");
    fcntl(keyboard, F_SETFL, O_NONBLOCK);
  }
  PseudoTerminal(const PseudoTerminal&) = delete;
  PseudoTerminal& operator=(const PseudoTerminal&) = delete;
  ~PseudoTerminal() {
    close(keyboard);
    close(terminal);
  }
  int keyboard = -1;
  int terminal = -1;
};

/// The same at a keyboard: what is decided is typed, and what comes of that is the terminal's doing.
class TypedAtATerminal : public bench::Subject {
 public:
  TypedAtATerminal(bench::SessionStore& store, std::filesystem::path journal)
      : decided_(store, std::move(journal)), terminal_(pair_.terminal, pair_.terminal) {}

  void show(const bench::SubjectView& view) override {
    view_ = view;
    decided_.show(view);
    terminal_.show(view);
  }
  std::optional<bench::SubjectAction> next() override {
    const auto decided = decided_.next();
    if (!decided) return terminal_.next();
    const std::string keys = keys_of(*decided);
    EXPECT_EQ(write(pair_.keyboard, keys.data(), keys.size()), static_cast<ssize_t>(keys.size()));
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);
    while (std::chrono::steady_clock::now() < end) {
      read_screen();
      if (const auto action = terminal_.next()) return action;
    }
    ADD_FAILURE() << "the terminal did not take what was typed";
    return bench::SubjectAction{.kind = bench::SubjectAction::Kind::quit};
  }
  [[nodiscard]] int refusals() const { return decided_.refusals(); }
  [[nodiscard]] const std::string& screen() const { return screen_; }

 private:
  [[nodiscard]] std::string keys_of(const bench::SubjectAction& action) const {
    using Kind = bench::SubjectAction::Kind;
    if (action.kind == Kind::go_on) return " ";
    return (action.kind == Kind::answer ? "\r" : "") + view_.labels.at(action.slot);
  }
  void read_screen() {
    std::array<char, 4096> bytes{};
    for (ssize_t count = 0; (count = read(pair_.keyboard, bytes.data(), bytes.size())) > 0;)
      screen_.append(bytes.data(), static_cast<std::size_t>(count));
  }

  FullWhileItAnswers decided_;
  PseudoTerminal pair_;
  bench::TerminalSubject terminal_;
  bench::SubjectView view_;
  std::string screen_;
};

/// The same on a page: what is decided is sent as the page sends it, of the view that the page has.
class ClickedOnAPage : public bench::Subject {
 public:
  ClickedOnAPage(bench::SessionStore& store, std::filesystem::path journal)
      : decided_(store, std::move(journal)) {}

  void show(const bench::SubjectView& view) override {
    decided_.show(view);
    page_.show(view);
  }
  std::optional<bench::SubjectAction> next() override {
    const auto decided = decided_.next();
    if (!decided) return page_.next();
    const auto seen = nlohmann::json::parse(body_of(ask("GET /view?after=0", "")));
    notices_ += seen["notice"].get<std::string>();
    const nlohmann::json action = {{"kind", name_of(decided->kind)},
                                   {"slot", decided->slot},
                                   {"stage", seen["stage"]},
                                   {"trial", seen["trial"]}};
    EXPECT_EQ(status_of(ask("POST /action", action.dump())), "200");
    return page_.next();
  }
  [[nodiscard]] int refusals() const { return decided_.refusals(); }
  [[nodiscard]] const std::string& notices() const { return notices_; }

 private:
  static const char* name_of(bench::SubjectAction::Kind kind) {
    using Kind = bench::SubjectAction::Kind;
    switch (kind) {
      case Kind::go_on:
        return "go_on";
      case Kind::decline:
        return "decline";
      case Kind::play:
        return "play";
      case Kind::answer:
        return "answer";
      case Kind::quit:
        return "quit";
      case Kind::slip:
        return "slip";
    }
    return "?";
  }
  [[nodiscard]] std::string ask(const std::string& line, const std::string& body) const {
    const std::string url = page_.url();
    const std::string host = url.substr(7, url.find('/', 7) - 7);
    const std::string port = host.substr(host.find(':') + 1);
    const std::string token = url.substr(url.find('=') + 1);
    return answer_to(static_cast<std::uint16_t>(std::stoi(port)),
                     fmt::format("{} HTTP/1.1\r\nHost: {}\r\nX-Kerf-Token: {}\r\nContent-Type: "
                                 "application/json\r\nContent-Length: {}\r\n\r\n{}",
                                 line, host, token, body.size(), body));
  }

  FullWhileItAnswers decided_;
  bench::ServedSubject page_;
  std::string notices_;
};

}  // namespace kerf::test
