#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "http/http_server.h"
#include "pages/access_control.h"
#include "protocol/apparatus.h"
#include "protocol/guide/guided_motion.h"
#include "subject/subject.h"

namespace kerf::bench {

/// A web page for the subject, in a server of this machine: what the server answers below one folder of it.
///
///     GET  /?token=T               the page with its texts, which loads page.css, page.js and icon.svg
///     GET  /view?after=N           the view as JSON, once its number is above N; 204 after 20 s without one
///     POST /action                 {"kind", "slot", "stage", "trial"}, of a number "number": 200; 409 if the
///     view was of another
///                                  stage or trial, or does not permit it
///     GET  /guide                  {"target", "tool"} as shares of the target's way (NaN: null), {"time_s"}
///     on
///                                  the guide's clock: where they are now; 409 if the loop does not run yet,
///                                  404 if there is no guide
///     POST /noise                  {"level_db"}, -60 to -15: 200; 409 if it is set, or no noise is asked for
///
/// Several pages may be open: all show the view, and the action of either counts. Whoever the access control
/// does not admit gets 403, whatever was asked for.
class PageSubject final : public Subject {
 public:
  /// `wake` is HttpServer's. Both are called until this ends. The page is in the language of the texts.
  PageSubject(AccessControl access, std::function<void()> wake,
              std::shared_ptr<const SubjectTexts> texts = english_texts());
  PageSubject(const PageSubject&) = delete;
  PageSubject& operator=(const PageSubject&) = delete;
  ~PageSubject() override = default;

  [[nodiscard]] const AccessControl& access() const noexcept { return access_; }
  /// Lets the page play noise while trials run. Where its level is not set yet, the page asks for it ahead of
  /// everything else, and `keep` is called with it from next(). Ahead of the first view.
  void use_noise(MaskingNoise noise, std::optional<double> level_db, std::function<void(double)> keep);
  /// Lets the page show what leads the hand. `look` is called by the server's thread, at the page's rate, for
  /// as long as this lives. Ahead of the first view.
  void use_guide(const GuidedMotion& guide, std::function<GuideLook()> look);
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
  [[nodiscard]] HttpResponse guide_now() const;
  HttpResponse take_action(const HttpRequest& request);
  HttpResponse take_noise_level(const HttpRequest& request);
  void keep_noise_level();

  AccessControl access_;
  std::function<void()> wake_;
  std::shared_ptr<const SubjectTexts> texts_;
  std::mutex mutex_;  ///< of all that follows, between the session's thread and the server's
  SubjectView view_;
  std::uint64_t number_ = 0;   ///< of the view; 0: none was shown yet
  std::uint64_t fetched_ = 0;  ///< the newest that a page has
  double shown_s_ = 0.0;
  std::deque<SubjectAction> actions_;
  std::condition_variable fetch_;
  MaskingNoise noise_ = MaskingNoise::none;
  std::optional<double> noise_level_db_;
  std::optional<double> noise_level_asked_db_;  ///< by the page, and not kept yet
  std::function<void(double)> keep_noise_level_;
  std::optional<GuidedMotion> guide_;  ///< set ahead of the first view, and then as it is
  std::function<GuideLook()> look_;
};

/// The page in a server of its own, as `kerf session run --page` has it.
class ServedSubject final : public Subject {
 public:
  /// Port 0: any that is free. @throws std::invalid_argument: the port is in use.
  explicit ServedSubject(std::uint16_t port = 0, std::shared_ptr<const SubjectTexts> texts = english_texts());
  ServedSubject(const ServedSubject&) = delete;
  ServedSubject& operator=(const ServedSubject&) = delete;
  ~ServedSubject() override;  ///< PageSubject::wait_until_fetched()

  /// Where the page is, with its token.
  [[nodiscard]] std::string url() const { return page_.access().url("/"); }
  [[nodiscard]] PageSubject& page() noexcept { return page_; }
  void show(const SubjectView& view) override { page_.show(view); }
  [[nodiscard]] std::optional<SubjectAction> next() override { return page_.next(); }

 private:
  HttpServer server_;
  PageSubject page_;
};

}  // namespace kerf::bench
