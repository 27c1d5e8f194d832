#include <algorithm>
#include <stdexcept>
#include <string_view>

#include <fmt/core.h>
#include <unistd.h>

#include "sealed/bytes.h"
#include "sealed/journal.h"
#include "sealed/journal_format.h"

namespace kerf::bench {
namespace {

using namespace journal_format;
using Bytes = std::span<const std::uint8_t>;

constexpr std::uint64_t sector = 512;

bool are_equal(Bytes one, Bytes other) { return std::ranges::equal(one, other); }

bool are_zero(Bytes bytes) {
  return std::ranges::all_of(bytes, [](std::uint8_t byte) { return byte == 0; });
}

ByteWriter head_of(const schema::Session& session, std::uint64_t first) {
  ByteWriter head;
  head.bytes(as_bytes(head_mark));
  head.bytes(as_bytes(session.uuid));
  head.number(first);
  head.bytes(check_of(blake2b({head.written()})));
  head.number(static_cast<std::uint64_t>(::getpid()));
  return head;
}

/// A power failure leaves whole sectors of a file unwritten, which read as zeros; what is sealed looks like
/// chance, and has none.
bool has_unwritten_sector(std::uint64_t at, Bytes bytes) {
  while (!bytes.empty()) {
    const std::size_t piece = std::min<std::size_t>(sector - at % sector, bytes.size());
    if (are_zero(bytes.first(piece))) return true;
    bytes = bytes.subspan(piece);
    at += piece;
  }
  return false;
}

}  // namespace

void Journal::refuse(const std::string& what) const {
  throw schema::FormatError(fmt::format("{}: {}", file_.string(), what));
}

void Journal::start(const schema::Session& session) {
  end_ = 0;
  cut_off();
  write(0, head_of(session, session.entries.size()).written());
  flush();
  bring_to_disk(file_.parent_path());
  end_ = head_size;
  entries_.clear();
  places_.clear();
}

std::uint64_t Journal::read_head(const schema::Session& session) const {
  auto head = read(0, head_size);
  head.resize(head_size);
  const Bytes checked = Bytes(head).first(head_size - 8 - check_size);
  if (!are_equal(check_of(blake2b({checked})), Bytes(head).subspan(checked.size(), check_size))) {
    refuse("found no head of a journal, expected one; move it away to go on with what " + session_.string() +
           " holds");
  }
  ByteReader reader(checked.subspan(head_mark.size()));
  const auto uuid = reader.bytes(uuid_size);
  if (!are_equal(uuid, as_bytes(session.uuid))) {
    refuse(fmt::format("belongs to another session ({}), expected {}; move it away to go on without it",
                       std::string(uuid.begin(), uuid.end()), session.uuid));
  }
  return reader.number<std::uint64_t>();
}

void Journal::take_up(const schema::Session& session) {
  if (session.uuid.size() != uuid_size) {
    throw schema::FormatError(
        fmt::format("{}: found the uuid '{}', expected 36 characters", session_.string(), session.uuid));
  }
  if (const auto all = read(0, std::min<std::uint64_t>(size(), head_size));
      all.size() < head_size || (size() == head_size && are_zero(all))) {
    // A crash while it was begun, or nothing yet.
    if (may_write_) start(session);
    return;
  }
  const std::uint64_t first = read_head(session);
  end_ = head_size;
  read_records();
  skip_those_in(session, first);
  if (!may_write_) return;
  if (entries_.empty()) return start(session);
  ByteWriter number;
  number.number(static_cast<std::uint64_t>(::getpid()));
  write(pid_at, number.written());
}

void Journal::read_records() {
  const std::uint64_t all = size();
  while (end_ < all && read_record(all)) {
  }
  if (end_ == all) return;
  if (!may_write_ && !being_run_) ask_whether_run();  // a run may have begun meanwhile
  if (being_run_) return;                             // what is being written is not whole yet
  warnings_.push_back(fmt::format(
      "{}: the last entry was cut off when the session stopped, and is dropped; all before it are there",
      file_.string()));
}

bool Journal::read_record(std::uint64_t size) {
  const std::string name = fmt::format("the record at byte {}", end_);
  const auto mend = [&] {
    return fmt::format("; move it away to go on with what {} holds", session_.string());
  };
  const auto head = read(end_, std::min<std::uint64_t>(size - end_, record_head_size));
  if (head.size() < record_head_size) return false;
  const Bytes checked = Bytes(head).first(record_head_size - check_size);
  if (!are_equal(check_of(blake2b({checked})), Bytes(head).last(check_size)) ||
      !are_equal(checked.first(record_mark.size()), as_bytes(record_mark))) {
    const auto rest = read(end_, size - end_);
    const bool last =
        std::search(rest.begin() + 1, rest.end(), record_mark.begin(), record_mark.end()) == rest.end();
    if (being_run_ || (last && has_unwritten_sector(end_, head))) return false;
    refuse(name + " was changed after it was written" + mend());
  }
  ByteReader reader(checked.subspan(record_mark.size()));
  const auto length = reader.number<std::uint64_t>();
  if (length > size - end_ - record_head_size) return false;
  const auto body = read(end_ + record_head_size, length);
  if (!are_equal(check_of(blake2b({body})), reader.rest())) {
    const bool last = end_ + record_head_size + length == size;
    if (being_run_ || (last && has_unwritten_sector(end_ + record_head_size, body))) return false;
    refuse(name + " was changed after it was written" + mend());
  }
  try {
    ByteReader texts(body);
    schema::SessionEntry entry;
    entry.kind = texts.text();
    entry.time = texts.text();
    entry.text = texts.text();
    entries_.push_back(std::move(entry));
    end_ += record_head_size + length;
    places_.push_back({.at = end_ - texts.rest().size(), .bytes = texts.rest().size()});
  } catch (const std::out_of_range&) {
    refuse(name + " is none" + mend());
  }
  return true;
}

/// A crash between the new FILE and the end of the journal leaves entries in both.
void Journal::skip_those_in(const schema::Session& session, std::uint64_t first) {
  const std::uint64_t in_file = session.entries.size();
  if (in_file < first) {
    refuse(
        fmt::format("goes on from entry {}, but {} holds {} only: it is an older copy, expected the one that "
                    "the journal belongs to",
                    first, session_.string(), in_file));
  }
  const std::uint64_t in_both = std::min<std::uint64_t>(in_file - first, entries_.size());
  for (std::uint64_t i = 0; i < in_both; ++i) {
    if (read_sealed(i) == schema::read_sealed(session_, first + i)) continue;
    refuse(fmt::format("entry {} is another than in {}; move away the one that was changed", first + i,
                       session_.string()));
  }
  entries_.erase(entries_.begin(), entries_.begin() + static_cast<std::ptrdiff_t>(in_both));
  places_.erase(places_.begin(), places_.begin() + static_cast<std::ptrdiff_t>(in_both));
}

}  // namespace kerf::bench
