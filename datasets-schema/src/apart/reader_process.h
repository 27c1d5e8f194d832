#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <sys/types.h>

#include <kerf/processes/helper.h>

#include "apart/archive.h"
#include "apart/pieces.h"

namespace kerf::schema::apart {

/// A process of its own, `kerf-reader`, that reads one file with HDF5: what a damaged file does to HDF5, it
/// does there. For one thread at a time.
class ReaderProcess {
 public:
  /// @throws std::invalid_argument (there is no such file, or it may not be read), std::system_error (the
  ///         reader does not start).
  /// @param expected "a recording", "a session", ...
  ReaderProcess(const std::filesystem::path& file, std::string_view expected);
  ReaderProcess(const ReaderProcess&) = delete;
  ReaderProcess& operator=(const ReaderProcess&) = delete;
  ~ReaderProcess();

  /// @throws what the reader does; DamageError if it falls over or does not answer.
  template <typename T>
  [[nodiscard]] T ask(const Request& request) {
    T value{};
    begin(request);
    ValueReader(*this).read(value);
    end();
    return value;
  }

  /// How long to wait for a piece of an answer [ms]; nullopt: as long as the slowest disk takes to give the
  /// whole file, and a minute.
  void set_timeout(std::optional<int> ms) noexcept { timeout_ms_ = ms.value_or(usual_timeout_ms_); }

  // An answer of several parts: begin(), as many get() as it has, end().
  void begin(const Request& request);
  /// The next so many bytes.
  void get(void* to, std::size_t bytes);
  void get(std::span<std::byte> bytes) { get(bytes.data(), bytes.size()); }
  /// So many numbers: no more than the file can hold, whatever the reader says.
  template <typename Number>
  void get(std::vector<Number>& numbers, std::uint64_t count) {
    if (count > max_bytes_ / sizeof(Number)) give_up("its reader says more than the file can hold");
    numbers.resize(count);
    get(std::as_writable_bytes(std::span(numbers)));
  }
  void end();
  /// The facts of a recording, which the answer begins with. @throws DamageError if they do not go together.
  [[nodiscard]] in_process::RecordingFacts get_facts();

 private:
  void next_piece();
  void copied();
  [[nodiscard]] std::string text_of_piece() const;
  [[nodiscard]] std::string in_our_words(std::string text) const;
  [[noreturn]] void refuse_as_it_does(Kind kind, int error_number);
  [[noreturn]] void give_up(const std::string& why);
  [[nodiscard]] std::string how_it_ended();

  std::filesystem::path file_;
  std::uintmax_t max_bytes_ = 0;
  int usual_timeout_ms_ = 0;
  int timeout_ms_ = 0;
  pid_t process_ = 0;
  processes::Descriptor socket_;
  std::byte* window_ = nullptr;
  std::size_t half_ = 0;                ///< that the next piece lies in
  std::span<const std::byte> piece_{};  ///< what of it was not read yet
  bool is_last_ = true;
};

}  // namespace kerf::schema::apart
