// Attributes: one value or a list of them.
#include <algorithm>

#include "hdf5/h5.h"
#include "hdf5/h5_spaces.h"

namespace kerf::schema::h5 {

namespace {

void put_attribute(hid_t object, const std::string& name, hid_t type, const Extent& extent,
                   const void* values) {
  const auto space = dataspace(extent, false);
  const Handle attribute(call(H5Acreate2, object, name.c_str(), type, space.id(),
                              utf8_names(H5P_ATTRIBUTE_CREATE).id(), H5P_DEFAULT));
  call(H5Awrite, attribute.id(), type, values);
}

}  // namespace

void write_attribute(hid_t object, const std::string& name, const std::string& text) {
  const char* start = text.c_str();
  put_attribute(object, name, text_type(H5T_VARIABLE).id(), {}, &start);
}

void write_attribute(hid_t object, const std::string& name, std::span<const std::string> texts) {
  std::vector<const char*> starts;
  for (const auto& text : texts) starts.push_back(text.c_str());
  put_attribute(object, name, text_type(H5T_VARIABLE).id(), {starts.size()}, starts.data());
}

void write_attribute(hid_t object, const std::string& name, hid_t native_type, const Extent& extent,
                     const void* values) {
  put_attribute(object, name, native_type, extent, values);
}

void delete_attribute(hid_t object, const std::string& name) { call(H5Adelete, object, name.c_str()); }

bool has_attribute(hid_t object, const std::string& name) {
  return call(H5Aexists, object, name.c_str()) > 0;
}

std::vector<std::string> attributes(hid_t object) {
  std::vector<std::string> names;
  const H5A_operator2_t collect = [](hid_t, const char* name, const H5A_info_t*, void* list) -> herr_t {
    static_cast<std::vector<std::string>*>(list)->emplace_back(name);
    return 0;
  };
  call(H5Aiterate2, object, H5_INDEX_NAME, H5_ITER_INC, nullptr, collect, &names);
  return names;
}

Description describe_attribute(hid_t object, const std::string& name) {
  const Handle attribute(call(H5Aopen, object, name.c_str(), H5P_DEFAULT));
  const Handle type(call(H5Aget_type, attribute.id()));
  return {type_name(type.id()), extent_of(Handle(call(H5Aget_space, attribute.id())))};
}

std::vector<std::string> read_texts(hid_t object, const std::string& name) {
  const Handle attribute(call(H5Aopen, object, name.c_str(), H5P_DEFAULT));
  const Handle space(call(H5Aget_space, attribute.id()));
  const Handle type(call(H5Aget_type, attribute.id()));
  const auto count = static_cast<std::size_t>(call(H5Sget_simple_extent_npoints, space.id()));
  std::vector<std::string> texts(count);
  if (count == 0) return texts;
  if (call(H5Tis_variable_str, type.id()) > 0) {
    std::vector<char*> starts(count, nullptr);
    call(H5Aread, attribute.id(), type.id(), static_cast<void*>(starts.data()));
    for (std::size_t i = 0; i < count; ++i) texts[i] = starts[i] == nullptr ? "" : starts[i];
    call(H5Dvlen_reclaim, type.id(), space.id(), H5P_DEFAULT, static_cast<void*>(starts.data()));
    return texts;
  }
  const std::size_t room = H5Tget_size(type.id());
  std::string bytes(count * room, '\0');
  call(H5Aread, attribute.id(), type.id(), bytes.data());
  for (std::size_t i = 0; i < count; ++i) {
    texts[i] = bytes.substr(i * room, room);
    texts[i].resize(std::min(texts[i].find('\0'), texts[i].size()));
  }
  return texts;
}

void read_attribute(hid_t object, const std::string& name, hid_t native_type, void* values) {
  const Handle attribute(call(H5Aopen, object, name.c_str(), H5P_DEFAULT));
  call(H5Aread, attribute.id(), native_type, values);
}

}  // namespace kerf::schema::h5
