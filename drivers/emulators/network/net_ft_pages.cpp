#include "network/net_ft_pages.h"

#include <chrono>
#include <utility>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>

#include "network/own_port.h"

namespace kerf::emulators {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using asio::ip::tcp;
using boost::system::error_code;
using Request = http::request<http::string_body>;
using Response = http::response<http::string_body>;

constexpr std::chrono::seconds patience{2};

}  // namespace

class EmulatedNetFt::Pages::State {
 public:
  State(const std::string& address, std::uint16_t port) : acceptor_(io_) {
    OwnPort own = open_port(Transport::connections, address, port, " for its page; another by http=");
    port_ = own.number;
    acceptor_.assign(tcp::v4(), own.socket.release());
    accept();
  }

  asio::io_context io_;
  std::map<std::string, std::function<std::string()>> pages_;
  std::function<void(const std::string&, const std::string&)> take_;
  std::uint16_t port_ = 0;

 private:
  struct Connection {
    explicit Connection(tcp::socket socket) : stream(std::move(socket)) {}
    beast::tcp_stream stream;
    beast::flat_buffer buffer;
    Request request;
    Response response;
  };

  void accept() {
    acceptor_.async_accept([this](error_code error, tcp::socket socket) {
      if (!error) read(std::make_shared<Connection>(std::move(socket)));
      if (error != asio::error::operation_aborted) accept();
    });
  }
  void read(const std::shared_ptr<Connection>& connection) {
    connection->stream.expires_after(patience);
    http::async_read(connection->stream, connection->buffer, connection->request,
                     [this, connection](error_code error, std::size_t) {
                       if (!error) write(connection);
                     });
  }
  void write(const std::shared_ptr<Connection>& connection) {
    connection->response = answer(std::string(connection->request.target()));
    connection->response.prepare_payload();
    http::async_write(connection->stream, connection->response, [connection](error_code, std::size_t) {
      error_code ignored;
      connection->stream.socket().shutdown(tcp::socket::shutdown_both, ignored);
    });
  }
  Response answer(const std::string& target) {
    const auto question = target.find('?');
    const std::string path = target.substr(0, question);
    if (path.ends_with(".cgi")) {
      // As real boxes answer to a setting.
      if (question != std::string::npos) take(target.substr(question + 1));
      Response moved(http::status::found, 10);
      moved.set(http::field::location, "/");
      return moved;
    }
    const auto page = pages_.find(path);
    Response response(page == pages_.end() ? http::status::not_found : http::status::ok, 11);
    response.set(http::field::content_type, "text/xml");
    response.set(http::field::connection, "close");
    if (page != pages_.end()) response.body() = page->second();
    return response;
  }
  void take(std::string settings) const {
    while (!settings.empty()) {
      const auto end = std::min(settings.find('&'), settings.size());
      const std::string one = settings.substr(0, end);
      const auto equals = one.find('=');
      if (equals != std::string::npos) take_(one.substr(0, equals), one.substr(equals + 1));
      settings.erase(0, end + 1);
    }
  }

  tcp::acceptor acceptor_;
};

EmulatedNetFt::Pages::Pages(const std::string& address, std::uint16_t port)
    : state_(std::make_shared<State>(address, port)) {}

EmulatedNetFt::Pages::~Pages() = default;

std::uint16_t EmulatedNetFt::Pages::port() const noexcept { return state_->port_; }

void EmulatedNetFt::Pages::serve(const std::string& path, std::function<std::string()> page) {
  state_->pages_.insert_or_assign(path, std::move(page));
}

void EmulatedNetFt::Pages::take_settings(std::function<void(const std::string&, const std::string&)> take) {
  state_->take_ = std::move(take);
}

void EmulatedNetFt::Pages::look_after() { state_->io_.poll(); }

}  // namespace kerf::emulators
