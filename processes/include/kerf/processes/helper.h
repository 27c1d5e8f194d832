#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include <sys/types.h>

/// Programs that this one starts to do what must not be done within it.
namespace kerf::processes {

/// A descriptor that is closed at the end of its scope; -1: none.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int number) noexcept : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(other.release()) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  ~Descriptor() { reset(); }
  [[nodiscard]] int number() const noexcept { return number_; }
  int release() noexcept { return std::exchange(number_, -1); }
  void reset() noexcept;

 private:
  int number_ = -1;
};

/// Two ends of a connection, of this process alone until one is handed on.
struct Connection {
  Descriptor ours;
  Descriptor theirs;
};
/// @param type SOCK_STREAM or SOCK_SEQPACKET. Its ends have the number -1, and errno says why, if there is
/// none.
[[nodiscard]] Connection connection(int type) noexcept;

/// Where a program lies that belongs to this one: in their own folder (libexec/kerf) of where both were
/// installed, or beside this one, where there is no such folder. Nothing that merely lies beside an installed
/// program is taken for one of them.
[[nodiscard]] std::filesystem::path helper_program(std::string_view name);

/// Where they lie for a program that is none of the house and has loaded a part of it: the Python module. Set
/// up before threads are started.
void look_for_helpers_in(std::filesystem::path folder);

/// The first descriptor that a helper is given; further ones follow it.
inline constexpr int first_descriptor = 3;

/// Starts a program with nothing but those descriptors, numbered from first_descriptor on, /dev/null as its
/// standard ones, deaf to signals, in a session of its own: what ends this program from outside, or its
/// group, does not end the helper. @returns an error number; 0: it runs.
[[nodiscard]] int start(const std::filesystem::path& program, std::span<const int> descriptors,
                        pid_t& process, std::span<const std::string> arguments = {});

/// Waits until a child that is about to end has ended. @returns its status as of waitpid().
int wait_for(pid_t process) noexcept;

/// Waits until a descriptor can be read, or its other end is closed, whatever signals come meanwhile.
/// @returns false after that time [ms].
[[nodiscard]] bool becomes_readable(int descriptor, int timeout_ms) noexcept;

}  // namespace kerf::processes
