#include "regress/renderers/lockstep.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <ctime>
#include <memory>
#include <stdexcept>
#include <system_error>
#include <thread>

#include <fmt/ranges.h>
#include <nlohmann/json.hpp>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>

#include "import/decimal.h"
#include "regress/renderers/child_program.h"
#include "regress/renderers/force_columns.h"
#include "regress/renderers/line_link.h"
#include "regress/renderers/trajectory_table.h"

namespace kerf::bench {
namespace {

using json = nlohmann::ordered_json;
using Clock = LineLink::Clock;

constexpr double rates_alike = 1e-3;  ///< relative; how even the ticks of a rate are

/// Keeps a pipe whose reader has gone from ending this program.
class NoPipeSignal {
 public:
  NoPipeSignal() noexcept {
    sigemptyset(&pipe_);
    sigaddset(&pipe_, SIGPIPE);
    pthread_sigmask(SIG_BLOCK, &pipe_, &before_);
  }
  NoPipeSignal(const NoPipeSignal&) = delete;
  NoPipeSignal& operator=(const NoPipeSignal&) = delete;
  ~NoPipeSignal() {
    if (sigismember(&before_, SIGPIPE) == 1) return;
    const timespec at_once{};
    while (sigtimedwait(&pipe_, nullptr, &at_once) == SIGPIPE) {
    }
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }

 private:
  sigset_t pipe_{};
  sigset_t before_{};
};

/// A socket that a renderer connects to.
int listen_at(const std::filesystem::path& file) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string& name = file.native();
  if (name.size() >= sizeof address.sun_path)
    throw std::invalid_argument(fmt::format(
        "the socket {} has a longer name than the {} bytes that there may be; set TMPDIR to a shorter folder",
        name, sizeof address.sun_path - 1));
  name.copy(address.sun_path, name.size());
  const int listener = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): the way of sockets
  if (listener < 0 || bind(listener, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      listen(listener, 1) != 0)
    throw std::system_error(errno, std::generic_category(), "a socket for a renderer");
  return listener;
}

/// The rate of even ticks; none of others.
std::optional<double> rate_of(const SampledMotion& motion) {
  if (motion.ticks() < 2) return {};
  const double period =
      (motion.time_s.back() - motion.time_s.front()) / static_cast<double>(motion.ticks() - 1);
  for (std::size_t tick = 1; tick < motion.ticks(); ++tick) {
    const double step = motion.time_s[tick] - motion.time_s[tick - 1];
    if (std::abs(step - period) > rates_alike * period) return {};
  }
  return 1.0 / period;
}

/// One case with a renderer that is asked.
class Conversation {
 public:
  Conversation(const OutsideRenderer& renderer, const SampledMotion& motion,
               const std::vector<std::string>& command, const std::filesystem::path& socket)
      : renderer_(renderer),
        motion_(motion),
        rate_(rate_of(motion)),
        trajectory_{renderer.axes, renderer.quaternion},
        deadline_(Clock::now() + seconds(renderer.timeout_s)) {
    if (socket.empty()) {
      to_.emplace();
      from_.emplace();
      program_ = std::make_unique<ChildProgram>(ChildProgram::Start{.command = command,
                                                                    .folder = renderer.folder,
                                                                    .input = to_->reads.number(),
                                                                    .output = from_->writes.number()});
      to_->reads.reset();
      from_->writes.reset();
      link_.emplace(*program_, from_->reads.number(), to_->writes.number());
    } else {
      const Descriptor listener(listen_at(socket));
      program_ =
          std::make_unique<ChildProgram>(ChildProgram::Start{.command = command, .folder = renderer.folder});
      accept_from(listener);
      link_.emplace(*program_, socket_.number(), socket_.number());
    }
  }

  RenderedForces render() {
    greet();
    RenderedForces got;
    for (const models::LawAxis& axis : renderer_.axes) got.channels.push_back({axis.name, axis.force_unit});
    got.compute_time_of = columns_.compute_time < width_ ? "renderer" : "round trip";
    const auto begin = Clock::now();
    for (std::size_t tick = 0; tick < motion_.ticks(); ++tick) {
      if (renderer_.lockstep->by_the_wall) std::this_thread::sleep_until(due(begin, tick));
      ask(tick, got);
      if (renderer_.lockstep->by_the_wall && tick + 1 < motion_.ticks() &&
          Clock::now() > due(begin, tick + 1))
        ++got.late;
    }
    take_leave();
    return got;
  }

