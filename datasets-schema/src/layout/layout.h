#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <kerf/schema/recording.h>

/// The schema itself: every group, dataset and attribute of a recording, once. The writers, the reader, the
/// validator and the document are loops over these tables.
namespace kerf::schema::layout {

/// Where the unit of a dataset comes from. One string; a list of D where the columns are axes.
enum class Units {
  one,
  second,
  axis_position,
  axis_velocity,
  axis_force,
  cycle_position,
  cycle_force,
  event,
  any
};

/// The member of a Recording that a dataset holds, and of a Row that it grows by.
using Member = std::variant<std::monostate, std::vector<double> Recording::*, std::vector<float> Recording::*,
                            std::vector<std::uint64_t> Recording::*, std::vector<std::uint32_t> Recording::*,
                            std::vector<double> Cycles::*, std::vector<std::vector<double>> Cycles::*>;
using RowMember = std::variant<std::monostate, std::array<double, max_axes> Row::*, double Row::*,
                               std::uint64_t Row::*, float Row::*, std::uint32_t Row::*>;

struct Dataset {
  std::string_view path;
  std::string_view type;   ///< as h5::type_name() says it
  std::string_view shape;  ///< one letter a dimension: N rows, D axes, E events, P phases, C cycles, G grid,
                           ///< K flags of cycles, H changes by hand
  Units units;
  bool required;  ///< in its group
  std::string_view description;
  Member member;
  RowMember row_member;
};

/// What an attribute holds: the same in every file, or a member.
using Value = std::variant<std::string_view, std::span<const std::uint32_t>, std::span<const std::uint8_t>,
                           std::string Header::*, std::optional<std::int64_t> Header::*, std::string Axis::*,
                           double Axis::*, double Cycles::*, std::size_t Cycles::*, std::string CycleFlags::*,
                           double CycleFlags::*>;

struct Attribute {
  std::string_view object;
  std::string_view name;
  std::string_view type;
  std::string_view shape;  ///< empty for one value
  bool required;           ///< on its object
  std::string_view description;
  Value value;
};

struct Group {
  std::string_view path;
  bool required;
  bool open;  ///< may hold attributes (and /samples/channels datasets) beyond the tables
  std::string_view description;
};

[[nodiscard]] std::span<const Group> groups();
[[nodiscard]] std::span<const Dataset> datasets();
[[nodiscard]] std::span<const Attribute> attributes();
[[nodiscard]] const Dataset& dataset(std::string_view path);

inline constexpr std::string_view samples = "/samples";
inline constexpr std::string_view channels = "/samples/channels";
inline constexpr std::string_view cycles = "/cycles";
inline constexpr std::string_view cycle_flags = "/cycle_flags";
inline constexpr std::string_view cycle_edits = "/cycle_edits";

/// The group that a path stands in: "/samples" of "/samples/time", "/" of "/events".
[[nodiscard]] std::string_view parent(std::string_view path);
[[nodiscard]] std::string_view last_name(std::string_view path);

/// The `units` of a dataset; `cycle_axis` is the axis that /cycles is about.
[[nodiscard]] std::vector<std::string> units_of(Units units, std::span<const Axis> axes,
                                                std::size_t cycle_axis);
/// Whether `units` is a list even for one column.
[[nodiscard]] bool is_list(Units units);
[[nodiscard]] std::string_view describe(Units units);

}  // namespace kerf::schema::layout
