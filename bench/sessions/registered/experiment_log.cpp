#include "registered/experiment_log.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <span>
#include <stdexcept>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <kerf/schema/recording.h>

#include "files/named_file.h"

namespace kerf::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view chain_mark = R"(,"chain":")";
constexpr std::size_t digits = 64;
constexpr std::size_t receipt_digits = 16;

std::span<const std::uint8_t> log_bytes(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

std::string hexadecimal_of(std::span<const std::uint8_t> bytes) {
  return fmt::format("{:02x}", fmt::join(bytes, ""));
}

std::string chain_after(const SealKey& key, std::string_view before, std::string_view body) {
  return hexadecimal_of(
      blake2b({log_bytes("kerf experiment log"), key.bytes(), log_bytes(before), log_bytes(body)}));
}

/// A whole line, with its end.
std::string line_of(const SealKey& key, std::string& chain, const std::string& kind, const Json& facts) {
  Json line{{"kind", kind}, {"time", schema::new_header("").created}};
  line.update(facts);
  std::string body = line.dump(-1, ' ', false, Json::error_handler_t::replace);
  body.pop_back();  // the brace
  chain = chain_after(key, chain, body);
  return fmt::format("{}{}{}\"}}\n", body, chain_mark, chain);
}

Json key_facts(const schema::KeyDerivation& derivation) {
  return {{"kind", derivation.kind},
          {"salt", hexadecimal_of(derivation.salt)},
          {"operations", derivation.operations},
          {"memory_bytes", derivation.memory_bytes}};
}

[[noreturn]] void refuse_line(const std::filesystem::path& file, std::size_t line, std::string_view what) {
  throw std::invalid_argument(fmt::format("{}:{}: {}", file.string(), line, what));
}

Json parsed(const std::filesystem::path& file, std::size_t number, std::string_view line) {
  Json line_facts = Json::parse(line, nullptr, false);
  const auto is_text = [&](const char* key) {
    return line_facts.contains(key) && line_facts[key].is_string();
  };
  if (!line_facts.is_object() || !is_text("kind") || !is_text("time") || !is_text("chain"))
    refuse_line(file, number, "is no line of an experiment's log; a copy that was kept elsewhere has it");
  return line_facts;
}

/// An open file under a lock that other processes wait for.
class LockedFile {
 public:
  explicit LockedFile(const std::filesystem::path& file)
      : file_(file), descriptor_(open(file.c_str(), O_RDWR | O_APPEND | O_CLOEXEC)) {
    if (descriptor_ < 0) fail();
    while (flock(descriptor_, LOCK_EX) != 0) {
      if (errno != EINTR) fail();
    }
  }
  LockedFile(const LockedFile&) = delete;
  LockedFile& operator=(const LockedFile&) = delete;
  ~LockedFile() {
    if (descriptor_ >= 0) close(descriptor_);
  }

  /// All of it or nothing, on the disk when it returns.
  void append(std::string_view line, std::size_t size) const {
    if (ftruncate(descriptor_, static_cast<off_t>(size)) != 0) fail();
    const ssize_t written = write(descriptor_, line.data(), line.size());
    if (written == static_cast<ssize_t>(line.size()) && fdatasync(descriptor_) == 0) return;
    const int error = written >= 0 && written < static_cast<ssize_t>(line.size()) ? ENOSPC : errno;
    [[maybe_unused]] const int ignored = ftruncate(descriptor_, static_cast<off_t>(size));
    errno = error;
    fail();
  }

 private:
  [[noreturn]] void fail() const { throw std::system_error(errno, std::generic_category(), file_.string()); }

  std::filesystem::path file_;
  int descriptor_;
};

}  // namespace

std::string ExperimentLog::begun(const SealKey& key, const schema::KeyDerivation& derivation,
                                 const Facts& registered, const Lines& more) {
  std::string chain;
  Json first{{"key", key_facts(derivation)}};
  first.update(registered);
  std::string text = line_of(key, chain, "registered", first);
  for (const auto& [kind, facts] : more) text += line_of(key, chain, kind, facts);
  return text;
}

