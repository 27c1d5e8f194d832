#pragma once

#include <stdexcept>
#include <string>
#include <utility>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

namespace kerf::test {

/// A connection to a server on this machine, which sends what it is told and no more.
class PlainClient {
 public:
  explicit PlainClient(std::uint16_t port) : socket_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
      throw std::runtime_error("no connection");
    }
  }
  PlainClient(PlainClient&& other) noexcept : socket_(std::exchange(other.socket_, -1)) {}
  PlainClient(const PlainClient&) = delete;
  PlainClient& operator=(const PlainClient&) = delete;
  PlainClient& operator=(PlainClient&&) = delete;
  ~PlainClient() {
    if (socket_ >= 0) close(socket_);
  }

  void send_text(const std::string& text) const {
    // The rest of a refused request may meet a closed connection.
    [[maybe_unused]] const auto ignored = send(socket_, text.data(), text.size(), MSG_NOSIGNAL);
  }

  /// Everything up to the end of the connection.
  [[nodiscard]] std::string answer() const {
    std::string text;
    std::array<char, 4096> buffer{};
    while (true) {
      const ssize_t count = recv(socket_, buffer.data(), buffer.size(), 0);
      if (count <= 0) return text;
      text.append(buffer.data(), static_cast<std::size_t>(count));
    }
  }

  /// What comes next; empty at the end of the connection.
  [[nodiscard]] std::string some() const {
    std::array<char, 4096> buffer{};
    const ssize_t count = recv(socket_, buffer.data(), buffer.size(), 0);
    return count <= 0 ? std::string() : std::string(buffer.data(), static_cast<std::size_t>(count));
  }

  [[nodiscard]] bool is_open() const {
    char byte = 0;
    return recv(socket_, &byte, 1, MSG_DONTWAIT | MSG_PEEK) < 0 && (errno == EAGAIN || errno == EWOULDBLOCK);
  }

 private:
  int socket_;
};

/// "403" of "HTTP/1.1 403 Forbidden ...".
inline std::string status_of(const std::string& answer) {
  return answer.size() < 12 ? answer : answer.substr(9, 3);
}

inline std::string body_of(const std::string& answer) {
  const std::size_t end = answer.find("\r\n\r\n");
  return end == std::string::npos ? std::string() : answer.substr(end + 4);
}

inline std::string answer_to(std::uint16_t port, const std::string& request) {
  const PlainClient client(port);
  client.send_text(request);
  return client.answer();
}

}  // namespace kerf::test
