#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace kerf::bench {

/// How a file writes an orientation: the rotation R from the sensor's (or tool's) frame to the world's,
/// p_world = R p. Orders are those of SciPy's Rotation.
///
///     quaternion xyzw, wxyz   axis times sin(a/2), and w = cos(a/2)
///     rotvec                  axis times angle
///     euler xyz               small letters: about the world's axes one after the other, R = Rz Ry Rx
///     euler XYZ               capitals: about axes that turn along, R = Rx Ry Rz
///     matrix rows, columns    R row by row, or column by column
///
/// and "inverse" behind it: what stands there is the rotation from the world's frame to the sensor's.
struct OrientationForm {
  enum class Kind : std::uint8_t { quaternion, rotation_vector, euler, matrix };
  Kind kind = Kind::quaternion;
  std::string order;  ///< "xyzw", "wxyz"; "xyz", "ZXZ", ...; "rows", "columns"; empty for a rotation vector
  bool is_inverse = false;

  /// How many columns it takes.
  [[nodiscard]] std::size_t columns() const noexcept;
  /// As it is written, "euler xyz".
  [[nodiscard]] std::string text() const;
  /// Its numbers are angles, with a unit.
  [[nodiscard]] bool has_angles() const noexcept;
};

/// Takes the words that say the form off the front of `text`; what is left is the unit of its angles.
/// Nothing if they say none.
[[nodiscard]] std::optional<OrientationForm> take_orientation_form(std::string_view& text);

}  // namespace kerf::bench