 private:
  static Clock::duration seconds(double length) {
    return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(length));
  }
  [[nodiscard]] Clock::time_point due(Clock::time_point begin, std::size_t tick) const {
    return begin + seconds(motion_.time_s[tick] - motion_.time_s.front());
  }
  [[nodiscard]] Clock::time_point answer_due() const {
    return std::min(deadline_, Clock::now() + seconds(renderer_.lockstep->answer_s));
  }

  void accept_from(const Descriptor& listener) {
    std::array<pollfd, 1> connection{{{.fd = listener.number(), .events = POLLIN, .revents = 0}}};
    const bool has_ended = program_->wait(connection, deadline_);
    if (connection[0].revents == 0)
      fail(has_ended ? LineLink::Outcome::ended : LineLink::Outcome::late, "connected to {socket}");
    socket_ = Descriptor(accept4(listener.number(), nullptr, nullptr, SOCK_CLOEXEC));
    if (socket_.number() < 0)
      throw std::system_error(errno, std::generic_category(), "a renderer's connection");
  }

  /// Ends it for what it has or has not done.
  [[noreturn]] void fail(const std::string& what) {
    program_->kill_group();
    throw RendererError("the renderer " + what + program_->last_words(), last_lines(program_->errors.said()));
  }
  /// @param done what it has not done: "answered tick 5"
  [[noreturn]] void fail(LineLink::Outcome outcome, const std::string& done) {
    switch (outcome) {
      case LineLink::Outcome::late:
        if (Clock::now() >= deadline_)
          fail(fmt::format("had not {} when its {:g} s were over and was killed with its process group", done,
                           renderer_.timeout_s));
        fail(fmt::format("had not {} after {:g} s and was killed with its process group", done,
                         renderer_.lockstep->answer_s));
      case LineLink::Outcome::endless:
        fail(fmt::format("had not {} after {} bytes without the end of a line and was killed", done,
                         LineLink::longest_line));
      case LineLink::Outcome::closed:
        fail(fmt::format("had not {} when it closed its side", done));
      case LineLink::Outcome::ended:
      case LineLink::Outcome::done:
        break;
    }
    fail(fmt::format("{} before it had {}", end_in_words(program_->kill_group()), done));
  }

  std::string_view exchange(std::string_view question, const std::string& done, Clock::time_point due) {
    std::string_view line;
    LineLink::Outcome outcome = link_->send(question, due);
    if (outcome == LineLink::Outcome::done) outcome = link_->receive(line, due);
    if (outcome != LineLink::Outcome::done) fail(outcome, done);
    return line;
  }

  [[nodiscard]] std::string hello() const {
    json axes = json::array();
    json answer{"tick"};
    for (const models::LawAxis& axis : renderer_.axes) {
      axes.push_back({{"name", axis.name}, {"position", axis.position_unit}, {"force", axis.force_unit}});
      answer.push_back(force_column(axis));
    }
    json line{{"hello", "kerf lockstep"},
              {"version", lockstep_version},
              {"axes", axes},
              {"columns", trajectory_.names()},
              {"answer", answer},
              {"rate_hz", rate_ ? json(*rate_) : json(nullptr)},
              {"ticks", motion_.ticks()},
              {"seed", renderer_.seed},
              {"sign", renderer_.sign},
              {"frame", renderer_.frame},
              {"clock", renderer_.lockstep->by_the_wall ? "wall" : "virtual"}};
    if (!renderer_.quaternion.empty()) line["quaternion"] = renderer_.quaternion;
    return line.dump() + '\n';
  }

  /// What it says of itself has to be what the suite says.
  void require_hello(const json& hello) {
    if (hello.at("version") != lockstep_version)
      fail(fmt::format("speaks version {} of the protocol, expected {}", hello.at("version").dump(),
                       lockstep_version));
    std::vector<std::string> columns = hello.at("columns");
    width_ = columns.size();
    columns_ = force_columns(columns, renderer_, "tick");
    require_declared("sign", hello.at("sign").get<std::string>(), renderer_);
    for (const char* const what : {"frame", "quaternion"}) {
      if (hello.contains(what)) require_declared(what, hello.at(what).get<std::string>(), renderer_);
    }
    const auto require_number = [&](const char* what, std::optional<double> expected) {
      if (!hello.contains(what) || (hello.at(what).is_null() && !expected)) return;
      const double got = hello.at(what);
      if (expected && std::abs(got - *expected) <= rates_alike * *expected) return;
      fail(fmt::format("says {} {:g}, and the case has {}", what, got,
                       expected ? fmt::format("{:g}", *expected) : "none: its ticks are not even"));
    };
    require_number("rate_hz", rate_);
    if (hello.contains("seed") && hello.at("seed") != renderer_.seed)
      fail(fmt::format("says seed {}, and the case has {}", hello.at("seed").dump(), renderer_.seed));
  }

