// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "python/src/errors.hpp"

#include <system_error>

#include <fmt/format.h>
#include <pybind11/pybind11.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/datasets/unclear_input.hpp"
#include "dynamic_icp/recording/formats/output_folder.hpp"

#include "python/src/bindings.hpp"
#include "python/src/settings.hpp"

namespace dynamic_icp::python {
namespace {

namespace py = pybind11;

constexpr const char* kDataErrorDoc =
    "Input data, a file or the machine is not as it must be.\n\nThe message names the file, the place in it and what "
    "was expected. It is an OSError and a ValueError: catch the one that you think of.";
constexpr const char* kUsageErrorDoc =
    "What was asked for cannot be: an unknown key, a value out of range, an array of another shape.\n\nThe message "
    "names it and what was expected.";

// For the life of the interpreter.
PyObject* data_error = nullptr;
PyObject* usage_error = nullptr;

void raise_data_error(const std::string& text) { PyErr_SetString(data_error, text.c_str()); }

void translate(std::exception_ptr thrown) {
  try {
    std::rethrow_exception(std::move(thrown));
  } catch (const UsageError& error) {
    PyErr_SetString(usage_error, error.what());
  } catch (const formats::EarlierResult& error) {
    raise_data_error(fmt::format("{}; replace=True replaces it", error.what()));
  } catch (const datasets::UnclearInput& error) {
    raise_data_error(fmt::format("{}; state it, e.g. with {}", error.what(), as_keywords(error.proposal())));
  } catch (const DataError& error) {
    raise_data_error(error.what());
  } catch (const std::system_error& error) {
    raise_data_error(error.what());
  }
}

PyObject* new_exception(py::module_& module, const char* name, const char* doc, const py::tuple& bases) {
  PyObject* type = PyErr_NewExceptionWithDoc((std::string("dynamic_icp.") + name).c_str(), doc, bases.ptr(), nullptr);
  if (type == nullptr) {
    throw py::error_already_set();
  }
  module.add_object(name, py::reinterpret_borrow<py::object>(type));
  return type;
}

}  // namespace

void raise_interrupts() {
  const py::gil_scoped_acquire gil;
  if (PyErr_CheckSignals() != 0) {
    throw py::error_already_set();
  }
}

void bind_errors(py::module_& module) {
  const auto type = [](PyObject* exception) { return py::reinterpret_borrow<py::object>(exception); };
  data_error =
      new_exception(module, "DataError", kDataErrorDoc, py::make_tuple(type(PyExc_OSError), type(PyExc_ValueError)));
  usage_error = new_exception(module, "UsageError", kUsageErrorDoc, py::make_tuple(type(PyExc_ValueError)));
  py::register_exception_translator(translate);
}

}  // namespace dynamic_icp::python
