#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <thread>

#include <nlohmann/json.hpp>

#include "http/routes.h"

namespace kerf::test {

/// Asks routes as a browser would, and waits for their answers.
class Asker {
 public:
  explicit Asker(bench::Routes& routes) : routes_(routes) {}

  bench::HttpResponse get(const std::string& path, const std::map<std::string, std::string>& query = {}) {
    return answer({.method = "GET", .path = path, .query = query});
  }
  bench::HttpResponse post(const std::string& path, const nlohmann::json& body) {
    return answer({.method = "POST",
                   .path = path,
                   .headers = {{"content-type", "application/json"}},
                   .body = body.dump()});
  }
  bench::HttpResponse post_bytes(const std::string& path, const std::map<std::string, std::string>& query,
                                 std::string bytes) {
    return answer({.method = "POST",
                   .path = path,
                   .query = query,
                   .headers = {{"content-type", "application/octet-stream"}},
                   .body = std::move(bytes)});
  }

 private:
  bench::HttpResponse answer(bench::HttpRequest request) {
    const auto waits = std::make_shared<int>();
    request.number = ++number_;
    request.asker = waits;
    while (true) {
      if (auto response = routes_.respond(request, false)) return *response;
      std::this_thread::yield();
    }
  }

  bench::Routes& routes_;
  std::uint64_t number_ = 0;
};

}  // namespace kerf::test
