#include "experiment/key_arguments.h"

#include <cerrno>
#include <optional>
#include <stdexcept>
#include <string_view>

#include <fcntl.h>
#include <fmt/core.h>
#include <termios.h>
#include <unistd.h>

#include "program/standard_streams.h"

namespace kerf::bench {
namespace {

/// The terminal without echo, and as it was again. Ctrl-C comes as a character, so that it cannot leave the
/// terminal silent.
class WithoutEcho {
 public:
  explicit WithoutEcho(int terminal) : terminal_(terminal) {
    tcgetattr(terminal_, &before_);
    termios silent = before_;
    silent.c_lflag &= ~static_cast<tcflag_t>(ECHO | ISIG | ICANON);
    silent.c_cc[VMIN] = 1;
    silent.c_cc[VTIME] = 0;
    tcsetattr(terminal_, TCSAFLUSH, &silent);
  }
  WithoutEcho(const WithoutEcho&) = delete;
  WithoutEcho& operator=(const WithoutEcho&) = delete;
  ~WithoutEcho() { tcsetattr(terminal_, TCSAFLUSH, &before_); }

 private:
  int terminal_;
  termios before_{};
};

/// The terminal of the program, whatever its input and output are.
class Terminal {
 public:
  Terminal() : number_(open("/dev/tty", O_RDWR | O_CLOEXEC | O_NOCTTY)) {
    if (number_ < 0)
      throw std::invalid_argument(
          "the passphrase is asked for at a terminal, and there is none; give a key file with --key-file");
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;
  ~Terminal() { close(number_); }

  [[nodiscard]] int number() const noexcept { return number_; }
  void say(std::string_view text) const {
    [[maybe_unused]] const ssize_t ignored = write(number_, text.data(), text.size());
  }
  /// The next character; nothing at the end.
  [[nodiscard]] std::optional<char> next() const {
    char c = 0;
    ssize_t count = -1;
    while ((count = read(number_, &c, 1)) < 0 && errno == EINTR) {
    }
    return count == 1 ? std::optional(c) : std::nullopt;
  }

 private:
  int number_;
};

void take_back(std::string& text) {
  const auto is_within = [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; };  // UTF-8
  while (!text.empty() && is_within(text.back())) text.pop_back();
  if (!text.empty()) text.pop_back();
}

std::string ask(std::string_view prompt) {
  constexpr std::string_view leaves("\3\4");  // Ctrl-C, Ctrl-D
  const Terminal terminal;
  let_lines_out();  // a warning before the question, not behind it
  const WithoutEcho silent(terminal.number());
  terminal.say(fmt::format("{}: ", prompt));
  std::string text;
  std::optional<char> c = terminal.next();
  for (; c && *c != '\n' && *c != '\r' && leaves.find(*c) == std::string_view::npos; c = terminal.next()) {
    if (*c == '\b' || *c == '\x7f') {
      take_back(text);
    } else {
      text.push_back(*c);
    }
  }
  terminal.say("\n");
  if (!c || leaves.find(*c) != std::string_view::npos)
    throw std::invalid_argument("no passphrase was given; nothing was done");
  return text;
}

SealKey key_of(const KeyArguments& arguments, const schema::KeyDerivation& derivation) {
  return arguments.passphrase ? SealKey::from_passphrase(*arguments.passphrase, derivation)
                              : SealKey::from_file(arguments.key_file, derivation);
}

}  // namespace

void add_key_options(Verb& verb, KeyArguments& arguments) {
  verb.add_option("--key-file", arguments.key_file,
                  "Key file of whoever keeps the blinding (default: a passphrase is asked for)");
}

SealKey key_for(KeyArguments& arguments, const schema::KeyDerivation& derivation) {
  const bool by_passphrase = derivation.kind == "passphrase";
  if (by_passphrase && !arguments.key_file.empty())
    throw std::invalid_argument(
        "--key-file: the session was sealed with a passphrase; leave the key file out");
  if (!by_passphrase && arguments.key_file.empty())
    throw std::invalid_argument("the session was sealed with a key file; give it with --key-file");
  if (by_passphrase && !arguments.passphrase) arguments.passphrase = ask("Passphrase of the session");
  return key_of(arguments, derivation);
}

SealKey new_key_for(KeyArguments& arguments, const schema::KeyDerivation& derivation) {
  if (arguments.key_file.empty() && !arguments.passphrase) {
    arguments.passphrase = ask("New passphrase, for whoever keeps the blinding");
    require_long_enough(*arguments.passphrase);
    if (ask("Once more") != *arguments.passphrase)
      throw std::invalid_argument("the two passphrases are not the same; nothing was written");
  }
  return key_of(arguments, derivation);
}

}  // namespace kerf::bench
