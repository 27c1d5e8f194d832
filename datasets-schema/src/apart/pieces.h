#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

/// What a program and its `kerf-reader` agree upon.
namespace kerf::schema::apart {

/// The descriptors with which a reader begins.
inline constexpr int reader_of_file = 3;   ///< opened for reading
inline constexpr int reader_to_asker = 4;  ///< SOCK_SEQPACKET; its end ends the reader
inline constexpr int reader_of_window = 5;

enum class Ask : std::uint32_t {
  whole_recording,               ///< RecordingFacts, then all rows of one dataset after the other
  recording,                     ///< RecordingFacts; it stays open
  recording_with_trusted_texts,  ///< the same, without a look through all texts
  rows,                          ///< of the open recording, as they lie in memory
  tail,
  stored_forces,
  session,
  session_facts,
  sealed,  ///< of the entry `first`
  schema,
  violations,
  sweep_tables,  ///< SweepTablesFacts; it stays open
  sweep_column   ///< all rows of column `first` of table `dataset`, as float64
};

struct Request {
  Ask what = Ask::schema;
  std::uint32_t dataset = 0;
  std::uint64_t first = 0;
  std::uint64_t rows = 0;
};

/// An answer comes in pieces, which lie in the two halves of a window by turns. Of each the socket says:
enum class Kind : std::uint32_t {
  more,          ///< another one follows
  last,          ///< the answer is whole
  format_error,  ///< the piece is the text of a FormatError
  damage,        ///< the piece is the reason of a DamageError
  system_error   ///< the piece is a text, beside errno
};
struct Piece {
  Kind kind = Kind::last;
  std::uint32_t bytes = 0;
  std::int32_t error_number = 0;
};
/// Whoever has copied a piece says so: then its half may be filled again.
inline constexpr char piece_is_copied = 'c';

inline constexpr std::size_t half_bytes = std::size_t{1} << 20U;
inline constexpr std::size_t window_bytes = 2 * half_bytes;
using Window = std::span<std::byte, window_bytes>;

/// The side that answers: fills the halves and waits only when both are full.
class PieceSink {
 public:
  PieceSink(int socket, Window window) : socket_(socket), window_(window) {}

  void put(const void* bytes, std::size_t count);
  /// Room for at least so many bytes, one half at most, to be filled where it lies; then filled().
  [[nodiscard]] std::span<std::byte> room(std::size_t least);
  void filled(std::size_t count) noexcept { used_ += count; }
  /// Ends the answer, and waits until all of it was copied.
  void end(Kind kind = Kind::last, int error_number = 0);
  /// What was put but not yet sent is forgotten.
  void take_back() noexcept { used_ = 0; }

 private:
  void send(Kind kind, int error_number);
  void wait_for_copy();
  [[nodiscard]] std::span<std::byte> half() const;

  int socket_;
  Window window_;
  std::size_t used_ = 0;
  std::uint64_t sent_ = 0;
  std::uint64_t copied_ = 0;
};

}  // namespace kerf::schema::apart