schema::KeyDerivation ExperimentLog::derivation_of(const std::filesystem::path& file) {
  const std::string text = read_named_file(file);
  const Json first = parsed(file, 1, std::string_view(text).substr(0, text.find('\n')));
  schema::KeyDerivation derivation;
  try {
    const Json& key = first.at("key");
    derivation.kind = key.at("kind").get<std::string>();
    derivation.operations = key.at("operations").get<std::uint64_t>();
    derivation.memory_bytes = key.at("memory_bytes").get<std::uint64_t>();
    const auto salt = key.at("salt").get<std::string>();
    if (salt.size() != 2 * derivation.salt.size() ||
        salt.find_first_not_of("0123456789abcdef") != std::string::npos)
      refuse_line(file, 1, "has no salt of its key: the log was changed");
    for (std::size_t i = 0; i < derivation.salt.size(); ++i)
      derivation.salt[i] = static_cast<std::uint8_t>(std::stoi(salt.substr(2 * i, 2), nullptr, 16));
  } catch (const Json::exception&) {
    refuse_line(file, 1, "does not say how its key is made: the log was changed");
  }
  return derivation;
}

ExperimentLog::ExperimentLog(std::filesystem::path file, const SealKey& key)
    : file_(std::move(file)), key_(key.copy()) {
  read(read_named_file(file_));
}

void ExperimentLog::read(std::string_view text) {
  lines_.clear();
  chain_.clear();
  warnings_.clear();
  std::size_t number = 0;
  while (!text.empty()) {
    ++number;
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos) {
      warnings_.push_back(fmt::format("{}:{}: the last line is torn, as a crash leaves it; it is dropped",
                                      file_.string(), number));
      break;
    }
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end + 1);
    Json line_facts = parsed(file_, number, line);
    const std::size_t mark = line.rfind(chain_mark);
    const std::string chain =
        mark == std::string_view::npos ? std::string() : chain_after(key_, chain_, line.substr(0, mark));
    if (line_facts["chain"] != chain || line.size() != mark + chain_mark.size() + digits + 2) {
      refuse_line(file_, number,
                  number == 1
                      ? "does not open with this key: it is another, or the log was changed"
                      : "was changed, or a line before it was taken out; put back the copy that was kept "
                        "elsewhere");
    }
    if ((number == 1) != (line_facts["kind"] == "registered"))
      refuse_line(file_, number, "is not where it belongs: a log begins with \"registered\"");
    chain_ = chain;
    line_facts.erase("chain");
    lines_.push_back({line_facts["kind"].get<std::string>(), line_facts["time"].get<std::string>(),
                      std::move(line_facts), chain_});
  }
  if (lines_.empty()) refuse_line(file_, 1, "is empty: the log was cut off");
}

std::string ExperimentLog::receipt() const {
  return fmt::format("{}/{}", lines_.size(), chain_.substr(0, receipt_digits));
}

bool ExperimentLog::bears_out(const std::string& receipt) const {
  std::size_t number = 0;
  const std::size_t slash = receipt.find('/');
  const char* const end = receipt.data() + std::min(slash, receipt.size());
  const auto read_number = std::from_chars(receipt.data(), end, number);
  const std::string chain = slash == std::string::npos ? std::string() : receipt.substr(slash + 1);
  if (read_number.ec != std::errc() || read_number.ptr != end || number == 0 ||
      chain.size() < receipt_digits || chain.find_first_not_of("0123456789abcdef") != std::string::npos)
    throw std::invalid_argument(fmt::format(
        "'{}' is no receipt of an experiment's log; expected one as 'kerf session status' prints it, such as "
        "22/0fec241f4a6f0311",
        receipt));
  return number <= lines_.size() && lines_[number - 1].chain.starts_with(chain);
}

void ExperimentLog::append(const std::string& kind, const Facts& facts) {
  const LockedFile held(file_);
  const std::string text = read_named_file(file_);
  read(text);  // what others have added meanwhile
  std::string chain = chain_;
  const std::string line = line_of(key_, chain, kind, facts);
  held.append(line, text.rfind('\n') + 1);
  read(read_named_file(file_));
}

std::filesystem::path log_of(const std::filesystem::path& experiment_file) {
  return experiment_file.parent_path() / "experiment.log";
}

std::string digest_of(std::string_view text) { return hexadecimal_of(blake2b({log_bytes(text)})); }

}  // namespace kerf::bench
