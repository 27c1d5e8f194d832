// Dimension scales: which dataset gives the places of another's rows.
#include <hdf5_hl.h>

#include "hdf5/h5.h"

namespace kerf::schema::h5 {

void make_scale(hid_t dataset, const std::string& name) { call(H5DSset_scale, dataset, name.c_str()); }

void attach_scale(hid_t dataset, hid_t scale, unsigned dimension) {
  call(H5DSattach_scale, dataset, scale, dimension);
}

void label(hid_t dataset, unsigned dimension, const std::string& name) {
  call(H5DSset_label, dataset, dimension, name.c_str());
}

bool is_scale(hid_t dataset) {
  // Not H5DSis_scale, which reads a list of texts into room for one.
  if (!has_attribute(dataset, "CLASS")) return false;
  const auto found = describe_attribute(dataset, "CLASS");
  return found.type == "text" && found.extent.empty() &&
         read_texts(dataset, "CLASS").front() == "DIMENSION_SCALE";
}

namespace {

/// H5DSget_num_scales takes it for granted, and overruns its memory where it is not so.
bool has_references_for_every_dimension(hid_t dataset) {
  if (!has_attribute(dataset, "DIMENSION_LIST")) return false;
  const Handle attribute(call(H5Aopen, dataset, "DIMENSION_LIST", H5P_DEFAULT));
  const Handle type(call(H5Aget_type, attribute.id()));
  if (call(H5Tget_class, type.id()) != H5T_VLEN) return false;
  const Handle element(call(H5Tget_super, type.id()));
  const Extent expected{describe(dataset).extent.size()};
  return call(H5Tget_class, element.id()) == H5T_REFERENCE &&
         describe_attribute(dataset, "DIMENSION_LIST").extent == expected;
}

}  // namespace

bool has_scale(hid_t dataset, unsigned dimension) {
  return has_references_for_every_dimension(dataset) && call(H5DSget_num_scales, dataset, dimension) > 0;
}

}  // namespace kerf::schema::h5
