#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <string>

#include "subject/subject.h"
#include "web/loopback_server.h"

namespace kerf::bench {

/// A web page for the subject, for a browser on this machine.
///
/// Whoever asks has to know the token of the address (128 random bits, compared in constant time), to have
/// called the server by 127.0.0.1 or localhost, and not to come from another site: otherwise 403, whatever
/// was asked for. The token is in the address and then in a header that no other site can send, not in a
/// cookie, which a browser would show to every server of this machine.
///
///     GET  /?token=T               the page, which loads /page.css, /page.js and /icon.svg
///     GET  /view?after=N           the view as JSON, once its number is above N; 204 after 20 s without one
///     POST /action                 {"kind", "slot", "stage", "trial"}: 200; 409 if the view was of another
///     stage or
///                                  trial, or does not permit it
///
/// Several pages may be open: all show the view, and the action of either counts.
class PageSubject final : public Subject {
 public:
  /// Port 0: any that is free. @throws std::invalid_argument: the port is in use; std::system_error.
  explicit PageSubject(std::uint16_t port = 0);
  PageSubject(const PageSubject&) = delete;
  PageSubject& operator=(const PageSubject&) = delete;
  ~PageSubject() override;  ///< gives an open page up to a second to fetch the last view

  /// Where the page is, with its token.
  [[nodiscard]] std::string url() const;

  void show(const SubjectView& view) override;
  [[nodiscard]] std::optional<SubjectAction> next() override;

 private:
  std::optional<HttpResponse> respond(const HttpRequest& request, bool overdue);
  [[nodiscard]] bool is_from_the_page(const HttpRequest& request) const;
  [[nodiscard]] HttpResponse file(const std::string& path) const;
  std::optional<HttpResponse> view_after(const HttpRequest& request, bool overdue);
  HttpResponse take_action(const HttpRequest& request);

  std::string token_;
  std::mutex mutex_;  ///< of all that follows, between the session's thread and the server's
  SubjectView view_;
  std::uint64_t number_ = 0;   ///< of the view; 0: none was shown yet
  std::uint64_t fetched_ = 0;  ///< the newest that a page has
  double shown_s_ = 0.0;
  std::deque<SubjectAction> actions_;
  std::condition_variable fetch_;
  LoopbackServer server_;  ///< last: its thread uses the rest
};

}  // namespace kerf::bench
