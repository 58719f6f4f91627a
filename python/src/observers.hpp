// A test that is watched and led from Python.
#pragma once

#include <memory>
#include <optional>

#include "feldspar/lab/observer.hpp"
#include "feldspar/model/assembly.hpp"
#include "types.hpp"

namespace feldspar::python {

/// A stage as Python has it.
struct PyStage {
    StageSpec spec;
};

/// The state of a running test as Python sees it, during a call only.
class PyState;

/// Calls a function of Python every so many steps, on the thread that started the test.
class PyObserver final : public TestObserver {
public:
    /// @param every  steps between two calls; rounded up to records
    PyObserver(OnCaller& caller, py::function function, long long every, std::optional<PyStage> first)
        : caller_(caller), function_(std::move(function)), every_(every), first_(std::move(first)) {}

    std::optional<StageSpec> begins() override { return first_ ? std::optional(first_->spec) : std::nullopt; }
    TestOrders look(const TestView& view) override;
    void leaves(Assembly&& assembly) noexcept override;

private:
    OnCaller& caller_;
    py::function function_;
    long long every_;
    std::optional<PyStage> first_;
    long long next_ = 0, last_ = -1;                                 // steps
    std::shared_ptr<Assembly> left_ = std::make_shared<Assembly>();  // what views look at when the test is over
};

}  // namespace feldspar::python
