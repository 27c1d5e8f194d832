#pragma once

#include <string>

#include <kerf/schema/recording.h>

#include "validate/inspect.h"

namespace kerf::schema {

/// What a file holds beside its rows: header, axes, the channels' names and units, events and cycles. Nothing
/// in the inspection may be fatal.
[[nodiscard]] Recording read_all_but_rows(const Inspection& inspection);

/// Rows that reached every dataset. While a file is written, its datasets grow one after the other; a row
/// that a crash kept from the disk reads as the fill value.
[[nodiscard]] hsize_t rows_in_every_dataset(const Inspection& inspection);

[[nodiscard]] std::string channel_path(const std::string& name);

}  // namespace kerf::schema
