#pragma once

#include <chrono>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "http/http_server.h"
#include "pages/attempt_limit.h"

namespace kerf::bench {

/// Who may ask a server of this machine. Whoever asks has to know the token of the address (128 random bits,
/// compared in constant time), to have called the server by one of its own names, and not to come from
/// another site. The token is in the address and then in a header that no other site can send, not in a
/// cookie, which a browser would show to every server of this machine.
class AccessControl {
 public:
  /// With a new token; `hosts` as HttpServer::hosts().
  explicit AccessControl(std::vector<std::string> hosts);

  [[nodiscard]] const std::string& token() const noexcept { return token_; }
  /// The address to open: "http://127.0.0.1:8000/?token=..." for the path "/".
  [[nodiscard]] std::string url(std::string_view path) const;
  /// What lets whoever has it GET this one address, as `key` in its query, as long as the server lives: for
  /// what is opened in a tab of its own, where an address may be copied. Of the token, which it does not
  /// tell.
  [[nodiscard]] std::string key_for(std::string_view path,
                                    const std::map<std::string, std::string>& query) const;
  /// An address can be opened from anywhere; an action (POST) only by the page, which sends the header.
  [[nodiscard]] bool admits(const HttpRequest& request) const;
  /// As admits(), but for the token: the server was called by a name of its own, and not by a page of another
  /// site. Enough to ask for zero force, which is always safe; a foreign page is refused, since it could
  /// spoil an experiment by asking again and again.
  [[nodiscard]] bool admits_without_token(const HttpRequest& request) const;
  /// The answer to a request that is not admitted: 403 with a sentence. Where 100 within 10 s have had one it
  /// is 429 without. Whoever knows the token is admitted all the while: else anybody could lock them out.
  [[nodiscard]] HttpResponse refuse(std::string_view why,
                                    AttemptLimit::Clock::time_point now = AttemptLimit::Clock::now());

 private:
  [[nodiscard]] bool is_ours(std::string_view host) const;

  std::vector<std::string> hosts_;
  std::string token_;
  AttemptLimit refusals_{100, std::chrono::seconds(10)};
};

}  // namespace kerf::bench
