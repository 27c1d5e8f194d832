#pragma once

#include <filesystem>
#include <system_error>

namespace kerf::schema {

/// What becomes of a file whose name another one is to have.
enum class Existing { keep, replace };

[[nodiscard]] constexpr Existing existing_if(bool replace) noexcept {
  return replace ? Existing::replace : Existing::keep;
}

/// A finished file or folder could not have its name, since somebody took it meanwhile; both are kept.
class NameTaken : public std::system_error {
 public:
  NameTaken(const std::filesystem::path& name, std::filesystem::path kept);
  /// Where the finished one stands now.
  [[nodiscard]] const std::filesystem::path& kept() const noexcept { return kept_; }

 private:
  std::filesystem::path kept_;
};

/// Gives a finished file or folder its final name, in one step: whoever looks sees the old one, if there was
/// any, or the new one. A folder replaces none but an empty one.
/// @throws NameTaken with Existing::keep where the name is taken; the finished one then stands as NAME-2, or
///         the next number that is free. std::system_error with the name.
void take_name(const std::filesystem::path& finished, const std::filesystem::path& name, Existing existing);

}  // namespace kerf::schema
