#include "sealed/sealed_entries.h"

#include <limits>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include "recordings/provenance.h"
#include "sealed/bytes.h"

namespace kerf::bench {
namespace {

using Bytes = std::span<const std::uint8_t>;

/// The file itself, so that two names of it are one session.
std::filesystem::path resolved(const std::filesystem::path& file) {
  return std::filesystem::is_symlink(file) ? std::filesystem::canonical(file) : file;
}

/// What the seal of an entry is bound to.
ByteWriter bound_of(const Digest& chain, std::size_t number, const schema::SessionEntry& entry) {
  ByteWriter bound;
  bound.text("kerf.session entry");
  bound.bytes(chain);
  bound.number(static_cast<std::uint64_t>(number));
  bound.text(entry.kind);
  bound.text(entry.time);
  bound.text(entry.text);
  return bound;
}

std::string_view as_text(Bytes bytes) { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }

void require_no_zero(const std::string& kind, const std::string& text) {
  if (kind.empty()) throw std::invalid_argument("an entry of a session needs a kind");
  if ((kind + text).find('\0') == std::string::npos) return;
  throw std::invalid_argument(fmt::format("the text of an entry '{}' has a zero byte", kind));
}

}  // namespace

Digest digest_of_header(const schema::Session& session) {
  ByteWriter header;
  header.text(schema::session_schema_name);
  header.number(schema::session_schema_version);
  for (const std::string& text : {session.uuid, session.created, session.software, session.subject}) {
    header.text(text);
  }
  header.number(session.number);
  header.number(session.subjects);
  header.text(session.protocol);
  header.number(static_cast<std::uint64_t>(session.laws.size()));
  for (const schema::SessionLaw& law : session.laws) {
    header.text(law.name);
    header.text(law.toml);
  }
  header.text(session.key.kind);
  header.bytes(session.key.salt);
  header.number(session.key.operations);
  header.number(session.key.memory_bytes);
  return blake2b({header.written()});
}

NewSessionName::NewSessionName(const std::filesystem::path& file, bool replace)
    : file_(resolved(file)), journal_(Journal::lock(file_)) {
  if (!replace && std::filesystem::exists(file_)) {
    throw std::invalid_argument(fmt::format("{} exists; --force replaces it", file.string()));
  }
  if (!replace && journal_.has_records()) {
    throw std::invalid_argument(fmt::format(
        "{} holds the answers of an earlier session, whose file is gone; move it away, or --force "
        "replaces it",
        journal_of(file).string()));
  }
}

void SealedEntries::create(const std::filesystem::path& file, schema::Session session, Bytes plan,
                           const SealKey& key, bool replace) {
  NewSessionName name(file, replace);
  schema::SessionEntry entry{.kind = "plan", .time = session.created, .text = "", .sealed = {}};
  entry.sealed = sealed(key, plan, as_text(bound_of(digest_of_header(session), 0, entry).written()));
  session.entries = {std::move(entry)};
  schema::write_session(name.file(), session, schema::existing_if(replace));
  bring_to_disk(name.file());
  bring_to_disk(name.file().parent_path());
  name.taken();
}

SealedEntries::SealedEntries(const std::filesystem::path& file, const SealKey& key, For purpose,
                             const Visit& visit)
    : file_(resolved(file)), key_(key.copy()), runs_(purpose == For::run) {
  if (!std::filesystem::is_regular_file(file_)) {
    throw std::invalid_argument(fmt::format(
        "{}: there is no such file; expected a session, as 'kerf session new' makes one", file_.string()));
  }
  // The journal ahead of the file: what another process moves from it into the file meanwhile is then in
  // both.
  if (runs_) {
    journal_.emplace(Journal::lock(file_));
  } else if (auto found = Journal::look(file_)) {
    journal_.emplace(std::move(*found));
  }
  opened_.emplace(file_);
  session_ = opened_->facts();
  in_file_ = session_.entries.size();
  if (in_file_ == 0) {
    throw schema::FormatError(fmt::format("{}: found no entry, expected the plan at least", file_.string()));
  }
  if (journal_) {
    journal_->take_up(session_);
    warnings_ = journal_->warnings();
    session_.entries.insert(session_.entries.end(), journal_->entries().begin(), journal_->entries().end());
  }
  chain_.push_back(digest_of_header(session_));
  for (std::size_t i = 0; i < session_.entries.size(); ++i) {
    const std::vector<std::uint8_t> sealed = box(i);
    visit(i, session_.entries[i], opened(i, sealed));
    chain_.push_back(blake2b({bound_of(chain_[i], i, session_.entries[i]).written(), sealed}));
  }
}

std::vector<std::uint8_t> SealedEntries::box(std::size_t number) const {
  if (number < in_file_) {
    if (!opened_) opened_.emplace(file_);
    return opened_->sealed(number);
  }
  return journal_.value().read_sealed(number - in_file_);
}

std::vector<std::uint8_t> SealedEntries::opened(std::size_t number, Bytes box) const {
  const schema::SessionEntry& entry = session_.entries[number];
  try {
    return unsealed(key_, box, as_text(bound_of(chain_[number], number, entry).written()));
  } catch (const std::invalid_argument&) {
    if (number == 0) {
      throw std::invalid_argument(
          fmt::format("{}: does not open with this key: it is the key of another session, or the file was "
                      "changed after it was written (nobody can tell which)",
                      file_.string()));
    }
    throw std::invalid_argument(fmt::format(
        "{}: entry {} ({}) was changed after it was written, or one before it was taken out, put in "
        "or exchanged; expected the file as kerf wrote it, take it from a copy",
        file_.string(), number, entry.kind));
  }
}

std::vector<std::uint8_t> SealedEntries::content(std::size_t number) const {
  if (number >= session_.entries.size()) throw std::out_of_range("there is no such entry");
  return opened(number, box(number));
}

void SealedEntries::append(const std::string& kind, const std::string& text, Bytes content) {
  if (!runs_ || !journal_) throw std::logic_error("a session that is not run takes no entries");
  require_no_zero(kind, text);
  const std::size_t number = session_.entries.size();
  schema::SessionEntry entry{
      .kind = kind, .time = schema::new_header("").created, .text = text, .sealed = {}};
  const auto bound = bound_of(chain_.back(), number, entry).written();
  entry.sealed = sealed(key_, content, as_text(bound));
  journal_->append(entry);
  chain_.push_back(blake2b({bound, entry.sealed}));
  entry.sealed.clear();
  session_.entries.push_back(std::move(entry));
}

void SealedEntries::close() {
  if (!runs_ || !journal_) return;
  if (!journal_->entries().empty()) {
    schema::write_session(
        file_, session_, [this](std::size_t number) { return box(number); }, schema::Existing::replace);
    // The name of the new file has to be on the disk before that of the journal goes.
    bring_to_disk(file_.parent_path());
    journal_->remove();
    in_file_ = session_.entries.size();
    opened_.reset();  // it holds the file that was replaced
  }
  journal_.reset();
}

}  // namespace kerf::bench
