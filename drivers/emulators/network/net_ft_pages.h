#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "network/net_ft.h"

namespace kerf::emulators {

/// The pages of a box: answers are made anew for each request. Asked from the box's own loop, nothing of it
/// runs beside that.
class EmulatedNetFt::Pages {
 public:
  /// @throws std::system_error if the port is taken.
  Pages(const std::string& address, std::uint16_t port);
  Pages(const Pages&) = delete;
  Pages& operator=(const Pages&) = delete;
  ~Pages();

  [[nodiscard]] std::uint16_t port() const noexcept;
  void serve(const std::string& path, std::function<std::string()> page);
  /// What stands behind the question mark of a request that ends with .cgi, one by one.
  void take_settings(std::function<void(const std::string& name, const std::string& value)> take);
  /// Does what has come up and returns.
  void look_after();

 private:
  class State;
  std::shared_ptr<State> state_;
};

}  // namespace kerf::emulators