  void greet() {
    const std::string_view line = exchange(hello(), "answered the hello", deadline_);
    const json answer = json::parse(line, nullptr, false);
    if (!answer.is_object() || !answer.contains("hello") || answer.at("hello") != "kerf lockstep")
      refuse_hello(line);
    try {
      require_hello(answer);
    } catch (const nlohmann::json::exception&) {  // a key that is missing, or of another kind
      refuse_hello(line);
    }
  }
  [[noreturn]] void refuse_hello(std::string_view line) {
    fail(fmt::format(R"(gave the hello '{}', expected a line such as {{"hello":"kerf lockstep","version":{},)"
                     R"("columns":["tick","{}"],"sign":"{}"}}; what is for people belongs on standard error)",
                     in_print(line), lockstep_version, force_column(renderer_.axes.front()), renderer_.sign));
  }

  void ask(std::size_t tick, RenderedForces& got) {
    question_.clear();
    trajectory_.append_row(question_, motion_, tick);
    question_ += '\n';
    const auto begin = Clock::now();
    const std::string_view line = exchange(question_, fmt::format("answered tick {}", tick), answer_due());
    const std::chrono::duration<double> round_trip = Clock::now() - begin;
    read_values(line, tick);
    if (values_[columns_.key] != static_cast<double>(tick))
      fail(fmt::format("answered tick {:g} where it was asked for tick {}: out of order, lost or late",
                       values_[columns_.key], tick));
    if (link_->more_came())
      fail(fmt::format("said more than its answer to tick {}, before it was asked again", tick));
    for (const std::size_t column : columns_.forces) got.force.push_back(values_[column]);
    got.compute_time_s.push_back(columns_.compute_time < width_ ? values_[columns_.compute_time]
                                                                : round_trip.count());
    if (columns_.fault == width_ || values_[columns_.fault] == 0.0) return;
    if (!got.first_fault) got.first_fault = tick;
    ++got.faults;
  }

  void read_values(std::string_view line, std::size_t tick) {
    values_.clear();
    const char* at = line.data();
    const char* const end = at + line.size();
    while (at != end) {
      double value = 0.0;
      const char* const stop = parse_decimal(at, end, '.', value);
      if (stop == at || (stop != end && *stop != ',')) break;
      values_.push_back(value);
      at = stop == end ? end : stop + 1;
      if (stop != end && at == end) break;
    }
    if (at == end && values_.size() == width_ && !line.ends_with(',')) return;
    fail(
        fmt::format("answered tick {} with '{}', expected {} numbers with commas between them; what is for "
                    "people belongs on standard error",
                    tick, in_print(line), width_));
  }

  void take_leave() {
    if (to_) to_->writes.reset();
    if (socket_.number() >= 0) shutdown(socket_.number(), SHUT_WR);
    const LineLink::Outcome outcome = link_->wait_for_end(answer_due());
    if (link_->more_came()) fail(fmt::format("said more than its answers to {} ticks", motion_.ticks()));
    if (outcome != LineLink::Outcome::done) fail(outcome, "ended after its last tick");
    const int status = program_->kill_group();
    if (status != 0) fail(end_in_words(status) + " after its last tick, expected status 0");
  }

  const OutsideRenderer& renderer_;
  const SampledMotion& motion_;
  std::optional<double> rate_;
  TrajectoryColumns trajectory_;
  Clock::time_point deadline_;
  std::optional<Pipe> to_;
  std::optional<Pipe> from_;
  Descriptor socket_;
  std::unique_ptr<ChildProgram> program_;
  std::optional<LineLink> link_;
  ForceColumns columns_;
  std::size_t width_ = 0;
  std::string question_;
  std::vector<double> values_;
};

}  // namespace

RenderedForces render_in_lockstep(const OutsideRenderer& renderer, const SampledMotion& motion,
                                  const std::vector<std::string>& command,
                                  const std::filesystem::path& socket) {
  const NoPipeSignal no_signal;
  return Conversation(renderer, motion, command, socket).render();
}

}  // namespace kerf::bench
