#include "module.h"

#include <exception>
#include <new>
#include <stdexcept>
#include <system_error>

#include <kerf/drivers/device.h>
#include <kerf/processes/helper.h>
#include <kerf/schema/recording.h>
#include <kerf/schema/validate.h>
#include <kerf/version.h>

namespace kerf::python {
namespace {

/// What the house throws, as Python's own exceptions. (A std::invalid_argument is a ValueError to pybind11
/// already.)
void translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const std::system_error& error) {
    if (error.code() == std::errc::not_enough_memory) {
      PyErr_SetString(PyExc_MemoryError, error.what());
      return;
    }
    // Of its number Python makes a PermissionError and so on.
    const py::tuple arguments = py::make_tuple(error.code().value(), text_of(error.what()));
    PyErr_SetObject(PyExc_OSError, arguments.ptr());
  } catch (const drivers::DeviceError& error) {
    PyErr_SetString(PyExc_OSError, error.what());
  }
}

bool is_of_numbers(const py::dtype& type) {
  const char kind = type.kind();
  return kind == 'f' || kind == 'i' || kind == 'u';
}

/// Whether a double may be another number than one of these.
bool is_wider_than_double(const py::dtype& type) {
  return type.kind() == 'f' ? type.itemsize() > 8 : type.itemsize() >= 8;
}

}  // namespace

Numbers numbers_of(const py::handle& given, const char* name) {
  const std::string who = name;
  const py::module_ numpy = py::module_::import("numpy");
  if (py::isinstance(given, numpy.attr("ma").attr("MaskedArray")))
    throw py::type_error(who +
                         ": a masked array; fill what is masked first, for example with .filled(numpy.nan)");
  const py::array array = py::array::ensure(given);
  if (!array) {
    PyErr_Clear();
    throw py::type_error(who + ": no array of numbers");
  }
  if (!is_of_numbers(array.dtype()))
    throw py::type_error(who + ": an array of " + std::string(py::str(array.dtype())) +
                         "; expected real numbers");
  const auto numbers = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(array);
  if (!numbers) throw py::error_already_set();
  if (is_wider_than_double(array.dtype())) {
    const bool exact =
        numpy.attr("array_equal")(numbers.attr("astype")(array.dtype()), array, true).cast<bool>();
    if (!exact)
      throw std::invalid_argument(who + ": numbers of " + std::string(py::str(array.dtype())) +
                                  " that float64 does not hold exactly; round them yourself");
  }
  return numbers;
}

std::string shape_of(const py::array& array) { return py::str(array.attr("shape")); }

py::str text_of(std::string_view bytes) {
  return py::reinterpret_steal<py::str>(
      PyUnicode_DecodeUTF8(bytes.data(), static_cast<Py_ssize_t>(bytes.size()), "replace"));
}

}  // namespace kerf::python

PYBIND11_MODULE(_core, module) {
  using namespace kerf;
  namespace py = pybind11;
  module.doc() = "What the package kerf is made of; nothing here is meant to be called by others.";
  py::register_exception_translator(python::translate);
  py::register_exception<schema::FormatError>(module, "FormatError", PyExc_ValueError);
  module.attr("version") = std::string(version());
  module.attr("software") = software();
  module.def("look_for_helpers_in", &processes::look_for_helpers_in);
  module.def("validate", [](const std::filesystem::path& file) {
    py::list all;
    for (const schema::Violation& one : schema::validate(file))
      all.append(py::make_tuple(python::text_of(one.where), python::text_of(one.found),
                                python::text_of(one.expected)));
    return all;
  });
  python::add_laws(module);
  python::add_recordings(module);
  python::add_fits(module);
}
