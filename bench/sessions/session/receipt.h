#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace kerf::bench {

class SessionStore;

/// What somebody keeps of a session away from its file, to find later that the file was replaced, cut short,
/// or restored from an older copy, which the file itself cannot tell.
///
/// As text "UUID/ENTRIES/CHAIN": the session, how many entries it had, and the chain after them (see
/// SealedEntries), in hexadecimal. UUID and CHAIN may be their first digits, 8 and 16 at least.
struct Receipt {
  std::string session;
  std::size_t entries = 0;
  std::string chain;

  [[nodiscard]] std::string in_full() const;
  /// To be written down: "1f3c9a2e/12/a1b2c3d4e5f60718".
  [[nodiscard]] std::string in_short() const;
};

/// Of a session as it is now.
[[nodiscard]] Receipt receipt_of(const SessionStore& session);

/// @throws std::invalid_argument for what is none.
[[nodiscard]] Receipt parse_receipt(std::string_view text);

/// Those of a file, one a line at the end of each, or the one that the text itself is.
/// @throws std::invalid_argument for what is neither.
[[nodiscard]] std::vector<Receipt> receipts_named(const std::string& file_or_text);

/// FILE.receipts
[[nodiscard]] std::filesystem::path receipts_of(const std::filesystem::path& session);

/// Adds a line to FILE.receipts: the time, what else is to be kept, and the receipt in full.
/// @throws std::system_error.
void keep_receipt(const std::filesystem::path& session, const Receipt& receipt,
                  const std::string& remark = {});

/// What a receipt says of the sessions at hand.
struct ReceiptFinding {
  Receipt receipt;
  bool holds = false;
  std::string text;  ///< one line that names the receipt, and the file if there is one
};

/// A session and the file that it was read from.
struct NamedSession {
  std::string file;
  const SessionStore* session = nullptr;
};

/// One finding for each receipt, in their order, then one for each session that none of them is of.
[[nodiscard]] std::vector<ReceiptFinding> held_against(const std::vector<Receipt>& receipts,
                                                       const std::vector<NamedSession>& sessions);

}  // namespace kerf::bench
