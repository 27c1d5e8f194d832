#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

namespace kerf::python {

namespace py = pybind11;

// What each source adds to the module `kerf._core`. The classes that people see are written in Python, in
// ../kerf; these are what they hold.
void add_laws(py::module_& module);
void add_recordings(py::module_& module);
void add_fits(py::module_& module);

/// Numbers in the order of C, as they are in an argument or copied from it: of any stride, order of axes and
/// bytes, whole or real.
using Numbers = py::array_t<double, py::array::c_style>;

/// @param name of the argument, for messages
/// @throws py::type_error for what is no array of numbers (objects, texts, truth values, complex numbers,
/// masked arrays);
///         std::invalid_argument where a double would not hold a number exactly.
[[nodiscard]] Numbers numbers_of(const py::handle& given, const char* name);

/// "(3, 2)", as NumPy shows it.
[[nodiscard]] std::string shape_of(const py::array& array);

/// A text of a file, which may hold bytes that are no UTF-8.
[[nodiscard]] py::str text_of(std::string_view bytes);

}  // namespace kerf::python
