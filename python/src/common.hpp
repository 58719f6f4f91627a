// What the parts of the Python module share: views of arrays, errors, and work beside the interpreter.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "feldspar/base/vec2.hpp"

namespace py = pybind11;

namespace feldspar::python {

// ------------------------------------------------------------------------------------------------------------------------ arrays

/// Makes an array read-only.
py::array read_only(py::array array);

/// Read-only view of memory that `owner` keeps alive. @param strides  in bytes
template <class T>
py::array view(const T* data, std::vector<py::ssize_t> shape, std::vector<py::ssize_t> strides, const py::handle& owner) {
    return read_only(py::array(py::dtype::of<T>(), std::move(shape), std::move(strides), data, owner));
}

/// Of numbers that stand one after the other.
template <class Vector>
py::array view(const Vector& numbers, const py::handle& owner) {
    using T = typename Vector::value_type;
    return view(numbers.data(), {static_cast<py::ssize_t>(numbers.size())}, {sizeof(T)}, owner);
}

/// Of points: shape (n, 2).
template <class Points>
py::array view_points(const Points& points, const py::handle& owner) {
    static_assert(std::is_same_v<typename Points::value_type, Vec2>);
    return view(points.empty() ? nullptr : &points.data()->x, {static_cast<py::ssize_t>(points.size()), 2},
                {sizeof(Vec2), sizeof(double)}, owner);
}

/// Of one member of each structure of a list.
template <class T, class Vector>
py::array view_member(const Vector& list, const T* first, const py::handle& owner) {
    return view(list.empty() ? nullptr : first, {static_cast<py::ssize_t>(list.size())}, {sizeof(typename Vector::value_type)},
                owner);
}

/// Keeps a shared object alive for the views of its arrays.
template <class T>
py::capsule keeper(std::shared_ptr<T> object) {
    using Held = std::shared_ptr<T>;
    return py::capsule(new Held(std::move(object)), [](void* held) { delete static_cast<Held*>(held); });
}

/// A new array with a copy.
template <class T>
py::array_t<T> copied(const std::vector<T>& values) {
    return py::array_t<T>(static_cast<py::ssize_t>(values.size()), values.data());
}

/// Not-a-number becomes None.
py::object number_or_none(double value);

// ------------------------------------------------------------------------------------------------------------------------ errors

/// Lets errors of the library arrive as those of feldspar.errors.
void translate_errors();

/// Raises feldspar.errors.Interrupted with what there is. @param result  may be None
[[noreturn]] void raise_interrupted(const py::object& result);

/// Raises feldspar.errors.NumericalError with the record of the test until then.
[[noreturn]] void raise_numerical(const std::string& message, const py::object& result);

// ------------------------------------------------------------------------------------------------------------------ running work

/// Runs work on a thread of its own while the calling thread waits without the interpreter's lock, looks for Ctrl-C, and calls
/// Python for the work. So everything that is written in Python runs on the thread that it belongs to.
class OnCaller {
public:
    OnCaller();
    ~OnCaller();

    /// To be called by the calling thread, with the interpreter's lock. Returns when the work has ended. After Ctrl-C, or an
    /// error in Python, `stop` is called once, and the work is waited for. @throws what the work threw, or the error of Python,
    /// which goes before; of Ctrl-C nothing: interrupted() tells
    void run(const std::function<void()>& work, const std::function<void()>& stop);

    /// Ctrl-C was pressed.
    bool interrupted() const;

    /// To be called by any thread of the work, without the lock: runs `call` on the calling thread, with the lock, and waits for
    /// it.
    /// @return false if it was not made, or has failed in Python: the work is to end
    bool call(const std::function<void()>& call);

private:
    struct Shared;
    std::unique_ptr<Shared> shared_;
};

// ------------------------------------------------------------------------------------------------------------------------- parts

void bind_jobs(py::module_& module);
void bind_specimens(py::module_& module);
void bind_results(py::module_& module);
void bind_observers(py::module_& module);
void bind_running(py::module_& module);
void bind_studies(py::module_& module);

}  // namespace feldspar::python
