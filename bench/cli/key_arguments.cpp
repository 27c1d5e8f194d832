#include "cli/key_arguments.h"

#include <cstdio>
#include <memory>
#include <stdexcept>

#include <fmt/core.h>
#include <termios.h>
#include <unistd.h>

namespace kerf::bench {
namespace {

/// The terminal without echo, and as it was again.
class WithoutEcho {
 public:
  explicit WithoutEcho(int terminal) : terminal_(terminal) {
    tcgetattr(terminal_, &before_);
    termios silent = before_;
    silent.c_lflag &= ~static_cast<tcflag_t>(ECHO);
    tcsetattr(terminal_, TCSAFLUSH, &silent);
  }
  WithoutEcho(const WithoutEcho&) = delete;
  WithoutEcho& operator=(const WithoutEcho&) = delete;
  ~WithoutEcho() { tcsetattr(terminal_, TCSAFLUSH, &before_); }

 private:
  int terminal_;
  termios before_{};
};

std::string ask(std::string_view prompt) {
  const std::unique_ptr<FILE, int (*)(FILE*)> terminal(std::fopen("/dev/tty", "r+"), &std::fclose);
  if (!terminal)
    throw std::invalid_argument(
        "the passphrase is asked for at a terminal, and there is none; give a key file with --key-file");
  const WithoutEcho silent(fileno(terminal.get()));
  fmt::print(terminal.get(), "{}: ", prompt);
  std::fflush(terminal.get());
  std::string text;
  for (int c = std::fgetc(terminal.get()); c != EOF && c != '\n'; c = std::fgetc(terminal.get()))
    text.push_back(static_cast<char>(c));
  fmt::print(terminal.get(), "\n");
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
