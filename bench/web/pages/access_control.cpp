#include "pages/access_control.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>
#include <sodium.h>

namespace kerf::bench {
namespace {

std::string new_token() {
  std::array<unsigned char, 16> bytes{};
  randombytes_buf(bytes.data(), bytes.size());
  return fmt::format("{:02x}", fmt::join(bytes, ""));
}

/// In a time that does not tell how much of it is right.
bool is_same_secret(std::string_view given, std::string_view secret) noexcept {
  return given.size() == secret.size() && sodium_memcmp(given.data(), secret.data(), secret.size()) == 0;
}

}  // namespace

AccessControl::AccessControl(std::vector<std::string> hosts)
    : hosts_(std::move(hosts)), token_(new_token()) {}

std::string AccessControl::url(std::string_view path) const {
  return fmt::format("http://{}{}?token={}", hosts_.front(), path, token_);
}

std::string AccessControl::key_for(std::string_view path,
                                   const std::map<std::string, std::string>& query) const {
  std::string address(path);
  for (const auto& [name, value] : query) {
    // With lengths: no other address is the same text.
    if (name != "key") address += fmt::format("\n{} {} {} {}", name.size(), name, value.size(), value);
  }
  std::array<unsigned char, 16> key{};
  const auto bytes = [](std::string_view text) {
    return reinterpret_cast<const unsigned char*>(text.data());
  };
  crypto_generichash(key.data(), key.size(), bytes(address), address.size(), bytes(token_), token_.size());
  return fmt::format("{:02x}", fmt::join(key, ""));
}

bool AccessControl::is_ours(std::string_view host) const {
  return std::find(hosts_.begin(), hosts_.end(), host) != hosts_.end();
}

bool AccessControl::admits_without_token(const HttpRequest& request) const {
  if (!is_ours(request.header("host"))) return false;
  if (!request.headers.contains("origin")) return true;
  constexpr std::string_view scheme = "http://";
  std::string_view origin = request.header("origin");
  if (!origin.starts_with(scheme)) return false;
  origin.remove_prefix(scheme.size());
  return is_ours(origin);
}

bool AccessControl::admits(const HttpRequest& request) const {
  if (!admits_without_token(request)) return false;
  if (request.headers.contains("x-kerf-token")) return is_same_secret(request.header("x-kerf-token"), token_);
  if (request.method == "POST") return false;
  if (const auto key = request.query.find("key"); key != request.query.end())
    return is_same_secret(key->second, key_for(request.path, request.query));
  const auto in_address = request.query.find("token");
  return in_address != request.query.end() && is_same_secret(in_address->second, token_);
}

HttpResponse AccessControl::refuse(std::string_view why, AttemptLimit::Clock::time_point now) {
  if (refusals_.wait(now) > AttemptLimit::Clock::duration::zero()) return refusal(429);
  refusals_.note_failure(now);
  return {.status = 403, .body = fmt::format("{}\n", why)};
}

}  // namespace kerf::bench
