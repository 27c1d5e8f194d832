#include "layout/session_layout.h"

#include <array>
#include <stdexcept>
#include <vector>

#include <kerf/schema/session.h>
#include <kerf/schema/validate.h>

#include "hdf5/files.h"

namespace kerf::schema::session_layout {
namespace {

constexpr std::array attribute_table{
    SessionAttribute{"/",
                     {.name = "schema", .type = "text", .always = session_schema_name},
                     "Always this text: `kerf.session`"},
    SessionAttribute{"/", {.name = "schema_version", .type = "uint32"}, "Always this number: `1`"},
    SessionAttribute{"/", {.name = "uuid", .type = "text"}, "Its identity: RFC 9562, lower case"},
    SessionAttribute{"/",
                     {.name = "created", .type = "text"},
                     "When it was laid out: ISO 8601, UTC, `2026-01-31T12:00:00Z`"},
    SessionAttribute{"/", {.name = "software", .type = "text"}, "What wrote it, `kerf 0.1.0`"},
    SessionAttribute{"/",
                     {.name = "subject", .type = "text"},
                     "The code of the subject: 1 to 16 of `A-Z a-z 0-9 _ -`; never a name"},
    SessionAttribute{"/", {.name = "number", .type = "uint32"}, "Of the subject in its study, from 1"},
    SessionAttribute{"/", {.name = "subjects", .type = "uint32"}, "Subjects of the study"},
    SessionAttribute{"/protocol", {.name = "toml", .type = "text"}, "The protocol file, as it was read"},
    SessionAttribute{any_law, {.name = "name", .type = "text"}, "What the protocol calls the law's file"},
    SessionAttribute{any_law, {.name = "toml", .type = "text"}, "The law file, as it was read"},
    SessionAttribute{"/key", {.name = "kind", .type = "text"}, "`key file` or `passphrase`"},
    SessionAttribute{"/key",
                     {.name = "salt", .type = "uint8", .list = salt_bytes},
                     "Random; makes the key this file's own"},
    SessionAttribute{
        "/key", {.name = "operations", .type = "uint64"}, "Passes of Argon2id; 0 for a key file"},
    SessionAttribute{
        "/key", {.name = "memory_bytes", .type = "uint64"}, "Memory of Argon2id [byte]; 0 for a key file"},
};

void check_attributes(TreeCheck& tree, const std::string& object, std::string_view as) {
  std::vector<std::string_view> known;
  for (const SessionAttribute& attribute : attribute_table) {
    if (attribute.object != as) continue;
    known.push_back(attribute.rule.name);
    if (attribute.rule.name.starts_with("schema")) continue;  // asked before
    static_cast<void>(tree.has_attribute(object, attribute.rule));
  }
  tree.only_attributes(object, known);
}

/// The children of a group have to be called 000000, 000001, ...
std::size_t count_numbered(TreeCheck& tree, const std::string& group) {
  const auto names = h5::children(h5::open(tree.file(), group).id());
  std::size_t count = 0;
  for (; count < names.size(); ++count) {
    const std::string expected = numbered(group, count);
    if (group + '/' + names[count] == expected) continue;
    tree.fail(group + '/' + names[count], "this name", expected);
    break;
  }
  return count;
}

void check_laws(TreeCheck& tree) {
  if (!tree.has_group(laws)) return;
  tree.only_attributes(laws, {});
  for (std::size_t i = 0; i < count_numbered(tree, laws); ++i) {
    const std::string law = numbered(laws, i);
    if (!tree.has_group(law)) continue;
    check_attributes(tree, law, any_law);
    tree.only_children(law, {});
  }
}

void check_entries(TreeCheck& tree) {
  const auto rows = tree.extent_of(entries, std::string(type_of_entries), 1);
  if (!tree.has_group(sealed)) return;
  const std::size_t boxes = count_numbered(tree, sealed);
  for (std::size_t i = 0; i < boxes; ++i) {
    static_cast<void>(tree.extent_of(numbered(sealed, i), "uint8", 1));
  }
  if (rows && rows->front() != boxes) {
    tree.fail(sealed, std::to_string(boxes) + " datasets",
              std::to_string(rows->front()) + ", one for each row of /entries");
  }
}

}  // namespace

std::span<const SessionAttribute> session_attributes() { return attribute_table; }

std::string numbered(const std::string& group, std::size_t number) {
  std::string digits = std::to_string(number);
  constexpr std::size_t least = 6;
  if (digits.size() < least) digits.insert(0, least - digits.size(), '0');
  return group + '/' + digits;
}

void check(TreeCheck& tree) {
  if (!tree.is(session_schema_name, session_schema_version)) return;
  check_attributes(tree, "/", "/");
  tree.only_children("/", {"protocol", "laws", "key", "entries", "sealed"});
  for (const std::string& group : {protocol, key}) {
    if (!tree.has_group(group)) continue;
    check_attributes(tree, group, group);
    tree.only_children(group, {});
  }
  check_laws(tree);
  check_entries(tree);
}

}  // namespace kerf::schema::session_layout
