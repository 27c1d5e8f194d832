#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <kerf/schema/recording.h>

#include "hdf5/h5.h"
#include "layout/layout.h"

/// What both writers put into a file, from the tables of layout.h.
namespace kerf::schema {

/// What the values of the attributes are taken from.
struct Sources {
  const Header& header;
  std::span<const Axis> axes;
  const Cycles* cycles = nullptr;
  const CycleFlags* cycle_flags = nullptr;
};

/// Those attributes of an object that the tables say.
void write_attributes(hid_t object, std::string_view path, const Sources& sources);

/// Root attributes, the group /samples, and /device and /scene where there is something to say.
void write_head(hid_t file, const Sources& sources);

/// @throws std::invalid_argument for a property of /device or /scene whose name is the schema's own.
void check_property(const std::string& path, const std::string& name);

/// Adds properties to /device or /scene, which is made if there is none; those of the same name are replaced.
void add_to_origin(hid_t file, const std::string& path, const Properties& properties);

/// A dataset with its units and its other attributes.
[[nodiscard]] h5::Handle make_dataset(hid_t file, const layout::Dataset& rule, hid_t type,
                                      const Sources& sources, const h5::DatasetOptions& options);

/// Makes `time` the scale of the rows of a dataset in /samples.
void attach_time(const h5::Handle& dataset, const h5::Handle& time);

/// A dataset of /samples/channels with its unit; the group must be there.
/// @throws std::invalid_argument for a name that cannot be one.
[[nodiscard]] h5::Handle make_channel(hid_t file, const Channel& channel, const h5::DatasetOptions& options);

/// Bytes for the texts of an event or a flag. They are of fixed size, as SWMR cannot follow any other.
struct TextRoom {
  std::size_t kind = 32;  ///< of an event; of a flag: its fault
  std::size_t text = 256;
};
/// For the longest texts that there are.
[[nodiscard]] TextRoom room_for(std::span<const Event> events);
[[nodiscard]] TextRoom room_for(std::span<const CycleFlag> flags);
[[nodiscard]] h5::Handle event_type(const TextRoom& room);
[[nodiscard]] h5::Handle flag_type(const TextRoom& room);
/// As records of that type; a text that has no room is cut between two characters.
[[nodiscard]] std::vector<std::byte> pack(std::span<const Event> events, const TextRoom& room);
[[nodiscard]] std::vector<std::byte> pack(std::span<const CycleFlag> flags, const TextRoom& room);
[[nodiscard]] std::vector<Event> unpack_events(std::span<const std::byte> records, const TextRoom& room);
[[nodiscard]] std::vector<CycleFlag> unpack_flags(std::span<const std::byte> records, const TextRoom& room);
[[nodiscard]] h5::Handle phase_type();

/// Bytes of a text that go into so much room without splitting a UTF-8 character.
[[nodiscard]] std::size_t fitting(const std::string& text, std::size_t room);
/// The text of a field of fixed size, which ends at its first zero.
[[nodiscard]] std::string text_in(const std::byte* field, std::size_t room);

}  // namespace kerf::schema
