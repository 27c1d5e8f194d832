#include <algorithm>
#include <cstddef>
#include <cstring>
#include <new>
#include <stdexcept>

#include <kerf/schema/session.h>

#include "hdf5/files.h"
#include "in_process.h"
#include "layout/session_layout.h"

namespace kerf::schema {
namespace {

namespace layout = session_layout;

/// Bytes for the texts of an entry.
struct EntryRoom {
  std::size_t kind = 1;
  std::size_t time = 1;
  std::size_t text = 1;

  [[nodiscard]] std::size_t total() const { return kind + time + text; }
};

h5::Handle entry_type(const EntryRoom& room) {
  const std::vector<h5::Field> fields{{"kind", "text", room.kind, 0},
                                      {"time", "text", room.time, room.kind},
                                      {"text", "text", room.text, room.kind + room.time}};
  return h5::record_type(fields, room.total());
}

void require_text(const std::string& text, const std::string& what) {
  if (text.find('\0') != std::string::npos) {
    throw std::invalid_argument("session: " + what + " has a zero byte; expected a text");
  }
}

void require_texts(const Session& session) {
  require_text(session.uuid, "the uuid");
  require_text(session.created, "the time");
  require_text(session.software, "the software");
  require_text(session.subject, "the subject");
  require_text(session.protocol, "the protocol");
  require_text(session.key.kind, "the kind of key");
  for (const SessionLaw& law : session.laws) require_text(law.name + law.toml, "a law");
  for (const SessionEntry& entry : session.entries) {
    require_text(entry.kind + entry.time + entry.text, "an entry");
  }
}

template <typename T>
void write_number(hid_t object, const char* name, const T& number) {
  h5::write_attribute(object, name, h5::native<T>(), {}, &number);
}

void write_header(hid_t file, const Session& session) {
  const auto root = h5::open(file, "/");
  h5::write_attribute(root.id(), "schema", std::string(session_schema_name));
  write_number(root.id(), "schema_version", session_schema_version);
  h5::write_attribute(root.id(), "uuid", session.uuid);
  h5::write_attribute(root.id(), "created", session.created);
  h5::write_attribute(root.id(), "software", session.software);
  h5::write_attribute(root.id(), "subject", session.subject);
  write_number(root.id(), "number", session.number);
  write_number(root.id(), "subjects", session.subjects);
  h5::write_attribute(h5::create_group(file, layout::protocol).id(), "toml", session.protocol);
  const auto laws = h5::create_group(file, layout::laws);
  for (std::size_t i = 0; i < session.laws.size(); ++i) {
    const auto law = h5::create_group(file, layout::numbered(layout::laws, i));
    h5::write_attribute(law.id(), "name", session.laws[i].name);
    h5::write_attribute(law.id(), "toml", session.laws[i].toml);
  }
  const auto key = h5::create_group(file, layout::key);
  h5::write_attribute(key.id(), "kind", session.key.kind);
  h5::write_attribute(key.id(), "salt", h5::native<std::uint8_t>(), {layout::salt_bytes},
                      session.key.salt.data());
  write_number(key.id(), "operations", session.key.operations);
  write_number(key.id(), "memory_bytes", session.key.memory_bytes);
}

void write_entries(hid_t file, const std::vector<SessionEntry>& entries) {
  EntryRoom room;
  for (const SessionEntry& entry : entries) {
    room.kind = std::max(room.kind, entry.kind.size());
    room.time = std::max(room.time, entry.time.size());
    room.text = std::max(room.text, entry.text.size());
  }
  std::string records(entries.size() * room.total(), '\0');
  char* record = records.data();
  for (const SessionEntry& entry : entries) {
    std::ranges::copy(entry.kind, record);
    std::ranges::copy(entry.time, record + room.kind);
    std::ranges::copy(entry.text, record + room.kind + room.time);
    record += room.total();
  }
  const auto type = entry_type(room);
  const auto dataset =
      h5::create_dataset(file, layout::entries, type.id(), {.extent = {entries.size()}, .contiguous = true});
  if (!entries.empty()) h5::write(dataset.id(), type.id(), records.data());
}

/// As they are: how well something can be compressed tells what it is like.
void write_sealed(hid_t file, std::size_t entries, const SealedOf& sealed_of) {
  const auto group = h5::create_group(file, layout::sealed);
  for (std::size_t i = 0; i < entries; ++i) {
    const std::vector<std::uint8_t> sealed = sealed_of(i);
    const auto dataset =
        h5::create_dataset(file, layout::numbered(layout::sealed, i), h5::native<std::uint8_t>(),
                           {.extent = {sealed.size()}, .contiguous = true});
    if (!sealed.empty()) h5::write(dataset.id(), h5::native<std::uint8_t>(), sealed.data());
  }
}

std::string text_of(hid_t file, const std::string& object, const std::string& name) {
  return h5::read_texts(h5::open(file, object).id(), name).front();
}

template <typename T>
void read_numbers(hid_t file, const std::string& object, const std::string& name, T* numbers) {
  h5::read_attribute(h5::open(file, object).id(), name, h5::native<T>(), numbers);
}

std::string text_in(const char* begin, std::size_t room) { return {begin, ::strnlen(begin, room)}; }

std::vector<SessionEntry> read_entries(hid_t file) {
  const auto dataset = h5::open(file, layout::entries);
  const hsize_t rows = h5::describe(dataset.id()).extent.front();
  std::vector<SessionEntry> entries(rows);
  if (rows == 0) return entries;
  const auto sizes = h5::field_sizes(dataset.id());
  const EntryRoom room{sizes.at(0), sizes.at(1), sizes.at(2)};
  std::string records(rows * room.total(), '\0');
  h5::read(dataset.id(), entry_type(room).id(), rows, records.data());
  const char* record = records.data();
  for (SessionEntry& entry : entries) {
    entry.kind = text_in(record, room.kind);
    entry.time = text_in(record + room.kind, room.time);
    entry.text = text_in(record + room.kind + room.time, room.text);
    record += room.total();
  }
  return entries;
}

std::vector<std::uint8_t> read_box(hid_t file, std::size_t entry) {
  const auto dataset = h5::open(file, layout::numbered(layout::sealed, entry));
  std::vector<std::uint8_t> sealed(h5::describe(dataset.id()).extent.front());
  if (!sealed.empty()) h5::read(dataset.id(), h5::native<std::uint8_t>(), sealed.size(), sealed.data());
  return sealed;
}

Session read_facts(hid_t file) {
  Session session;
  session.uuid = text_of(file, "/", "uuid");
  session.created = text_of(file, "/", "created");
  session.software = text_of(file, "/", "software");
  session.subject = text_of(file, "/", "subject");
  read_numbers(file, "/", "number", &session.number);
  read_numbers(file, "/", "subjects", &session.subjects);
  session.protocol = text_of(file, layout::protocol, "toml");
  const auto laws = h5::children(h5::open(file, layout::laws).id());
  for (std::size_t i = 0; i < laws.size(); ++i) {
    const std::string law = layout::numbered(layout::laws, i);
    session.laws.push_back({text_of(file, law, "name"), text_of(file, law, "toml")});
  }
  session.key.kind = text_of(file, layout::key, "kind");
  read_numbers(file, layout::key, "salt", session.key.salt.data());
  read_numbers(file, layout::key, "operations", &session.key.operations);
  read_numbers(file, layout::key, "memory_bytes", &session.key.memory_bytes);
  session.entries = read_entries(file);
  return session;
}

/// Does `read` with the open file once its tree is known to be that of a session.
template <typename Read>
auto read_checked(const std::filesystem::path& file, Read read) {
  require_hdf5(file, "a session");
  try {
    TreeCheck tree(file);
    layout::check(tree);
    if (const Finding* fatal = tree.first_fatal()) {
      const Violation& violation = fatal->violation;
      throw FormatError(one_line(file.string() + ": " + violation.where + ": found " + violation.found +
                                 ", expected " + violation.expected + " (a session of schema '" +
                                 std::string(session_schema_name) + "')"));
    }
    return read(tree.file());
  } catch (const h5::Error& error) {
    throw DamageError(file, error.what());
  } catch (const std::bad_alloc&) {
    throw FormatError(file.string() + ": more bytes than fit into the memory; expected a session");
  }
}

}  // namespace

namespace in_process {

Session read_session(const std::filesystem::path& file) {
  return read_checked(file, [](hid_t opened) {
    Session session = read_facts(opened);
    for (std::size_t i = 0; i < session.entries.size(); ++i) session.entries[i].sealed = read_box(opened, i);
    return session;
  });
}

Session read_session_facts(const std::filesystem::path& file) {
  return read_checked(file, [](hid_t opened) { return read_facts(opened); });
}

std::vector<std::uint8_t> read_sealed(const std::filesystem::path& file, std::size_t entry) {
  require_hdf5(file, "a session");
  try {
    // No text is read: their heaps, for which the whole file would be searched, need not be sound.
    const auto opened = h5::open_file(file);
    const std::string path = layout::numbered(layout::sealed, entry);
    if (!h5::is_dataset(opened.id(), path)) {
      throw FormatError(file.string() + ": " + path + ": found nothing, expected what is sealed of an entry");
    }
    const auto found = h5::describe(h5::open(opened.id(), path).id());
    if (found.type != "uint8" || found.extent.size() != 1 ||
        found.extent.front() > std::filesystem::file_size(file)) {
      throw FormatError(file.string() + ": " + path + ": found " + found.type + ", expected a list of uint8");
    }
    return read_box(opened.id(), entry);
  } catch (const h5::Error& error) {
    throw DamageError(file, error.what());
  }
}

}  // namespace in_process

void write_session(const std::filesystem::path& file, const Session& session, const SealedOf& sealed_of,
                   Existing existing) {
  require_texts(session);
  TemporaryFile temporary(file);
  h5::WritableFile output;
  try {
    output = temporary.create();
    write_header(output.id(), session);
    write_entries(output.id(), session.entries);
    write_sealed(output.id(), session.entries.size(), sealed_of);
    output.close();
  } catch (const h5::Error& error) {
    throw write_error(file, output.cause_of(error));
  }
  temporary.commit(existing);
}

void write_session(const std::filesystem::path& file, const Session& session, Existing existing) {
  write_session(
      file, session, [&](std::size_t entry) { return session.entries[entry].sealed; }, existing);
}

}  // namespace kerf::schema
