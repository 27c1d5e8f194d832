// Types by their names, and records of several fields.
#include "hdf5/h5.h"
#include "hdf5/h5_spaces.h"

namespace kerf::schema::h5 {

Handle text_type(std::size_t size) {
  Handle type(call(H5Tcopy, H5T_C_S1));
  call(H5Tset_size, type.id(), size);
  call(H5Tset_cset, type.id(), H5T_CSET_UTF8);
  if (size != H5T_VARIABLE) call(H5Tset_strpad, type.id(), H5T_STR_NULLPAD);
  return type;
}

namespace {

std::string number_name(hid_t type, std::string_view kind) {
  return std::string(kind) +
         std::to_string(8 * call([](hid_t id) { return static_cast<long long>(H5Tget_size(id)); }, type));
}

std::string record_name(hid_t type) {
  std::string name = "{";
  const int fields = call(H5Tget_nmembers, type);
  for (unsigned i = 0; i < static_cast<unsigned>(fields); ++i) {
    char* field = H5Tget_member_name(type, i);
    name += (i > 0 ? ", " : "") + std::string(field == nullptr ? "?" : field);
    H5free_memory(field);
    const Handle member(call(H5Tget_member_type, type, i));
    const bool variable =
        call(H5Tget_class, member.id()) == H5T_STRING && call(H5Tis_variable_str, member.id()) > 0;
    name += (variable ? " variable-length " : " ") + type_name(member.id());
  }
  return name + '}';
}

}  // namespace

template <>
hid_t native<double>() {
  silence();
  return H5T_NATIVE_DOUBLE;
}
template <>
hid_t native<float>() {
  silence();
  return H5T_NATIVE_FLOAT;
}
template <>
hid_t native<std::int64_t>() {
  silence();
  return H5T_NATIVE_INT64;
}
template <>
hid_t native<std::uint64_t>() {
  silence();
  return H5T_NATIVE_UINT64;
}
template <>
hid_t native<std::uint32_t>() {
  silence();
  return H5T_NATIVE_UINT32;
}
template <>
hid_t native<std::uint8_t>() {
  silence();
  return H5T_NATIVE_UINT8;
}

std::string type_name(hid_t type) {
  switch (call(H5Tget_class, type)) {
    case H5T_FLOAT:
      return number_name(type, "float");
    case H5T_INTEGER:
      return number_name(type, call(H5Tget_sign, type) == H5T_SGN_NONE ? "uint" : "int");
    case H5T_STRING:
      return "text";
    case H5T_COMPOUND:
      return record_name(type);
    default:
      return "another type";
  }
}

Handle record_type(std::span<const Field> fields, std::size_t record_size) {
  Handle type(call(H5Tcreate, H5T_COMPOUND, record_size));
  for (const auto& field : fields) {
    const auto text = text_type(field.size);
    const hid_t member = field.type == "text"      ? text.id()
                         : field.type == "float64" ? native<double>()
                         : field.type == "uint64"  ? native<std::uint64_t>()
                         : field.type == "int64"   ? native<std::int64_t>()
                         : field.type == "uint32"  ? native<std::uint32_t>()
                                                   : native<std::uint8_t>();
    call(H5Tinsert, type.id(), field.name.c_str(), field.offset, member);
  }
  return type;
}

Handle packed(const Handle& type) {
  Handle copy(call(H5Tcopy, type.id()));
  call(H5Tpack, copy.id());
  return copy;
}

std::vector<std::size_t> field_sizes(hid_t dataset) {
  const Handle type(call(H5Dget_type, dataset));
  std::vector<std::size_t> sizes(static_cast<std::size_t>(call(H5Tget_nmembers, type.id())));
  for (unsigned i = 0; i < sizes.size(); ++i) {
    sizes[i] = H5Tget_size(Handle(call(H5Tget_member_type, type.id(), i)).id());
  }
  return sizes;
}

}  // namespace kerf::schema::h5
