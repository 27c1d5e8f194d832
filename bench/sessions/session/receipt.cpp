#include "session/receipt.h"

#include <algorithm>
#include <charconv>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>

#include <kerf/schema/recording.h>

#include "files/named_file.h"
#include "files/whole_file.h"
#include "sealed/session_store.h"

namespace kerf::bench {
namespace {

constexpr std::size_t short_session = 8;
constexpr std::size_t short_chain = 16;

bool is_made_of(std::string_view text, std::string_view characters) {
  return text.find_first_not_of(characters) == std::string_view::npos;
}

std::string hexadecimal(const Digest& digest) { return fmt::format("{:02x}", fmt::join(digest, "")); }

/// Whether the receipt is of this session, whatever it holds by now.
bool is_of(const Receipt& receipt, const NamedSession& named) {
  return named.session->session().uuid.starts_with(receipt.session);
}

ReceiptFinding held_against_its_own(const Receipt& receipt, const NamedSession& named) {
  const std::string name = fmt::format("receipt {}: {}", receipt.in_short(), named.file);
  const std::size_t entries = named.session->session().entries.size();
  if (entries < receipt.entries) {
    return {receipt, false,
            fmt::format("{} has {} entries, and had {}: it was cut short, or an older copy was put back",
                        name, entries, receipt.entries)};
  }
  if (!hexadecimal(named.session->chain_after(receipt.entries)).starts_with(receipt.chain)) {
    return {receipt, false,
            fmt::format("{} has other entries than it had: an older copy was put back and run on", name)};
  }
  return {receipt, true,
          fmt::format("{} is as it was, with {} later entries", name, entries - receipt.entries)};
}

}  // namespace

std::string Receipt::in_full() const { return fmt::format("{}/{}/{}", session, entries, chain); }

std::string Receipt::in_short() const {
  return fmt::format("{}/{}/{}", session.substr(0, short_session), entries, chain.substr(0, short_chain));
}

Receipt receipt_of(const SessionStore& session) {
  const std::size_t entries = session.session().entries.size();
  return {.session = session.session().uuid,
          .entries = entries,
          .chain = hexadecimal(session.chain_after(entries))};
}

Receipt parse_receipt(std::string_view text) {
  const std::size_t first = text.find('/');
  const std::size_t second = text.find('/', first + 1);
  if (first != std::string_view::npos && second != std::string_view::npos) {
    Receipt receipt{.session = std::string(text.substr(0, first)),
                    .entries = 0,
                    .chain = std::string(text.substr(second + 1))};
    const char* const end = text.data() + second;
    const auto number = std::from_chars(text.data() + first + 1, end, receipt.entries);
    if (number.ec == std::errc{} && number.ptr == end && receipt.entries > 0 &&
        receipt.session.size() >= short_session && is_made_of(receipt.session, "0123456789abcdef-") &&
        receipt.chain.size() >= short_chain && is_made_of(receipt.chain, "0123456789abcdef"))
      return receipt;
  }
  throw std::invalid_argument(
      fmt::format("'{}' is no receipt of a session; expected one as 'kerf session run' prints it, such as "
                  "1f3c9a2e/12/a1b2c3d4e5f60718, or a file of them",
                  text));
}

std::vector<Receipt> receipts_named(const std::string& file_or_text) {
  std::error_code ignored;
  if (!std::filesystem::exists(file_or_text, ignored)) return {parse_receipt(file_or_text)};
  std::vector<Receipt> receipts;
  std::istringstream lines(read_named_file(file_or_text));
  std::size_t number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    while (line.ends_with('\r') || line.ends_with(' ')) line.pop_back();
    if (line.empty()) continue;
    try {
      receipts.push_back(parse_receipt(std::string_view(line).substr(line.rfind(' ') + 1)));
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(fmt::format("{}:{}: {}", file_or_text, number, error.what()));
    }
  }
  if (receipts.empty())
    throw std::invalid_argument(fmt::format("{}: no receipt in it; expected one a line", file_or_text));
  return receipts;
}

std::filesystem::path receipts_of(const std::filesystem::path& session) {
  std::filesystem::path file = session;
  file += ".receipts";
  return file;
}

void keep_receipt(const std::filesystem::path& session, const Receipt& receipt, const std::string& remark) {
  const std::filesystem::path file = receipts_of(session);
  const std::string earlier = std::filesystem::exists(file) ? read_named_file(file) : std::string();
  write_whole_file(file, fmt::format("{}{} {}{}{}\n", earlier, schema::new_header("").created, remark,
                                     remark.empty() ? "" : "; ", receipt.in_full()));
}

std::vector<ReceiptFinding> held_against(const std::vector<Receipt>& receipts,
                                         const std::vector<NamedSession>& sessions) {
  std::vector<ReceiptFinding> findings;
  for (const Receipt& receipt : receipts) {
    const auto own = std::ranges::find_if(sessions, [&](const auto& it) { return is_of(receipt, it); });
    findings.push_back(
        own != sessions.end()
            ? held_against_its_own(receipt, *own)
            : ReceiptFinding{receipt, false,
                             fmt::format("receipt {}: none of the files is its session: it was "
                                         "left out, or replaced by another",
                                         receipt.in_short())});
  }
  for (const NamedSession& named : sessions) {
    if (std::ranges::any_of(receipts, [&](const auto& receipt) { return is_of(receipt, named); })) continue;
    findings.push_back({receipt_of(*named.session), false,
                        fmt::format("{}: none of the receipts is of this session", named.file)});
  }
  return findings;
}

}  // namespace kerf::bench
