#include "network/http_get.h"

#include <stdexcept>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <fmt/format.h>

namespace kerf::drivers {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using asio::ip::tcp;
using boost::system::error_code;

/// One request, whose steps are callbacks so that a clock can end any of them.
class Asking {
 public:
  explicit Asking(const HttpPage& page) : page_(page), stream_(io_) {
    response_.body_limit(page.most_bytes);
    request_.method(http::verb::get);
    request_.target(page.target);
    request_.version(11);
    request_.set(http::field::host, page.address);
    request_.set(http::field::connection, "close");
  }

  [[nodiscard]] std::string answer() {
    const tcp::endpoint there(asio::ip::make_address(page_.address), page_.port);
    stream_.async_connect(there, [this](error_code error) {
      if (!ended_by(error)) send();
    });
    io_.run_for(page_.patience);
    if (!done_) throw std::runtime_error(fmt::format("no answer within {} ms", page_.patience.count()));
    if (error_) throw std::runtime_error(error_.message());
    if (response_.get().result() != http::status::ok)
      throw std::runtime_error(fmt::format("its answer is {}", response_.get().result_int()));
    return response_.get().body();
  }

 private:
  bool ended_by(error_code error) {
    error_ = error;
    done_ = static_cast<bool>(error);
    return done_;
  }
  void send() {
    http::async_write(stream_, request_, [this](error_code error, std::size_t) {
      if (!ended_by(error)) receive();
    });
  }
  void receive() {
    http::async_read(stream_, buffer_, response_, [this](error_code error, std::size_t) {
      error_ = error;
      done_ = true;
    });
  }

  const HttpPage& page_;
  asio::io_context io_;
  beast::tcp_stream stream_;
  beast::flat_buffer buffer_;
  http::request<http::empty_body> request_;
  http::response_parser<http::string_body> response_;
  error_code error_;
  bool done_ = false;
};

}  // namespace

std::string http_get(const HttpPage& page) { return Asking(page).answer(); }

}  // namespace kerf::drivers
