#include <algorithm>

#include "in_process.h"
#include "layout/session_layout.h"
#include "validate/validators.h"

namespace kerf::schema {
namespace {

bool is_subject_code(const std::string& text) {
  constexpr std::size_t longest = 16;
  constexpr std::string_view allowed = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-";
  return !text.empty() && text.size() <= longest && text.find_first_not_of(allowed) == std::string::npos;
}

/// What the tree cannot say.
class SessionContentCheck {
 public:
  SessionContentCheck(const Session& session, std::vector<Violation>& violations)
      : session_(session), violations_(violations) {}

  void run() {
    check_header();
    check_key();
    for (std::size_t i = 0; i < session_.entries.size(); ++i) check_entry(i);
  }

 private:
  void require(bool right, std::string where, std::string found, std::string_view expected) {
    if (!right) violations_.push_back({std::move(where), std::move(found), std::string(expected)});
  }

  void check_header() {
    require(is_uuid(session_.uuid), "/ attribute 'uuid'", quoted(session_.uuid), expected_uuid);
    require(is_utc_time(session_.created), "/ attribute 'created'", quoted(session_.created),
            expected_utc_time);
    require(!session_.software.empty(), "/ attribute 'software'", "an empty text", "a text");
    require(is_subject_code(session_.subject), "/ attribute 'subject'", quoted(session_.subject),
            "a code: 1 to 16 of A-Z a-z 0-9 _ -");
    require(session_.number >= 1 && session_.number <= session_.subjects, "/ attribute 'number'",
            std::to_string(session_.number),
            "from 1 to the " + std::to_string(session_.subjects) + " subjects of the study");
    require(!session_.protocol.empty(), "/protocol attribute 'toml'", "an empty text", "a protocol");
    require(!session_.laws.empty(), session_layout::laws, "no law", "one at least");
  }

  void check_key() {
    const KeyDerivation& key = session_.key;
    const bool passphrase = key.kind == "passphrase";
    require(passphrase || key.kind == "key file", "/key attribute 'kind'", quoted(key.kind),
            "'key file' or 'passphrase'");
    const bool costs = key.operations > 0 && key.memory_bytes > 0;
    const bool none = key.operations == 0 && key.memory_bytes == 0;
    require(passphrase ? costs : none, "/key",
            std::to_string(key.operations) + " operations in " + std::to_string(key.memory_bytes) + " bytes",
            passphrase ? "the costs of Argon2id" : "0 and 0, as a key file has no costs");
  }

  void check_entry(std::size_t i) {
    const SessionEntry& entry = session_.entries[i];
    const std::string where = "/entries row " + std::to_string(i);
    require(i != 0 || entry.kind == "plan", where, "kind " + quoted(entry.kind),
            "'plan' ahead of all others");
    require(!entry.kind.empty(), where, "no kind", "a kind");
    require(is_utc_time(entry.time), where, "time " + quoted(entry.time), expected_utc_time);
    constexpr std::size_t least = 40;  // nonce and tag
    require(entry.sealed.size() >= least, session_layout::numbered(session_layout::sealed, i),
            std::to_string(entry.sealed.size()) + " bytes", "40 at least: nonce and tag");
  }

  const Session& session_;
  std::vector<Violation>& violations_;
};

}  // namespace

void validate_session(const std::filesystem::path& file, std::vector<Violation>& violations) {
  {
    TreeCheck tree(file);
    session_layout::check(tree);
    for (const Finding& finding : tree.findings()) violations.push_back(finding.violation);
    if (tree.first_fatal() != nullptr) return;
  }
  SessionContentCheck(in_process::read_session(file), violations).run();
}

}  // namespace kerf::schema
