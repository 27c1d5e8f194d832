#pragma once

#include <optional>

#include <boost/beast/http.hpp>

#include "http/http_server.h"

// Between Boost.Beast's messages and ours; included by sources of this folder alone.

namespace kerf::bench {

/// The status to refuse a request with that could not be read; 0 where there is nothing to answer, or no
/// error.
[[nodiscard]] int status_of(const boost::system::error_code& error) noexcept;

/// Nothing for a request that no browser sends: a header or a part of the query that comes twice, a target
/// that is no path.
[[nodiscard]] std::optional<HttpRequest> parse_http_request(
    const boost::beast::http::request<boost::beast::http::string_body>& request);

/// With the headers of every answer.
[[nodiscard]] boost::beast::http::response<boost::beast::http::string_body> serialise_response(
    const HttpResponse& response);

}  // namespace kerf::bench
