#pragma once

#include "hdf5/h5.h"

/// What the sources of h5.h share: extents, texts and properties as HDF5 has them.
namespace kerf::schema::h5 {

[[nodiscard]] Handle property_list(hid_t kind);
/// Names of links and of attributes are UTF-8.
[[nodiscard]] Handle utf8_names(hid_t kind);
/// A scalar where there is no extent.
[[nodiscard]] Handle dataspace(const Extent& extent, bool growing);
[[nodiscard]] Extent extent_of(const Handle& space);
[[nodiscard]] Handle text_type(std::size_t size);

}  // namespace kerf::schema::h5
