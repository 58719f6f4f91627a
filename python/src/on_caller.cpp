#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "common.hpp"

namespace feldspar::python {

// Everything but `interrupted` is guarded by the mutex.
struct OnCaller::Shared {
    std::mutex mutex;
    std::condition_variable to_caller, to_work;
    const std::function<void()>* wanted = nullptr;  // a call that waits to be made
    bool made = false;                              // it has been
    bool refusing = false;                          // no further calls: the work is to end
    bool over = false;
    std::exception_ptr of_work, of_python;
    bool interrupted = false;
};

OnCaller::OnCaller() : shared_(std::make_unique<Shared>()) {}
OnCaller::~OnCaller() = default;

bool OnCaller::interrupted() const { return shared_->interrupted; }

bool OnCaller::call(const std::function<void()>& call) {
    Shared& s = *shared_;
    std::unique_lock lock(s.mutex);
    s.to_work.wait(lock, [&] { return s.wanted == nullptr || s.refusing; });  // another thread's call
    if (s.refusing) return false;
    s.wanted = &call;
    s.made = false;
    s.to_caller.notify_one();
    s.to_work.wait(lock, [&] { return s.made || s.refusing; });
    const bool made = s.made;
    s.wanted = nullptr;
    s.to_work.notify_all();
    return made && !s.refusing;
}

void OnCaller::run(const std::function<void()>& work, const std::function<void()>& stop) {
    constexpr std::chrono::milliseconds kLook{50};  // how long Ctrl-C may wait
    Shared& s = *shared_;
    std::thread thread([&] {
        std::exception_ptr error;
        try {
            work();
        } catch (...) {
            error = std::current_exception();
        }
        const std::scoped_lock lock(s.mutex);
        s.of_work = error;
        s.over = true;
        s.to_caller.notify_one();
    });
    const auto refuse = [&] {
        {
            const std::scoped_lock lock(s.mutex);
            s.refusing = true;
        }
        s.to_work.notify_all();
        stop();
    };
    for (;;) {
        const std::function<void()>* wanted = nullptr;
        bool over = false;
        {
            const py::gil_scoped_release free;
            std::unique_lock lock(s.mutex);
            s.to_caller.wait_for(lock, kLook, [&] { return s.over || (s.wanted != nullptr && !s.made && !s.refusing); });
            over = s.over;
            if (s.wanted != nullptr && !s.made && !s.refusing) wanted = s.wanted;
        }
        if (over) break;
        if (wanted != nullptr) {
            bool failed = false;
            try {
                (*wanted)();
            } catch (...) {
                s.of_python = std::current_exception();
                failed = true;
            }
            if (failed) {
                refuse();
                continue;
            }
            const std::scoped_lock lock(s.mutex);
            s.made = true;
            s.to_work.notify_all();
        }
        if (!s.refusing && PyErr_CheckSignals() != 0) {
            try {
                throw py::error_already_set();
            } catch (py::error_already_set& error) {
                if (error.matches(PyExc_KeyboardInterrupt))
                    s.interrupted = true;
                else
                    s.of_python = std::current_exception();
            }
            refuse();
        }
    }
    {
        const py::gil_scoped_release free;
        thread.join();
    }
    if (s.of_python) {
        try {
            std::rethrow_exception(s.of_python);
        } catch (py::error_already_set& error) {
            if (!error.matches(PyExc_KeyboardInterrupt)) throw;
            s.interrupted = true;  // Ctrl-C while Python was called
        }
    }
    if (s.of_work && !s.interrupted) std::rethrow_exception(s.of_work);
}

}  // namespace feldspar::python
