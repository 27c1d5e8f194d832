#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <kerf/schema/recording.h>

#include "hdf5/h5.h"

/// Changes of cycles as records of `/cycle_edits/changes`: numbers, then texts of fixed size.
namespace kerf::schema {

/// Bytes for time, author, kind and text.
using ChangeRoom = std::array<std::size_t, 4>;

/// For the longest texts that there are.
[[nodiscard]] ChangeRoom room_for_changes(std::span<const CycleChange> changes);
/// Of a dataset whose fields have these sizes.
[[nodiscard]] ChangeRoom room_of_changes(std::span<const std::size_t> field_sizes);
[[nodiscard]] std::size_t record_size(const ChangeRoom& room);
[[nodiscard]] h5::Handle change_type(const ChangeRoom& room);
/// As records of that type; a text that has no room is cut between two characters.
[[nodiscard]] std::vector<std::byte> pack_changes(std::span<const CycleChange> changes,
                                                  const ChangeRoom& room);
[[nodiscard]] std::vector<CycleChange> unpack_changes(std::span<const std::byte> records,
                                                      const ChangeRoom& room);

}  // namespace kerf::schema
