#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <string>

#include "http/http_server.h"
#include "pages/access_control.h"
#include "subject/subject.h"

namespace kerf::bench {

/// A web page for the subject, in a server of this machine: what the server answers below one folder of it.
///
///     GET  /?token=T               the page, which loads page.css, page.js and icon.svg
///     GET  /view?after=N           the view as JSON, once its number is above N; 204 after 20 s without one
///     POST /action                 {"kind", "slot", "stage", "trial"}: 200; 409 if the view was of another
///                                  stage or trial, or does not permit it
///
/// Several pages may be open: all show the view, and the action of either counts. Whoever the access control
/// does not admit gets 403, whatever was asked for.
class PageSubject final : public Subject {
 public:
  /// `wake` is HttpServer's. Both are called until this ends.
  PageSubject(AccessControl access, std::function<void()> wake);
  PageSubject(const PageSubject&) = delete;
  PageSubject& operator=(const PageSubject&) = delete;
  ~PageSubject() override = default;

  [[nodiscard]] const AccessControl& access() const noexcept { return access_; }
  /// As HttpServer::Handler, with the folder taken off the path.
  [[nodiscard]] std::optional<HttpResponse> respond(const HttpRequest& request, bool overdue);
  /// Of the view that is shown; nothing before the first.
  [[nodiscard]] std::optional<SessionStage> stage();
  /// Gives an open page up to a second to fetch the last view.
  void wait_until_fetched();

  void show(const SubjectView& view) override;
  [[nodiscard]] std::optional<SubjectAction> next() override;

 private:
  std::optional<HttpResponse> view_after(const HttpRequest& request, bool overdue);
  HttpResponse take_action(const HttpRequest& request);

  AccessControl access_;
  std::function<void()> wake_;
  std::mutex mutex_;  ///< of all that follows, between the session's thread and the server's
  SubjectView view_;
  std::uint64_t number_ = 0;   ///< of the view; 0: none was shown yet
  std::uint64_t fetched_ = 0;  ///< the newest that a page has
  double shown_s_ = 0.0;
  std::deque<SubjectAction> actions_;
  std::condition_variable fetch_;
};

/// The page in a server of its own, as `kerf session run --page` has it.
class ServedSubject final : public Subject {
 public:
  /// Port 0: any that is free. @throws std::invalid_argument: the port is in use.
  explicit ServedSubject(std::uint16_t port = 0);
  ServedSubject(const ServedSubject&) = delete;
  ServedSubject& operator=(const ServedSubject&) = delete;
  ~ServedSubject() override;  ///< PageSubject::wait_until_fetched()

  /// Where the page is, with its token.
  [[nodiscard]] std::string url() const { return page_.access().url("/"); }
  void show(const SubjectView& view) override { page_.show(view); }
  [[nodiscard]] std::optional<SubjectAction> next() override { return page_.next(); }

 private:
  HttpServer server_;
  PageSubject page_;
};

}  // namespace kerf::bench
