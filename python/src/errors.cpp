// Errors of the library as those of Python, and small conversions.
#include <cmath>

#include "common.hpp"
#include "feldspar/base/error.hpp"
#include "feldspar/job/mistakes.hpp"

namespace feldspar::python {
namespace {

py::object error_class(const char* name) { return py::module_::import("feldspar.errors").attr(name); }

void raise(const char* name, const py::object& error) { PyErr_SetObject(error_class(name).ptr(), error.ptr()); }

py::object input_error(const InputError& error) {
    py::list mistakes;
    const py::object mistake = error_class("Mistake");
    for (const InputError& one : each_mistake(error)) {
        const InputPlace& place = one.place();
        mistakes.append(mistake(place.file, place.line, place.column, place.key, one.problem(), one.allowed(), one.suggestion()));
    }
    return error_class("InputError")(error.what(), mistakes);
}

}  // namespace

void translate_errors() {
    py::register_exception_translator([](std::exception_ptr error) {
        try {
            if (error) std::rethrow_exception(error);
        } catch (const InputError& e) {
            raise("InputError", input_error(e));
        } catch (const NumericalError& e) {
            raise("NumericalError", error_class("NumericalError")(e.what()));
        } catch (const OutputError& e) {
            raise("OutputError", error_class("OutputError")(e.what()));
        } catch (const Interrupted& e) {
            raise("Interrupted", error_class("Interrupted")(e.what()));
        }
    });
}

void raise_interrupted(const py::object& result) {
    raise("Interrupted", error_class("Interrupted")("interrupted by the user", result));
    throw py::error_already_set();
}

void raise_numerical(const std::string& message, const py::object& result) {
    raise("NumericalError", error_class("NumericalError")(message, result));
    throw py::error_already_set();
}

py::array read_only(py::array array) {
    py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
    return array;
}

py::object number_or_none(double value) { return std::isnan(value) ? py::object(py::none()) : py::object(py::float_(value)); }

}  // namespace feldspar::python
