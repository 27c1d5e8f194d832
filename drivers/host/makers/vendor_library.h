#pragma once

#include <span>
#include <string>
#include <string_view>

namespace kerf::host {

/// A library of a device's maker, loaded where somebody has installed it: Kerf ships and links none of it.
class VendorLibrary {
 public:
  struct Wanted {
    std::span<const std::string> files;  ///< tried in this order, as dlopen() finds them
    std::string_view what;               ///< "3D Systems' OpenHaptics"
    std::string_view mend;               ///< what to install where none of them is there
  };
  /// @throws std::runtime_error where there is none, or one that cannot be loaded, with what it says
  explicit VendorLibrary(const Wanted& wanted);

  /// Looks for a function; of those that are missing require() tells.
  template <typename Function>
  void find(Function*& function, const char* name) {
    function = reinterpret_cast<Function*>(symbol(name));  // NOLINT(*-reinterpret-cast): dlsym
    if (function == nullptr) missing_ += (missing_.empty() ? "" : ", ") + std::string(name);
  }
  /// One that older and newer versions may lack.
  template <typename Function>
  void find_if_there(Function*& function, const char* name) const noexcept {
    function = reinterpret_cast<Function*>(symbol(name));  // NOLINT(*-reinterpret-cast): dlsym
  }
  /// @throws std::runtime_error that names the functions which were looked for and are not there
  void require() const;

  /// Where it was found.
  [[nodiscard]] const std::string& file() const noexcept { return file_; }

 private:
  [[nodiscard]] void* symbol(const char* name) const noexcept;

  void* library_ = nullptr;  // never closed: its threads may outlive whoever uses it
  std::string what_;
  std::string file_;
  std::string missing_;
};

}  // namespace kerf::host
